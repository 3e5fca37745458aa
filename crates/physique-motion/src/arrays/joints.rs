//! Features and joint positions in arrays, whatever the order of their axes.

use glam::Vec3;

use super::{Context, points};
use crate::features::{FeatureSkeleton, JointFile, JointPositions, MotionFeatures};
use crate::npz::Array;
use crate::read::Part;
use crate::smpl_motion::{SMPL_JOINTS, SMPLH_JOINTS, SMPLX_JOINTS};
use crate::world::World;
use crate::{Error, FrameRate, PositionClip, SourceMotion};

/// What an array of motions holds, by its shape.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct Axes {
    pub(super) skeleton: FeatureSkeleton,
    is_features: bool,
    /// Numbers of a frame: of positions, more than the skeleton's where hands are behind.
    width: usize,
    /// Number of motions, where the first axis counts them.
    pub(super) motions: Option<usize>,
    pub(super) frames: usize,
    frames_last: bool,
}

/// Joints a frame that positions may have: hands, jaw and eyes come behind the body's.
const fn joint_counts(skeleton: FeatureSkeleton) -> &'static [usize] {
    match skeleton {
        FeatureSkeleton::HumanMl3d => &[22, SMPL_JOINTS, SMPLH_JOINTS, SMPLX_JOINTS],
        FeatureSkeleton::Kit => &[21],
    }
}

impl Axes {
    /// Frames come before the numbers of a frame, or, as in PyTorch's convolutions, after them.
    pub(super) fn of(shape: &[usize]) -> Option<Self> {
        FeatureSkeleton::ALL.into_iter().find_map(|skeleton| {
            let width = skeleton.feature_count();
            let axes = |is_features, width, motions, frames, frames_last| {
                Some(Self {
                    skeleton,
                    is_features,
                    width,
                    motions,
                    frames,
                    frames_last,
                })
            };
            let has = |joints| joint_counts(skeleton).contains(&joints);
            match *shape {
                [frames, w] if w == width => axes(true, w, None, frames, false),
                [motions, frames, w] if w == width => axes(true, w, Some(motions), frames, false),
                [w, 1, frames] if w == width => axes(true, w, None, frames, true),
                [motions, w, 1, frames] if w == width => axes(true, w, Some(motions), frames, true),
                [frames, w] if w % 3 == 0 && has(w / 3) => axes(false, w, None, frames, false),
                [frames, j, 3] if has(j) => axes(false, 3 * j, None, frames, false),
                [motions, frames, j, 3] if has(j) => {
                    axes(false, 3 * j, Some(motions), frames, false)
                }
                [j, 3, frames] if has(j) => axes(false, 3 * j, None, frames, true),
                // Three frames would be rotation matrices.
                [motions, j, 3, frames] if has(j) && frames != 3 => {
                    axes(false, 3 * j, Some(motions), frames, true)
                }
                _ => None,
            }
        })
    }

    pub(super) const fn format(&self) -> &'static str {
        match (self.skeleton, self.is_features) {
            (FeatureSkeleton::HumanMl3d, true) => "HumanML3D features",
            (FeatureSkeleton::HumanMl3d, false) => "HumanML3D joint positions",
            (FeatureSkeleton::Kit, true) => "KIT-ML features",
            (FeatureSkeleton::Kit, false) => "KIT-ML joint positions",
        }
    }

    /// Which motion of the array, in words.
    fn place(&self, motion: usize) -> String {
        match self.motions {
            Some(_) => format!("motion {motion}"),
            None => "the array".into(),
        }
    }

    /// Numbers of a frame that are the skeleton's.
    const fn own_width(&self) -> usize {
        if self.is_features {
            self.width
        } else {
            3 * self.skeleton.joint_count()
        }
    }

    /// The first `frames` frames of a motion, in the order `[frames][numbers]`, without hands.
    fn rows(&self, values: &[f32], motion: usize, frames: usize) -> Vec<f32> {
        let (width, own) = (self.width, self.own_width());
        let motion = &values[motion * self.frames * width..][..self.frames * width];
        if !self.frames_last {
            let rows = motion.chunks_exact(width).take(frames);
            return rows.flat_map(|row| row[..own].iter().copied()).collect();
        }
        let rows = (0..frames).flat_map(|frame| {
            let columns = motion.iter().skip(frame).step_by(self.frames);
            columns.take(own).copied()
        });
        rows.collect()
    }
}

/// Motions of an array without a dictionary around it.
pub(super) fn read(context: &Context<'_>, array: &Array) -> Result<Vec<Part>, Error> {
    let Some(axes) = Axes::of(array.shape()) else {
        let expected = "[frames][263], [frames][251], [frames][22][3] or [frames][21][3], alone or \
            behind a number of motions";
        return Err(context.format("the shape", expected, format!("{:?}", array.shape())));
    };
    let values = numbers(context, array)?;
    let motions = (0..axes.motions.unwrap_or(1)).map(|index| Part {
        key: axes.motions.map_or(String::new(), |_| index.to_string()),
        text: None,
        format: axes.format(),
        motion: clip(context, &axes, &values, index, axes.frames)
            .and_then(|clip| person(context, &axes, index, clip))
            .map(SourceMotion::Positions),
    });
    Ok(motions.collect())
}

/// A clip of which only the shape is known: a person's, made to stand along Y.
fn person(
    context: &Context<'_>,
    axes: &Axes,
    motion: usize,
    mut clip: PositionClip,
) -> Result<PositionClip, Error> {
    if axes.is_features {
        return Ok(clip);
    }
    if !points::are_a_persons(&clip.positions) {
        let full_turn = std::f32::consts::TAU + 1e-3;
        let mut vectors = clip.positions.positions().iter();
        let found = if vectors.all(|vector| vector.length() < full_turn) {
            "vectors that look like rotations, which need a path: a dictionary of `poses` and `trans`"
        } else {
            "points of no person's proportions"
        };
        let expected = "joint positions, whose bones are a person's";
        return Err(context.format(axes.place(motion), expected, found));
    }
    if let Some((metres, note)) = points::unit(&clip.positions) {
        let scaled = clip.positions.positions().iter().map(|&at| at * metres);
        clip.positions = clip.positions.with_positions(scaled.collect())?;
        clip.notes.push(note);
    }
    let world = match context.options.up_axis {
        Some(up) => World::from(up),
        None => points::world(&clip.positions),
    };
    if world != World::YUp {
        let positions = clip.positions.positions().iter();
        let turned = positions.map(|&at| world.to_ours(at.as_dvec3()).as_vec3());
        clip.positions = clip.positions.with_positions(turned.collect())?;
        if context.options.up_axis.is_none() {
            clip.notes.push(format!(
                "The person stands upright with {}, which was taken.",
                world.words()
            ));
        }
    }
    Ok(clip)
}

/// All numbers of an array, which must hold some: any number of motions without frames would fit
/// into an empty one.
pub(super) fn numbers(context: &Context<'_>, array: &Array) -> Result<Vec<f32>, Error> {
    if array.shape().contains(&0) {
        let found = format!("{:?}", array.shape());
        return Err(context.format("the shape", "at least one frame", found));
    }
    array.to_f32().map_err(|problem| Error::Array {
        path: context.path.into(),
        problem,
    })
}

/// The only motion of an array, features as features.
pub(super) fn only(context: &Context<'_>, array: &Array) -> Result<JointFile, Error> {
    let axes = Axes::of(array.shape()).filter(|axes| axes.motions.is_none());
    let Some(axes) = axes else {
        let expected = "[frames][263], [frames][251], [frames][22][3] or [frames][21][3]";
        return Err(context.format("the shape", expected, format!("{:?}", array.shape())));
    };
    let values = numbers(context, array)?;
    file(context, &axes, &values, 0, axes.frames, &mut Vec::new())
}

/// One motion of an array, cut to `frames` frames.
pub(super) fn clip(
    context: &Context<'_>,
    axes: &Axes,
    values: &[f32],
    motion: usize,
    frames: usize,
) -> Result<PositionClip, Error> {
    let mut notes = Vec::new();
    let positions = file(context, axes, values, motion, frames, &mut notes)?.into_positions();
    let positions = positions.map_err(|problem| context.inside(axes.place(motion), problem))?;
    Ok(PositionClip { positions, notes })
}

fn file(
    context: &Context<'_>,
    axes: &Axes,
    values: &[f32],
    motion: usize,
    frames: usize,
    notes: &mut Vec<String>,
) -> Result<JointFile, Error> {
    context.check_frames(frames)?;
    let rate = match context.options.frame_rate {
        Some(rate) => rate,
        None => FrameRate::new(axes.skeleton.frames_per_second())?,
    };
    if context.options.frame_rate.is_none() {
        notes.push(format!(
            "The file does not state its frame rate: the data set's {} frames a second were taken.",
            rate.per_second()
        ));
    }
    let rows = axes.rows(values, motion, frames);
    let not_a_motion = |problem: Error| context.inside(axes.place(motion), problem);
    if axes.is_features {
        let format = axes.format();
        notes.push(format!("Joint positions were recovered from {format}."));
        let features = MotionFeatures::new(rate, axes.skeleton, rows).map_err(not_a_motion)?;
        in_own_units(context, features, &axes.place(motion), notes).map(JointFile::Features)
    } else {
        let (joints, found) = (axes.skeleton.joint_count(), axes.width / 3);
        if found > joints {
            notes.push(format!(
                "Of {found} joints a frame, the body's {joints} were taken, which come first."
            ));
        }
        let positions = rows.as_chunks().0.iter().copied().map(Vec3::from_array);
        let positions = JointPositions::new(rate, axes.skeleton, positions.collect());
        positions.map(JointFile::Positions).map_err(not_a_motion)
    }
}

/// Features with their normalisation undone, where they have one.
fn in_own_units(
    context: &Context<'_>,
    features: MotionFeatures,
    place: &str,
    notes: &mut Vec<String>,
) -> Result<MotionFeatures, Error> {
    let statistics = context.options.statistics.as_ref();
    match (features.look_normalised(), statistics) {
        (false, None) => Ok(features),
        (false, Some(_)) => {
            notes.push(
                "Mean and deviation were given, but the features are not normalised: they were read \
                 as they are."
                    .into(),
            );
            Ok(features)
        }
        (true, Some(statistics)) if statistics.skeleton() == features.skeleton() => {
            notes.push("Normalisation was undone with the mean and deviation given.".into());
            let mut values = features.values().to_vec();
            statistics.denormalise(&mut values);
            MotionFeatures::new(features.frame_rate(), features.skeleton(), values)
        }
        (true, statistics) => {
            let expected = "features in their own units, or the mean and deviation of their data set \
                (--mean and --std)";
            let found = match statistics {
                None => "features that look normalised".into(),
                Some(other) => format!(
                    "features that look normalised, of {} numbers, and statistics of {}",
                    features.skeleton().feature_count(),
                    other.skeleton().feature_count()
                ),
            };
            Err(context.format(place, expected, found))
        }
    }
}

#[cfg(test)]
mod tests {
    use super::{Axes, FeatureSkeleton};

    #[test]
    fn axes_are_told_by_their_lengths() {
        let seen = |shape: &[usize]| {
            Axes::of(shape).map(|axes| (axes.format(), axes.motions, axes.frames, axes.frames_last))
        };
        for (shape, expected) in [
            (&[60, 263][..], ("HumanML3D features", None, 60, false)),
            (&[3, 60, 251], ("KIT-ML features", Some(3), 60, false)),
            (
                &[6, 263, 1, 120],
                ("HumanML3D features", Some(6), 120, true),
            ),
            (&[60, 22, 3], ("HumanML3D joint positions", None, 60, false)),
            (&[22, 22, 3], ("HumanML3D joint positions", None, 22, false)),
            (
                &[6, 21, 3, 75],
                ("KIT-ML joint positions", Some(6), 75, true),
            ),
            (&[22, 3, 60], ("HumanML3D joint positions", None, 60, true)),
            (&[60, 66], ("HumanML3D joint positions", None, 60, false)),
            (&[60, 24, 3], ("HumanML3D joint positions", None, 60, false)),
            (
                &[9, 55, 3, 60],
                ("HumanML3D joint positions", Some(9), 60, true),
            ),
        ] {
            assert_eq!(seen(shape), Some(expected), "{shape:?}");
        }
        for shape in [
            &[263][..],
            &[60, 64],
            &[60, 23, 3],
            &[60, 22, 3, 3],
            &[2, 3, 60, 22, 3],
        ] {
            assert_eq!(seen(shape), None, "{shape:?}");
        }
    }

    #[test]
    fn frames_that_come_last_are_brought_to_the_front() {
        let axes = Axes::of(&[2, 22, 3, 5]);
        let values: Vec<f32> = (0..2 * 66 * 5).map(|value| value as f32).collect();
        let rows = axes.map(|axes| axes.rows(&values, 1, 2));
        let expected = (0..2).flat_map(|frame| (0..66).map(move |n| (330 + 5 * n + frame) as f32));
        assert_eq!(rows, Some(expected.collect()));
        assert_eq!(
            axes.map(|axes| axes.skeleton),
            Some(FeatureSkeleton::HumanMl3d)
        );
    }
}

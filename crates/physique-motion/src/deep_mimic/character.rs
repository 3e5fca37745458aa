//! The character `humanoid3d`, and how a row of numbers poses it.

use std::f64::consts::FRAC_1_SQRT_2;
use std::path::Path;

use glam::{DQuat, DVec3, Quat, Vec3};

use super::frames::COLUMNS;
use crate::{Conversion, Error, FrameRate, ReadOptions, Skeleton, SkeletonClip, SkeletonJoint};

/// Names of the joints, parents first, in the order of a frame's numbers; wrists do not move.
pub const JOINTS: [&str; 15] = [
    "root",
    "chest",
    "neck",
    "right_hip",
    "right_knee",
    "right_ankle",
    "right_shoulder",
    "right_elbow",
    "right_wrist",
    "left_hip",
    "left_knee",
    "left_ankle",
    "left_shoulder",
    "left_elbow",
    "left_wrist",
];

/// Parent of each joint.
const PARENTS: [Option<usize>; 15] = [
    None,
    Some(0),
    Some(1),
    Some(0),
    Some(3),
    Some(4),
    Some(1),
    Some(6),
    Some(7),
    Some(0),
    Some(9),
    Some(10),
    Some(1),
    Some(12),
    Some(13),
];

/// Origin of each joint in its parent's frame, in metres, in DeepMimic's axes.
const OFFSETS: [[f64; 3]; 15] = [
    [0.0, 0.0, 0.0],
    [0.0, 0.236_151, 0.0],
    [0.0, 0.223_894, 0.0],
    [0.0, 0.0, 0.084_887],
    [0.0, -0.421_546, 0.0],
    [0.0, -0.409_870, 0.0],
    [-0.024_05, 0.243_5, 0.183_11],
    [0.0, -0.274_788, 0.0],
    [0.0, -0.258_947, 0.0],
    [0.0, 0.0, -0.084_887],
    [0.0, -0.421_546, 0.0],
    [0.0, -0.409_870, 0.0],
    [-0.024_05, 0.243_5, -0.183_11],
    [0.0, -0.274_788, 0.0],
    [0.0, -0.258_947, 0.0],
];

/// Top of the head, and toes at the height of the soles, in their joint's frame.
const TIPS: [(usize, [f64; 3]); 3] = [
    (2, [0.0, 0.277_5, 0.0]),
    (5, [0.133_5, -0.05, 0.0]),
    (11, [0.133_5, -0.05, 0.0]),
];

/// How a joint's rotation stands in a frame.
#[derive(Clone, Copy)]
enum Rotation {
    /// A quaternion (w, x, y, z) at this number.
    Quaternion(usize),
    /// An angle about the lateral axis at this number.
    Hinge(usize),
    Fixed,
}

const ROTATIONS: [Rotation; 15] = {
    use Rotation::{Fixed, Hinge, Quaternion};
    [
        Quaternion(4),
        Quaternion(8),
        Quaternion(12),
        Quaternion(16),
        Hinge(20),
        Quaternion(21),
        Quaternion(25),
        Hinge(29),
        Fixed,
        Quaternion(30),
        Hinge(34),
        Quaternion(35),
        Quaternion(39),
        Hinge(43),
        Fixed,
    ]
};

/// Rotation from DeepMimic's axes to ours: a quarter turn about Y that takes +X to +Z.
const OURS_FROM_FILE: DQuat = DQuat::from_xyzw(0.0, -FRAC_1_SQRT_2, 0.0, FRAC_1_SQRT_2);

/// A vector in our axes: a swap, so exact.
fn ours([x, y, z]: [f64; 3]) -> DVec3 {
    DVec3::new(-z, y, x)
}

/// One pose of the character, in our axes.
struct Pose {
    root: DVec3,
    rotations: [DQuat; 15],
}

impl Pose {
    /// The pose of a row; `Err` names the joint whose quaternion has no length.
    fn from_row(row: &[f64; COLUMNS]) -> Result<Self, &'static str> {
        let mut rotations = [DQuat::IDENTITY; 15];
        for (joint, rotation) in rotations.iter_mut().enumerate() {
            let file = match ROTATIONS[joint] {
                Rotation::Fixed => continue,
                Rotation::Hinge(at) => DQuat::from_rotation_z(row[at]),
                Rotation::Quaternion(at) => {
                    let raw = DQuat::from_xyzw(row[at + 1], row[at + 2], row[at + 3], row[at]);
                    let length = raw.length();
                    if !(length.is_finite() && length > 1e-6) {
                        return Err(JOINTS[joint]);
                    }
                    raw / length
                }
            };
            *rotation = OURS_FROM_FILE * file * OURS_FROM_FILE.inverse();
        }
        Ok(Self {
            root: ours([row[1], row[2], row[3]]),
            rotations,
        })
    }

    /// Between this pose and the next one.
    fn mixed(&self, next: &Self, weight: f64) -> Self {
        Self {
            root: self.root.lerp(next.root, weight),
            rotations: std::array::from_fn(|joint| {
                self.rotations[joint].slerp(next.rotations[joint], weight)
            }),
        }
    }
}

/// The clip that the rows describe.
pub(super) fn clip(
    rows: &[[f64; COLUMNS]],
    path: &Path,
    options: &ReadOptions,
) -> Result<SkeletonClip, Error> {
    let format = |place: String, expected: &str, found: &str| Error::Format {
        path: path.into(),
        place,
        expected: expected.into(),
        found: found.into(),
    };
    let poses: Vec<Pose> = rows
        .iter()
        .enumerate()
        .map(|(frame, row)| {
            Pose::from_row(row).map_err(|joint| {
                let place = format!("frame {frame}, {joint}");
                format(place, "a rotation", "a quaternion of no length")
            })
        })
        .collect::<Result<_, _>>()?;

    let timing = Timing::of(rows, options.frame_rate).ok_or_else(|| {
        format(
            "the durations".into(),
            "a frame that lasts, or a frame rate given as an option",
            "0 s",
        )
    })?;
    let mut conversion = Conversion::default();
    let poses = match timing.resampled_frames {
        None => poses,
        Some(frames) => {
            if frames > options.limits.frames as u64 {
                return Err(Error::Limit {
                    path: path.into(),
                    what: "the number of frames at the shortest duration",
                    found: frames,
                    limit: options.limits.frames as u64,
                });
            }
            conversion.notes.push(format!(
                "Frames of varying duration were resampled at {:.6} s.",
                timing.step
            ));
            resample(&poses, rows, timing.step, frames)
        }
    };

    let frame_rate = match options.frame_rate {
        Some(given) => given,
        None => FrameRate::new(1.0 / timing.step)?,
    };
    let rotations = poses
        .iter()
        .flat_map(|pose| pose.rotations.map(|q| q.as_quat()));
    SkeletonClip::new(
        skeleton()?,
        frame_rate,
        conversion,
        rotations.collect(),
        vec![0],
        poses.iter().map(|pose| pose.root.as_vec3()).collect(),
    )
    .map_err(|error| format("the frames".into(), "a pose each", &error.to_string()))
}

/// Time from frame to frame.
struct Timing {
    step: f64,
    /// Number of frames to resample to, where the durations vary.
    resampled_frames: Option<u64>,
}

impl Timing {
    /// Timing of rows whose last duration does not count: no frame follows it.
    fn of(rows: &[[f64; COLUMNS]], fallback: Option<FrameRate>) -> Option<Self> {
        let lasting = rows[..rows.len() - 1].iter().map(|row| row[0]);
        let shortest = lasting
            .clone()
            .filter(|&duration| duration > 0.0)
            .reduce(f64::min);
        let Some(step) = shortest else {
            // One frame, or frames at no distance: only its own duration or the caller can tell.
            let own = rows
                .iter()
                .map(|row| row[0])
                .find(|&duration| duration > 0.0);
            let step = own.or(fallback.map(FrameRate::frame_seconds))?;
            return Some(Self {
                step,
                resampled_frames: None,
            });
        };
        // Durations are printed with six decimals or more.
        let is_constant = lasting
            .clone()
            .all(|duration| (duration - step).abs() < 1e-5);
        let span: f64 = lasting.sum();
        Some(Self {
            step,
            resampled_frames: (!is_constant)
                .then(|| ((span / step + 1e-6).floor() as u64).saturating_add(1)),
        })
    }
}

/// Poses at a constant step from the first row on.
fn resample(poses: &[Pose], rows: &[[f64; COLUMNS]], step: f64, frames: u64) -> Vec<Pose> {
    let (mut row, mut row_start) = (0, 0.0);
    let mut resampled = Vec::with_capacity(frames as usize);
    for frame in 0..frames {
        let time = frame as f64 * step;
        while row + 2 < poses.len() && time >= row_start + rows[row][0] {
            row_start += rows[row][0];
            row += 1;
        }
        let weight = if rows[row][0] > 0.0 {
            (time - row_start) / rows[row][0]
        } else {
            1.0
        };
        resampled.push(poses[row].mixed(&poses[row + 1], weight.clamp(0.0, 1.0)));
    }
    resampled
}

fn skeleton() -> Result<Skeleton, Error> {
    let joints = JOINTS.iter().enumerate().map(|(joint, &name)| {
        let tips = TIPS.iter().filter(|(of, _)| *of == joint);
        SkeletonJoint {
            name: name.into(),
            parent: PARENTS[joint],
            rest_translation: ours(OFFSETS[joint]).as_vec3(),
            rest_rotation: Quat::IDENTITY,
            end_sites: tips
                .map(|&(_, tip)| ours(tip).as_vec3())
                .collect::<Vec<Vec3>>(),
        }
    });
    Skeleton::new(joints.collect())
}

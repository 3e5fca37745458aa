//! What points without a name show: whether they are a person's joints, and which way is up.
//!
//! A shape of `[frames][22][3]` fits rotation vectors as well as positions, in any world. Bones tell
//! the first: people differ little in how long one bone is against another. How a person stands
//! tells the second.

use glam::Vec3;
use physique_body::Joint;

use crate::clip::spread;
use crate::features::{FeatureSkeleton, JointPositions};
use crate::world::World;

/// So many frames are looked at.
const LOOKED_AT: usize = 64;

/// Whether the bones have a person's proportions, however rough: generated ones stretch.
pub(super) fn are_a_persons(positions: &JointPositions) -> bool {
    /// Three quarters of a person's bones are within this factor of the mean person's. Joints
    /// shaken by 15 cm stay below 2; of the rotation vectors of 320 recordings, all are above 2.8.
    const FACTOR: f32 = 2.3;
    misfit(positions) < FACTOR.ln()
}

/// How far three quarters of the bones are at most from the mean person's, once the size is taken
/// off: |ln(length / usual)|.
fn misfit(positions: &JointPositions) -> f32 {
    let mut misfits = Vec::new();
    for mut ratios in ratios(positions) {
        let size = median(&mut ratios);
        misfits.extend(ratios.iter().map(|ratio| (ratio - size).abs()));
    }
    quantile(&mut misfits, 0.75)
}

/// ln(length / usual) of all bones, for some frames.
fn ratios(positions: &JointPositions) -> impl Iterator<Item = Vec<f32>> {
    let skeleton = positions.skeleton();
    let (parents, offsets) = (skeleton.parents(), skeleton.offsets());
    spread(positions.frame_count(), LOOKED_AT).map(move |frame| {
        let at = positions.frame(frame);
        let bones = parents.iter().zip(&offsets).enumerate();
        let ratios = bones.filter_map(|(joint, (parent, usual))| {
            let length = at[joint].distance(at[(*parent)?]);
            // Bones of no length are the solver's to refuse, which names them.
            (length > 0.0).then(|| (length / usual.length()).ln())
        });
        ratios.collect()
    })
}

/// Metres in the unit of the positions, and a note, where they are a person's in centimetres,
/// millimetres or inches. KIT's have a unit of their own.
pub(super) fn unit(positions: &JointPositions) -> Option<(f32, String)> {
    /// A child and a giant, by the mean person.
    const HUMAN: f32 = 0.6;
    const UNITS: [(f32, &str); 3] = [
        (0.01, "centimetres"),
        (0.001, "millimetres"),
        (0.0254, "inches"),
    ];
    if positions.skeleton() != FeatureSkeleton::HumanMl3d {
        return None;
    }
    let mut sizes: Vec<f32> = ratios(positions).map(|mut all| median(&mut all)).collect();
    let size = median(&mut sizes);
    let off = |metres: f32| (size + metres.ln()).abs();
    let (metres, name) = UNITS
        .into_iter()
        .min_by(|a, b| off(a.0).total_cmp(&off(b.0)))?;
    (size.abs() > HUMAN && off(metres) < HUMAN).then(|| {
        let note = format!("The bones are a person's in {name}: they were brought to metres.");
        (metres, note)
    })
}

/// The middle of some numbers; 0 for none.
fn median(values: &mut [f32]) -> f32 {
    quantile(values, 0.5)
}

/// The number below which a share of some lies; 0 for none.
fn quantile(values: &mut [f32], share: f32) -> f32 {
    let Some(last) = values.len().checked_sub(1) else {
        return 0.0;
    };
    let at = (last as f32 * share).round() as usize;
    *values.select_nth_unstable_by(at, f32::total_cmp).1
}

/// Where an axis's ground would be.
struct Ground {
    /// From the lowest joint of the lowest frames to that of the highest, in a person's heights.
    range: f32,
    /// Whether the lowest joint is at height 0 in half of the frames, and never below.
    is_at_zero: bool,
}

impl Ground {
    /// `lowest` joint of each frame, and the size of the person.
    fn of(mut lowest: Vec<f32>, size: f32) -> Self {
        lowest.sort_by(f32::total_cmp);
        let at = |share: usize| lowest[(lowest.len() - 1) * share / 100] / size;
        Self {
            range: at(95) - at(5),
            is_at_zero: at(5) > -0.03 && at(50) < 0.1,
        }
    }

    /// Whether this looks more like the ground than another.
    fn is_likelier_than(&self, other: &Self) -> bool {
        match (self.is_at_zero, other.is_at_zero) {
            (true, false) => true,
            (false, true) => false,
            _ => self.range < other.range,
        }
    }
}

/// The world in which the person stands: Y up, unless they stand along another axis and its ground
/// is likelier, since crawling and lying people are upright along the ground.
pub(super) fn world(positions: &JointPositions) -> World {
    /// Mean height from ankles to head along the axis, of their distance.
    const UPRIGHT: f32 = 0.6;
    let [ankles, head] = match positions.skeleton() {
        FeatureSkeleton::HumanMl3d => [
            [Joint::LeftAnkle.index(), Joint::RightAnkle.index()],
            [Joint::Head.index(), Joint::Neck.index()],
        ],
        // KIT's joints are mirrored, which does not matter here: its spine ends at 4.
        FeatureSkeleton::Kit => [[18, 13], [4, 4]],
    };
    let (mut upright, mut size, mut frames) = (Vec3::ZERO, 0.0, 0.0_f32);
    let mut lowest = [const { Vec::new() }; 2];
    for frame in spread(positions.frame_count(), LOOKED_AT) {
        let at = positions.frame(frame);
        let middle = |[a, b]: [usize; 2]| at[a].midpoint(at[b]);
        let tall = middle(head) - middle(ankles);
        upright += tall.normalize_or_zero();
        size += tall.length();
        frames += 1.0;
        let low = at.iter().copied().fold(Vec3::INFINITY, Vec3::min);
        lowest[0].push(low.y);
        lowest[1].push(low.z);
    }
    let (upright, size) = (upright / frames, size / frames);
    let [along_y, along_z] = lowest.map(|lowest| Ground::of(lowest, size));
    if upright.z > UPRIGHT && along_z.is_likelier_than(&along_y) {
        World::ZUp
    } else if upright.y < -UPRIGHT && !along_y.is_at_zero {
        World::Camera
    } else {
        World::YUp
    }
}

#[cfg(test)]
mod tests {
    use super::{Ground, median, quantile};

    #[test]
    fn the_middle_of_numbers() {
        assert_eq!(median(&mut [3.0, 1.0, 2.0]), 2.0);
        assert_eq!(median(&mut []), 0.0);
        assert_eq!(quantile(&mut [4.0, 0.0, 3.0, 1.0, 2.0], 0.75), 3.0);
    }

    #[test]
    fn ground_is_where_feet_return_to() {
        let flat = Ground::of(vec![0.02; 10], 1.5);
        let far = Ground::of(vec![0.9; 10], 1.5);
        let sloping = Ground::of((0..10).map(|step| step as f32).collect(), 1.5);
        assert!(flat.is_likelier_than(&far) && !far.is_likelier_than(&flat));
        assert!(far.is_likelier_than(&sloping) && !sloping.is_likelier_than(&far));
    }
}

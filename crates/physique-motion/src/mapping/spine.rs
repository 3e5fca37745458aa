//! A spine of any number of joints resampled to the body's three, a neck to one.

use glam::Quat;
use physique_body::Joint;

use super::{
    alignment::Alignment, axes::mean_rotation, body_rest::BodyRest, human_joints::HumanJoints,
};
use crate::SkeletonPose;

/// How much each source joint of the trunk contributes to `spine1` and `spine2`, and of the neck
/// to `neck`. `spine3` carries neck and arms and takes the chest's orientation as it is.
#[derive(Clone, Debug)]
pub(super) struct SpineWeights {
    /// By source joint from the pelvis up.
    lower: Vec<f32>,
    middle: Vec<f32>,
    neck: Vec<f32>,
}

impl SpineWeights {
    /// A bone of the body takes the mean orientation of the piece of the source's spine that lies
    /// at the same height between pelvis and neck, so the spine keeps its curve. A spine of one
    /// joint bends by thirds instead of in one place.
    pub(super) fn new(human: &HumanJoints, pose: &SkeletonPose, body: &BodyRest) -> Self {
        let distance = |a: usize, b: usize| pose.positions[a].distance(pose.positions[b]);
        let chain: Vec<usize> = [human.pelvis]
            .into_iter()
            .chain(human.spine.clone())
            .collect();
        let top = human
            .neck
            .first()
            .copied()
            .or(human.head)
            .unwrap_or(human.left.shoulder);
        let ends: Vec<usize> = chain[1..].iter().copied().chain([top]).collect();
        let lengths: Vec<f32> = chain
            .iter()
            .zip(&ends)
            .map(|(&from, &to)| distance(from, to))
            .collect();

        let offset = |joint| body.offset(joint).length();
        let bones = [Joint::Spine1, Joint::Spine2, Joint::Spine3, Joint::Neck].map(offset);
        let whole: f32 = bones.iter().sum();
        let piece = |from: f32, to: f32| overlaps(&lengths, from / whole, to / whole);
        let (lower, middle) = match chain.len() {
            1 => (vec![1.0], vec![1.0]),
            2 => (vec![2.0 / 3.0, 1.0 / 3.0], vec![1.0 / 3.0, 2.0 / 3.0]),
            _ => (
                piece(bones[0], bones[0] + bones[1]),
                piece(bones[0] + bones[1], whole - bones[3]),
            ),
        };
        let neck_ends = human.neck.iter().skip(1).copied().chain(human.head);
        let mut neck: Vec<f32> = human
            .neck
            .iter()
            .zip(neck_ends)
            .map(|(&from, to)| distance(from, to))
            .collect();
        neck.resize(human.neck.len(), 0.0);
        if neck.iter().sum::<f32>() <= 0.0 {
            neck.fill(1.0);
        }
        Self {
            lower,
            middle,
            neck,
        }
    }

    /// Sets the world orientations of pelvis, spine, neck and head.
    pub(super) fn orient(
        &self,
        human: &HumanJoints,
        alignment: &Alignment,
        pose: &SkeletonPose,
        world_from_joint: &mut [Quat; Joint::COUNT],
    ) {
        let oriented = |joint: usize| alignment.world_from_body(pose, joint);
        let trunk = || {
            [human.pelvis]
                .into_iter()
                .chain(human.spine.iter().copied())
        };
        let pelvis = oriented(human.pelvis);
        let chest = oriented(human.chest());
        let mean = |weights: &[f32], joints: &mut dyn Iterator<Item = usize>| {
            mean_rotation(weights.iter().copied().zip(joints.map(oriented)))
        };
        let lower = mean(&self.lower, &mut trunk()).unwrap_or(pelvis);
        let middle = mean(&self.middle, &mut trunk()).unwrap_or(pelvis);
        let head = human.head.map(oriented);
        // Without a neck joint, the neck shares the way from chest to head.
        let between = head.map_or(chest, |head| chest.slerp(head, 0.5));
        let neck = mean(&self.neck, &mut human.neck.iter().copied()).unwrap_or(between);
        for (joint, rotation) in [
            (Joint::Pelvis, pelvis),
            (Joint::Spine1, lower),
            (Joint::Spine2, middle),
            (Joint::Spine3, chest),
            (Joint::Neck, neck),
            (Joint::Head, head.unwrap_or(neck)),
        ] {
            world_from_joint[joint.index()] = rotation;
        }
    }
}

/// Length of each piece of a chain inside `from..to`, which are parts of the whole chain.
fn overlaps(lengths: &[f32], from: f32, to: f32) -> Vec<f32> {
    let whole: f32 = lengths.iter().sum();
    let mut start = 0.0;
    let pieces = lengths.iter().map(|length| {
        let end = start + length;
        let overlap = (end.min(to * whole) - start.max(from * whole)).max(0.0);
        start = end;
        overlap
    });
    pieces.collect()
}

#[cfg(test)]
mod tests {
    use super::overlaps;

    #[test]
    fn overlaps_cut_a_chain_by_parts_of_its_length() {
        assert_eq!(overlaps(&[1.0, 1.0, 2.0], 0.25, 0.75), [0.0, 1.0, 1.0]);
        assert_eq!(overlaps(&[1.0, 3.0], 0.5, 1.0), [0.0, 2.0]);
        assert_eq!(overlaps(&[0.0, 0.0], 0.0, 1.0), [0.0, 0.0]);
    }
}

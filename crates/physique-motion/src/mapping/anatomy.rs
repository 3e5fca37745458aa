//! Alignment of rigs whose zero pose is no human pose, from how the clip moves.
//!
//! Such rigs (Bandai Namco, LAFAN1, iClone) lay every bone along one local axis. What a joint's
//! axes mean is read off the body: hips and shoulders lie to the left and right, elbows and knees
//! bend about a hinge, soles lie flat when the foot is lowest. Measured directions close to a
//! local axis are taken for the axis, so that two clips of one rig agree. From a joint to the
//! next along a straight chain (upper arm to forearm to hand, chest to neck to head) axes carry
//! over by the zero pose, in which the chain is straight and untwisted.

mod arm;
mod leg;

use glam::{Quat, Vec3};
use physique_body::Joint;

use super::{
    axes::{align, degrees_between, snapped},
    body_rest::BodyRest,
    human_joints::{HumanJoints, Limbs},
    soles::Soles,
};
use crate::{Skeleton, SkeletonClip, SkeletonPose, clip::spread};

/// A measured direction this near to a local axis means the axis.
const SNAP_DEGREES: f32 = 25.0;

/// The clip's poses that are looked at; more would not change the means.
const MOST_FRAMES: usize = 400;

/// `joint_from_body` by source joint.
pub(super) fn joint_from_body(
    clip: &SkeletonClip,
    human: &HumanJoints,
    body: &BodyRest,
    soles: Soles,
) -> Vec<Quat> {
    let poses = spread(clip.frame_count(), MOST_FRAMES).map(|frame| clip.pose(frame));
    let mut anatomy = Anatomy {
        skeleton: clip.skeleton(),
        human,
        body,
        rest: clip.skeleton().rest_pose(),
        soles,
        poses: poses.collect(),
        joint_from_body: vec![Quat::IDENTITY; clip.skeleton().joint_count()],
    };
    anatomy.trunk();
    for side in [Side::LEFT, Side::RIGHT] {
        anatomy.arm(side);
        anatomy.leg(side);
    }
    anatomy.joint_from_body
}

/// The body's joints of one side.
#[derive(Clone, Copy)]
struct Side {
    shoulder: Joint,
    elbow: Joint,
    wrist: Joint,
    hip: Joint,
    knee: Joint,
    ankle: Joint,
    outward: Vec3,
}

impl Side {
    const LEFT: Self = Self::of(0, Vec3::X);
    const RIGHT: Self = Self::of(1, Vec3::NEG_X);

    const fn of(side: usize, outward: Vec3) -> Self {
        let [_, shoulder, elbow, wrist] = Joint::ARMS[side];
        let [hip, knee, ankle, _] = Joint::LEGS[side];
        Self {
            shoulder,
            elbow,
            wrist,
            hip,
            knee,
            ankle,
            outward,
        }
    }

    fn limbs(self, human: &HumanJoints) -> &Limbs {
        if self.outward == Vec3::X {
            &human.left
        } else {
            &human.right
        }
    }
}

struct Anatomy<'a> {
    skeleton: &'a Skeleton,
    human: &'a HumanJoints,
    body: &'a BodyRest,
    rest: SkeletonPose,
    poses: Vec<SkeletonPose>,
    soles: Soles,
    joint_from_body: Vec<Quat>,
}

impl Anatomy<'_> {
    /// Mean over the clip of a direction of the world, seen from a joint.
    fn seen_from(&self, joint: usize, direction: impl Fn(&SkeletonPose) -> Vec3) -> Vec3 {
        let local = |pose: &SkeletonPose| pose.rotations[joint].inverse() * direction(pose);
        self.poses
            .iter()
            .map(local)
            .sum::<Vec3>()
            .normalize_or_zero()
    }

    /// Mean direction of a bone in the frame of its upper joint.
    fn bone(&self, from: usize, to: usize) -> Vec3 {
        self.seen_from(from, |pose| pose.positions[to] - pose.positions[from])
    }

    /// Mean axis about which the second bone of a limb bends away from the first, seen from a
    /// joint. Strongly bent frames weigh more. Zero for a limb that never bends.
    fn hinge(&self, joint: usize, [top, middle, end]: [usize; 3]) -> Vec3 {
        let axis = self.seen_from(joint, |pose| {
            let upper = (pose.positions[middle] - pose.positions[top]).normalize_or_zero();
            let lower = (pose.positions[end] - pose.positions[middle]).normalize_or_zero();
            let across = upper.cross(lower);
            // Below 10 degrees the bend is a rig's carrying angle rather than a motion.
            if across.length() > 0.17 {
                across * across.length()
            } else {
                Vec3::ZERO
            }
        });
        snapped(axis, SNAP_DEGREES)
    }

    /// A direction of one joint's frame carried to another's by the zero pose.
    fn carried(&self, direction: Vec3, from: usize, to: usize) -> Vec3 {
        self.rest.rotations[to].inverse() * (self.rest.rotations[from] * direction)
    }

    /// Sets `joint_from_body` from a direction and a second one, each in the body's frame and the
    /// joint's.
    fn set(&mut self, joint: usize, body: [Vec3; 2], local: [Vec3; 2]) {
        if let Some(rotation) = align(body, local) {
            self.joint_from_body[joint] = rotation;
        }
    }

    /// Copies the alignment of a joint to the next by the zero pose.
    fn carry(&mut self, from: usize, to: usize) {
        let to_from = self.rest.rotations[to].inverse() * self.rest.rotations[from];
        self.joint_from_body[to] = (to_from * self.joint_from_body[from]).normalize();
    }

    fn trunk(&mut self) {
        let human = self.human;
        let [left_hip, right_hip] = human.hips();
        let [left_shoulder, right_shoulder] = human.shoulders();
        let middle = [human.pelvis]
            .into_iter()
            .chain(human.spine.iter().copied());
        let trunk: Vec<usize> = middle.collect();
        let top = human.neck.first().copied().or(human.head);
        for (place, &joint) in trunk.iter().enumerate() {
            let above = trunk.get(place + 1).copied().or(top);
            let left = self.seen_from(joint, |pose| {
                let hips = pose.positions[left_hip] - pose.positions[right_hip];
                let shoulders = pose.positions[left_shoulder] - pose.positions[right_shoulder];
                if place == 0 { hips } else { shoulders }
            });
            let up = self.seen_from(joint, |pose| {
                let [left, right] = [left_shoulder, right_shoulder].map(|at| pose.positions[at]);
                let above = above.map_or((left + right) / 2.0, |above| pose.positions[above]);
                above - pose.positions[joint]
            });
            let local = [snapped(left, SNAP_DEGREES), snapped(up, SNAP_DEGREES)];
            self.set(joint, [Vec3::X, Vec3::Y], local);
        }
        let mut below = human.chest();
        for &joint in human.neck.iter().chain(&human.head) {
            self.carry(below, joint);
            below = joint;
        }
    }

    /// The upper bone's hinge as the lower joint's axis: by the zero pose if the limb is straight
    /// there, otherwise as the lower joint sees the hinge over the clip.
    fn carried_if_straight(
        &self,
        upper: Vec3,
        hinge: Vec3,
        [from, to]: [usize; 2],
        lower: Vec3,
        bones: [usize; 3],
    ) -> Vec3 {
        let seen = self.hinge(to, bones);
        if degrees_between(self.carried(upper, from, to), lower) < 40.0 || seen == Vec3::ZERO {
            self.carried(hinge, from, to)
        } else {
            seen
        }
    }
}

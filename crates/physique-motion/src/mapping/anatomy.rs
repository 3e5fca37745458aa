//! Alignment of rigs whose zero pose is no human pose, from how the clip moves.
//!
//! Such rigs (Bandai Namco, LAFAN1, iClone) lay every bone along one local axis. What a joint's
//! axes mean is read off the body: hips and shoulders lie to the left and right, elbows and knees
//! bend about a hinge, soles lie flat when the foot is lowest. Measured directions close to a
//! local axis are taken for the axis, so that two clips of one rig agree. From a joint to the
//! next along a straight chain (upper arm to forearm to hand, chest to neck to head) axes carry
//! over by the zero pose, in which the chain is straight and untwisted.

use glam::{Quat, Vec3};
use physique_body::Joint;

use super::{
    axes::{align, degrees_between, mean_rotation, reject, snapped},
    body_rest::BodyRest,
    figure::ball_of_foot,
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
    const LEFT: Self = Self {
        shoulder: Joint::LeftShoulder,
        elbow: Joint::LeftElbow,
        wrist: Joint::LeftWrist,
        hip: Joint::LeftHip,
        knee: Joint::LeftKnee,
        ankle: Joint::LeftAnkle,
        outward: Vec3::X,
    };
    const RIGHT: Self = Self {
        shoulder: Joint::RightShoulder,
        elbow: Joint::RightElbow,
        wrist: Joint::RightWrist,
        hip: Joint::RightHip,
        knee: Joint::RightKnee,
        ankle: Joint::RightAnkle,
        outward: Vec3::NEG_X,
    };

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

    fn arm(&mut self, side: Side) {
        let limbs = *side.limbs(self.human);
        let (shoulder, elbow) = (limbs.shoulder, limbs.elbow);
        if let Some(collar) = limbs.collar {
            // A clavicle at rest points to the side; the body's own slope stays the body's.
            let chest = self.human.chest();
            let chest_from_body = self.joint_from_body[chest];
            let forward = self.seen_from(collar, |pose| {
                pose.rotations[chest] * (chest_from_body * Vec3::Z)
            });
            let bone = snapped(self.bone(collar, shoulder), SNAP_DEGREES);
            let local = [bone, snapped(forward, SNAP_DEGREES)];
            self.set(collar, [side.outward, Vec3::Z], local);
        }
        // An elbow bends forward.
        let body_upper = self.body.bone(side.shoulder, side.elbow);
        let body_hinge = side.outward.cross(Vec3::Z);
        let upper = self.bone(shoulder, elbow);
        let Some(wrist) = limbs.wrist else {
            let hinge = self.chest_axis(shoulder, body_hinge);
            self.set(shoulder, [body_upper, body_hinge], [upper, hinge]);
            self.carry(shoulder, elbow);
            return;
        };
        let bones = [shoulder, elbow, wrist];
        let mut hinge = self.hinge(shoulder, bones);
        if hinge == Vec3::ZERO {
            hinge = self.chest_axis(shoulder, body_hinge);
        }
        self.set(shoulder, [body_upper, body_hinge], [upper, hinge]);

        let fore = self.bone(elbow, wrist);
        let fore_hinge = self.carried_if_straight(upper, hinge, [shoulder, elbow], fore, bones);
        let body_fore = self.body.bone(side.elbow, side.wrist);
        self.set(elbow, [body_fore, body_hinge], [fore, fore_hinge]);
        self.carry(elbow, wrist);
        self.palm(side, wrist);
    }

    /// A palm faces down in a T-pose: the knuckle of the index lies before that of the little
    /// finger. Without fingers the hand stays as the zero pose has it.
    fn palm(&mut self, side: Side, wrist: usize) {
        let knuckle = |names: &[&str]| {
            (wrist + 1..self.skeleton.joint_count()).find(|&joint| {
                let name = self.skeleton.joints()[joint].name.to_lowercase();
                names.iter().any(|finger| name.contains(finger))
                    && self.skeleton.is_at_or_below(joint, wrist)
            })
        };
        let (Some(index), Some(little)) = (knuckle(&["index"]), knuckle(&["pinky", "little"]))
        else {
            return;
        };
        let across = self.seen_from(wrist, |pose| pose.positions[index] - pose.positions[little]);
        let along = self.joint_from_body[wrist] * side.outward;
        self.set(wrist, [side.outward, Vec3::Z], [along, across]);
    }

    /// Mean of one of the chest's body axes seen from a joint: for an arm that never bends.
    fn chest_axis(&self, joint: usize, body_axis: Vec3) -> Vec3 {
        let chest = self.human.chest();
        let axis = self.joint_from_body[chest] * body_axis;
        snapped(
            self.seen_from(joint, |pose| pose.rotations[chest] * axis),
            SNAP_DEGREES,
        )
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

    fn leg(&mut self, side: Side) {
        let limbs = *side.limbs(self.human);
        let (hip, knee, ankle) = (limbs.hip, limbs.knee, limbs.ankle);
        let bones = [hip, knee, ankle];
        let thigh = self.bone(hip, knee);
        let mut hinge = self.hinge(hip, bones);
        if hinge == Vec3::ZERO {
            // A knee that never bends: its hinge lies across the body on the whole.
            let pelvis = self.human.pelvis;
            let left = self.joint_from_body[pelvis] * Vec3::X;
            let left = self.seen_from(hip, |pose| pose.rotations[pelvis] * left);
            hinge = snapped(left, SNAP_DEGREES);
        }
        self.set(
            hip,
            [self.body.bone(side.hip, side.knee), Vec3::X],
            [thigh, hinge],
        );

        let shin = self.bone(knee, ankle);
        let shin_hinge = self.carried_if_straight(thigh, hinge, [hip, knee], shin, bones);
        self.set(
            knee,
            [self.body.bone(side.knee, side.ankle), Vec3::X],
            [shin, shin_hinge],
        );
        self.foot(side, &limbs, self.carried(shin_hinge, knee, ankle));
    }

    /// The ankle hinges about the knee's axis; its sole is level when the foot is lowest.
    fn foot(&mut self, side: Side, limbs: &Limbs, left: Vec3) {
        let ankle = limbs.ankle;
        let Some((ball, offset)) = ball_of_foot(self.skeleton, limbs) else {
            self.carry(limbs.knee, ankle);
            return;
        };
        let toward_ball = self.seen_from(ankle, |pose| {
            pose.positions[ball] + pose.rotations[ball] * offset - pose.positions[ankle]
        });
        let Some(left) = reject(left, toward_ball) else {
            self.carry(limbs.knee, ankle);
            return;
        };
        let pitch = self.soles.pitch;
        let forward = Quat::from_axis_angle(left, -pitch) * toward_ball;
        let heading = self.body.foot_heading(side.ankle);
        let across = Vec3::Y.cross(heading);
        self.set(ankle, [across, heading], [left, forward]);
        if let Some(foot) = limbs.foot {
            self.toes(foot, ankle, self.soles.ankle_height);
        }
    }

    /// Toes are level with the sole when the foot stands: their mean turn in the lowest frames.
    fn toes(&mut self, foot: usize, ankle: usize, ankle_height: f32) {
        const STANDS_WITHIN_METRES: f32 = 0.02;
        let standing = self
            .poses
            .iter()
            .filter(|pose| (pose.positions[ankle].y - ankle_height).abs() < STANDS_WITHIN_METRES);
        let foot_from_ankle = mean_rotation(
            standing.map(|pose| (1.0, pose.rotations[foot].inverse() * pose.rotations[ankle])),
        );
        match foot_from_ankle {
            Some(foot_from_ankle) => {
                self.joint_from_body[foot] =
                    (foot_from_ankle * self.joint_from_body[ankle]).normalize();
            }
            None => self.carry(ankle, foot),
        }
    }
}

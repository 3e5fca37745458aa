//! How each joint of the source turns when the body would be at rest.
//!
//! The body rests in a T-pose where all its joints have world orientation identity. For a joint
//! of the source, `joint_from_body` is the constant that makes
//! `world_from_joint * joint_from_body` the orientation of the body's joint: source bones and
//! body bones then point the same way in the world, and twist is what the source's joint turns.

use glam::Quat;
use physique_body::Joint;

use super::{
    anatomy,
    body_rest::BodyRest,
    figure::{Arms, Figure},
    human_joints::HumanJoints,
    known_t_pose::KnownTPose,
    reference,
    soles::Soles,
};
use crate::{SkeletonClip, SkeletonPose};

/// Where the alignment of a source came from.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum AlignedBy {
    /// The skeleton's rest pose is a standing person.
    RestPose,
    /// The first frame is a T-pose.
    FirstFrame,
    /// The T-pose that is known of the family of rigs, or that the mapping file gives.
    KnownTPose,
    /// None of these: hinges of knees and elbows, soles, shoulders and hips over the clip.
    Anatomy,
}

/// `joint_from_body` of every human joint of the source.
#[derive(Clone, Debug)]
pub(super) struct Alignment {
    /// By source joint; the identity for joints that are no human joint.
    pub(super) joint_from_body: Vec<Quat>,
    pub(super) by: AlignedBy,
    /// Why a T-pose that is known of the rig was not taken.
    pub(super) note: Option<String>,
}

impl Alignment {
    /// Finds the alignment from the rest pose, a T-pose in the first frame, the one that is known
    /// of the rig, or the clip.
    ///
    /// A first frame counts only where `leads_with_t_pose`: a dancer's arms may be level, too.
    pub(super) fn find(
        clip: &SkeletonClip,
        human: &HumanJoints,
        body: &BodyRest,
        soles: Soles,
        leads_with_t_pose: bool,
        known_t_pose: Option<&KnownTPose>,
    ) -> Self {
        let skeleton = clip.skeleton();
        let reference = |pose: &SkeletonPose, arms| {
            let figure = Figure {
                human,
                skeleton,
                pose,
            };
            let world_from_figure = figure.standing(arms)?;
            Some(reference::joint_from_body(&figure, world_from_figure, body))
        };
        let found = |joint_from_body, by| Self {
            joint_from_body,
            by,
            note: None,
        };
        if let Some(joint_from_body) = reference(&skeleton.rest_pose(), Arms::Straight) {
            return found(joint_from_body, AlignedBy::RestPose);
        }
        if leads_with_t_pose && let Some(joint_from_body) = reference(&clip.pose(0), Arms::Level) {
            return found(joint_from_body, AlignedBy::FirstFrame);
        }
        let note = match known_t_pose.map(|known| known.pose(clip, human)) {
            None => None,
            Some(Err(joint)) => Some(format!(
                "the T-pose that is known of this rig was not used: it says nothing of {joint}"
            )),
            Some(Ok(pose)) => {
                if let Some(joint_from_body) = reference(&pose, Arms::Level) {
                    return found(joint_from_body, AlignedBy::KnownTPose);
                }
                // A later generation of the rig, or one that a converter has changed.
                Some(
                    "the T-pose that is known of this rig was not used: this skeleton does not \
                     stand with level arms in it"
                        .to_owned(),
                )
            }
        };
        Self {
            note,
            ..found(
                anatomy::joint_from_body(clip, human, body, soles),
                AlignedBy::Anatomy,
            )
        }
    }

    /// Orientation of the body's joint that the source's joint gives, in the world.
    pub(super) fn world_from_body(&self, pose: &SkeletonPose, joint: usize) -> Quat {
        pose.rotations[joint] * self.joint_from_body[joint]
    }
}

/// Joint, parent and child along the body's limbs: shoulder and elbow, hip and knee.
pub(super) const LIMB_BONES: [(Joint, Joint); 8] = [
    (Joint::LeftShoulder, Joint::LeftElbow),
    (Joint::RightShoulder, Joint::RightElbow),
    (Joint::LeftElbow, Joint::LeftWrist),
    (Joint::RightElbow, Joint::RightWrist),
    (Joint::LeftHip, Joint::LeftKnee),
    (Joint::RightHip, Joint::RightKnee),
    (Joint::LeftKnee, Joint::LeftAnkle),
    (Joint::RightKnee, Joint::RightAnkle),
];

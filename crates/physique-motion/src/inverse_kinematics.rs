//! From joint positions to the 22 rotations of the body: [`solve`].
//!
//! Every bone's direction is in the data, so positions can be met in closed form, parents first,
//! each joint aimed from where the body's own joint came to be. What positions do not say is how
//! far a bone turns about itself, and only that is a question of the whole clip:
//!
//! * pelvis and chest carry three bones each, which fix their whole rotation, tilt included
//!   (Kabsch's problem); the spine between them shares what remains;
//! * thighs and upper arms turn so that knee and elbow bend as hinges do, and the foot points where
//!   it points; straight limbs say little, so the turn is found for all frames at once,
//!   weighted by what each frame says, and kept steady in time (a tridiagonal system);
//! * collars, neck, shins, forearms and ankles swing without twist, and head, hands and toes, which
//!   have no bones below them, stay with their parents: nothing is known of them.

use glam::Vec3;
use physique_body::Joint;

use crate::{
    Error, Motion,
    features::{FeatureSkeleton, JointPositions, RotationLayer},
    mapping::{BodyRest, FitError, FitErrorGatherer},
};

mod limb;
mod pose;
mod rigid;
mod source_bones;
mod twist;

use limb::LIMBS;
use pose::{CHEST_BONES, PELVIS_BONES, SolvedPose};
use source_bones::SourceBones;

/// What to take for granted about the positions.
#[derive(Clone, Debug, PartialEq)]
pub struct IkOptions {
    /// Unit vectors from the parent to each joint of the **positions'** skeleton at rest, facing
    /// +Z; otherwise those of the data set's body (SMPL-H for HumanML3D and for KIT).
    ///
    /// Bone lengths, and the angles between the bones of pelvis and chest, are always taken from
    /// the clip.
    pub rest_directions: Option<[Vec3; Joint::COUNT]>,
    /// How long a straight limb remembers its twist, in seconds.
    pub twist_memory: f32,
    /// Moves the whole clip up or down so that the lowest sole of all frames stands at height 0.
    ///
    /// Without it the pelvis stands where it stood, times [`IkSolution::scale`].
    pub soles_on_ground: bool,
}

impl Default for IkOptions {
    fn default() -> Self {
        Self {
            rest_directions: None,
            twist_memory: 0.1,
            soles_on_ground: true,
        }
    }
}

impl IkOptions {
    /// Options for positions of this very body: the rest directions are its own.
    pub fn for_joints_of(body: &BodyRest) -> Self {
        Self {
            rest_directions: Some(Joint::ALL.map(|joint| body.offset(joint).normalize_or_zero())),
            ..Self::default()
        }
    }
}

/// Whether the bones of the positions are as long as this body's: the positions are then of this
/// very body, and [`IkOptions::for_joints_of`] gives its motion back.
pub fn are_joints_of(positions: &JointPositions, body: &BodyRest) -> bool {
    /// A millimetre: no two persons' 21 bones agree so well, and files keep more digits.
    const METRES: f32 = 1e-3;
    let Ok(positions) = positions.to_smpl_joints() else {
        return false;
    };
    let directions = positions.skeleton().smpl_rest_directions();
    SourceBones::at_rest(&positions, &directions).is_ok_and(|bones| {
        Joint::ALL.into_iter().all(|joint| {
            (bones.offset(joint).length() - body.offset(joint).length()).abs() < METRES
        })
    })
}

/// Whether the three bones of pelvis and of chest stand to each other as this body's do, whatever
/// their lengths: features bring all people to one skeleton's lengths, but leave directions as
/// they were. [`IkOptions::for_joints_of`] then gives the rotations of this very body.
///
/// KIT's joints lack the collars: nothing is known of them.
pub fn are_directions_of(positions: &JointPositions, body: &BodyRest) -> bool {
    /// A tenth of a degree: no two persons' six angles agree so well.
    const RADIANS: f32 = 2e-3;
    if positions.skeleton() != FeatureSkeleton::HumanMl3d {
        return false;
    }
    let trios = [(Joint::Pelvis, PELVIS_BONES), (Joint::Spine3, CHEST_BONES)];
    trios.into_iter().all(|(joint, ends)| {
        [[0, 1], [1, 2], [2, 0]].into_iter().all(|pair| {
            let [a, b] = pair.map(|bone| ends[bone]);
            let between = |frame: &[Vec3]| {
                let bone = |end: Joint| frame[end.index()] - frame[joint.index()];
                bone(a).angle_between(bone(b))
            };
            let frames = positions.frame_count() as f32;
            let mean = positions.frames().map(between).sum::<f32>() / frames;
            // Not a number is not near, either.
            (mean - body.offset(a).angle_between(body.offset(b))).abs() < RADIANS
        })
    })
}

/// A motion found from positions, and how well it meets them.
#[derive(Clone, Debug, PartialEq)]
pub struct IkSolution {
    /// The motion on the body's joints.
    pub motion: Motion,
    /// Distances of the solved skeleton's joints (the clip's bone lengths, the solved rotations)
    /// from the positions, in centimetres of the body.
    pub fit: FitError,
    /// From the positions' unit to the body's metres, by the length of the legs.
    pub scale: f32,
}

/// Finds the body's rotations from joint positions.
///
/// KIT's joints are brought to SMPL's first. Runs on one thread at some 10 microseconds a frame.
///
/// On positions of the body itself the fit is exact to rounding (some micrometres). Of the
/// rotations, pelvis and chest are exact too; thighs and shins come within some degrees, upper arms
/// within the angle by which the source's elbows are no hinges; head, forearm and hand twists are
/// unknown.
///
/// # Errors
/// [`Error::NoBone`] for a bone that has no length in most frames; [`Error::NotFinite`] when sums
/// of huge numbers overflow.
pub fn solve(
    positions: &JointPositions,
    body: &BodyRest,
    options: &IkOptions,
) -> Result<IkSolution, Error> {
    let directions = options
        .rest_directions
        .unwrap_or_else(|| positions.skeleton().smpl_rest_directions());
    let positions = positions.to_smpl_joints()?;
    let bones = SourceBones::measure(&positions, &directions)?;
    let frames = positions.positions().as_chunks::<{ Joint::COUNT }>().0;

    let mut poses: Vec<SolvedPose> = frames
        .iter()
        .map(|p| SolvedPose::trunk(&bones, p))
        .collect();
    for limb in &LIMBS {
        let says = poses.iter().zip(frames);
        let mut twists: Vec<_> = says.map(|(pose, p)| limb.twist(&bones, pose, p)).collect();
        let frames_remembered = options.twist_memory * positions.frame_rate().per_second() as f32;
        twist::steady(&mut twists, frames_remembered);
        for ((pose, p), twist) in poses.iter_mut().zip(frames).zip(&twists) {
            limb.place(&bones, pose, p, twist.angle());
        }
    }

    finish(&positions, &bones, &poses, body, options.soles_on_ground)
}

/// Finds the body's rotations by the self-intersection paper's own layer, [`RotationLayer`], for
/// comparison with its figures: the pelvis takes the heading only, nothing twists, and the
/// positions are missed by some 0.1 m at the limbs.
///
/// # Errors
/// As [`solve`].
pub fn solve_by_paper_layer(
    positions: &JointPositions,
    body: &BodyRest,
    soles_on_ground: bool,
) -> Result<IkSolution, Error> {
    let skeleton = positions.skeleton();
    let layer = RotationLayer::published(skeleton);
    let positions = positions.to_smpl_joints()?;
    let bones = SourceBones::at_rest(&positions, &skeleton.smpl_rest_directions())?;
    let frames = positions.positions().as_chunks().0.iter();
    let poses: Vec<SolvedPose> = frames
        .map(|p| SolvedPose::of_rotations(&bones, p[0], &layer.rotations(p)))
        .collect();
    finish(&positions, &bones, &poses, body, soles_on_ground)
}

/// The motion of solved poses on the body, and how far they are from the positions.
fn finish(
    positions: &JointPositions,
    bones: &SourceBones,
    poses: &[SolvedPose],
    body: &BodyRest,
    soles_on_ground: bool,
) -> Result<IkSolution, Error> {
    let frames = positions.positions().as_chunks::<{ Joint::COUNT }>().0;
    let scale = body.leg_length() / bones.leg_length();
    let mut gatherer = FitErrorGatherer::default();
    for (pose, p) in poses.iter().zip(frames) {
        for joint in &Joint::ALL[1..] {
            let index = joint.index();
            gatherer.add(*joint, scale * pose.positions[index].distance(p[index]));
        }
    }
    let mut roots: Vec<Vec3> = frames
        .iter()
        .map(|p| p[0] * scale - body.joints[0])
        .collect();
    if soles_on_ground {
        let lowest = lowest_sole(poses, &roots, body);
        for root in &mut roots {
            root.y -= lowest;
        }
    }
    let rotations = poses.iter().flat_map(SolvedPose::local_rotations).collect();
    Ok(IkSolution {
        motion: Motion::new(positions.frame_rate(), None, roots, rotations)?,
        fit: gatherer.finish(),
        scale,
    })
}

/// Height of the lowest sole of all frames when the body moves so.
fn lowest_sole(poses: &[SolvedPose], roots: &[Vec3], body: &BodyRest) -> f32 {
    let mut lowest = f32::INFINITY;
    for (pose, root) in poses.iter().zip(roots) {
        for leg in Joint::LEGS {
            let (mut position, mut above) = (*root + body.joints[0], pose.world[0]);
            for joint in leg {
                position += above * body.offset(joint);
                above = pose.world[joint.index()];
                if Joint::FEET.contains(&joint) {
                    lowest = lowest.min(position.y - body.height(joint));
                }
            }
        }
    }
    lowest
}

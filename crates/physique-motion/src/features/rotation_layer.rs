//! The self-intersection paper's way from joint positions to the rotations of SMPL's body.

use glam::{DMat3, DQuat, DVec3, Quat, Vec3};
use physique_body::Joint;

use super::{FeatureSkeleton, JointPositions, rest_directions};
use crate::{Error, FrameRate, Motion, mapping::BodyRest};

/// Joint positions to 22 local rotations, frame by frame, after the layer that the paper's loss and
/// metric put between a generator and the body.
///
/// The pelvis takes the heading only, no tilt; a joint is swung, never twisted, so that the mean
/// direction of its bones is met; feet, head and hands keep their parent's rotation. Posing a body
/// with the result does not reproduce the positions (some 0.1 m at the limbs).
///
/// Where the published formula is 0/0 or 0 x infinity (bones parallel to their rest direction, or a
/// body exactly facing +Z) this one is finite: the rotation from `u` to `w` is
/// `c I + [n]x + n n^T / (1 + c)` with `c = u . w` and `n = u x w`. A bone folded straight back, for
/// which every axis is as good as another, is turned by half a turn; bones without length and bodies
/// without a heading leave the identity.
#[derive(Clone, Debug, PartialEq)]
pub struct RotationLayer {
    /// By joint: mean direction of its bones at rest; `None` for joints without children and for
    /// the pelvis.
    rest: [Option<DVec3>; Joint::COUNT],
}

impl RotationLayer {
    /// The layer of the paper: for [`FeatureSkeleton::HumanMl3d`] or for KIT brought to SMPL's
    /// joints by [`super::smpl_from_kit`].
    pub fn published(skeleton: FeatureSkeleton) -> Self {
        Self::new(&rest_directions::published(skeleton))
    }

    /// The layer for another body.
    pub fn for_body(body: &BodyRest) -> Self {
        Self::new(&Joint::ALL.map(|joint| body.offset(joint).as_dvec3()))
    }

    fn new(bones: &[DVec3; Joint::COUNT]) -> Self {
        let mut rest = [DVec3::ZERO; Joint::COUNT];
        for joint in &Joint::ALL[1..] {
            if let Some(parent) = joint.parent() {
                rest[parent.index()] += bones[joint.index()].normalize_or_zero();
            }
        }
        rest[Joint::Pelvis.index()] = DVec3::ZERO;
        Self {
            rest: rest.map(DVec3::try_normalize),
        }
    }

    /// By joint, where the mean of its bones points at rest, of unit length; `None` for joints that
    /// are never swung: the pelvis, and those without children.
    pub const fn rest_directions(&self) -> &[Option<DVec3>; Joint::COUNT] {
        &self.rest
    }

    /// Local rotations of one frame's joints, of any unit of length.
    pub fn rotations(&self, joints: &[Vec3; Joint::COUNT]) -> [DMat3; Joint::COUNT] {
        self.frame(&joints.map(|joint| joint.as_dvec3())).local
    }

    /// A motion of a body whose pelvis rests at `rest_pelvis`; the root stands where it stood.
    ///
    /// KIT's joints are brought to SMPL's, in KIT's unit.
    ///
    /// # Errors
    /// [`Error::NotFinite`] when sums of huge numbers overflow.
    pub fn motion(&self, positions: &JointPositions, rest_pelvis: Vec3) -> Result<Motion, Error> {
        let positions = positions.to_smpl_joints()?;
        let mut rotations = Vec::with_capacity(positions.positions().len());
        for joints in positions.positions().as_chunks().0 {
            let local = self.rotations(joints);
            rotations.extend(local.iter().map(quaternion));
        }
        let roots = positions
            .frames()
            .map(|joints| joints[0] - rest_pelvis)
            .collect();
        let rate: FrameRate = positions.frame_rate();
        Motion::new(rate, None, roots, rotations)
    }

    /// All that a frame's rotations and their gradient need.
    pub(super) fn frame(&self, joints: &[DVec3; Joint::COUNT]) -> LayerFrame {
        let across = across(joints);
        let mut frame = LayerFrame {
            across,
            local: [DMat3::IDENTITY; Joint::COUNT],
            world: [DMat3::IDENTITY; Joint::COUNT],
            swings: [None; Joint::COUNT],
        };
        let root = Joint::Pelvis.index();
        frame.local[root] = heading(across);
        frame.world[root] = frame.local[root];
        let mut sums = [DVec3::ZERO; Joint::COUNT];
        for (joint, parent) in bones() {
            sums[parent] += (joints[joint] - joints[parent]).normalize_or_zero();
        }
        for (joint, parent) in bones() {
            let world_from_parent = frame.world[parent];
            if let (Some(rest), Some(now)) = (self.rest[joint], sums[joint].try_normalize()) {
                let swing = Swing {
                    rest,
                    now,
                    sum_length: sums[joint].length(),
                    in_parent: world_from_parent.transpose() * now,
                };
                frame.local[joint] = swing.rotation();
                frame.swings[joint] = Some(swing);
            }
            frame.world[joint] = world_from_parent * frame.local[joint];
        }
        frame
    }
}

/// A frame on its way through the layer.
pub(super) struct LayerFrame {
    /// From the body's left to its right.
    pub(super) across: DVec3,
    pub(super) local: [DMat3; Joint::COUNT],
    pub(super) world: [DMat3; Joint::COUNT],
    pub(super) swings: [Option<Swing>; Joint::COUNT],
}

/// The turn of a joint from the rest direction of its bones to their direction now.
#[derive(Clone, Copy)]
pub(super) struct Swing {
    pub(super) rest: DVec3,
    /// In the world, of unit length.
    pub(super) now: DVec3,
    /// Length of the sum of the bones' directions.
    pub(super) sum_length: f64,
    /// `now` in the parent's frame.
    pub(super) in_parent: DVec3,
}

/// Below this 1 + cosine, bones are folded straight back.
pub(super) const FOLDED: f64 = 1e-12;

impl Swing {
    fn rotation(&self) -> DMat3 {
        let (axis, cosine) = (
            self.rest.cross(self.in_parent),
            self.rest.dot(self.in_parent),
        );
        if 1.0 + cosine < FOLDED {
            return DMat3::from_quat(DQuat::from_axis_angle(
                self.rest.any_orthonormal_vector(),
                std::f64::consts::PI,
            ));
        }
        DMat3::from_diagonal(DVec3::splat(cosine))
            + skew(axis)
            + outer(axis, axis) * (1.0 / (1.0 + cosine))
    }
}

/// Joint and parent of every bone, parents first.
pub(super) fn bones() -> impl DoubleEndedIterator<Item = (usize, usize)> {
    Joint::ALL
        .into_iter()
        .filter_map(|joint| Some((joint.index(), joint.parent()?.index())))
}

/// From left to right, by hips and shoulders, which both count forwards here.
fn across(joints: &[DVec3; Joint::COUNT]) -> DVec3 {
    let at = |joint: Joint| joints[joint.index()];
    let hips = at(Joint::RightHip) - at(Joint::LeftHip);
    hips + (at(Joint::RightShoulder) - at(Joint::LeftShoulder))
}

/// The rotation about +Y that turns +Z to the body's front, (0, 1, 0) x `across`.
fn heading(across: DVec3) -> DMat3 {
    let Some(forward) = DVec3::new(across.z, 0.0, -across.x).try_normalize() else {
        return DMat3::IDENTITY;
    };
    DMat3::from_cols(DVec3::new(forward.z, 0.0, -forward.x), DVec3::Y, forward)
}

/// The matrix of the cross product with `axis` on the left.
pub(super) fn skew(axis: DVec3) -> DMat3 {
    DMat3::from_cols(
        DVec3::new(0.0, axis.z, -axis.y),
        DVec3::new(-axis.z, 0.0, axis.x),
        DVec3::new(axis.y, -axis.x, 0.0),
    )
}

/// a b^T.
pub(super) fn outer(a: DVec3, b: DVec3) -> DMat3 {
    DMat3::from_cols(a * b.x, a * b.y, a * b.z)
}

fn quaternion(rotation: &DMat3) -> Quat {
    DQuat::from_mat3(rotation).normalize().as_quat()
}

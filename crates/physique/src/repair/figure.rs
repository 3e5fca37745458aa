//! The body as a repair sees it: skeleton, soles, some skin, and where the mass is.

use glam::{DMat3, DMat4, DVec3};
use physique_body::{Body, Joint};
use physique_physics::loss::{LossBody, SkinPoint};
use physique_physics::soles::SOLE_POINTS;
use physique_physics::{MassMoments, Rig};

use super::wrench::posed;
use crate::Error;

/// Points of skin that the ground is compared with, besides the soles'.
const SKIN_POINTS: usize = 500;

/// A body prepared once for all repairs.
pub(super) struct Figure {
    pub(super) rig: Rig,
    /// Points of the skin, those of the soles first.
    pub(super) skin: Vec<SkinPoint>,
    pub(super) moments: MassMoments,
}

/// A posed frame.
#[derive(Clone, Debug)]
pub(super) struct Pose {
    pub(super) rotations: [DMat3; Joint::COUNT],
    pub(super) world_from_rest: Vec<DMat4>,
    /// Sole points in the world.
    pub(super) soles: [DVec3; SOLE_POINTS],
    /// Centre of mass.
    pub(super) centre: DVec3,
}

impl Figure {
    pub(super) fn new(body: &Body) -> Result<Self, Error> {
        let points = LossBody::new(body, SKIN_POINTS)?;
        Ok(Self {
            rig: points.rig().clone(),
            skin: points.skin().to_vec(),
            moments: points.mass_points().moments(),
        })
    }

    pub(super) fn soles(&self) -> &[SkinPoint] {
        &self.skin[..SOLE_POINTS]
    }

    pub(super) fn pose(&self, rotations: [DMat3; Joint::COUNT], root: DVec3) -> Pose {
        let mut world_from_rest = Vec::with_capacity(self.rig.joint_count());
        self.rig.pose(rotations, root, &mut world_from_rest);
        Pose {
            soles: std::array::from_fn(|sole| posed(&self.skin[sole], &world_from_rest)),
            centre: self.moments.mean(&world_from_rest),
            rotations,
            world_from_rest,
        }
    }
}

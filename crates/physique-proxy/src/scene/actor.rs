//! A body that moves, and where its gradient goes.

use glam::{DVec3, Vec3};

use crate::reference::{self, Gradient, Posed, Rotations};
use crate::{Error, Penalty, PoseMatrices, SphereBody};

/// A body over time.
#[derive(Clone, Copy, Debug)]
pub struct Actor<'a> {
    /// The spheres, in metres.
    pub body: &'a SphereBody,
    /// `[frames]` local rotations.
    pub poses: &'a [PoseMatrices],
    /// `[frames]` root translations: the pelvis stands at its rest position plus this.
    pub translations: &'a [Vec3],
}

/// Where an actor's gradient goes; overwritten.
#[derive(Debug)]
pub struct ActorGradient<'a> {
    /// `[frames]` by the entries of the rotation matrices.
    pub by_poses: &'a mut [PoseMatrices],
    /// `[frames]` by the root translations.
    pub by_translations: &'a mut [Vec3],
}

/// How contact is punished.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct SceneOptions {
    /// Cost of a depth.
    pub penalty: Penalty,
    /// Depth that is free, in metres.
    pub tolerance: f64,
}

impl Actor<'_> {
    pub(super) fn check(&self) -> Result<(), Error> {
        self.body.check()?;
        length("Translations", self.poses.len(), self.translations.len())
    }

    pub(super) fn posed(&self, frame: usize) -> PosedActor<'_> {
        let rotations = reference::rotations(&self.poses[frame]);
        let translation = self.translations[frame].as_dvec3();
        PosedActor {
            body: self.body,
            posed: reference::pose(self.body, &rotations, translation),
            rotations,
            by_centres: vec![DVec3::ZERO; self.body.sphere_count()],
        }
    }
}

impl ActorGradient<'_> {
    pub(super) fn check(&self, frames: usize) -> Result<(), Error> {
        length("Gradient by poses", frames, self.by_poses.len())?;
        length(
            "Gradient by translations",
            frames,
            self.by_translations.len(),
        )
    }
}

/// One frame of an actor, and what is known of its gradient.
pub(super) struct PosedActor<'a> {
    pub(super) body: &'a SphereBody,
    pub(super) posed: Posed,
    rotations: Rotations,
    pub(super) by_centres: Vec<DVec3>,
}

impl PosedActor<'_> {
    /// Spheres in the world.
    pub(super) fn spheres(&self) -> impl Iterator<Item = (DVec3, f64)> + '_ {
        let radii = self.body.radii.iter().map(|&radius| f64::from(radius));
        self.posed.centres.iter().copied().zip(radii)
    }

    /// 0, or NaN where a centre is no number: so that nothing makes it a good loss.
    pub(super) fn poison(&self) -> f64 {
        self.posed.centres.iter().sum::<DVec3>().element_sum() * 0.0
    }

    /// The gradient by the pose, in the layout of its slices.
    pub(super) fn gradient(&self) -> (PoseMatrices, Vec3) {
        let Gradient {
            rotations,
            translation,
            ..
        } = reference::pose_backward(self.body, &self.rotations, &self.posed, &self.by_centres);
        let rows = |matrix: glam::DMat3| matrix.transpose().to_cols_array().map(|by| by as f32);
        (rotations.map(rows), translation.as_vec3())
    }
}

pub(super) fn length(what: &'static str, expected: usize, found: usize) -> Result<(), Error> {
    if expected == found {
        return Ok(());
    }
    Err(Error::Length {
        what,
        expected,
        found,
    })
}

/// Names the first frame that is not finite.
pub(super) fn finite(poses: &[PoseMatrices], losses: &[f32]) -> Result<(), Error> {
    let frame = losses.iter().position(|loss| !loss.is_finite());
    crate::self_intersection::refuse(poses, frame)
}

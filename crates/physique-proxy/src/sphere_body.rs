//! A body made of spheres, ready to be posed.

use glam::{Mat3, Vec3};
use physique_body::Joint;

use crate::{Error, Pairs, PoseMatrices, chain};

/// The spheres and joints of one body shape at rest, with the weights by which they follow joints.
///
/// Lengths are metres, or the paper's normalised unit (1 is the radius of the rest body's bounding
/// sphere about the middle of its bounding box); losses work in either.
#[derive(Clone, Debug, PartialEq)]
pub struct SphereBody {
    /// Rest positions of the joints.
    pub rest_joints: [Vec3; Joint::COUNT],
    /// `[spheres]` centres at rest.
    pub centres: Vec<Vec3>,
    /// `[spheres]` radii, which posing leaves alone.
    pub radii: Vec<f32>,
    /// `[spheres]` up to four joints that each sphere follows, with weights that sum to 1. Unused
    /// entries have weight 0.
    pub blend_weights: Vec<[(u8, f32); 4]>,
}

impl SphereBody {
    /// Number of spheres.
    pub fn sphere_count(&self) -> usize {
        self.centres.len()
    }

    /// The joint that moves a sphere most; the first of equals.
    ///
    /// # Panics
    /// When there is no such sphere.
    pub fn dominant_joint(&self, sphere: usize) -> Joint {
        let mut best = (0, f32::NEG_INFINITY);
        for (joint, weight) in self.blend_weights[sphere] {
            if weight > best.1 {
                best = (joint, weight);
            }
        }
        Joint::from_index(best.0.into()).unwrap_or(Joint::Pelvis)
    }

    /// Whether all arrays fit each other and hold numbers that can be.
    ///
    /// # Errors
    /// [`Error::SphereBody`] with the first sphere or joint that does not work.
    pub fn check(&self) -> Result<(), Error> {
        let spheres = self.sphere_count();
        let refuse = |expected, found| Err(Error::SphereBody { expected, found });
        if self.radii.len() != spheres || self.blend_weights.len() != spheres {
            return refuse(
                "as many radii and blend weights as centres",
                format!(
                    "{spheres} centres, {} radii, {} rows of blend weights",
                    self.radii.len(),
                    self.blend_weights.len()
                ),
            );
        }
        if spheres > Pairs::MOST_SPHERES {
            return refuse("at most 65,536 spheres", spheres.to_string());
        }
        if let Some(joint) = (0..Joint::COUNT).find(|&joint| !self.rest_joints[joint].is_finite()) {
            let found = format!("{} for {}", self.rest_joints[joint], Joint::ALL[joint]);
            return refuse("finite rest joints", found);
        }
        for sphere in 0..spheres {
            let (centre, radius) = (self.centres[sphere], self.radii[sphere]);
            if !centre.is_finite() {
                return refuse("finite centres", format!("{centre} for sphere {sphere}"));
            }
            if !(radius.is_finite() && radius >= 0.0) {
                let found = format!("{radius} for sphere {sphere}");
                return refuse("finite radii of at least 0", found);
            }
            let possible = |&(joint, weight): &(u8, f32)| {
                usize::from(joint) < Joint::COUNT && weight.is_finite()
            };
            let row = &self.blend_weights[sphere];
            if !row.iter().all(possible) {
                let found = format!("{row:?} for sphere {sphere}");
                return refuse("finite blend weights of joints 0 to 21", found);
            }
        }
        Ok(())
    }

    /// `world_from_rest` of all joints: where a point that follows one joint only moves to.
    pub fn joint_transforms(&self, rotations: &PoseMatrices) -> [(Mat3, Vec3); Joint::COUNT] {
        let mut transforms = chain::world_from_joint(&self.rest_joints, rotations);
        for ((rotation, position), &rest) in transforms.iter_mut().zip(&self.rest_joints) {
            *position -= *rotation * rest;
        }
        transforms
    }

    /// Centres of one pose about the rest body's root: kinematic chain and linear blend skinning.
    ///
    /// `centres` is overwritten, `[spheres]`. For many frames at once, and for losses, the fused
    /// kernels of this crate are the fast way.
    pub fn pose(&self, rotations: &PoseMatrices, centres: &mut Vec<Vec3>) {
        let transforms = self.joint_transforms(rotations);
        centres.clear();
        centres.extend(
            self.centres
                .iter()
                .zip(&self.blend_weights)
                .map(|(&rest, row)| {
                    let moved = row.iter().map(|&(joint, weight)| {
                        let (rotation, translation) = transforms[usize::from(joint)];
                        (rotation * rest + translation) * weight
                    });
                    moved.sum::<Vec3>()
                }),
        );
    }
}

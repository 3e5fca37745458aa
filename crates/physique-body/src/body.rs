//! A body: a model with a shape, ready to be posed.

use std::sync::Arc;

use glam::{Affine3A, Vec3};

use crate::pose::pose_joints;
use crate::skinning::SkinningTransform;
use crate::{BodyModel, Error, Joint, Pose};

/// Mean density of a whole living body, air in the lungs included, in kg/m3.
pub const BODY_DENSITY: f64 = 985.0;

/// A body model with a shape: rest vertices and rest joints.
///
/// Cheap to clone; posing needs `&self` only, so that threads share one body.
#[derive(Clone, Debug)]
pub struct Body {
    model: Arc<BodyModel>,
    betas: Arc<[f32]>,
    rest_vertices: Arc<[Vec3]>,
    rest_joints: Arc<[Vec3]>,
}

impl Body {
    /// The body with these betas; missing ones are 0.
    ///
    /// # Errors
    /// [`Error::Betas`] for more betas than the model has, or for one that is not finite.
    pub fn new(model: Arc<BodyModel>, betas: &[f32]) -> Result<Self, Error> {
        if betas.len() > model.beta_count() || !betas.iter().all(|beta| beta.is_finite()) {
            return Err(Error::Betas {
                available: model.beta_count(),
                found: format!("{betas:?}"),
            });
        }
        let mut rest_vertices = model.template().to_vec();
        for (&beta, direction) in betas.iter().zip(model.shape_directions()) {
            for (vertex, displacement) in rest_vertices.iter_mut().zip(direction) {
                *vertex += *displacement * beta;
            }
        }
        let rest_joints = model.joint_regressor().joints(&rest_vertices);
        Ok(Self {
            betas: betas.into(),
            rest_vertices: rest_vertices.into(),
            rest_joints: rest_joints.into(),
            model,
        })
    }

    /// The model that this body is a shape of.
    pub fn model(&self) -> &Arc<BodyModel> {
        &self.model
    }

    /// The betas given; those missing are 0.
    pub fn betas(&self) -> &[f32] {
        &self.betas
    }

    /// `[vertices]` rest positions, in metres.
    pub fn rest_vertices(&self) -> &[Vec3] {
        &self.rest_vertices
    }

    /// `[joints]` rest positions, in metres; the first 22 are [`Joint`]'s.
    pub fn rest_joints(&self) -> &[Vec3] {
        &self.rest_joints
    }

    /// Rest position of one body joint.
    pub fn rest_joint(&self, joint: Joint) -> Vec3 {
        self.rest_joints[joint.index()]
    }

    /// From the lowest to the highest point of the rest pose, in metres.
    pub fn stature(&self) -> f64 {
        let heights = self.rest_vertices.iter().map(|vertex| vertex.y);
        let (low, high) = heights.fold((f32::MAX, f32::MIN), |(low, high), y| {
            (low.min(y), high.max(y))
        });
        f64::from(high) - f64::from(low)
    }

    /// Height of the soles in the rest pose, in metres: the lowest vertex.
    pub fn rest_ground(&self) -> f32 {
        self.rest_vertices
            .iter()
            .map(|vertex| vertex.y)
            .fold(f32::MAX, f32::min)
    }

    /// Volume of the rest pose in m3, by the divergence theorem.
    pub fn volume(&self) -> f64 {
        let vertex = |index: u32| self.rest_vertices[index as usize].as_dvec3();
        self.model
            .triangles()
            .iter()
            .map(|&[a, b, c]| vertex(a).dot(vertex(b).cross(vertex(c))))
            .sum::<f64>()
            / 6.0
    }

    /// Mass in kg: the rest volume times [`BODY_DENSITY`].
    pub fn mass(&self) -> f64 {
        self.volume() * BODY_DENSITY
    }

    /// Body mass index in kg/m2.
    pub fn body_mass_index(&self) -> f64 {
        self.mass() / self.stature().powi(2)
    }

    /// Scratch space for [`Body::pose`]; one a thread.
    pub fn posed(&self) -> PosedBody {
        PosedBody {
            world_from_joint: Vec::with_capacity(self.model.joint_count()),
            transforms: Vec::with_capacity(self.model.joint_count()),
            corrected_vertices: Vec::new(),
            vertices: vec![Vec3::ZERO; self.rest_vertices.len()],
        }
    }

    /// Joint transforms in the world: each frame sits at its joint and has the world's axes at
    /// rest. Cheaper than [`Body::pose`] where no vertices are wanted.
    ///
    /// # Errors
    /// [`Error::RotationCount`] unless the pose has 22 rotations, or up to the model's joints.
    pub fn pose_joints(
        &self,
        pose: &Pose<'_>,
        world_from_joint: &mut Vec<Affine3A>,
    ) -> Result<(), Error> {
        let joints = self.model.joint_count();
        if !(Joint::COUNT..=joints).contains(&pose.rotations.len()) {
            return Err(Error::RotationCount {
                joints,
                found: pose.rotations.len(),
            });
        }
        pose_joints(
            pose,
            &self.rest_joints,
            self.model.parents(),
            world_from_joint,
        );
        Ok(())
    }

    /// Poses joints and skins all vertices into `posed`, which is overwritten.
    ///
    /// Costs about 20 microseconds for 6,900 vertices on one core; allocates nothing.
    ///
    /// # Errors
    /// As [`Body::pose_joints`].
    pub fn pose(&self, pose: &Pose<'_>, posed: &mut PosedBody) -> Result<(), Error> {
        self.pose_joints(pose, &mut posed.world_from_joint)?;
        posed.transforms.clear();
        posed.transforms.extend(
            posed
                .world_from_joint
                .iter()
                .zip(self.rest_joints.iter())
                .map(|(world_from_joint, &rest)| SkinningTransform::new(world_from_joint, rest)),
        );
        posed.vertices.resize(self.rest_vertices.len(), Vec3::ZERO);
        let rest_vertices = if self.model.pose_directions().is_empty() {
            &self.rest_vertices
        } else {
            self.correct(pose, &mut posed.corrected_vertices);
            &posed.corrected_vertices[..]
        };
        self.model
            .skinning()
            .skin(rest_vertices, &posed.transforms, &mut posed.vertices);
        Ok(())
    }

    /// Rest vertices plus the pose-dependent correction (SMPL, equation 9).
    fn correct(&self, pose: &Pose<'_>, corrected: &mut Vec<Vec3>) {
        corrected.clear();
        corrected.extend_from_slice(&self.rest_vertices);
        let directions = self.model.pose_directions().as_chunks::<9>().0;
        for (rotation, directions) in pose.rotations.iter().skip(1).zip(directions) {
            let matrix = glam::Mat3::from_quat(*rotation) - glam::Mat3::IDENTITY;
            let features = matrix.transpose().to_cols_array();
            for (feature, direction) in features.into_iter().zip(directions) {
                if feature != 0.0 {
                    for (vertex, displacement) in corrected.iter_mut().zip(direction) {
                        *vertex += *displacement * feature;
                    }
                }
            }
        }
    }
}

/// A posed body: joint transforms and vertices, with the scratch space to pose the next frame.
#[derive(Clone, Debug)]
pub struct PosedBody {
    world_from_joint: Vec<Affine3A>,
    transforms: Vec<SkinningTransform>,
    corrected_vertices: Vec<Vec3>,
    vertices: Vec<Vec3>,
}

impl PosedBody {
    /// `[vertices]` positions in the world, in metres.
    pub fn vertices(&self) -> &[Vec3] {
        &self.vertices
    }

    /// `[joints]` transforms in the world.
    pub fn world_from_joint(&self) -> &[Affine3A] {
        &self.world_from_joint
    }

    /// World position of one body joint.
    pub fn joint(&self, joint: Joint) -> Vec3 {
        self.world_from_joint[joint.index()].translation.into()
    }
}

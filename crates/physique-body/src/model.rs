//! A body model: everything that is the same for all shapes and poses.

use std::fmt;

use glam::Vec3;

use crate::skinning::SkinningPlan;
use crate::{AttributeMap, BlendWeights, Error, Joint, JointRegressor, Surface};

/// The arrays of a body model, as a file gives them.
#[derive(Clone, Debug)]
pub struct BodyArrays {
    /// What to call the model in reports.
    pub name: String,
    /// `[vertices]` rest positions of the mean shape, in metres.
    pub template: Vec<Vec3>,
    /// `[betas][vertices]` displacement a unit of each beta, in metres.
    pub shape_directions: Vec<Vec<Vec3>>,
    /// `[9 * (joints - 1)][vertices]` pose-dependent displacement, or empty. The features are the
    /// entries of `R - I` of joints 1.. in row-major order.
    pub pose_directions: Vec<Vec<Vec3>>,
    /// Rest joints from rest vertices.
    pub joint_regressor: JointRegressor,
    /// Joints that move each vertex.
    pub blend_weights: BlendWeights,
    /// Triangles, counter-clockwise seen from outside.
    pub triangles: Vec<[u32; 3]>,
    /// Parent of each joint; parents come before children, joint 0 is the only root.
    pub parents: Vec<Option<usize>>,
    /// Index of each vertex's mirror image, or empty.
    pub mirror_vertices: Vec<u32>,
    /// How sex, stature, mass and age map to betas, where known.
    pub attributes: Option<AttributeMap>,
}

/// A body model of the SMPL family: template, shape and pose directions, joint regressor, blend
/// weights (Loper et al., "SMPL: A Skinned Multi-Person Linear Model", 2015).
///
/// Its first 22 joints are [`Joint`]'s. Checked on construction, so that everything built on it
/// can index without fear.
#[derive(Clone)]
pub struct BodyModel {
    arrays: BodyArrays,
    vertex_parts: Vec<Joint>,
    triangle_parts: Vec<Joint>,
    skinning: SkinningPlan,
}

impl BodyModel {
    /// Checks that the arrays fit together.
    ///
    /// # Errors
    /// [`Error::Model`] that names the first array that does not fit.
    pub fn new(arrays: BodyArrays) -> Result<Self, Error> {
        check(&arrays)?;
        let vertex_parts: Vec<_> = (0..arrays.template.len())
            .map(|vertex| body_part(&arrays.parents, arrays.blend_weights.dominant_joint(vertex)))
            .collect();
        let triangle_parts = arrays
            .triangles
            .iter()
            .map(|triangle| {
                let parts = triangle.map(|vertex| vertex_parts[vertex as usize]);
                // The majority, or of three different parts the one nearest to the pelvis.
                if parts[1] == parts[2] {
                    parts[1]
                } else if parts[0] == parts[1] || parts[0] == parts[2] {
                    parts[0]
                } else {
                    parts[0].min(parts[1]).min(parts[2])
                }
            })
            .collect();
        Ok(Self {
            skinning: SkinningPlan::new(&arrays.blend_weights),
            arrays,
            vertex_parts,
            triangle_parts,
        })
    }

    /// What to call the model in reports.
    pub fn name(&self) -> &str {
        &self.arrays.name
    }

    /// Number of vertices.
    pub fn vertex_count(&self) -> usize {
        self.arrays.template.len()
    }

    /// Number of joints: 22, or more where hands are known.
    pub fn joint_count(&self) -> usize {
        self.arrays.parents.len()
    }

    /// Number of shape coefficients.
    pub fn beta_count(&self) -> usize {
        self.arrays.shape_directions.len()
    }

    /// `[vertices]` rest positions of the mean shape, in metres.
    pub fn template(&self) -> &[Vec3] {
        &self.arrays.template
    }

    /// `[betas][vertices]` displacement a unit of each beta, in metres.
    pub fn shape_directions(&self) -> &[Vec<Vec3>] {
        &self.arrays.shape_directions
    }

    /// `[9 * (joints - 1)][vertices]` pose-dependent displacement in metres, or empty.
    pub fn pose_directions(&self) -> &[Vec<Vec3>] {
        &self.arrays.pose_directions
    }

    /// Rest joints from rest vertices.
    pub fn joint_regressor(&self) -> &JointRegressor {
        &self.arrays.joint_regressor
    }

    /// Joints that move each vertex.
    pub fn blend_weights(&self) -> &BlendWeights {
        &self.arrays.blend_weights
    }

    /// Triangles, counter-clockwise seen from outside.
    pub fn triangles(&self) -> &[[u32; 3]] {
        &self.arrays.triangles
    }

    /// Whether the mesh is closed and in one part. Computed anew by every call.
    pub fn surface(&self) -> Surface {
        Surface::of(&self.arrays.triangles)
    }

    /// Parent of each joint.
    pub fn parents(&self) -> &[Option<usize>] {
        &self.arrays.parents
    }

    /// Index of each vertex's mirror image; empty where the mesh is not symmetric.
    pub fn mirror_vertices(&self) -> &[u32] {
        &self.arrays.mirror_vertices
    }

    /// How sex, stature, mass and age map to betas, where the model knows.
    pub fn attributes(&self) -> Option<&AttributeMap> {
        self.arrays.attributes.as_ref()
    }

    /// Body part of each vertex: the body joint that moves it most (fingers count as wrist).
    pub fn vertex_parts(&self) -> &[Joint] {
        &self.vertex_parts
    }

    /// Body part of each triangle: that of most of its vertices.
    pub fn triangle_parts(&self) -> &[Joint] {
        &self.triangle_parts
    }

    pub(crate) fn skinning(&self) -> &SkinningPlan {
        &self.skinning
    }
}

impl fmt::Debug for BodyModel {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        formatter
            .debug_struct("BodyModel")
            .field("name", &self.name())
            .field("vertices", &self.vertex_count())
            .field("joints", &self.joint_count())
            .field("betas", &self.beta_count())
            .finish_non_exhaustive()
    }
}

/// The nearest body joint at or above `joint`: joints beyond the 22 belong to hands and face.
fn body_part(parents: &[Option<usize>], mut joint: usize) -> Joint {
    loop {
        match (Joint::from_index(joint), parents[joint]) {
            (Some(part), _) => return part,
            (None, Some(parent)) => joint = parent,
            (None, None) => return Joint::Pelvis,
        }
    }
}

fn check(arrays: &BodyArrays) -> Result<(), Error> {
    let vertices = arrays.template.len();
    let joints = arrays.parents.len();
    let require = |holds: bool, what, expected: String, found: String| {
        if holds {
            Ok(())
        } else {
            Err(Error::Model {
                what,
                expected,
                found,
            })
        }
    };

    require(
        vertices > 0 && u32::try_from(vertices).is_ok(),
        "the template",
        "between 1 and 2^32 vertices".into(),
        vertices.to_string(),
    )?;
    let finite = |vectors: &[Vec3]| vectors.iter().all(|vector| vector.is_finite());
    require(
        finite(&arrays.template),
        "the template",
        "finite".into(),
        "NaN or infinity".into(),
    )?;
    let smpl_parents = Joint::ALL.map(|joint| joint.parent().map(Joint::index));
    require(
        arrays.parents.get(..Joint::COUNT) == Some(&smpl_parents)
            && arrays.parents[Joint::COUNT..]
                .iter()
                .enumerate()
                .all(|(i, parent)| parent.is_some_and(|parent| parent < Joint::COUNT + i)),
        "the kinematic tree",
        "SMPL's 22 body joints first, parents before children".into(),
        format!("{:?}", arrays.parents),
    )?;
    for (what, directions, expected) in [
        ("a shape direction", &arrays.shape_directions, None),
        (
            "the pose directions",
            &arrays.pose_directions,
            Some(9 * (joints - 1)),
        ),
    ] {
        if let (Some(expected), false) = (expected, directions.is_empty()) {
            let found = directions.len();
            require(
                found == expected,
                what,
                format!("{expected}, or none"),
                found.to_string(),
            )?;
        }
        for direction in directions {
            require(
                direction.len() == vertices && finite(direction),
                what,
                format!("{vertices} finite vectors"),
                format!("{} vectors", direction.len()),
            )?;
        }
    }
    let regressor = &arrays.joint_regressor;
    require(
        regressor.joint_count() == joints && (regressor.largest_vertex() as usize) < vertices,
        "the joint regressor",
        format!("{joints} joints of {vertices} vertices"),
        format!(
            "{} joints, vertex {}",
            regressor.joint_count(),
            regressor.largest_vertex()
        ),
    )?;
    let weights = &arrays.blend_weights;
    require(
        weights.vertex_count() == vertices && usize::from(weights.largest_joint()) < joints,
        "the blend weights",
        format!("{vertices} rows of {joints} joints"),
        format!(
            "{} rows, joint {}",
            weights.vertex_count(),
            weights.largest_joint()
        ),
    )?;
    let largest = arrays.triangles.iter().flatten().copied().max();
    require(
        largest.is_some_and(|largest| (largest as usize) < vertices),
        "the triangles",
        format!("indices below {vertices}"),
        format!("{largest:?}"),
    )?;
    let mirror = &arrays.mirror_vertices;
    let involution = || {
        mirror.len() == vertices
            && mirror.iter().enumerate().all(|(vertex, &mirrored)| {
                mirror.get(mirrored as usize).map(|&back| back as usize) == Some(vertex)
            })
    };
    require(
        mirror.is_empty() || involution(),
        "the mirror map",
        format!("a pairing of {vertices} vertices"),
        format!("{} entries that do not pair up", mirror.len()),
    )
}

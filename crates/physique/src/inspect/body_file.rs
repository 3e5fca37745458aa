//! Body models.

use std::path::Path;

use physique_body::{BodyOptions, read_body};
use physique_motion::Error;
use schemars::JsonSchema;
use serde::Serialize;

/// What a body model is.
#[derive(Clone, Debug, PartialEq, Serialize, JsonSchema)]
pub struct BodyInspection {
    /// Its name.
    pub name: String,
    /// Vertices of its mesh.
    pub vertices: usize,
    /// Triangles of its mesh.
    pub triangles: usize,
    /// Joints.
    pub joints: usize,
    /// Shape coefficients.
    pub betas: usize,
    /// Directions in which vertices move with the pose; 0 for plain skinning.
    pub pose_directions: usize,
    /// Joints that a vertex follows at most.
    pub influences: usize,
    /// From the lowest to the highest point of the mean shape at rest.
    pub stature_m: f64,
    /// Edges of its surface with one triangle only.
    pub open_edges: usize,
    /// Parts of its surface.
    pub components: usize,
}

/// A file that is no motion as a body; `None` if it is none either, so that the motion's error
/// counts.
pub(super) fn inspect(path: &Path, no_motion: &Error) -> Option<BodyInspection> {
    if matches!(no_motion, Error::Io { .. } | Error::Limit { .. }) {
        return None;
    }
    let model = read_body(path, &BodyOptions::default()).ok()?;
    let surface = model.surface();
    let heights = model.template().iter().map(|vertex| vertex.y);
    let (low, high) = heights.fold((f32::MAX, f32::MIN), |(low, high), y| {
        (low.min(y), high.max(y))
    });
    Some(BodyInspection {
        name: model.name().to_owned(),
        vertices: model.vertex_count(),
        triangles: model.triangles().len(),
        joints: model.joint_count(),
        betas: model.beta_count(),
        pose_directions: model.pose_directions().len(),
        influences: model.blend_weights().influences(),
        stature_m: f64::from(high) - f64::from(low),
        open_edges: surface.open_edges,
        components: surface.components,
    })
}

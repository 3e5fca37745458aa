//! Which body was scored.

use physique_body::Body;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use sha2::{Digest, Sha256};

/// Which body was scored.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct BodyDescription {
    /// Name of the model.
    pub model: String,
    /// Stature in metres.
    pub stature_m: f64,
    /// Mass in kilograms.
    pub mass_kg: f64,
    /// Shape coefficients; missing ones are 0.
    pub betas: Vec<f32>,
    /// SHA-256 over rest vertices, rest joints, triangles and blend weights: equal hashes are equal
    /// bodies, whatever they are called.
    pub sha256: String,
}

impl BodyDescription {
    /// Describes a body.
    pub fn of(body: &Body) -> Self {
        Self {
            model: body.model().name().to_owned(),
            stature_m: body.stature(),
            mass_kg: body.mass(),
            betas: body.betas().to_vec(),
            sha256: sha256(body),
        }
    }
}

fn sha256(body: &Body) -> String {
    let mut hash = Sha256::new();
    let places = body.rest_vertices().iter().chain(body.rest_joints());
    for number in places.flat_map(|place| place.to_array()) {
        hash.update(number.to_le_bytes());
    }
    for vertex in body.model().triangles().iter().flatten() {
        hash.update(vertex.to_le_bytes());
    }
    let blend_weights = body.model().blend_weights();
    hash.update(blend_weights.joints());
    for weight in blend_weights.weights() {
        hash.update(weight.to_le_bytes());
    }
    let digest = hash.finalize();
    digest.iter().map(|byte| format!("{byte:02x}")).collect()
}

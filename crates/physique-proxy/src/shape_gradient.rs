//! How a loss changes with the shape of the body.

use glam::{DVec3, Vec3};
use physique_body::Joint;

use crate::kernel::ShapeSums;

/// Derivatives of a weighted sum of losses over frames by the rest body that is posed.
#[derive(Clone, Debug, PartialEq)]
pub struct ShapeGradient {
    /// By the rest joints.
    pub rest_joints: [Vec3; Joint::COUNT],
    /// `[spheres]` by the rest centres.
    pub centres: Vec<Vec3>,
    /// `[spheres]` by the radii.
    pub radii: Vec<f32>,
}

impl ShapeGradient {
    /// From sums in the order of a plan.
    pub(crate) fn new(order: &[u16], sums: Option<&ShapeSums>) -> Self {
        let mut gradient = Self {
            rest_joints: [Vec3::ZERO; Joint::COUNT],
            centres: vec![Vec3::ZERO; order.len()],
            radii: vec![0.0; order.len()],
        };
        if let Some(sums) = sums {
            gradient.rest_joints = sums.rest_joints.map(vector);
            for (place, &sphere) in order.iter().enumerate() {
                gradient.centres[usize::from(sphere)] = vector(sums.centres[place]);
                gradient.radii[usize::from(sphere)] = sums.radii[place] as f32;
            }
        }
        gradient
    }
}

fn vector(sum: [f64; 3]) -> Vec3 {
    DVec3::from_array(sum).as_vec3()
}

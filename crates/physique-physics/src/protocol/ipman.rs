//! IPMAN (Tripathi et al., CVPR 2023): static stability, frame by frame.
//!
//! Centre of mass: surface points weighted by the volume of their part. Centre of pressure: all
//! surface points by IPMAN's pressure. Base of support: hull of the skin below 10 cm, if ten points
//! or more. IPMAN samples 20,000 points evenly over the surface; here vertices stand for the area
//! around them, the expectation of that sample.

use glam::{DVec2, DVec3};
use physique_motion::Motion;

use super::ProtocolMeasure;
use super::parts::vertex_volumes;
use super::track::{Track, pose};
use crate::balance::on_ground;
use crate::measures::mean;
use crate::{Error, Physics, PressureModel, SupportPolygon};

const CONTACT: f64 = 0.10;
const LEAST_POINTS: usize = 10;

pub(super) fn measure(
    physics: &Physics,
    motion: &Motion,
    track: &Track,
) -> Result<Vec<ProtocolMeasure>, Error> {
    let rest: Vec<_> = physics
        .body()
        .rest_vertices()
        .iter()
        .map(|v| v.as_dvec3())
        .collect();
    let volumes = vertex_volumes(physics.body(), &rest);
    let mut posed = physics.body().posed();
    let (mut distances, mut inside) = (Vec::new(), Vec::new());
    for frame in 0..motion.frame_count() {
        pose(physics, motion, frame, &mut posed)?;
        let vertices: Vec<DVec3> = posed.vertices().iter().map(|v| v.as_dvec3()).collect();
        let weights = || {
            volumes
                .iter()
                .zip(physics.vertex_areas())
                .map(|(v, area)| v * area)
        };
        let total: f64 = weights().sum();
        let sum: DVec2 = vertices
            .iter()
            .zip(weights())
            .map(|(v, w)| on_ground(*v) * w)
            .sum();
        let centre = sum / total;
        let points = vertices
            .iter()
            .copied()
            .zip(physics.vertex_areas().iter().copied());
        if let Some(pressure) = PressureModel::IPMAN.centre(points, track.floor, 0.0) {
            distances.push(1000.0 * centre.distance(pressure));
        }
        let low = vertices.iter().filter(|v| v.y - track.floor < CONTACT);
        let mut contacts: Vec<_> = low.map(|v| on_ground(*v)).collect();
        if contacts.len() >= LEAST_POINTS {
            let hull = SupportPolygon::around(&mut contacts);
            let stands = hull.is_some_and(|hull| hull.signed_distance(centre) <= 0.0);
            inside.push(if stands { 100.0 } else { 0.0 });
        }
    }
    let supported = 100.0 * inside.len() as f64 / motion.frame_count() as f64;
    Ok(vec![
        ProtocolMeasure::new("com_cop_distance_mm", mean(distances.into_iter())),
        ProtocolMeasure::new("com_in_base_of_support_percent", mean(inside.into_iter())),
        ProtocolMeasure::new("frames_with_contact_percent", Some(supported)),
    ])
}

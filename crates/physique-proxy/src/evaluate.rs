//! How well a proxy stands in for its body.

use std::sync::Arc;
use std::time::Instant;

use physique_body::{BodyModel, Joint};
use rayon::prelude::*;
use serde::Serialize;

use crate::fit::shapes::{self, NormalisedBody, Purpose};
use crate::{Error, SphereProxy};

/// Distances over many places, in centimetres.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize)]
pub struct DistanceSummary {
    /// Number of distances.
    pub count: usize,
    /// Their mean.
    pub mean_cm: f64,
    /// 95 % are at most this.
    pub p95_cm: f64,
    /// The greatest.
    pub max_cm: f64,
}

impl DistanceSummary {
    fn of(mut distances: Vec<f32>) -> Self {
        let count = distances.len();
        if count == 0 {
            return Self::default();
        }
        distances.sort_unstable_by(f32::total_cmp);
        let sum: f64 = distances.iter().map(|&distance| f64::from(distance)).sum();
        Self {
            count,
            mean_cm: sum / count as f64,
            p95_cm: f64::from(distances[(count - 1) * 95 / 100]),
            max_cm: f64::from(distances[count - 1]),
        }
    }
}

/// What [`evaluate`] found.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Evaluation {
    /// Number of spheres.
    pub spheres: usize,
    /// Bodies that it was measured on.
    pub bodies: usize,
    /// Betas were drawn from plus and minus this.
    pub beta_range: f32,
    /// Distance of rest vertices from the surface of the union of spheres, inside or outside.
    pub vertices: DistanceSummary,
    /// The same by the joint that moves the vertex most; all joints that move any, in order.
    pub by_joint: Vec<JointDistances>,
    /// Distance of regressed joints from the body's.
    pub joints: DistanceSummary,
    /// Pairs that the self-intersection loss compares.
    pub pairs: usize,
    /// Milliseconds to regress the spheres of one shape, on one thread.
    pub regress_ms: f64,
    /// Bytes of both regressors' parameters in memory.
    pub parameter_bytes: usize,
}

/// Distances of the vertices of one body part.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct JointDistances {
    /// Name of the joint.
    pub joint: &'static str,
    /// The vertices that it moves most.
    pub vertices: DistanceSummary,
}

/// Measures a proxy on `bodies` shapes that no fit with this seed has seen: betas uniform in plus
/// and minus `beta_range`, in the rest pose.
///
/// Cost: some 10 ms a body.
///
/// # Errors
/// [`Error::Betas`] for a proxy that reads fewer betas than the model draws; [`Error::Body`] and
/// [`Error::Geometry`] for a model that gives no body with extent.
pub fn evaluate(
    proxy: &SphereProxy,
    model: &Arc<BodyModel>,
    bodies: usize,
    beta_range: f32,
    seed: u64,
) -> Result<Evaluation, Error> {
    let measured: Vec<(Vec<f32>, Vec<f32>)> = (0..bodies)
        .into_par_iter()
        .map(|index| {
            let betas = shapes::betas(Purpose::HeldOut, index, model, beta_range, seed);
            of_body(proxy, &NormalisedBody::new(model, &betas)?, &betas)
        })
        .collect::<Result<_, Error>>()?;
    let parts = model.vertex_parts();
    let of_joint = |joint: Joint| {
        let vertices = measured.iter().flat_map(|(distances, _)| {
            let mine = distances
                .iter()
                .zip(parts)
                .filter(|&(_, part)| *part == joint);
            mine.map(|(distance, _)| *distance)
        });
        JointDistances {
            joint: joint.name(),
            vertices: DistanceSummary::of(vertices.collect()),
        }
    };
    let networks = [
        proxy.sphere_regressor().network(),
        proxy.joint_regressor().network(),
    ];
    Ok(Evaluation {
        spheres: proxy.sphere_count(),
        bodies,
        beta_range,
        by_joint: Joint::ALL
            .into_iter()
            .map(of_joint)
            .filter(|part| part.vertices.count > 0)
            .collect(),
        vertices: DistanceSummary::of(measured.iter().flat_map(|m| m.0.clone()).collect()),
        joints: DistanceSummary::of(measured.iter().flat_map(|m| m.1.clone()).collect()),
        pairs: proxy.pairs()?.len(),
        regress_ms: regress_ms(proxy)?,
        parameter_bytes: networks
            .map(|network| 4 * network.parameters().len())
            .iter()
            .sum(),
    })
}

/// Distances of vertices and joints in centimetres.
fn of_body(
    proxy: &SphereProxy,
    shape: &NormalisedBody,
    betas: &[f32],
) -> Result<(Vec<f32>, Vec<f32>), Error> {
    let spheres = proxy.normalised(betas)?;
    let centimetres = 100.0 / shape.ball.scale;
    let vertices = shape.vertices.iter().map(|vertex| {
        let rows = spheres.centres.iter().zip(&spheres.radii);
        let gap = rows
            .map(|(centre, radius)| vertex.distance(*centre) - radius)
            .fold(f32::INFINITY, f32::min);
        gap.abs() * centimetres
    });
    let joints = spheres.rest_joints.iter().zip(shape.body.rest_joints());
    let joints = joints.map(|(regressed, &joint)| {
        regressed.distance(shape.ball.ball_from_world(joint)) * centimetres
    });
    Ok((vertices.collect(), joints.collect()))
}

/// Median of some runs.
fn regress_ms(proxy: &SphereProxy) -> Result<f64, Error> {
    let mut times = Vec::new();
    for _ in 0..9 {
        let start = Instant::now();
        proxy.sphere_regressor().spheres(&[])?;
        times.push(start.elapsed().as_secs_f64() * 1e3);
    }
    times.sort_by(f64::total_cmp);
    Ok(times[times.len() / 2])
}

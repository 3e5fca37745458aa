//! Which joints spheres follow.

use std::sync::Arc;

use glam::Vec3;
use physique_body::{BodyModel, Joint};
use rayon::prelude::*;

use super::FitOptions;
use super::shapes::{self, NormalisedBody, Purpose};
use crate::sphere_proxy::BlendRow;
use crate::{Error, RegressedSpheres, SphereRegressor};

/// How the vertices next to a sphere share in its blend weights.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum NeighbourWeights {
    /// All alike, as the paper says.
    #[default]
    Equal,
    /// By their signed distance to the sphere, as the published program does: farther ones weigh
    /// more, and those within the sphere count negative.
    Distance,
}

/// Where blend weights come from.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct BlendOptions {
    /// Random shapes whose weights are averaged: 1,000 as published.
    pub bodies: usize,
    /// How neighbours share.
    pub neighbours: NeighbourWeights,
}

impl Default for BlendOptions {
    fn default() -> Self {
        Self {
            bodies: 1_000,
            neighbours: NeighbourWeights::Equal,
        }
    }
}

/// Vertices that give a sphere its weights.
const NEIGHBOURS: usize = 8;

type DenseRow = [f32; Joint::COUNT];

/// Blend weights of a regressor's spheres: the mean over random shapes of those of the 8
/// vertices nearest to each sphere's surface, cut to the four heaviest joints.
pub(crate) fn blend_weights(
    model: &Arc<BodyModel>,
    spheres: &SphereRegressor,
    options: &FitOptions,
    blend: &BlendOptions,
) -> Result<Vec<BlendRow>, Error> {
    let vertex_rows = vertex_rows(model);
    let of_bodies: Vec<Vec<DenseRow>> = (0..blend.bodies.max(1))
        .into_par_iter()
        .map(|index| {
            let purpose = Purpose::BlendWeights;
            let betas = shapes::betas(purpose, index, model, options.beta_range, options.seed);
            let shape = NormalisedBody::new(model, &betas)?;
            let spheres = spheres.spheres(&betas)?;
            Ok({
                let rule = blend.neighbours;
                sphere_rows(&spheres, &shape.vertices, &vertex_rows, rule)
            })
        })
        .collect::<Result<_, Error>>()?;
    let mean = |sphere: usize| {
        let mut sum = [0.0; Joint::COUNT];
        for rows in &of_bodies {
            for (sum, weight) in sum.iter_mut().zip(rows[sphere]) {
                *sum += weight / of_bodies.len() as f32;
            }
        }
        sum
    };
    Ok((0..spheres.sphere_count())
        .map(|sphere| heaviest(&mean(sphere)))
        .collect())
}

/// `[vertices]` weights of the 22 joints; what fingers and face move counts for wrist and head.
pub(crate) fn vertex_rows(model: &BodyModel) -> Vec<DenseRow> {
    let body_joint = |mut joint: usize| {
        while joint >= Joint::COUNT {
            joint = model.parents()[joint].unwrap_or(0);
        }
        joint
    };
    (0..model.vertex_count())
        .map(|vertex| {
            let mut dense = [0.0; Joint::COUNT];
            for (joint, weight) in model.blend_weights().row(vertex) {
                dense[body_joint(joint)] += weight;
            }
            dense
        })
        .collect()
}

/// Weights of the spheres of one shape: four joints each, the rest 0.
pub(crate) fn sphere_rows(
    spheres: &RegressedSpheres,
    vertices: &[Vec3],
    vertex_rows: &[DenseRow],
    rule: NeighbourWeights,
) -> Vec<DenseRow> {
    let mut gaps: Vec<(f32, usize)> = Vec::with_capacity(vertices.len());
    let rows = spheres.centres.iter().zip(&spheres.radii);
    rows.map(|(&centre, &radius)| {
        gaps.clear();
        let gap = |vertex: Vec3| vertex.distance(centre) - radius;
        gaps.extend(vertices.iter().map(|&vertex| gap(vertex)).zip(0..));
        let order = |a: &(f32, usize), b: &(f32, usize)| a.0.total_cmp(&b.0).then(a.1.cmp(&b.1));
        let count = NEIGHBOURS.min(gaps.len());
        if count < gaps.len() {
            gaps.select_nth_unstable_by(count, order);
        }
        let nearest = &mut gaps[..count];
        nearest.sort_unstable_by(order);
        let sum: f32 = nearest.iter().map(|(gap, _)| gap).sum();
        let mut dense = [0.0; Joint::COUNT];
        for &mut (gap, vertex) in nearest {
            let share = match rule {
                NeighbourWeights::Equal => 1.0 / count as f32,
                NeighbourWeights::Distance => gap / sum,
            };
            for (sum, weight) in dense.iter_mut().zip(vertex_rows[vertex]) {
                *sum += share * weight;
            }
        }
        let mut kept = [0.0; Joint::COUNT];
        for (joint, weight) in heaviest(&dense) {
            kept[usize::from(joint)] += weight;
        }
        kept
    })
    .collect()
}

/// The four heaviest joints, divided by their sum; of equals the first.
fn heaviest(dense: &DenseRow) -> BlendRow {
    let mut joints: [(u8, f32); Joint::COUNT] = std::array::from_fn(|i| (i as u8, dense[i]));
    joints.sort_by(|a, b| b.1.total_cmp(&a.1));
    let mut row = [(0, 0.0); 4];
    row.copy_from_slice(&joints[..4]);
    let sum: f32 = row.iter().map(|(_, weight)| weight).sum();
    if sum > 0.0 {
        row.iter_mut().for_each(|(_, weight)| *weight /= sum);
    }
    row
}

#[cfg(test)]
mod tests {
    use glam::Vec3;
    use physique_files::npz::{Archive, ArrayLimits};

    use super::{NeighbourWeights, heaviest, sphere_rows};
    use crate::RegressedSpheres;

    #[test]
    fn the_published_programs_rule() {
        let bytes = include_bytes!("../../tests/fixtures/sphere_proxy_posed.npz").to_vec();
        let mut archive = Archive::open(bytes, ArrayLimits::default()).expect("a sound archive");
        let mut array = |key: &str| archive.array(key).expect(key).to_f32().expect(key);
        let vectors = |numbers: Vec<f32>| -> Vec<Vec3> {
            let rows = numbers.as_chunks().0.iter();
            rows.map(|&xyz| Vec3::from_array(xyz)).collect()
        };
        let spheres = RegressedSpheres {
            centres: vectors(array("bw_centers")),
            radii: array("bw_radii"),
        };
        let vertices = vectors(array("bw_verts"));
        let rows = array("bw_smpl_weights").as_chunks().0.to_vec();
        let found = sphere_rows(&spheres, &vertices, &rows, NeighbourWeights::Distance);
        for (found, expected) in found.as_flattened().iter().zip(array("bw_out")) {
            assert!((found - expected).abs() < 1e-5, "{found} for {expected}");
        }
        // The paper's rule: weights of a mean are never negative.
        let found = sphere_rows(&spheres, &vertices, &rows, NeighbourWeights::Equal);
        assert!(
            found
                .iter()
                .all(|row| row.iter().all(|&weight| weight >= 0.0))
        );
    }

    #[test]
    fn neighbours_share_alike() {
        // Nine vertices on a line: the farthest, and it alone, is left out.
        let vertices: Vec<Vec3> = (1..=9).map(|i| Vec3::X * i as f32).collect();
        let mut rows = vec![[0.0; 22]; 9];
        for (vertex, row) in rows.iter_mut().enumerate() {
            row[if vertex < 2 { 3 } else { 5 }] = 1.0;
        }
        rows[8] = [0.0; 22];
        rows[8][7] = 1.0;
        let spheres = RegressedSpheres {
            centres: vec![Vec3::ZERO],
            radii: vec![0.5],
        };
        let found = sphere_rows(&spheres, &vertices, &rows, NeighbourWeights::Equal);
        assert_eq!((found[0][3], found[0][5], found[0][7]), (0.25, 0.75, 0.0));
    }

    #[test]
    fn the_four_heaviest_stay() {
        let mut dense = [0.0; 22];
        for (joint, weight) in [(1, 0.1), (4, 0.3), (9, 0.2), (20, 0.25), (21, 0.15)] {
            dense[joint] = weight;
        }
        let row = heaviest(&dense);
        assert_eq!(row.map(|(joint, _)| joint), [4, 20, 9, 21]);
        assert!((row[0].1 - 0.3 / 0.9).abs() < 1e-6);
    }
}

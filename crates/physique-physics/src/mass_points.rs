//! The mass of a body as points inside it that move with its joints.

use glam::{DMat4, DVec3};
use physique_body::{Body, Joint};
use physique_geometry::Triangles;
use rayon::prelude::*;

use crate::interior::interior_points;
use crate::segment::{Segment, density};
use crate::{Error, MassMoments};

/// Surface vertices up to this many times as far as the nearest one lend a point their weights:
/// about the ring around a limb for a point on its axis.
const REACH: f64 = 1.5;
/// Weights below this are dropped.
const LEAST_WEIGHT: f64 = 0.01;

/// Mass points of a rest body: where, how heavy, and which joints move them.
///
/// The points fill the closed surface on a lattice. Each takes blend weights from the vertices
/// nearest to it (inverse squared distance) and the density of the part it belongs to; masses are
/// then scaled so that they add up to the body's mass.
#[derive(Clone, Debug, PartialEq)]
pub struct MassPoints {
    positions: Vec<DVec3>,
    masses: Vec<f64>,
    /// Begin of each point's weights; one more than points.
    begins: Vec<usize>,
    weights: Vec<(usize, f64)>,
    parts: Vec<Joint>,
    segments: Vec<Segment>,
}

impl MassPoints {
    /// Fills `body` with points about `spacing` metres apart: 2 cm gives some 9,000.
    ///
    /// Costs a tenth of a second at 2 cm, once a body.
    ///
    /// # Errors
    /// [`Error::Geometry`] for a surface that is not closed, [`Error::Option`] for a spacing that
    /// is not between 5 mm and 10 cm, [`Error::Shape`] where nothing is inside.
    pub fn new(body: &Body, spacing: f64) -> Result<Self, Error> {
        if !(0.005..=0.1).contains(&spacing) {
            return Err(Error::Option {
                option: "spacing of the mass points",
                expected: "0.005 to 0.1 m",
                found: spacing,
            });
        }
        let model = body.model();
        Triangles::new(model.vertex_count(), model.triangles())?.require_closed()?;
        let vertices: Vec<_> = body.rest_vertices().iter().map(|v| v.as_dvec3()).collect();
        let points = interior_points(&vertices, model.triangles(), spacing);
        if points.is_empty() {
            return Err(Error::Shape {
                body: model.name().to_owned(),
                expected: "a volume",
                found: format!("no point of a lattice of {spacing} m inside"),
            });
        }
        let rows: Vec<_> = points
            .par_iter()
            .map(|point| {
                let near = near_vertices(&vertices, point.position);
                blend(near.iter().map(|&(vertex, share)| {
                    let row = model.blend_weights().row(vertex);
                    (share, row.map(|(joint, weight)| (joint, f64::from(weight))))
                }))
            })
            .collect();
        let parts: Vec<_> = rows.iter().map(|row| part(model.parents(), row)).collect();
        let mut masses: Vec<_> = points
            .iter()
            .zip(&parts)
            .map(|(point, &part)| point.volume * density(part))
            .collect();
        let scale = body.mass() / masses.iter().sum::<f64>();
        masses.iter_mut().for_each(|mass| *mass *= scale);
        let segments = points
            .iter()
            .zip(&parts)
            .map(|(point, &part)| Segment::at(body, part, point.position))
            .collect();
        let positions = points.iter().map(|point| point.position).collect();
        Ok(Self {
            segments,
            ..Self::from_parts(positions, masses, &rows, parts)
        })
    }

    pub(crate) fn from_parts(
        positions: Vec<DVec3>,
        masses: Vec<f64>,
        rows: &[Vec<(usize, f64)>],
        parts: Vec<Joint>,
    ) -> Self {
        let mut begins = vec![0];
        let mut weights = Vec::new();
        for row in rows {
            weights.extend_from_slice(row);
            begins.push(weights.len());
        }
        Self {
            positions,
            masses,
            begins,
            weights,
            segments: parts.iter().map(|&part| Segment::of(part)).collect(),
            parts,
        }
    }

    /// The same points elsewhere: their masses and weights stay.
    pub(crate) fn with_positions(&self, positions: Vec<DVec3>) -> Self {
        Self {
            positions,
            ..self.clone()
        }
    }

    /// `[points]` rest positions, in metres.
    pub fn positions(&self) -> &[DVec3] {
        &self.positions
    }

    /// `[points]` masses, in kg.
    pub fn masses(&self) -> &[f64] {
        &self.masses
    }

    /// `[points]` body parts.
    pub fn parts(&self) -> &[Joint] {
        &self.parts
    }

    /// Joints and weights of a point; they sum to 1.
    pub fn weights(&self, point: usize) -> &[(usize, f64)] {
        &self.weights[self.begins[point]..self.begins[point + 1]]
    }

    /// Mass of a segment, in kg.
    pub fn segment_mass(&self, segment: Segment) -> f64 {
        self.segments
            .iter()
            .zip(&self.masses)
            .filter(|&(&other, _)| other == segment)
            .map(|(_, mass)| mass)
            .sum()
    }

    /// The sums over all points that posing needs, by joint and pair of joints.
    pub fn moments(&self) -> MassMoments {
        MassMoments::new(self)
    }

    /// The points in the world, blended by `world_from_rest` (or, from its time derivatives, their
    /// velocities and accelerations). The slow way: [`MassMoments`] knows the sums without.
    pub fn posed(&self, world_from_rest: &[DMat4]) -> Vec<DVec3> {
        (0..self.positions.len())
            .map(|point| {
                let rest = self.positions[point].extend(1.0);
                let blended: DMat4 = self
                    .weights(point)
                    .iter()
                    .map(|&(joint, weight)| world_from_rest[joint] * weight)
                    .fold(DMat4::ZERO, |sum, term| sum + term);
                (blended * rest).truncate()
            })
            .collect()
    }
}

/// The vertices around a point with their shares, which add up to 1.
pub(crate) fn near_vertices(vertices: &[DVec3], point: DVec3) -> Vec<(usize, f64)> {
    let squared = |vertex: &DVec3| vertex.distance_squared(point).max(1e-8);
    let nearest = vertices.iter().map(squared).fold(f64::MAX, f64::min);
    let mut near: Vec<_> = vertices
        .iter()
        .enumerate()
        .map(|(index, vertex)| (index, squared(vertex)))
        .filter(|&(_, distance)| distance <= nearest * REACH * REACH)
        .map(|(index, distance)| (index, 1.0 / distance))
        .collect();
    let sum: f64 = near.iter().map(|&(_, share)| share).sum();
    near.iter_mut().for_each(|(_, share)| *share /= sum);
    near
}

/// Weighted mean of rows of blend weights, without what hardly counts.
fn blend<Row: Iterator<Item = (usize, f64)>>(
    rows: impl Iterator<Item = (f64, Row)>,
) -> Vec<(usize, f64)> {
    let mut sums: Vec<(usize, f64)> = Vec::new();
    for (share, row) in rows {
        for (joint, weight) in row {
            match sums.iter_mut().find(|(known, _)| *known == joint) {
                Some((_, sum)) => *sum += share * weight,
                None => sums.push((joint, share * weight)),
            }
        }
    }
    sums.retain(|&(_, weight)| weight >= LEAST_WEIGHT);
    let total: f64 = sums.iter().map(|&(_, weight)| weight).sum();
    sums.iter_mut().for_each(|(_, weight)| *weight /= total);
    sums.sort_by(|a, b| b.1.total_cmp(&a.1).then(a.0.cmp(&b.0)));
    sums
}

/// The body part that a row of weights belongs to; joints beyond the 22 belong to hands and face.
fn part(parents: &[Option<usize>], row: &[(usize, f64)]) -> Joint {
    let mut joint = row.first().map_or(0, |&(joint, _)| joint);
    loop {
        match (Joint::from_index(joint), parents[joint]) {
            (Some(part), _) => return part,
            (None, Some(parent)) => joint = parent,
            (None, None) => return Joint::Pelvis,
        }
    }
}

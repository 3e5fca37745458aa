//! What the losses look at: few points of skin, mass moments, and how both change with shape.

use glam::{DMat4, DVec3, DVec4};
use physique_body::Body;
use rayon::prelude::*;

use crate::mass_points::near_vertices;
use crate::soles::{SOLE_POINTS, sole_points};
use crate::{Error, MassMoments, MassPoints, Rig};

/// Distance between mass points, in metres: some 1,100 points.
const MASS_SPACING: f64 = 0.04;

/// A point of the skin that may touch the ground.
#[derive(Clone, Debug, PartialEq)]
pub struct SkinPoint {
    /// Place in the rest pose, in metres.
    pub rest: DVec3,
    /// Joints that move it, and how much each does.
    pub weights: Vec<(usize, f64)>,
    /// Area that it stands for, in m2.
    pub area: f64,
}

/// A body prepared for the losses: once a body model or identity.
///
/// Linear in a change of the betas: rest joints, skin and mass points move along the model's shape
/// directions; masses and blend weights stay.
#[derive(Clone, Debug)]
pub struct LossBody {
    pub(crate) rig: Rig,
    pub(crate) skin: Vec<SkinPoint>,
    pub(crate) mass_points: MassPoints,
    betas: usize,
    /// `[betas][joints]`, `[betas][skin]`, `[betas][mass points]` displacements a unit.
    joint_directions: Vec<Vec<DVec3>>,
    skin_directions: Vec<Vec<DVec3>>,
    mass_directions: Vec<Vec<DVec3>>,
}

impl LossBody {
    /// Prepares a body with `skin_points` points of skin besides the twelve sole points; 500 are
    /// plenty. The first twelve skin points are the sole points.
    ///
    /// # Errors
    /// As [`crate::Physics::new`]; [`Error::Option`] for no or more points than vertices.
    pub fn new(body: &Body, skin_points: usize) -> Result<Self, Error> {
        let model = body.model();
        if skin_points == 0 || skin_points > model.vertex_count() {
            return Err(Error::Option {
                option: "skin points of a loss",
                expected: "1 up to the body's vertices",
                found: skin_points as f64,
            });
        }
        let vertices: Vec<_> = body.rest_vertices().iter().map(|v| v.as_dvec3()).collect();
        let soles = sole_points(body)?.map(|sole| sole.vertex);
        let chosen = spread_out(&vertices, &soles, skin_points);
        let area = surface_area(&vertices, model.triangles()) / chosen.len() as f64;
        let skin = chosen
            .iter()
            .map(|&vertex| SkinPoint {
                rest: vertices[vertex],
                weights: model
                    .blend_weights()
                    .row(vertex)
                    .filter(|&(_, weight)| weight > 0.0)
                    .map(|(joint, weight)| (joint, f64::from(weight)))
                    .collect(),
                area,
            })
            .collect();
        let mass_points = MassPoints::new(body, MASS_SPACING)?;
        let carriers: Vec<_> = mass_points
            .positions()
            .par_iter()
            .map(|&point| near_vertices(&vertices, point))
            .collect();

        let directions = model.shape_directions();
        let joint_directions = directions
            .iter()
            .map(|direction| {
                let moved = model.joint_regressor().joints(direction);
                moved.iter().map(|joint| joint.as_dvec3()).collect()
            })
            .collect();
        let skin_directions = directions
            .iter()
            .map(|direction| chosen.iter().map(|&v| direction[v].as_dvec3()).collect())
            .collect();
        let mass_directions = directions
            .iter()
            .map(|direction| {
                let moved = |carriers: &Vec<(usize, f64)>| {
                    let shares = carriers.iter();
                    shares
                        .map(|&(v, share)| direction[v].as_dvec3() * share)
                        .sum()
                };
                carriers.iter().map(moved).collect()
            })
            .collect();
        Ok(Self {
            rig: Rig::new(body),
            skin,
            mass_points,
            betas: directions.len(),
            joint_directions,
            skin_directions,
            mass_directions,
        })
    }

    /// Number of shape coefficients.
    pub const fn beta_count(&self) -> usize {
        self.betas
    }

    /// Number of skin points, the twelve sole points first.
    pub fn skin_count(&self) -> usize {
        self.skin.len()
    }

    /// The skin points, the twelve sole points first: heel, ball and toes of the left foot, inner
    /// edge before outer, then of the right.
    pub fn skin(&self) -> &[SkinPoint] {
        &self.skin
    }

    /// The skeleton.
    pub const fn rig(&self) -> &Rig {
        &self.rig
    }

    /// The mass points.
    pub const fn mass_points(&self) -> &MassPoints {
        &self.mass_points
    }

    /// The body with its betas changed by `change` (missing ones by 0).
    pub(crate) fn shaped(&self, change: &[f64]) -> ShapedBody<'_> {
        let moved = |rest: &mut [DVec3], directions: &[Vec<DVec3>]| {
            for (&beta, direction) in change.iter().zip(directions) {
                for (point, step) in rest.iter_mut().zip(direction) {
                    *point += *step * beta;
                }
            }
        };
        let mut joints = self.rig.rest_joints().to_vec();
        moved(&mut joints, &self.joint_directions);
        let mut skin: Vec<_> = self.skin.iter().map(|point| point.rest).collect();
        moved(&mut skin, &self.skin_directions);
        let mut mass = self.mass_points.positions().to_vec();
        moved(&mut mass, &self.mass_directions);
        let moments = self.mass_points.with_positions(mass.clone()).moments();
        ShapedBody {
            body: self,
            rig: self.rig.with_rest_joints(joints),
            skin,
            mass,
            moments,
        }
    }
}

/// A body of one shape.
pub(crate) struct ShapedBody<'a> {
    pub(crate) body: &'a LossBody,
    pub(crate) rig: Rig,
    pub(crate) skin: Vec<DVec3>,
    mass: Vec<DVec3>,
    pub(crate) moments: MassMoments,
}

impl ShapedBody<'_> {
    /// The mass points of this shape.
    pub(crate) fn mass_points(&self) -> MassPoints {
        self.body.mass_points.with_positions(self.mass.clone())
    }

    /// A skin point in the world.
    pub(crate) fn posed_skin(&self, point: usize, world_from_rest: &[DMat4]) -> DVec3 {
        let terms = self.body.skin[point]
            .weights
            .iter()
            .map(|&(joint, weight)| {
                world_from_rest[joint].transform_point3(self.skin[point]) * weight
            });
        terms.sum()
    }
}

/// Gradient to a rest body: of fixed size, however long the motion.
#[derive(Clone, Debug, Default)]
pub(crate) struct RestGradient {
    pub(crate) joints: Vec<DVec3>,
    pub(crate) skin: Vec<DVec3>,
    /// To [`MassMoments`]'s first and second moments, entry by entry.
    pub(crate) first: Vec<DVec4>,
    pub(crate) second: Vec<DMat4>,
}

impl RestGradient {
    pub(crate) fn new(shaped: &ShapedBody<'_>) -> Self {
        Self {
            joints: vec![DVec3::ZERO; shaped.rig.joint_count()],
            skin: vec![DVec3::ZERO; shaped.skin.len()],
            first: vec![DVec4::ZERO; shaped.moments.first.len()],
            second: vec![DMat4::ZERO; shaped.moments.second.len()],
        }
    }

    /// Derivative to each beta.
    pub(crate) fn betas(&self, shaped: &ShapedBody<'_>) -> Vec<f64> {
        let mass = self.mass_points(shaped);
        let body = shaped.body;
        let along = |gradient: &[DVec3], direction: &[DVec3]| -> f64 {
            gradient.iter().zip(direction).map(|(g, d)| g.dot(*d)).sum()
        };
        (0..body.betas)
            .map(|beta| {
                along(&self.joints, &body.joint_directions[beta])
                    + along(&self.skin, &body.skin_directions[beta])
                    + along(&mass, &body.mass_directions[beta])
            })
            .collect()
    }

    /// From the moments to the rest positions of the mass points.
    fn mass_points(&self, shaped: &ShapedBody<'_>) -> Vec<DVec3> {
        let points = &shaped.body.mass_points;
        let joints = self.first.len();
        let mut second = vec![DMat4::ZERO; joints * joints];
        for (&(j, l, _), gradient) in shaped.moments.second.iter().zip(&self.second) {
            // M = m w w x x^T: the derivative to x is (G + G^T) x.
            second[j * joints + l] = *gradient + gradient.transpose();
        }
        (0..shaped.mass.len())
            .map(|point| {
                let rest = shaped.mass[point].extend(1.0);
                let mut sum = DVec4::ZERO;
                for &(j, weight) in points.weights(point) {
                    sum += self.first[j] * weight;
                    for &(l, other) in points.weights(point) {
                        sum += second[j * joints + l] * rest * (weight * other);
                    }
                }
                sum.truncate() * points.masses()[point]
            })
            .collect()
    }
}

/// The given vertices, then those that are farthest from all chosen before, one after the other.
fn spread_out(vertices: &[DVec3], first: &[usize; SOLE_POINTS], more: usize) -> Vec<usize> {
    let mut chosen = first.to_vec();
    let mut distances = vec![f64::MAX; vertices.len()];
    let mut done = 0;
    while chosen.len() < first.len() + more {
        for &point in &chosen[done..] {
            for (distance, vertex) in distances.iter_mut().zip(vertices) {
                *distance = distance.min(vertex.distance_squared(vertices[point]));
            }
        }
        done = chosen.len();
        let farthest = (0..vertices.len()).max_by(|&a, &b| distances[a].total_cmp(&distances[b]));
        chosen.extend(farthest);
    }
    chosen
}

fn surface_area(vertices: &[DVec3], triangles: &[[u32; 3]]) -> f64 {
    let areas = triangles.iter().map(|triangle| {
        let [a, b, c] = triangle.map(|v| vertices[v as usize]);
        (b - a).cross(c - a).length() / 2.0
    });
    areas.sum()
}

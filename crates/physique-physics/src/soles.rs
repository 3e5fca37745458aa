//! Sole points: heel, ball and toes of both feet.

use glam::{DMat4, DVec3};
use physique_body::{Body, Joint};

use crate::Error;

/// Where under a foot a point is.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
#[allow(missing_docs)] // The names are the documentation.
pub enum SoleRegion {
    Heel,
    Ball,
    Toes,
}

/// A vertex of the sole.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SolePoint {
    /// Ankle of the foot that it is under.
    pub ankle: Joint,
    /// Part of the sole.
    pub region: SoleRegion,
    /// Vertex of the body model.
    pub vertex: usize,
}

/// Number of sole points: heel, ball and toes, inner and outer, of two feet.
pub const SOLE_POINTS: usize = 12;

/// Vertices higher than this above the lowest one are not under the foot, in metres.
const SOLE_THICKNESS: f64 = 0.02;
/// Middles of heel and toes lie this part of the sole's length from its ends.
const FROM_END: f64 = 0.1;
/// A region reaches this part of the sole's length to either side of its middle.
const REGION: f64 = 0.08;
/// A centimetre of height outweighs so many of width when the edge of the sole is looked for.
const FLATNESS: f64 = 4.0;

/// The sole points of a rest body: left foot first; heel, ball, toes; inner edge before outer.
///
/// # Errors
/// [`Error::Shape`] for a body without soles in one of the regions.
pub fn sole_points(body: &Body) -> Result<[SolePoint; SOLE_POINTS], Error> {
    let mut points = Vec::with_capacity(SOLE_POINTS);
    for (ankle, ball, outwards) in [
        (Joint::LeftAnkle, Joint::LeftFoot, 1.0),
        (Joint::RightAnkle, Joint::RightFoot, -1.0),
    ] {
        let foot: Vec<_> = body
            .rest_vertices()
            .iter()
            .zip(body.model().vertex_parts())
            .enumerate()
            .filter(|(_, (_, part))| **part == ankle || **part == ball)
            .map(|(index, (vertex, _))| (index, vertex.as_dvec3()))
            .collect();
        let floor = foot.iter().map(|(_, v)| v.y).fold(f64::MAX, f64::min);
        let back = foot.iter().map(|(_, v)| v.z).fold(f64::MAX, f64::min);
        let front = foot.iter().map(|(_, v)| v.z).fold(f64::MIN, f64::max);
        let (length, toe_joint) = (front - back, f64::from(body.rest_joint(ball).z));
        for (region, middle) in [
            (SoleRegion::Heel, back + FROM_END * length),
            (SoleRegion::Ball, toe_joint),
            (SoleRegion::Toes, front - FROM_END * length),
        ] {
            let inside =
                |v: &DVec3| v.y < floor + SOLE_THICKNESS && (v.z - middle).abs() < REGION * length;
            for side in [-outwards, outwards] {
                let edge = |v: &DVec3| side * v.x - FLATNESS * (v.y - floor);
                let found = foot
                    .iter()
                    .filter(|(_, v)| inside(v))
                    .max_by(|a, b| edge(&a.1).total_cmp(&edge(&b.1)));
                let Some(&(vertex, _)) = found else {
                    return Err(Error::Shape {
                        body: body.model().name().to_owned(),
                        expected: "vertices under heel, ball and toes",
                        found: format!("none at the {region:?} of {ankle:?}"),
                    });
                };
                points.push(SolePoint {
                    ankle,
                    region,
                    vertex,
                });
            }
        }
    }
    points.try_into().map_err(|points: Vec<_>| Error::Shape {
        body: body.model().name().to_owned(),
        expected: "twelve sole points",
        found: points.len().to_string(),
    })
}

/// A skinned vertex in the world; from derivatives of the transforms, its velocity.
pub(crate) fn skinned(body: &Body, vertex: usize, transforms: &[DMat4]) -> DVec3 {
    let rest = body.rest_vertices()[vertex].as_dvec3().extend(1.0);
    let row = body.model().blend_weights().row(vertex);
    row.filter(|&(_, weight)| weight > 0.0)
        .map(|(joint, weight)| (transforms[joint] * rest).truncate() * f64::from(weight))
        .sum()
}

#[cfg(test)]
mod tests {
    use physique_body::{Sex, open_body};

    use super::*;

    #[test]
    fn soles_are_low_ordered_and_mirrored() {
        let body = Body::mean(open_body().unwrap(), Sex::Neutral).unwrap();
        let points = sole_points(&body).unwrap();
        let position = |index: usize| body.rest_vertices()[points[index].vertex];
        for foot in [0, 6] {
            let (heel, ball, toes) = (position(foot), position(foot + 2), position(foot + 4));
            assert!(
                heel.z + 0.08 < ball.z && ball.z + 0.02 < toes.z,
                "{heel} {ball} {toes}"
            );
        }
        for index in 0..6 {
            let (left, right) = (position(index), position(index + 6));
            assert!(left.y < body.rest_ground() + 0.02 && left.x > 0.0);
            assert!((left.x + right.x).abs() < 0.01 && (left.z - right.z).abs() < 0.01);
        }
        assert!(position(1).x > position(0).x + 0.03, "outer and inner heel");
    }
}

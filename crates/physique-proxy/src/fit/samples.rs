//! Points around one body with their signed distances.

use glam::Vec3;
use physique_body::Joint;
use physique_geometry::{NearestSurface, SignedDistances, Triangles, space_filling_order};

use super::blocks::{Block, Blocks, quantised};
use super::options::{FitOptions, Shares};
use super::shapes::NormalisedBody;
use crate::Error;
use crate::random::Random;

/// Standard deviations of the noise on surface points, half of them each (twice the variances of
/// DeepSDF, Park et al., CVPR 2019).
const NOISE: [f32; 2] = [0.070_710_68, 0.022_360_68];
/// Points drawn at a time.
const ROUND: usize = 1 << 17;
/// Rounds after which a body that has too little inside is given up.
const MOST_ROUNDS: usize = 400;

/// The kinds of points that a step shows, in the order of the store.
pub(crate) struct BodySamples {
    /// Ball, hands and feet, surface inside, surface outside.
    pub(crate) kinds: [Blocks; 4],
}

impl BodySamples {
    /// Draws points around a body: a third in the ball, the rest near the surface, as many inside
    /// as outside, and cuts them into blocks of what one step shows.
    pub(crate) fn draw(
        shape: &NormalisedBody,
        triangles: &Triangles,
        options: &FitOptions,
        random: &mut Random,
    ) -> Result<Self, Error> {
        let distances = SignedDistances::new(triangles, &shape.vertices)?;
        let surface = SurfacePoints::new(shape);
        let ball = measured(
            &distances,
            (0..options.ball_points).map(|_| in_ball(random)),
        );

        let half = options.surface_points.div_ceil(2);
        let (mut inside, mut outside) = (Vec::new(), Vec::new());
        for _ in 0..MOST_ROUNDS {
            let mut drawn = surface.draw(ROUND, random);
            for (index, point) in drawn.iter_mut().enumerate() {
                let [a, b] = random.normal_pair();
                let c = random.normal_pair()[0];
                *point += Vec3::new(a, b, c) * NOISE[index % NOISE.len()];
            }
            random.shuffle(&mut drawn);
            for point in measured(&distances, drawn.into_iter()) {
                let half_list = if point.distance <= 0.0 {
                    &mut inside
                } else {
                    &mut outside
                };
                if half_list.len() < half {
                    half_list.push(point);
                }
            }
            if inside.len() == half && outside.len() == half {
                break;
            }
        }
        if inside.len() < half || outside.len() < half {
            return Err(Error::Samples {
                wanted: half,
                inside: inside.len(),
                outside: outside.len(),
            });
        }

        let parts = shape.body.model().vertex_parts();
        let is_detail = |point: &MeasuredPoint| {
            let corners = triangles.corners()[point.triangle as usize];
            let distance =
                |vertex: u32| shape.vertices[vertex as usize].distance_squared(point.place);
            let [a, b, c] = corners;
            let nearest = [b, c].into_iter().fold(a, |best, vertex| {
                if distance(vertex) < distance(best) {
                    vertex
                } else {
                    best
                }
            });
            DETAIL.contains(&parts[nearest as usize])
        };
        let (detail_inside, inside): (Vec<_>, Vec<_>) = inside.into_iter().partition(is_detail);
        let (detail_outside, outside): (Vec<_>, Vec<_>) = outside.into_iter().partition(is_detail);
        let detail = [detail_inside, detail_outside].concat();

        // What hands and feet lack, the rest of the surface shows.
        let shares = Shares::BLOCK;
        let detail_share = shares.detail.min(detail.len());
        let surface_share = shares.surface + shares.detail - detail_share;
        let inside_share = surface_share / 2;
        let mut deal = |points, share| blocks(points, share, random);
        Ok(Self {
            kinds: [
                deal(ball, shares.ball),
                deal(detail, detail_share),
                deal(inside, inside_share),
                deal(outside, surface_share - inside_share),
            ],
        })
    }
}

/// Hands and feet.
const DETAIL: [Joint; 6] = [
    Joint::LeftAnkle,
    Joint::RightAnkle,
    Joint::LeftFoot,
    Joint::RightFoot,
    Joint::LeftWrist,
    Joint::RightWrist,
];

/// A point with its distance.
#[derive(Clone, Copy, Debug)]
struct MeasuredPoint {
    place: Vec3,
    distance: f32,
    triangle: u32,
}

/// Measures points as the store rounds them, in the order of a space-filling curve.
fn measured(distances: &SignedDistances, points: impl Iterator<Item = Vec3>) -> Vec<MeasuredPoint> {
    let drawn: Vec<Vec3> = points.map(quantised).collect();
    let order = space_filling_order(&drawn);
    let points: Vec<Vec3> = order.iter().map(|&index| drawn[index as usize]).collect();
    let mut nearest = vec![NearestSurface::UNKNOWN; points.len()];
    distances.fill(&points, &mut nearest);
    // Back in the order drawn, so that a cut of the list is a fair one.
    let mut measured = vec![
        MeasuredPoint {
            place: Vec3::ZERO,
            distance: 0.0,
            triangle: 0,
        };
        points.len()
    ];
    for ((&index, &place), nearest) in order.iter().zip(&points).zip(&nearest) {
        measured[index as usize] = MeasuredPoint {
            place,
            distance: nearest.signed_distance,
            triangle: nearest.triangle,
        };
    }
    measured
}

/// Uniform in the unit ball.
fn in_ball(random: &mut Random) -> Vec3 {
    loop {
        let point = Vec3::new(random.within(1.0), random.within(1.0), random.within(1.0));
        if point.length_squared() <= 1.0 {
            return point;
        }
    }
}

/// Cuts points into blocks of `share`, each a fair sample in the order of a space-filling curve:
/// points are dealt along the curve like cards. The few that fill no block are left out at random.
fn blocks(points: Vec<MeasuredPoint>, share: usize, random: &mut Random) -> Blocks {
    let count = points.len().checked_div(share).unwrap_or(0);
    let places: Vec<Vec3> = points.iter().map(|point| point.place).collect();
    let order = space_filling_order(&places);
    let mut blocks = vec![Block::with_capacity(share); count];
    let mut hands: Vec<usize> = (0..count).collect();
    let (mut wanted, mut next) = (count * share, count);
    for (position, &index) in order.iter().enumerate() {
        let left = order.len() - position;
        if random.below(left) >= wanted {
            continue;
        }
        wanted -= 1;
        if next == count {
            random.shuffle(&mut hands);
            next = 0;
        }
        let point = &points[index as usize];
        blocks[hands[next]].push(point.place, point.distance);
        next += 1;
    }
    Blocks { share, blocks }
}

/// Uniform points on the surface.
struct SurfacePoints<'a> {
    shape: &'a NormalisedBody,
    /// Sums of areas up to each triangle.
    areas: Vec<f64>,
}

impl<'a> SurfacePoints<'a> {
    fn new(shape: &'a NormalisedBody) -> Self {
        let mut sum = 0.0;
        let areas = shape.body.model().triangles().iter().map(|triangle| {
            let [a, b, c] = triangle.map(|v| shape.vertices[v as usize].as_dvec3());
            sum += (b - a).cross(c - a).length();
            sum
        });
        Self {
            areas: areas.collect(),
            shape,
        }
    }

    /// Points in the order of the triangles, each uniform within its share of the area: evener
    /// than points drawn one by one.
    fn draw(&self, count: usize, random: &mut Random) -> Vec<Vec3> {
        let share = self.areas.last().copied().unwrap_or(0.0) / count as f64;
        let triangles = self.shape.body.model().triangles();
        let mut index = 0;
        (0..count)
            .map(|number| {
                let area = share * (number as f64 + f64::from(random.unit()));
                while index + 1 < triangles.len() && self.areas[index] <= area {
                    index += 1;
                }
                let [a, b, c] = triangles[index].map(|v| self.shape.vertices[v as usize]);
                let (mut u, mut v) = (random.unit(), random.unit());
                if u + v > 1.0 {
                    (u, v) = (1.0 - u, 1.0 - v);
                }
                a + (b - a) * u + (c - a) * v
            })
            .collect()
    }
}

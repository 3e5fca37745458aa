//! Feet that stand stay where they are, or stop sliding; feet that swing low keep their way.

use glam::DVec3;
use physique_physics::loss::soft_contact;
use physique_physics::soles::SOLE_POINTS;

use super::figure::Pose;

/// A sole point 1 m/s off its velocity, in units of the stiffness, while that is slow.
const VELOCITY: f64 = 3000.0;
/// Differences of velocity far above this cost by their size only: what slides on purpose, a turn
/// on the heel, may go on sliding. In m/s.
const SOFTNESS: f64 = 0.1;
/// Vertical velocity matters less: the ground has its own say.
const LEVEL: DVec3 = DVec3::new(1.0, 0.3, 1.0);
/// A sole point 1 m off its place.
const PLACE: f64 = 100.0;
/// Points lower than this are kept with full weight, in metres,
const LOW: f64 = 0.03;
/// those above the less, over this height.
const FADE: f64 = 0.04;

/// Where sole points should move, from the source.
pub(super) struct Feet {
    frame_s: f64,
    /// `[frames]` places in the source.
    places: Vec<[DVec3; SOLE_POINTS]>,
    /// `[frames - 1]` wanted steps to the next frame, and their weights.
    steps: Vec<[Step; SOLE_POINTS]>,
    /// How surely points stand in the source.
    pub(super) contacts: Vec<[f64; SOLE_POINTS]>,
}

#[derive(Clone, Copy, Debug, Default)]
struct Step {
    velocity: DVec3,
    weight: f64,
}

impl Feet {
    /// Keeps the steps of the source; where its points stand, they should not move, if asked for.
    pub(super) fn of(source: &[Pose], frame_s: f64, mend: bool) -> Self {
        let places: Vec<_> = source.iter().map(|pose| pose.soles).collect();
        let last = places.len().saturating_sub(1);
        let contacts: Vec<[f64; SOLE_POINTS]> = (0..places.len())
            .map(|frame| {
                let (from, to) = (frame.saturating_sub(1), (frame + 1).min(last));
                let seconds = frame_s * (to - from).max(1) as f64;
                std::array::from_fn(|point| {
                    let step = places[to][point] - places[from][point];
                    soft_contact(places[frame][point].y, step.length() / seconds)
                })
            })
            .collect();
        let steps = places.windows(2).zip(contacts.windows(2));
        let steps = steps.map(|(places, contacts)| {
            std::array::from_fn(|point| {
                let [from, to] = [places[0][point], places[1][point]];
                let stands = contacts[0][point].min(contacts[1][point]);
                let own = (to - from) / frame_s;
                let level = DVec3::new(own.x, 0.0, own.z);
                Step {
                    velocity: if mend { own - level * stands } else { own },
                    weight: lowness(from.y.min(to.y)),
                }
            })
        });
        Self {
            steps: steps.collect(),
            places,
            contacts,
            frame_s,
        }
    }

    /// The cost, and the forces on the sole points, which are added.
    pub(super) fn cost(
        &self,
        poses: &[Pose],
        weight: f64,
        forces: &mut [[DVec3; SOLE_POINTS]],
    ) -> f64 {
        let mut cost = 0.0;
        for (frame, steps) in self.steps.iter().enumerate() {
            for (point, step) in steps.iter().enumerate() {
                let moved = poses[frame + 1].soles[point] - poses[frame].soles[point];
                let off = (moved / self.frame_s - step.velocity) * LEVEL;
                let root = (1.0 + off.length_squared() / (SOFTNESS * SOFTNESS)).sqrt();
                let scale = weight * VELOCITY * step.weight;
                cost += scale * SOFTNESS * SOFTNESS * (root - 1.0);
                let force = off * LEVEL * (scale / (root * self.frame_s));
                forces[frame + 1][point] += force;
                forces[frame][point] -= force;
            }
        }
        for (frame, (pose, forces)) in poses.iter().zip(forces).enumerate() {
            for (point, force) in forces.iter_mut().enumerate() {
                let off = pose.soles[point] - self.places[frame][point];
                let scale = self.place_weight(frame, point);
                cost += 0.5 * scale * off.length_squared();
                *force += off * scale;
            }
        }
        cost
    }

    /// Curvature by the place of a point.
    pub(super) fn place_weight(&self, frame: usize, point: usize) -> f64 {
        PLACE * lowness(self.places[frame][point].y)
    }

    /// Curvature by the difference of a point's places in a frame and the next, along each axis.
    pub(super) fn step_weight(&self, frame: usize, point: usize) -> DVec3 {
        let weight = self
            .steps
            .get(frame)
            .map_or(0.0, |steps| steps[point].weight);
        LEVEL * LEVEL * (VELOCITY * weight / (self.frame_s * self.frame_s))
    }
}

fn lowness(height: f64) -> f64 {
    (-((height - LOW).max(0.0) / FADE)).exp()
}

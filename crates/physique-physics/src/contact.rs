//! Which skin bears the body: what is low, and at rest.

use glam::{DMat4, DVec2, Vec3};
use physique_body::Body;

use crate::PhysicsOptions;
use crate::balance::on_ground;
use crate::soles::skinned;
use crate::transforms::Transforms;

/// Motion of the skin just before and just after a frame.
///
/// A foot that lands is at rest from then on, one that leaves was at rest until then: skin bears
/// the body when it hardly moves on either side. Over both sides together, every contact would be
/// found late and lost early by half the time that speeds are taken over.
#[derive(Clone, Debug, Default)]
pub(crate) struct AroundFrame {
    /// Joint transforms just before and just after the frame.
    sides: [Vec<DMat4>; 2],
    /// Rates of the joint transforms; a side without frames is left out.
    rates: Vec<Vec<DMat4>>,
    /// From the one side to the other.
    seconds: f64,
}

impl AroundFrame {
    /// Looks so many frames to either side, or parts of frames: the same time at every frame rate.
    pub(crate) fn set(
        &mut self,
        transforms: &Transforms,
        frame: usize,
        reach: [f64; 2],
        frame_s: f64,
    ) {
        let [before, after] = &mut self.sides;
        transforms.interpolated(frame as f64 - reach[0], before);
        transforms.interpolated(frame as f64 + reach[1], after);
        let now = transforms.frame(frame);
        let steps = [(before.as_slice(), now), (now, after.as_slice())];
        let steps = steps.into_iter().zip(reach);
        let mut used = 0;
        for ((from, to), frames) in steps.filter(|(_, frames)| *frames > 0.0) {
            if self.rates.len() == used {
                self.rates.push(Vec::new());
            }
            let per_second = 1.0 / (frames * frame_s);
            let rate = &mut self.rates[used];
            rate.clear();
            rate.extend(
                from.iter()
                    .zip(to)
                    .map(|(from, to)| (*to - *from) * per_second),
            );
            used += 1;
        }
        self.rates.truncate(used);
        self.seconds = (reach[0] + reach[1]) * frame_s;
    }

    /// Joint transforms just before and just after the frame.
    pub(crate) fn sides(&self) -> [&[DMat4]; 2] {
        let [before, after] = &self.sides;
        [before, after]
    }

    /// Time between them; 0 for a single frame.
    pub(crate) fn seconds(&self) -> f64 {
        self.seconds
    }

    /// Whether a vertex hardly moves; so do those of a single frame.
    fn rests(&self, body: &Body, vertex: usize, speed: f64) -> bool {
        let slow = |rate: &Vec<DMat4>| skinned(body, vertex, rate).length_squared() < speed * speed;
        self.rates.is_empty() || self.rates.iter().any(slow)
    }
}

/// Places on the ground of the skin that bears the body, over `places`.
pub(crate) fn bearing_skin(
    body: &Body,
    vertices: &[Vec3],
    around: &AroundFrame,
    (ground, options): (f64, &PhysicsOptions),
    places: &mut Vec<DVec2>,
) {
    places.clear();
    let highest = (ground + options.contact_height) as f32;
    for (vertex, position) in vertices.iter().enumerate() {
        if position.y < highest && around.rests(body, vertex, options.contact_speed) {
            places.push(on_ground(position.as_dvec3()));
        }
    }
}

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
    /// Rates of the joint transforms; a side without frames is left out.
    rates: Vec<Vec<DMat4>>,
}

impl AroundFrame {
    /// Rates from `frames.0` to `frame` and from there to `frames.1`.
    pub(crate) fn set(
        &mut self,
        transforms: &Transforms,
        frame: usize,
        frames: (usize, usize),
        frame_s: f64,
    ) {
        let sides = [(frames.0, frame), (frame, frames.1)];
        let sides = sides.into_iter().filter(|(from, to)| from < to);
        let mut used = 0;
        for (from, to) in sides {
            if self.rates.len() == used {
                self.rates.push(Vec::new());
            }
            let seconds = (to - from) as f64 * frame_s;
            transforms.rate(from, to, seconds, &mut self.rates[used]);
            used += 1;
        }
        self.rates.truncate(used);
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

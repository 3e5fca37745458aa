//! The centre of mass moves over the feet as it did.
//!
//! The zero moment point of a body whose mass is in one point is `c - h a / g`, with its centre c at
//! height h and its acceleration a. What a repair adds to it must keep within the base of support:
//! where the source is stable, it may move by part of what it has to spare; where it is not, hardly.

use glam::{DVec2, DVec3};
use physique_physics::GRAVITY;
use physique_physics::balance::on_ground;
use physique_physics::soles::SOLE_POINTS;

use super::feet::Feet;
use super::figure::Pose;

/// A zero moment point 1 m farther off than it may be, in units of the stiffness.
const POINT: f64 = 5e4;
/// Part of what the source has to spare that a repair may use up.
const SPARE: f64 = 0.5;
/// Frames whose soles stand less surely than this are not judged.
const LEAST_CONTACT: f64 = 0.5;

/// What the source's balance allows.
pub(super) struct Balance {
    centres: Vec<DVec2>,
    soles: Vec<[DVec2; SOLE_POINTS]>,
    frames: Vec<Frame>,
    /// `h / (g dt^2)`.
    inertia: f64,
}

#[derive(Clone, Copy, Debug)]
struct Frame {
    /// Whether the frame has a term.
    judged: bool,
    /// How far the zero moment point may move, in metres.
    spare: f64,
    /// Share of each sole point in the support.
    shares: [f64; SOLE_POINTS],
}

impl Balance {
    /// `distances` are the signed distances of the source's zero moment point to its base of
    /// support, in metres; `None` where that is not judged.
    pub(super) fn of(
        source: &[Pose],
        frame_s: f64,
        feet: &Feet,
        distances: &[Option<f64>],
    ) -> Self {
        let heights: f64 = source.iter().map(|pose| pose.centre.y).sum();
        let height = heights / source.len().max(1) as f64;
        let frames = feet.contacts.iter().enumerate().map(|(frame, contacts)| {
            let total: f64 = contacts.iter().sum();
            let inside = distances.get(frame).copied().flatten();
            Frame {
                judged: total > LEAST_CONTACT && frame > 0 && frame + 1 < source.len(),
                spare: SPARE * (-inside.unwrap_or(0.0)).max(0.0),
                shares: contacts.map(|contact| contact / total.max(LEAST_CONTACT)),
            }
        });
        Self {
            centres: source.iter().map(|pose| on_ground(pose.centre)).collect(),
            soles: source
                .iter()
                .map(|pose| pose.soles.map(on_ground))
                .collect(),
            frames: frames.collect(),
            inertia: height / (GRAVITY * frame_s * frame_s),
        }
    }

    /// The cost, and the forces on centres of mass and sole points, which are added.
    pub(super) fn cost(
        &self,
        poses: &[Pose],
        weight: f64,
        centres: &mut [DVec3],
        soles: &mut [[DVec3; SOLE_POINTS]],
    ) -> f64 {
        let moved = |frame: usize| on_ground(poses[frame].centre) - self.centres[frame];
        let mut cost = 0.0;
        for (index, frame) in self.frames.iter().enumerate() {
            if !frame.judged {
                continue;
            }
            let bend = moved(index - 1) + moved(index + 1) - moved(index) * 2.0;
            let mut off = moved(index) - bend * self.inertia;
            for (point, share) in frame.shares.iter().enumerate() {
                off -= (on_ground(poses[index].soles[point]) - self.soles[index][point]) * *share;
            }
            let length = off.length();
            let excess = length - frame.spare;
            if excess <= 0.0 {
                continue;
            }
            cost += 0.5 * weight * POINT * excess * excess;
            let force = off * (weight * POINT * excess / length);
            let force = DVec3::new(force.x, 0.0, force.y);
            centres[index] += force * (1.0 + 2.0 * self.inertia);
            centres[index - 1] -= force * self.inertia;
            centres[index + 1] -= force * self.inertia;
            for (point, share) in frame.shares.iter().enumerate() {
                soles[index][point] -= force * *share;
            }
        }
        cost
    }

    /// Curvature by the zero moment point of a frame without anything to spare; `None` where it
    /// is not judged.
    pub(super) fn curvature(&self, frame: usize) -> Option<f64> {
        let judged = self.frames.get(frame).is_some_and(|frame| frame.judged);
        judged.then_some(POINT)
    }

    /// Share of each sole point in the support of a frame.
    pub(super) fn shares(&self, frame: usize) -> &[f64; SOLE_POINTS] {
        &self.frames[frame].shares
    }

    /// Derivatives of a zero moment point by the centres of mass of the frame before, its own
    /// and the one after.
    pub(super) fn taps(&self) -> [f64; 3] {
        [-self.inertia, 1.0 + 2.0 * self.inertia, -self.inertia]
    }
}

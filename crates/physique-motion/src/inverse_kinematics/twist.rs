//! How far a bone turns about itself: what each frame says, and what the clip makes of it.

use glam::{Vec2, Vec3};

/// What a frame says about a twist: a direction in the plane, as long as it is sure.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Twist {
    toward: Vec2,
    weight: f32,
}

impl Twist {
    /// Adds what a pointer says: without twist it would be at `rest`, and is at `now`, both seen
    /// along the unit vector `axis`. Its weight is `trust` for a pointer at right angles to the
    /// axis, and falls with the fourth power of the sine to nothing for one along it: limbs that
    /// are all but straight bend either way.
    pub(super) fn add(&mut self, axis: Vec3, rest: Vec3, now: Vec3, trust: f32) {
        let (Some(rest), Some(now)) = (
            rest.reject_from_normalized(axis).try_normalize(),
            now.try_normalize(),
        ) else {
            return;
        };
        let across = now.reject_from_normalized(axis);
        let weight = trust * across.length_squared().powi(2);
        let direction = Vec2::new(rest.dot(across), axis.cross(rest).dot(across));
        if let Some(direction) = direction.try_normalize() {
            self.toward += weight * direction;
            self.weight += weight;
        }
    }

    /// Adds the word of habit: no twist.
    pub(super) fn add_none(&mut self, trust: f32) {
        self.toward += trust * Vec2::X;
        self.weight += trust;
    }

    /// The angle, in radians.
    pub(super) fn angle(&self) -> f32 {
        if self.toward == Vec2::ZERO {
            0.0
        } else {
            self.toward.to_angle()
        }
    }
}

/// Replaces what each frame says by the x that minimises, over the whole clip,
/// sum w |x - said|^2 + memory^2 sum |x' - x|^2: a tridiagonal system, solved exactly.
///
/// Sure frames keep their word, frames that know nothing follow their neighbours. Angles are
/// directions here, so that no full turn has to be unwrapped.
pub(super) fn steady(twists: &mut [Twist], memory: f32) {
    /// How sure a frame must be to stand against its neighbours.
    const SURE: f32 = 0.01;
    let Some(last) = twists.len().checked_sub(1) else {
        return;
    };
    let pull = SURE * memory * memory;
    // Thomas's algorithm: eliminate forwards, substitute backwards.
    let mut shares = vec![0.0_f32; twists.len()];
    let mut before = Vec2::ZERO;
    for frame in 0..=last {
        let (from_before, to_next) = (
            if frame > 0 { pull } else { 0.0 },
            if frame < last { pull } else { 0.0 },
        );
        let share_before = if frame > 0 { shares[frame - 1] } else { 0.0 };
        let pivot = twists[frame].weight + from_before + to_next - from_before * share_before;
        // The pivot is above 0: every frame has at least the weight of habit.
        shares[frame] = to_next / pivot;
        before = (twists[frame].toward + from_before * before) / pivot;
        twists[frame].toward = before;
    }
    for frame in (0..last).rev() {
        let next = twists[frame + 1].toward;
        twists[frame].toward += shares[frame] * next;
    }
}

#[cfg(test)]
mod tests {
    use glam::{Vec2, Vec3};

    use super::{Twist, steady};

    fn said(angle: f32, weight: f32) -> Twist {
        Twist {
            toward: weight * Vec2::from_angle(angle),
            weight,
        }
    }

    #[test]
    fn a_pointer_tells_its_angle_about_the_axis() {
        let mut twist = Twist::default();
        twist.add(
            Vec3::Y,
            Vec3::new(0.0, 3.0, 2.0),
            Vec3::new(1.0, -2.0, 1.0),
            1.0,
        );
        assert!((twist.angle() - std::f32::consts::FRAC_PI_4).abs() < 1e-6);
        assert!((twist.weight - (2.0_f32 / 6.0).powi(2)).abs() < 1e-6);
        let mut silent = Twist::default();
        silent.add(Vec3::Y, Vec3::Z, Vec3::Y, 1.0);
        silent.add(Vec3::Y, Vec3::Z, Vec3::ZERO, 1.0);
        assert_eq!((silent.angle(), silent.weight), (0.0, 0.0));
    }

    #[test]
    fn the_minimum_has_no_slope() {
        let given: Vec<Twist> = (0..30)
            .map(|frame| {
                said(
                    (frame as f32 * 0.7).sin() * 3.0,
                    if frame % 5 == 0 { 0.8 } else { 1e-3 },
                )
            })
            .collect();
        let mut solved = given.clone();
        let memory = 3.0_f32;
        steady(&mut solved, memory);
        let x = |frame: usize| solved[frame].toward;
        for (frame, given) in given.iter().enumerate() {
            let mut slope = given.weight * x(frame) - given.toward;
            if frame > 0 {
                slope += 0.01 * memory * memory * (x(frame) - x(frame - 1));
            }
            if frame < 29 {
                slope += 0.01 * memory * memory * (x(frame) - x(frame + 1));
            }
            assert!(slope.length() < 1e-6, "{frame}: {slope}");
        }
    }

    #[test]
    fn sure_frames_lead_and_silent_ones_follow_across_the_half_turn() {
        let mut twists = vec![said(0.0, 1e-4); 9];
        twists[0] = said(3.0, 1.0);
        twists[8] = said(-3.0, 1.0);
        steady(&mut twists, 5.0);
        assert!((twists[0].angle() - 3.0).abs() < 0.1 && (twists[8].angle() + 3.0).abs() < 0.1);
        assert!(twists[4].angle().abs() > 3.0, "{}", twists[4].angle());
    }
}

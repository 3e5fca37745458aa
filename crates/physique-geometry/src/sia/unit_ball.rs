use glam::Vec3;

use crate::Error;

/// The map that moves a body's rest pose into the unit ball: the middle of its bounding box to the
/// origin, its farthest vertex from there to distance 1.
///
/// Always made from the rest pose of the same shape, then applied to every pose: lengths in the ball
/// are comparable from frame to frame, but posed limbs may leave it.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct UnitBall {
    /// Middle of the rest pose's bounding box, in metres.
    pub centre: Vec3,
    /// One over the greatest distance of a rest vertex from the centre, in 1/m.
    pub scale: f32,
}

impl UnitBall {
    /// The ball around a rest pose.
    ///
    /// # Errors
    ///
    /// If a position is not finite, or all of them coincide (or there are none): no ball has radius 0.
    pub fn around(rest_positions: &[Vec3]) -> Result<Self, Error> {
        if let Some(vertex) = rest_positions.iter().position(|p| !p.is_finite()) {
            return Err(Error::NotFinite {
                vertex,
                position: rest_positions[vertex],
            });
        }
        let least = rest_positions
            .iter()
            .copied()
            .fold(Vec3::INFINITY, Vec3::min);
        let most = rest_positions
            .iter()
            .copied()
            .fold(Vec3::NEG_INFINITY, Vec3::max);
        let centre = least.midpoint(most);
        let radius = rest_positions
            .iter()
            .map(|p| p.distance(centre))
            .fold(0.0, f32::max);
        let scale = radius.recip();
        if !(scale.is_normal() && centre.is_finite()) {
            return Err(Error::NoExtent { radius });
        }
        Ok(Self { centre, scale })
    }

    /// A point in the ball's coordinates.
    #[must_use]
    pub fn ball_from_world(&self, point: Vec3) -> Vec3 {
        (point - self.centre) * self.scale
    }
}

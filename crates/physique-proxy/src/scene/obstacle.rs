//! Things that stand still, as signed distances.

use glam::DVec3;

/// A thing in the world.
pub trait Obstacle: Sync {
    /// Signed distance from a point to the surface, positive outside, in metres, and its gradient.
    /// Where it has none, any that is finite.
    fn distance(&self, point: DVec3) -> (f64, DVec3);
}

/// All that lies below a plane; by default the ground.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Plane {
    /// Outwards, of unit length.
    pub normal: DVec3,
    /// Distance of the plane from the origin, along the normal.
    pub offset: f64,
}

impl Default for Plane {
    fn default() -> Self {
        Self {
            normal: DVec3::Y,
            offset: 0.0,
        }
    }
}

impl Obstacle for Plane {
    fn distance(&self, point: DVec3) -> (f64, DVec3) {
        (self.normal.dot(point) - self.offset, self.normal)
    }
}

/// All points within a radius of a line from `start` to `end`: a sphere where those are one.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Capsule {
    /// One end of the line.
    pub start: DVec3,
    /// The other.
    pub end: DVec3,
    /// Distance of the surface from the line.
    pub radius: f64,
}

impl Capsule {
    /// A static sphere.
    pub const fn sphere(centre: DVec3, radius: f64) -> Self {
        Self {
            start: centre,
            end: centre,
            radius,
        }
    }
}

impl Obstacle for Capsule {
    fn distance(&self, point: DVec3) -> (f64, DVec3) {
        let axis = self.end - self.start;
        let length_squared = axis.length_squared();
        let along = if length_squared > 0.0 {
            ((point - self.start).dot(axis) / length_squared).clamp(0.0, 1.0)
        } else {
            0.0
        };
        let apart = point - (self.start + axis * along);
        (apart.length() - self.radius, apart.normalize_or_zero())
    }
}

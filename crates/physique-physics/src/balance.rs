//! Zero moment point, capture point, pressure: what decides whether a body falls.

use glam::{DMat4, DVec2, DVec3};

use crate::MassMoments;

/// Standard gravity used throughout, in m/s2.
pub const GRAVITY: f64 = 9.81;
/// Below this part of the body's weight, the ground carries too little to speak of a zero moment
/// point.
pub const LEAST_LOAD: f64 = 0.3;

/// The place on the ground under a point: `(x, z)`.
pub fn on_ground(point: DVec3) -> DVec2 {
    DVec2::new(point.x, point.z)
}

/// The motion of a body as a whole.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Centroid {
    /// Mass in kg.
    pub mass: f64,
    /// Centre of mass, in metres.
    pub centre: DVec3,
    /// Its velocity, in m/s.
    pub velocity: DVec3,
    /// Its acceleration, in m/s2.
    pub acceleration: DVec3,
    /// Angular momentum about the centre of mass, in kg m2/s.
    pub angular_momentum: DVec3,
    /// Rate of the angular momentum, in N m.
    pub angular_momentum_rate: DVec3,
}

impl Centroid {
    /// From the transforms of a moment and their first and second time derivatives.
    pub fn new(moments: &MassMoments, poses: &[DMat4], first: &[DMat4], second: &[DMat4]) -> Self {
        Self {
            mass: moments.mass(),
            centre: moments.mean(poses),
            velocity: moments.mean(first),
            acceleration: moments.mean(second),
            angular_momentum: moments.moment_about_centre(poses, first),
            // p' x p' vanishes: the rate needs accelerations only.
            angular_momentum_rate: moments.moment_about_centre(poses, second),
        }
    }

    /// Vertical force of the ground in body weights: `(g + a_y) / g`. 1 at rest, 0 in free fall.
    pub fn load(&self) -> f64 {
        (GRAVITY + self.acceleration.y) / GRAVITY
    }

    /// Horizontal over vertical force of the ground: the friction that the motion needs.
    pub fn needed_friction(&self) -> f64 {
        on_ground(self.acceleration).length() / (GRAVITY + self.acceleration.y)
    }

    /// Zero moment point: where the ground's force must act for the motion to happen. `None` where
    /// the ground carries less than [`LEAST_LOAD`].
    ///
    /// `z = c - h a / (g + a_y) + (Hdot_z, -Hdot_x) / (M (g + a_y))`, horizontal parts of centre
    /// and acceleration, h the centre's height above `ground` (Vukobratovic; Sardain and
    /// Bessonnet, "Forces acting on a biped robot", 2004; Y up).
    pub fn zero_moment_point(&self, ground: f64) -> Option<DVec2> {
        (self.load() > LEAST_LOAD).then(|| {
            let support = GRAVITY + self.acceleration.y;
            let turn = self.angular_momentum_rate;
            on_ground(self.centre)
                - on_ground(self.acceleration) * (self.centre.y - ground) / support
                + DVec2::new(turn.z, -turn.x) / (self.mass * support)
        })
    }

    /// Extrapolated centre of mass `c + v / sqrt(g / h)`, also capture point: where a foot must be
    /// put to come to rest (Hof et al., "The condition for dynamic stability", 2005). `None` for a
    /// centre below the ground.
    pub fn capture_point(&self, ground: f64) -> Option<DVec2> {
        let height = self.centre.y - ground;
        (height > 0.0)
            .then(|| on_ground(self.centre) + on_ground(self.velocity) * (height / GRAVITY).sqrt())
    }
}

/// Pressure on a point by its height above ground, as IPMAN and HUMOS model it: linear in the depth
/// below, falling exponentially above.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PressureModel {
    /// Growth with depth, per metre.
    pub alpha: f64,
    /// Fall with height, per metre.
    pub gamma: f64,
}

impl PressureModel {
    /// IPMAN's constants.
    pub const IPMAN: Self = Self {
        alpha: 100.0,
        gamma: 10.0,
    };
    /// HUMOS's constants.
    pub const HUMOS: Self = Self {
        alpha: 100.0,
        gamma: 30.0,
    };
    /// Deeper than this, pressure no longer grows.
    const DEEPEST: f64 = -0.3;

    /// Pressure at a height above ground, 1 on it.
    pub fn pressure(&self, height: f64) -> f64 {
        if height < 0.0 {
            1.0 - self.alpha * height.max(Self::DEEPEST)
        } else {
            (-self.gamma * height).exp()
        }
    }

    /// Derivative of [`PressureModel::pressure`] to the height.
    pub fn slope(&self, height: f64) -> f64 {
        if height < Self::DEEPEST {
            0.0
        } else if height < 0.0 {
            -self.alpha
        } else {
            -self.gamma * (-self.gamma * height).exp()
        }
    }

    /// Centre of pressure of `(position, area)`; `None` where no pressure reaches `least`.
    pub fn centre(
        &self,
        points: impl IntoIterator<Item = (DVec3, f64)>,
        ground: f64,
        least: f64,
    ) -> Option<DVec2> {
        /// As published; hardly matters unless everything is in the air.
        const EPSILON: f64 = 1e-6;
        let (mut sum, mut total, mut greatest) = (DVec2::ZERO, 0.0, 0.0_f64);
        for (point, area) in points {
            let pressure = self.pressure(point.y - ground);
            sum += on_ground(point) * (pressure * area);
            total += pressure * area;
            greatest = greatest.max(pressure);
        }
        (greatest >= least).then(|| sum / (total + EPSILON))
    }
}

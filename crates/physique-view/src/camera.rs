//! Cameras: where the picture is taken from.

use std::f32::consts::{FRAC_PI_2, PI};

use glam::Vec3;

use crate::render::ViewTransform;
use crate::{Bounds, ViewError};

/// How depth becomes a picture.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Projection {
    /// Things farther away look smaller.
    Perspective {
        /// The angle from the bottom to the top of the picture, in radians, above 0 and below pi.
        vertical_field_of_view: f32,
    },
    /// Things keep their size: lengths can be compared.
    Orthographic {
        /// Half of the height that the picture shows, in metres.
        half_height: f32,
    },
}

/// A camera that looks from a point at a point. World frame: metres, Y up.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Camera {
    /// Where it stands.
    pub eye: Vec3,
    /// What it looks at: the middle of the picture.
    pub target: Vec3,
    /// The direction that is upwards in the picture; any length, not along the line of sight.
    pub up: Vec3,
    /// Perspective or orthographic.
    pub projection: Projection,
    /// Nearer things, in metres before the eye, are cut away (perspective only).
    pub near: f32,
}

impl Camera {
    /// A camera that shows all of a box from the direction of a [`View`], whatever the picture's shape.
    ///
    /// `aspect` is width over height; `margin` is the share of the picture left free on each
    /// side (0.05 is a good start; clamped to 0 to 0.45).
    ///
    /// ```
    /// use glam::Vec3;
    /// use physique_view::{Bounds, Camera, View};
    /// let body = Bounds { min: Vec3::new(-0.5, 0.0, -0.2), max: Vec3::new(0.5, 1.8, 0.2) };
    /// let camera = Camera::framing(&body, &View::FRONT, 0.75, 0.05);
    /// assert!(camera.eye.z > 2.0, "the camera stands before the body");
    /// ```
    #[must_use]
    pub fn framing(bounds: &Bounds, view: &View, aspect: f32, margin: f32) -> Self {
        Self::framing_points(bounds.corners(), view, aspect, margin)
    }

    /// The nearest camera in the direction of a [`View`] that shows all of some points, with
    /// equal margins left and right and equal margins above and below. See [`Camera::framing`].
    #[must_use]
    pub fn framing_points(
        points: impl IntoIterator<Item = Vec3>,
        view: &View,
        aspect: f32,
        margin: f32,
    ) -> Self {
        let axes = [view.up().cross(view.towards_eye()), view.up()];
        let towards_eye = view.towards_eye();
        let half_tangent = view.field_of_view.map(|angle| (angle * 0.5).tan());
        // The picture's half sizes at one metre of distance, or relative to its half height.
        let fill = (1.0 - 2.0 * margin.clamp(0.0, 0.45)) * half_tangent.unwrap_or(1.0);
        let half = [fill * aspect, fill];
        // A point p is inside on an axis u if |p.u - shift| <= half (distance - p.towards_eye): two
        // bounds on shift and half * distance, of which only the greatest over all points counts.
        let mut reach = [[f32::NEG_INFINITY; 2]; 2];
        let mut nearest = f32::NEG_INFINITY;
        for point in points {
            let forward = point.dot(towards_eye);
            nearest = nearest.max(forward);
            let lean = if half_tangent.is_some() { forward } else { 0.0 };
            for axis in 0..2 {
                let offset = point.dot(axes[axis]);
                reach[axis][0] = reach[axis][0].max(offset + half[axis] * lean);
                reach[axis][1] = reach[axis][1].max(-offset + half[axis] * lean);
            }
        }
        let distances: [f32; 2] =
            std::array::from_fn(|axis| (reach[axis][0] + reach[axis][1]) / (2.0 * half[axis]));
        let shifts: [f32; 2] = std::array::from_fn(|axis| (reach[axis][0] - reach[axis][1]) * 0.5);
        let distance = distances[0].max(distances[1]);
        let across = axes[0] * shifts[0] + axes[1] * shifts[1];
        let (depth, projection) = match view.field_of_view {
            Some(vertical_field_of_view) => (
                distance.max(nearest + 0.05),
                Projection::Perspective {
                    vertical_field_of_view,
                },
            ),
            None => (
                nearest + 1.0,
                Projection::Orthographic {
                    half_height: distance.max(0.01),
                },
            ),
        };
        let eye = across + towards_eye * depth;
        Self {
            eye,
            target: eye - towards_eye,
            up: view.up(),
            projection,
            near: 0.02,
        }
    }

    /// The same camera moved by some metres.
    #[must_use]
    pub fn moved_by(&self, offset: Vec3) -> Self {
        Self {
            eye: self.eye + offset,
            target: self.target + offset,
            ..*self
        }
    }

    /// Where a point lies in a picture of `width` x `height` pixels, in pixels from the top left
    /// corner; `None` if it is behind the camera or the camera cannot see.
    #[must_use]
    pub fn project(&self, point: Vec3, width: u32, height: u32) -> Option<[f32; 2]> {
        self.check().ok()?;
        let (x, y, _) = ViewTransform::new(self, width, height).to_pixel(point)?;
        Some([x, y])
    }

    pub(crate) fn check(&self) -> Result<(), ViewError> {
        let sight = self.target - self.eye;
        let bad = |reason| Err(ViewError::BadCamera { reason });
        if !(self.eye.is_finite() && self.target.is_finite() && self.up.is_finite()) {
            return bad("eye, target and up must be finite");
        }
        if sight.try_normalize().is_none() {
            return bad("eye and target must differ");
        }
        if sight
            .normalize_or_zero()
            .cross(self.up.normalize_or_zero())
            .length()
            < 1e-4
        {
            return bad("up must not lie along the line of sight");
        }
        match self.projection {
            Projection::Perspective {
                vertical_field_of_view: angle,
            } if !(angle > 1e-3 && angle < 3.1) => {
                bad("the vertical field of view must be between 0.001 and 3.1 radians")
            }
            Projection::Orthographic { half_height }
                if !(half_height > 1e-6 && half_height.is_finite()) =>
            {
                bad("half of the height shown must be positive and finite")
            }
            Projection::Perspective { .. } if !(self.near > 1e-6 && self.near.is_finite()) => {
                bad("the near distance must be positive and finite")
            }
            _ => Ok(()),
        }
    }
}

/// A direction to look from, with a name: a row of a contact sheet.
#[derive(Clone, Debug, PartialEq)]
pub struct View {
    /// Shown beside the row.
    pub name: &'static str,
    /// The camera's direction around the vertical, in radians: 0 stands on +Z (before the body),
    /// a quarter turn on +X (at its left).
    pub azimuth: f32,
    /// The camera's angle above the horizon, in radians: a quarter turn looks straight down.
    pub elevation: f32,
    /// The vertical field of view in radians; `None` is orthographic.
    pub field_of_view: Option<f32>,
}

impl View {
    /// From before the body, slightly above.
    pub const FRONT: Self = Self {
        name: "Front",
        azimuth: 0.0,
        elevation: 0.14,
        field_of_view: Some(0.42),
    };
    /// From the body's right: walking goes from left to right in the picture.
    pub const SIDE: Self = Self {
        name: "Right side",
        azimuth: -FRAC_PI_2,
        elevation: 0.14,
        field_of_view: Some(0.42),
    };
    /// From before, the body's left, and above.
    pub const THREE_QUARTER: Self = Self {
        name: "Three-quarter",
        azimuth: 0.72,
        elevation: 0.42,
        field_of_view: Some(0.42),
    };
    /// From straight above, orthographic; +Z is upwards in the picture.
    pub const TOP: Self = Self {
        name: "Top",
        azimuth: PI,
        elevation: FRAC_PI_2,
        field_of_view: None,
    };
    /// From behind the body.
    pub const BACK: Self = Self {
        name: "Back",
        azimuth: PI,
        elevation: 0.14,
        field_of_view: Some(0.42),
    };

    /// The same view of a body that faces another way: `facing` is its direction around the
    /// vertical in radians, 0 for +Z, a quarter turn for +X.
    #[must_use]
    pub fn around(&self, facing: f32) -> Self {
        Self {
            azimuth: self.azimuth + facing,
            ..self.clone()
        }
    }

    pub(crate) fn towards_eye(&self) -> Vec3 {
        let (sin, cos) = self.elevation.sin_cos();
        Vec3::new(self.azimuth.sin() * cos, sin, self.azimuth.cos() * cos)
    }

    pub(crate) fn up(&self) -> Vec3 {
        let (sin, cos) = self.elevation.sin_cos();
        Vec3::new(-self.azimuth.sin() * sin, cos, -self.azimuth.cos() * sin)
    }
}

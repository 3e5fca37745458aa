//! From the world to the picture and back.

use glam::{DVec3, Vec3};

use crate::camera::{Camera, Projection};

/// A camera bound to a picture's size.
///
/// A point has clip coordinates `(x, y, depth, w)`; divided by `w`, `x` and `y` are pixels from
/// the picture's top left corner and `depth` is *nearness*: larger is nearer, and it is linear
/// over the picture (1 / distance in perspective, minus the distance in orthographic views).
#[derive(Clone, Copy, Debug)]
pub(crate) struct ViewTransform {
    eye: DVec3,
    right: DVec3,
    up: DVec3,
    forward: DVec3,
    /// Pixels for one unit of tangent (perspective) or one metre (orthographic).
    scale: f64,
    centre: (f64, f64),
    /// The near distance in perspective, `None` in orthographic views.
    near: Option<f64>,
}

/// A point in clip coordinates.
#[derive(Clone, Copy, Debug)]
pub(super) struct ClipPoint {
    pub(super) x: f64,
    pub(super) y: f64,
    pub(super) depth: f64,
    pub(super) w: f64,
}

impl ClipPoint {
    pub(super) fn lerp(self, other: Self, t: f64) -> Self {
        let mix = |a: f64, b: f64| a + (b - a) * t;
        Self {
            x: mix(self.x, other.x),
            y: mix(self.y, other.y),
            depth: mix(self.depth, other.depth),
            w: mix(self.w, other.w),
        }
    }
}

/// A line of sight; `direction` is not of unit length.
#[derive(Clone, Copy, Debug)]
pub(super) struct Ray {
    pub(super) origin: Vec3,
    pub(super) direction: Vec3,
}

impl ViewTransform {
    /// The camera must have passed its check.
    pub(crate) fn new(camera: &Camera, width: u32, height: u32) -> Self {
        let forward = (camera.target - camera.eye)
            .as_dvec3()
            .normalize_or(DVec3::NEG_Z);
        let right = forward.cross(camera.up.as_dvec3()).normalize_or(DVec3::X);
        let half = f64::from(height) * 0.5;
        let (scale, near) = match camera.projection {
            Projection::Perspective {
                vertical_field_of_view,
            } => (
                half / (f64::from(vertical_field_of_view) * 0.5).tan(),
                Some(f64::from(camera.near)),
            ),
            Projection::Orthographic { half_height } => (half / f64::from(half_height), None),
        };
        Self {
            eye: camera.eye.as_dvec3(),
            right,
            up: right.cross(forward),
            forward,
            scale,
            centre: (f64::from(width) * 0.5, half),
            near,
        }
    }

    pub(super) fn near(&self) -> Option<f64> {
        self.near
    }

    pub(super) fn to_clip(self, point: Vec3) -> ClipPoint {
        let offset = point.as_dvec3() - self.eye;
        let distance = offset.dot(self.forward);
        let (depth, w) = if self.near.is_some() {
            (1.0, distance)
        } else {
            (-distance, 1.0)
        };
        ClipPoint {
            x: offset.dot(self.right) * self.scale + self.centre.0 * w,
            y: -offset.dot(self.up) * self.scale + self.centre.1 * w,
            depth,
            w,
        }
    }

    /// Where a point lies in the picture, in pixels, and its nearness; `None` behind the near plane.
    pub(crate) fn to_pixel(self, point: Vec3) -> Option<(f32, f32, f32)> {
        let clip = self.to_clip(point);
        (clip.w >= self.near.unwrap_or(0.0)).then(|| {
            (
                (clip.x / clip.w) as f32,
                (clip.y / clip.w) as f32,
                (clip.depth / clip.w) as f32,
            )
        })
    }

    /// The line of sight through a point of the picture, in pixels.
    pub(super) fn ray(&self, x: f64, y: f64) -> Ray {
        let across = self.right * ((x - self.centre.0) / self.scale)
            - self.up * ((y - self.centre.1) / self.scale);
        let (origin, direction) = if self.near.is_some() {
            (self.eye, self.forward + across)
        } else {
            (self.eye + across, self.forward)
        };
        Ray {
            origin: origin.as_vec3(),
            direction: direction.as_vec3(),
        }
    }

    /// How many metres across the line of sight one pixel takes, `distance` along a ray.
    pub(super) fn metres_per_pixel(&self, distance: f32) -> f32 {
        // Rays advance one metre into the depth for each unit of distance.
        let depth = if self.near.is_some() {
            f64::from(distance)
        } else {
            1.0
        };
        (depth / self.scale) as f32
    }

    /// The distance into the depth, in metres, of a nearness.
    pub(super) fn depth(&self, nearness: f32) -> f32 {
        if self.near.is_some() {
            1.0 / nearness
        } else {
            -nearness
        }
    }
}

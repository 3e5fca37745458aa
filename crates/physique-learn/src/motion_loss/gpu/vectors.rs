//! Vectors and matrices of three dimensions in kernels.

use cubecl::prelude::*;

/// The least square of a length that has a direction.
const LEAST: f32 = f32::MIN_POSITIVE;

/// Three numbers.
#[derive(CubeType, Clone, Copy)]
#[expand(derive(Clone, Copy))]
pub(super) struct Vec3 {
    pub(super) x: f32,
    pub(super) y: f32,
    pub(super) z: f32,
}

/// Three rows.
#[derive(CubeType, Clone, Copy)]
#[expand(derive(Clone, Copy))]
pub(super) struct Mat3 {
    pub(super) x: Vec3,
    pub(super) y: Vec3,
    pub(super) z: Vec3,
}

/// The direction of a vector; zero where it has none.
#[derive(CubeType, Clone, Copy)]
#[expand(derive(Clone, Copy))]
pub(super) struct Unit {
    pub(super) direction: Vec3,
    /// 0 where there is no direction.
    pub(super) inverse_length: f32,
}

/// Whether it is a number and finite: by its bits, which no compiler takes for granted.
#[cube]
pub(super) fn is_finite(number: f32) -> bool {
    (u32::reinterpret(number) & 0x7F80_0000u32) != 0x7F80_0000u32
}

#[cube]
impl Vec3 {
    pub(super) fn new(x: f32, y: f32, z: f32) -> Vec3 {
        Vec3 { x, y, z }
    }

    pub(super) fn add(self, other: Vec3) -> Vec3 {
        Vec3::new(self.x + other.x, self.y + other.y, self.z + other.z)
    }

    pub(super) fn subtract(self, other: Vec3) -> Vec3 {
        Vec3::new(self.x - other.x, self.y - other.y, self.z - other.z)
    }

    pub(super) fn scale(self, factor: f32) -> Vec3 {
        Vec3::new(self.x * factor, self.y * factor, self.z * factor)
    }

    pub(super) fn dot(self, other: Vec3) -> f32 {
        self.x * other.x + self.y * other.y + self.z * other.z
    }

    pub(super) fn cross(self, other: Vec3) -> Vec3 {
        Vec3::new(
            self.y * other.z - self.z * other.y,
            self.z * other.x - self.x * other.z,
            self.x * other.y - self.y * other.x,
        )
    }

    /// `self other^T`.
    pub(super) fn outer(self, other: Vec3) -> Mat3 {
        Mat3 {
            x: other.scale(self.x),
            y: other.scale(self.y),
            z: other.scale(self.z),
        }
    }

    /// Its direction.
    pub(super) fn unit(self) -> Unit {
        let square = self.dot(self);
        let inverse = 1.0f32 / f32::sqrt(f32::max(square, LEAST));
        let inverse_length = select(square > LEAST, inverse, 0.0f32);
        Unit {
            direction: self.scale(inverse_length),
            inverse_length,
        }
    }
}

#[cube]
impl Unit {
    /// The gradient by the vector from the one by its direction.
    pub(super) fn gradient(self, by_direction: Vec3) -> Vec3 {
        let along = self.direction.dot(by_direction);
        let across = by_direction.subtract(self.direction.scale(along));
        across.scale(self.inverse_length)
    }
}

#[cube]
impl Mat3 {
    pub(super) fn identity() -> Mat3 {
        let (zero, one) = (0.0f32, 1.0f32);
        Mat3 {
            x: Vec3::new(one, zero, zero),
            y: Vec3::new(zero, one, zero),
            z: Vec3::new(zero, zero, one),
        }
    }

    pub(super) fn transpose(self) -> Mat3 {
        Mat3 {
            x: Vec3::new(self.x.x, self.y.x, self.z.x),
            y: Vec3::new(self.x.y, self.y.y, self.z.y),
            z: Vec3::new(self.x.z, self.y.z, self.z.z),
        }
    }

    pub(super) fn add(self, other: Mat3) -> Mat3 {
        Mat3 {
            x: self.x.add(other.x),
            y: self.y.add(other.y),
            z: self.z.add(other.z),
        }
    }

    /// `self v`.
    pub(super) fn turn(self, v: Vec3) -> Vec3 {
        Vec3::new(self.x.dot(v), self.y.dot(v), self.z.dot(v))
    }

    /// `self other`.
    pub(super) fn product(self, other: Mat3) -> Mat3 {
        let columns = other.transpose();
        Mat3 {
            x: columns.turn(self.x),
            y: columns.turn(self.y),
            z: columns.turn(self.z),
        }
    }
}

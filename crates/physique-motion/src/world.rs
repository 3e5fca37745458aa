//! The axes of a file's world, and turning it to ours and back in double precision.

use glam::{DQuat, DVec3};

use crate::UpAxis;

/// How a file's world stands.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum World {
    /// Y up, as ours.
    YUp,
    /// Z up, as AMASS's.
    ZUp,
    /// A camera's: Y down, Z away from it.
    Camera,
}

impl From<UpAxis> for World {
    fn from(up: UpAxis) -> Self {
        match up {
            UpAxis::Y => Self::YUp,
            UpAxis::Z => Self::ZUp,
        }
    }
}

impl World {
    /// Rotation that takes vectors of the file's world to our Y-up world.
    pub(crate) fn ours_from_file(self) -> DQuat {
        use std::f64::consts::FRAC_1_SQRT_2;
        match self {
            Self::YUp => DQuat::IDENTITY,
            // A quarter turn about X that takes Z to Y, and so Y to -Z.
            Self::ZUp => DQuat::from_xyzw(-FRAC_1_SQRT_2, 0.0, 0.0, FRAC_1_SQRT_2),
            // Half a turn about X.
            Self::Camera => DQuat::from_xyzw(1.0, 0.0, 0.0, 0.0),
        }
    }

    /// A vector of the file's world in ours: a swap of axes, so exact.
    pub(crate) fn to_ours(self, vector: DVec3) -> DVec3 {
        match self {
            Self::YUp => vector,
            Self::ZUp => DVec3::new(vector.x, vector.z, -vector.y),
            Self::Camera => DVec3::new(vector.x, -vector.y, -vector.z),
        }
    }

    /// A vector of our world in the file's.
    pub(crate) fn to_file(self, vector: DVec3) -> DVec3 {
        match self {
            Self::YUp => vector,
            Self::ZUp => DVec3::new(vector.x, -vector.z, vector.y),
            Self::Camera => DVec3::new(vector.x, -vector.y, -vector.z),
        }
    }

    /// The world in which a body with these root rotations stands most upright, and how clearly:
    /// the mean height of the vector from its pelvis to its head, 1 for a body that never leans.
    pub(crate) fn most_upright(roots: impl Iterator<Item = DQuat>) -> (Self, f64) {
        let (sum, count) = roots.fold((DVec3::ZERO, 0.0), |(sum, count), root| {
            (sum + root * DVec3::Y, count + 1.0)
        });
        let mean = sum / f64::max(count, 1.0);
        let candidates = [
            (Self::YUp, mean.y),
            (Self::ZUp, mean.z),
            (Self::Camera, -mean.y),
        ];
        candidates
            .into_iter()
            .fold((Self::YUp, f64::MIN), |best, next| {
                if next.1 > best.1 { next } else { best }
            })
    }

    /// In words, for notes.
    pub(crate) const fn words(self) -> &'static str {
        match self {
            Self::YUp => "Y up",
            Self::ZUp => "Z up",
            Self::Camera => "a camera's (Y down)",
        }
    }
}

#[cfg(test)]
mod tests {
    use super::{DQuat, DVec3, World};

    const WORLDS: [World; 3] = [World::YUp, World::ZUp, World::Camera];

    #[test]
    fn rotation_and_swap_agree_and_invert() {
        let vector = DVec3::new(1.0, 2.0, 3.0);
        for world in WORLDS {
            let ours = world.to_ours(vector);
            assert!((world.ours_from_file() * vector - ours).length() < 1e-15);
            assert_eq!(world.to_file(ours), vector);
        }
        assert_eq!(World::ZUp.to_ours(DVec3::Z), DVec3::Y);
        assert_eq!(World::Camera.to_ours(DVec3::NEG_Y), DVec3::Y);
    }

    #[test]
    fn a_standing_body_tells_its_world() {
        for world in WORLDS {
            let lean = DQuat::from_rotation_z(0.3);
            let roots = [world.ours_from_file().inverse() * lean; 4];
            let (found, height) = World::most_upright(roots.into_iter());
            assert_eq!(found, world);
            assert!((height - 0.3_f64.cos()).abs() < 1e-12);
        }
    }
}

//! A motion of the body: 22 rotations and a root translation a frame.

use glam::{Quat, Vec3};
use physique_body::{Joint, Pose};

use crate::{Error, FrameRate};

/// Which body's shape space some betas belong to; betas of one family say nothing to another.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
#[non_exhaustive]
pub enum ShapeSpace {
    /// Physique's embedded open body.
    Open,
    /// SMPL and SMPL-H, which share their shape space.
    Smpl,
    /// SMPL-X.
    SmplX,
}

/// The shape that a motion was recorded or made for, as far as its file says.
#[derive(Clone, Debug, PartialEq)]
pub struct MotionShape {
    /// Shape space of the betas.
    pub space: ShapeSpace,
    /// Gender of the model, as the file spells it ("male", "female", "neutral").
    pub gender: Option<String>,
    /// Shape coefficients.
    pub betas: Vec<f32>,
}

/// A motion on the body's 22 joints.
///
/// `rotations` holds `[frames][22]` local rotations (`parent_from_joint`, relative to the rest
/// pose) in [`Joint`]'s order. `root_translation` holds one vector a frame that is added after
/// posing about the pelvis of the rest body, as SMPL's and AMASS's `trans`: the pelvis stands at
/// `rest_pelvis + root_translation` in the world. World axes are Y up; units metres and radians.
#[derive(Clone, Debug, PartialEq)]
pub struct Motion {
    frame_rate: FrameRate,
    shape: Option<MotionShape>,
    root_translation: Vec<Vec3>,
    rotations: Vec<Quat>,
}

impl Motion {
    /// A motion from its arrays. Rotations whose length is off by more than rounding are
    /// normalised; others keep every bit, so that files come back as they were written.
    ///
    /// # Errors
    /// [`Error::RotationCount`] when `rotations` is not `[frames][22]`; [`Error::NotFinite`] with
    /// frame and joint for NaN, infinity or a rotation of no length.
    pub fn new(
        frame_rate: FrameRate,
        shape: Option<MotionShape>,
        root_translation: Vec<Vec3>,
        mut rotations: Vec<Quat>,
    ) -> Result<Self, Error> {
        let frames = root_translation.len();
        let expected = frames.saturating_mul(Joint::COUNT);
        if rotations.len() != expected {
            return Err(Error::RotationCount {
                frames,
                joints: Joint::COUNT,
                expected,
                found: rotations.len(),
            });
        }
        let not_finite = |frame, joint: Joint, what| Error::NotFinite {
            frame,
            joint: joint.name().into(),
            what,
        };
        for (frame, translation) in root_translation.iter().enumerate() {
            if !translation.is_finite() {
                return Err(not_finite(frame, Joint::Pelvis, "the root translation"));
            }
        }
        for (index, rotation) in rotations.iter_mut().enumerate() {
            let length = rotation.length();
            if !(length.is_finite() && length > 1e-6) {
                let joint = Joint::ALL[index % Joint::COUNT];
                return Err(not_finite(index / Joint::COUNT, joint, "the rotation"));
            }
            if (length - 1.0).abs() > 1e-6 {
                *rotation /= length;
            }
        }
        Ok(Self {
            frame_rate,
            shape,
            root_translation,
            rotations,
        })
    }

    /// Frames a second.
    pub const fn frame_rate(&self) -> FrameRate {
        self.frame_rate
    }

    /// The shape the motion was recorded for, if its file says.
    pub const fn shape(&self) -> Option<&MotionShape> {
        self.shape.as_ref()
    }

    /// Number of frames.
    pub const fn frame_count(&self) -> usize {
        self.root_translation.len()
    }

    /// From the first frame to the end of the last, in seconds.
    pub fn seconds(&self) -> f64 {
        self.frame_count() as f64 * self.frame_rate.frame_seconds()
    }

    /// `[frames]` root translations, in metres.
    pub fn root_translation(&self) -> &[Vec3] {
        &self.root_translation
    }

    /// `[frames][22]` local rotations, flat.
    pub fn rotations(&self) -> &[Quat] {
        &self.rotations
    }

    /// The 22 local rotations of one frame.
    ///
    /// # Panics
    /// When there is no such frame.
    pub fn frame_rotations(&self, frame: usize) -> &[Quat] {
        &self.rotations[frame * Joint::COUNT..(frame + 1) * Joint::COUNT]
    }

    /// Pose of one frame, to hand to [`physique_body::Body::pose`].
    ///
    /// # Panics
    /// When there is no such frame.
    pub fn pose(&self, frame: usize) -> Pose<'_> {
        Pose {
            root_translation: self.root_translation[frame],
            rotations: self.frame_rotations(frame),
        }
    }
}

//! An animation of any skeleton.

use glam::{Quat, Vec3};

use crate::{Error, FrameRate, Skeleton, SkeletonPose};

/// The axis that points up in a file.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub enum UpAxis {
    /// +Y, as BVH, glTF and this crate.
    #[default]
    Y,
    /// +Z, as AMASS, Blender and MuJoCo.
    Z,
}

impl UpAxis {
    /// Rotation from the file's world to this crate's, which has Y up. Z up turns -90 degrees
    /// about X: the file's Y becomes -Z.
    pub fn y_up_from_file(self) -> Quat {
        match self {
            Self::Y => Quat::IDENTITY,
            Self::Z => Quat::from_rotation_x(-std::f32::consts::FRAC_PI_2),
        }
    }
}

/// How a reader brought a file to metres and Y up, and what it had to guess.
#[derive(Clone, Debug, PartialEq)]
pub struct Conversion {
    /// Metres in one unit of the file.
    pub metres_per_unit: f64,
    /// The file's up axis.
    pub up_axis: UpAxis,
    /// What was inferred and from what, a sentence each.
    pub notes: Vec<String>,
}

impl Default for Conversion {
    /// A file in metres with Y up, as glTF.
    fn default() -> Self {
        Self {
            metres_per_unit: 1.0,
            up_axis: UpAxis::Y,
            notes: Vec::new(),
        }
    }
}

/// An animation of a [`Skeleton`]: local rotations of all joints in all frames, and local
/// translations of the joints that move within their parent. Metres, radians, Y up.
#[derive(Clone, Debug, PartialEq)]
pub struct SkeletonClip {
    skeleton: Skeleton,
    frame_rate: FrameRate,
    conversion: Conversion,
    rotations: Vec<Quat>,
    translations: Vec<Vec3>,
    translated_joints: Vec<usize>,
    /// By joint: its place in `translated_joints`.
    translation_slot: Vec<Option<usize>>,
}

impl SkeletonClip {
    /// A clip from its arrays.
    ///
    /// * `rotations`: `[frames][joints]`, `parent_from_joint` (not relative to the rest
    ///   rotation); normalised here.
    /// * `translated_joints`: the joints that the file moves; their translations replace the
    ///   rest translation.
    /// * `translations`: `[frames][translated_joints]`, origins in the parent's frame, in metres.
    ///
    /// # Errors
    /// [`Error::ClipArrays`] when the arrays disagree in length or name a joint twice or beyond
    /// the skeleton; [`Error::NotFinite`] with frame and joint.
    pub fn new(
        skeleton: Skeleton,
        frame_rate: FrameRate,
        conversion: Conversion,
        mut rotations: Vec<Quat>,
        translated_joints: Vec<usize>,
        translations: Vec<Vec3>,
    ) -> Result<Self, Error> {
        let joints = skeleton.joint_count();
        let frames = rotations.len().checked_div(joints).unwrap_or(0);
        let moved = translated_joints.len();
        if rotations.len() != frames * joints || translations.len() != frames * moved {
            return Err(Error::ClipArrays {
                joints,
                rotations: rotations.len(),
                moved,
                translations: translations.len(),
            });
        }
        let mut translation_slot = vec![None; joints];
        for (slot, &joint) in translated_joints.iter().enumerate() {
            match translation_slot.get_mut(joint) {
                Some(free @ None) => *free = Some(slot),
                _ => {
                    return Err(Error::ClipArrays {
                        joints,
                        rotations: rotations.len(),
                        moved,
                        translations: translations.len(),
                    });
                }
            }
        }
        let not_finite = |frame, joint: usize, what| Error::NotFinite {
            frame,
            joint: skeleton.joints()[joint].name.clone(),
            what,
        };
        for (index, rotation) in rotations.iter_mut().enumerate() {
            let length = rotation.length();
            if !(length.is_finite() && length > 1e-6) {
                return Err(not_finite(index / joints, index % joints, "the rotation"));
            }
            *rotation /= length;
        }
        for (index, translation) in translations.iter().enumerate() {
            if !translation.is_finite() {
                let joint = translated_joints[index % moved];
                return Err(not_finite(index / moved, joint, "the translation"));
            }
        }
        Ok(Self {
            skeleton,
            frame_rate,
            conversion,
            rotations,
            translations,
            translated_joints,
            translation_slot,
        })
    }

    /// The clip with its roots turned so that Y points up, and `conversion` to tell of it.
    pub(crate) fn turned_upright(mut self, conversion: Conversion) -> Result<Self, Error> {
        if conversion.up_axis != UpAxis::Y {
            let turn = conversion.up_axis.y_up_from_file();
            let mut joints = self.skeleton.joints().to_vec();
            let is_root: Vec<bool> = joints.iter().map(|joint| joint.parent.is_none()).collect();
            for joint in joints.iter_mut().filter(|joint| joint.parent.is_none()) {
                joint.rest_rotation = (turn * joint.rest_rotation).normalize();
                joint.rest_translation = turn * joint.rest_translation;
            }
            self.skeleton = Skeleton::new(joints)?;
            for frame in self.rotations.chunks_exact_mut(is_root.len().max(1)) {
                for (rotation, _) in frame.iter_mut().zip(&is_root).filter(|(_, root)| **root) {
                    *rotation = (turn * *rotation).normalize();
                }
            }
            for frame in self
                .translations
                .chunks_exact_mut(self.translated_joints.len().max(1))
            {
                for (translation, &joint) in frame.iter_mut().zip(&self.translated_joints) {
                    if is_root[joint] {
                        *translation = turn * *translation;
                    }
                }
            }
        }
        self.conversion = conversion;
        Ok(self)
    }

    /// The skeleton.
    pub const fn skeleton(&self) -> &Skeleton {
        &self.skeleton
    }

    /// Frames a second.
    pub const fn frame_rate(&self) -> FrameRate {
        self.frame_rate
    }

    /// How the file was brought to metres and Y up.
    pub const fn conversion(&self) -> &Conversion {
        &self.conversion
    }

    /// Number of frames.
    pub fn frame_count(&self) -> usize {
        let joints = self.skeleton.joint_count();
        self.rotations.len().checked_div(joints).unwrap_or(0)
    }

    /// From the first frame to the end of the last, in seconds.
    pub fn seconds(&self) -> f64 {
        self.frame_count() as f64 * self.frame_rate.frame_seconds()
    }

    /// Joints whose translation the clip animates.
    pub fn translated_joints(&self) -> &[usize] {
        &self.translated_joints
    }

    /// Whether the clip animates the joint's translation.
    ///
    /// # Panics
    /// When there is no such joint.
    pub fn moves(&self, joint: usize) -> bool {
        self.translation_slot[joint].is_some()
    }

    /// `parent_from_joint` rotation in a frame.
    ///
    /// # Panics
    /// When there is no such frame or joint.
    pub fn rotation(&self, frame: usize, joint: usize) -> Quat {
        self.rotations[frame * self.skeleton.joint_count() + joint]
    }

    /// Origin of a joint in its parent's frame, in metres: animated, or the rest translation.
    ///
    /// # Panics
    /// When there is no such frame or joint.
    pub fn translation(&self, frame: usize, joint: usize) -> Vec3 {
        match self.translation_slot[joint] {
            Some(slot) => self.translations[frame * self.translated_joints.len() + slot],
            None => self.skeleton.joints()[joint].rest_translation,
        }
    }

    /// World pose of a frame, into `pose`, whose memory is reused. O(joints).
    ///
    /// # Panics
    /// When there is no such frame.
    pub fn pose_into(&self, frame: usize, pose: &mut SkeletonPose) {
        pose.set(&self.skeleton, |joint| {
            (self.rotation(frame, joint), self.translation(frame, joint))
        });
    }

    /// World pose of a frame.
    ///
    /// # Panics
    /// When there is no such frame.
    pub fn pose(&self, frame: usize) -> SkeletonPose {
        let mut pose = SkeletonPose::default();
        self.pose_into(frame, &mut pose);
        pose
    }
}

/// At most `most` of `frames` frames, evenly spread.
pub(crate) fn spread(frames: usize, most: usize) -> impl Iterator<Item = usize> {
    let step = frames.div_ceil(most.max(1)).max(1);
    (0..frames).step_by(step)
}

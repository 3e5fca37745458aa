//! A motion known only by where its joints are.

use glam::Vec3;

use super::FeatureSkeleton;
use crate::{Error, FrameRate};

/// Joint positions over time: `[frames][joints]`, Y up.
///
/// HumanML3D's are in metres, KIT's in its own unit of about 1/600 m and mirrored; see
/// [`FeatureSkeleton`]. Nothing is known of the turn of a bone about itself: this is not yet a
/// [`crate::Motion`].
#[derive(Clone, Debug, PartialEq)]
pub struct JointPositions {
    frame_rate: FrameRate,
    skeleton: FeatureSkeleton,
    positions: Vec<Vec3>,
}

impl JointPositions {
    /// Positions in the order `[frames][joints]`.
    ///
    /// # Errors
    /// [`Error::PositionCount`] unless `positions` are whole frames; [`Error::NotFinite`] with
    /// frame and joint; [`Error::NoFrames`].
    pub fn new(
        frame_rate: FrameRate,
        skeleton: FeatureSkeleton,
        positions: Vec<Vec3>,
    ) -> Result<Self, Error> {
        let joints = skeleton.joint_count();
        if !positions.len().is_multiple_of(joints) {
            return Err(Error::PositionCount {
                joints,
                found: positions.len(),
            });
        }
        if positions.is_empty() {
            return Err(Error::NoFrames);
        }
        if let Some(index) = positions.iter().position(|position| !position.is_finite()) {
            return Err(Error::NotFinite {
                frame: index / joints,
                joint: skeleton
                    .joint_name(index % joints)
                    .unwrap_or_default()
                    .into(),
                what: "the position",
            });
        }
        Ok(Self {
            frame_rate,
            skeleton,
            positions,
        })
    }

    /// The same rate and skeleton with other positions of as many joints a frame.
    pub(crate) fn with_positions(&self, positions: Vec<Vec3>) -> Result<Self, Error> {
        Self::new(self.frame_rate, self.skeleton, positions)
    }

    /// Frames a second.
    pub const fn frame_rate(&self) -> FrameRate {
        self.frame_rate
    }

    /// Which joints these are.
    pub const fn skeleton(&self) -> FeatureSkeleton {
        self.skeleton
    }

    /// Number of frames, at least 1.
    pub fn frame_count(&self) -> usize {
        self.positions.len() / self.skeleton.joint_count()
    }

    /// `[frames][joints]` positions, flat.
    pub fn positions(&self) -> &[Vec3] {
        &self.positions
    }

    /// The joints of each frame in turn.
    pub fn frames(&self) -> std::slice::ChunksExact<'_, Vec3> {
        self.positions.chunks_exact(self.skeleton.joint_count())
    }

    pub(super) fn frames_mut(&mut self) -> std::slice::ChunksExactMut<'_, Vec3> {
        self.positions.chunks_exact_mut(self.skeleton.joint_count())
    }

    /// The joints of one frame.
    ///
    /// # Panics
    /// When there is no such frame.
    pub fn frame(&self, frame: usize) -> &[Vec3] {
        let joints = self.skeleton.joint_count();
        &self.positions[frame * joints..(frame + 1) * joints]
    }
}

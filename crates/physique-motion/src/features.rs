//! Motions known only by their joints, and the features that networks learn from: HumanML3D's 263
//! numbers a frame and KIT-ML's 251.
//!
//! [`JointPositions`] becomes [`MotionFeatures`] by [`extract`], and comes back by
//! [`recover_from_positions`] or [`recover_from_rotations`]. The published data were made by a
//! pipeline with peculiarities (hips that count backwards in the heading, half angles, a first
//! frame that is taken to face +Z). Networks have learnt them, so they are kept, each named where
//! it happens. [`FeatureStatistics`] normalises, [`RotationLayer`] gives the 22 rotations of the
//! SMPL body in the way of the self-intersection paper, with gradients.
//!
//! All arithmetic on features is 32-bit, as in the reference; the rotation layer computes in
//! 64 bits inside.
//!
//! Sources: Guo et al., "Generating Diverse and Natural 3D Human Motions from Text", CVPR 2022
//! (HumanML3D); Plappert et al., "The KIT Motion-Language Dataset", 2016.

mod bone_rotations;
mod contact;
mod extract;
mod gradient;
mod heading;
mod kit;
mod layout;
mod low_pass;
mod matrix;
mod mirror;
mod npy;
mod posed;
mod positions;
mod quaternion;
mod recover;
mod rest_directions;
mod rotation6d;
mod rotation_layer;
mod skeleton;
mod smoothing;
mod statistics;
mod uniform;

pub use bone_rotations::{BoneRotations, Heading};
pub use extract::{extract, extract_window};
pub use gradient::{GradientRule, recover_from_positions_gradient};
pub use kit::{KIT_SOURCES, kit_from_smpl, smpl_from_kit, smpl_from_kit_gradient};
pub use layout::FeatureLayout;
pub use matrix::MotionFeatures;
pub use npy::{JointFile, parse, read, write_features, write_positions};
pub use positions::JointPositions;
pub use quaternion::{between, matrix, multiply, rotate};
pub use recover::{recover_from_positions, recover_from_rotations};
pub use rest_directions::{BETAS_HUMANML3D, BETAS_KIT};
pub use rotation_layer::RotationLayer;
pub use rotation6d::Rotation6d;
pub use skeleton::FeatureSkeleton;
pub use statistics::{FeatureStatistics, StatisticsGatherer};
pub use uniform::{canonicalise, canonicalise_window};

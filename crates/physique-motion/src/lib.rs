//! A human motion over time: types, file formats, and any humanoid skeleton mapped to the body.
//!
//! Inside, lengths are metres, angles radians, axes right-handed with **Y up**; readers convert
//! at the door and writers convert back.

pub mod acclaim;
pub mod amass;
pub mod arrays;
mod body_clip;
pub mod bvh;
pub mod clip;
mod content;
pub mod csv;
pub mod deep_mimic;
pub mod embedded;
pub mod error;
pub mod features;
mod fields;
pub mod frame_rate;
pub mod glb;
pub mod inverse_kinematics;
pub mod limits;
pub mod mapping;
pub mod motion;
pub mod native;
pub mod position_clip;
pub mod read;
mod read_file;
pub mod recording;
mod resample;
pub mod skeleton;
mod smpl_motion;
mod unspoken;
mod world;
mod write_file;

pub use clip::{Conversion, SkeletonClip, UpAxis};
pub use error::Error;
pub use frame_rate::FrameRate;
pub use limits::Limits;
pub use motion::{Motion, MotionShape, ShapeSpace};
/// NumPy's archives; they live in their own crate, which bodies share.
pub use physique_files::npz;
pub use position_clip::PositionClip;
pub use read::{
    NamedMotion, ReadOptions, SourceMotion, parse_motion, parse_motions, read_each, read_motion,
    read_motions,
};
pub use recording::Recording;
pub use skeleton::{Skeleton, SkeletonJoint, SkeletonPose};

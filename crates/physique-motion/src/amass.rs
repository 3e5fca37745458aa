//! AMASS `.npz` files, the exchange format of the SMPL family, read and written.
//!
//! | form | rotations | frame rate |
//! |---|---|---|
//! | SMPL-H | `poses` `[frames][156]` | `mocap_framerate` |
//! | SMPL-X | `root_orient` `[frames][3]` and `pose_body` `[frames][63]`, or `poses` `[frames][165]` | `mocap_frame_rate` |
//! | bodies alone | `poses` `[frames][66]` or `[frames][72]` | either |
//!
//! Rotations are axis-angle vectors in radians, local to the parent joint; the first 22 joints are
//! the same in every form, and those behind them (hands, jaw, eyes) are left out with a note.
//! Lengths are metres. The world is **Z up**, while the body's rest pose is Y up.
//!
//! # Turning the world
//!
//! A vertex `x` of the rest body stands at `trans + J + R (x - J)` when only the root turns: `R` is
//! the root's rotation and `J` the rest pelvis, about which it turns. Turning the world by `C`
//! gives `C trans + C J + C R (x - J)`, so that in the new world
//!
//! ```text
//! R' = C R          trans' = C (trans + J) - J
//! ```
//!
//! The second is not `C trans`: for SMPL, whose rest pelvis lies 0.23 m below the origin, that
//! mistake moves a body by 0.26 m upwards and 0.20 m backwards. `J` depends on the body's shape,
//! which AMASS leaves to the model's file; [`ReadOptions::rest_pelvis`](crate::ReadOptions) gives
//! it, else [`SMPL_REST_PELVIS`] or [`SMPLX_REST_PELVIS`] stands in for it. A stand-in that is
//! wrong by `d` misplaces the whole motion by the constant `C d - d`, at most 1.5 times as long.
//!
//! AMASS: <https://amass.is.tue.mpg.de>, Mahmood et al., ICCV 2019.

mod reader;
mod writer;

pub use reader::{from_archive, read};
pub(crate) use reader::{from_fields, holds};
pub use writer::{AmassFile, to_npz, write};

use glam::Vec3;

/// Rest pelvis of SMPL's and SMPL-H's mean bodies, rounded to the centimetre that separates them.
pub const SMPL_REST_PELVIS: Vec3 = Vec3::new(0.0, -0.23, 0.03);

/// Rest pelvis of SMPL-X's mean bodies, rounded to the centimetre.
pub const SMPLX_REST_PELVIS: Vec3 = Vec3::new(0.0, -0.35, 0.01);

//! How much a body passes through itself, where and when.
//!
//! The measure is the volume that the closed skin covers twice ([`ColumnScanner`](physique_geometry::ColumnScanner), exact along
//! lines), told apart by pair of body parts. It is taken in the pelvis's frame: moving or turning
//! the whole body changes nothing, to the bit.
//!
//! Two kinds are kept apart, because they mean different things:
//! * **Intersections**: a part of the body inside another one, such as a forearm in the chest.
//! * **Creases**: where the skin of neighbouring parts folds over itself, such as behind a bent
//!   knee. Linear blend skinning makes them in every deep bend; real flesh gives way there.

mod crease;
mod frame;
mod summary;

pub use crease::is_crease;
pub use frame::{FrameIntersections, PairVolume};
pub(crate) use frame::{FrameMeter, Surface};
pub use summary::{PairSummary, SelfIntersection};

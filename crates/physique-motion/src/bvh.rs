//! Biovision Hierarchy (`.bvh`): a skeleton and Euler angles a frame, as text.
//!
//! The format names neither its unit, its up axis, nor whether position channels replace a
//! joint's offset or add to it; files disagree on all three. [`read`] infers them from the
//! skeleton and says what it chose in [`crate::Conversion::notes`]; [`BvhOptions`] overrides.
//!
//! | question | rule |
//! |---|---|
//! | unit | The longest way through the skeleton from tip to tip (a foot to the other hand) is about 2.3 m on an adult. Of metre, inch, centimetre, millimetre and Acclaim's 5.644 cm, the unit that comes nearest by ratio. |
//! | up axis | Y, unless the head stands above the feet along Z in four of five frames. |
//! | position channels | Joints below the root vote: values near the offset replace it, values near zero add to it. If only the root has some: whatever brings the lowest joint nearer to height zero. |
//! | frame rate | `1 / Frame Time`, rounded to a customary rate where the digits allow. |
//!
//! Accepted beyond the usual: any hierarchy and channel order, any number of channels a joint,
//! several roots, names with spaces, `#` and `//` comments, tabs, CRLF, keywords in any case.

mod channel;
mod frames;
mod hierarchy;
mod infer;
mod read;
mod text;
mod write;

pub use crate::unspoken::LengthUnit;
pub use infer::PositionChannels;
pub use read::{BvhOptions, parse, read};
pub use write::{BvhWriteOptions, format_clip, write_clip, write_motion};

//! See the crate's description; its rooms follow.

//! Face crate.

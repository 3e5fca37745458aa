//! glTF in: round trips, and every rule of the standard against matrices or by hand.

#![allow(clippy::unwrap_used, reason = "a test that cannot go on says where")]

mod figures;
mod file;
mod keys;
mod mistakes;
mod round_trip;

//! ASF/AMC: what the two files say together.

#![allow(clippy::unwrap_used, reason = "a test that cannot go on says where")]

mod arm;
mod by_hand;
mod finding;
mod human;
mod mistakes;
mod recorded;
mod reference;

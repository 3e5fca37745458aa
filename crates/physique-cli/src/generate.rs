//! `physique generate`: motions from words.

pub(crate) mod motion;

//! The evaluation of generated motions, on made-up data.

#[cfg(feature = "embedded")]
mod generator;
mod judge;
mod protocol;
mod sentence;
mod support;
mod words;

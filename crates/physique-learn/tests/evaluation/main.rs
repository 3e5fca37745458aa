//! The evaluation of generated motions, on made-up data.

mod judge;
mod protocol;
mod sentence;
mod support;
mod words;

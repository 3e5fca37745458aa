//! Losses of predicted motions.

mod feet;
mod operation;

//! Checkpoints that PyTorch wrote, in every layout that published ones have
//! (`tools/checkpoints/build.py` makes them, with made-up numbers), and our own.

mod own;
mod planners;
mod published;
mod support;

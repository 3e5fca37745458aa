//! What pictures show, checked through the public face.

mod cameras;
mod coverage;
mod depth;
mod files;
mod hostile;
mod sheets;
mod support;
mod symmetry;
mod threads;
mod words;

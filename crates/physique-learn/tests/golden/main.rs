//! Against vectors that the published formulations gave in PyTorch and NumPy, on made-up numbers
//! (`fixtures/*.npz`; no recorded motion, no published weights).

mod diffusion;
mod evaluation;
mod made_up;
mod mdm;

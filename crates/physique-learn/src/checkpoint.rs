//! Files of networks: PyTorch's, read as data, and our own.

mod safetensors_file;
mod torch;

pub use safetensors_file::{Precision, parse_safetensors, read_safetensors, write_safetensors};
pub use torch::TorchCheckpoint;

/// What a file of parameters may ask for.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct CheckpointLimits {
    /// Bytes of the file, and of all its arrays together.
    pub bytes: u64,
    /// Arrays in the file.
    pub arrays: usize,
}

impl Default for CheckpointLimits {
    /// 4 GiB, 100,000 arrays.
    fn default() -> Self {
        Self {
            bytes: 1 << 32,
            arrays: 100_000,
        }
    }
}

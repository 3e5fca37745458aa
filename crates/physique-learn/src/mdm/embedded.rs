//! The network inside the program.

use std::path::Path;

use burn::tensor::Device;

use super::MdmFolder;
use crate::Error;
use crate::checkpoint::CheckpointLimits;

/// What is embedded, by name.
macro_rules! files {
    ($($name:literal),+) => {
        [$(($name, include_bytes!(concat!("../../assets/mdm-small/", $name)).as_slice())),+]
    };
}

const FILES: [(&str, &[u8]); 5] = files!(
    "config.json",
    "model.safetensors",
    "mean.npy",
    "std.npy",
    "captions.safetensors"
);

impl MdmFolder {
    /// A small network of the open data: what it was trained on and what it may be used for stands
    /// in its card, `assets/mdm-small/CARD.md`, and in its description's notes.
    ///
    /// # Errors
    /// None that a test has not ruled out; the type is [`Self::read`]'s.
    pub fn embedded(device: &Device) -> Result<Self, Error> {
        let file = |name: &str| {
            let found = FILES.iter().find(|(of, _)| *of == name);
            Ok(found.map(|(_, bytes)| bytes.to_vec()))
        };
        let limits = CheckpointLimits::default();
        Self::parse(Path::new("embedded network"), file, &limits, device)
    }
}

//! The networks inside the program.

use std::path::Path;

use burn::tensor::Device;

use super::MdmFolder;
use crate::Error;
use crate::checkpoint::CheckpointLimits;

/// A network inside the program: a small MDM of open data. What it was trained on, how, and what it may
/// be used for stands in its card, `assets/NAME/CARD.md`, and in its description's notes.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub enum EmbeddedNetwork {
    /// `mdm-small`, of three archives: knows most, **not for commercial use** (CC BY-NC 4.0).
    #[default]
    Small,
    /// `mdm-small-free`, of the two archives that may be used for anything (CC BY 4.0): knows less.
    SmallFree,
}

/// What is embedded of a folder, by name.
macro_rules! folder {
    ($folder:literal) => {
        folder!($folder, "config.json", "model.safetensors", "mean.npy", "std.npy", "captions.safetensors")
    };
    ($folder:literal, $($name:literal),+) => {
        [$((
            $name,
            include_bytes!(concat!("../../assets/", $folder, "/", $name)).as_slice(),
        )),+]
    };
}

const SMALL: [(&str, &[u8]); 5] = folder!("mdm-small");
const SMALL_FREE: [(&str, &[u8]); 5] = folder!("mdm-small-free");

impl EmbeddedNetwork {
    /// All there are.
    pub const ALL: [Self; 2] = [Self::Small, Self::SmallFree];

    /// Its name, on the command line and of its folder.
    pub const fn name(self) -> &'static str {
        match self {
            Self::Small => "mdm-small",
            Self::SmallFree => "mdm-small-free",
        }
    }

    /// That of a name.
    pub fn named(name: &str) -> Option<Self> {
        Self::ALL.into_iter().find(|network| network.name() == name)
    }

    const fn files(self) -> &'static [(&'static str, &'static [u8])] {
        match self {
            Self::Small => &SMALL,
            Self::SmallFree => &SMALL_FREE,
        }
    }
}

impl MdmFolder {
    /// A network that is inside the program. Cost: 10 MB are read, 0.1 s.
    ///
    /// # Errors
    /// None that a test has not ruled out; the type is [`Self::read`]'s.
    pub fn embedded(network: EmbeddedNetwork, device: &Device) -> Result<Self, Error> {
        let file = |name: &str| {
            let found = network.files().iter().find(|(of, _)| *of == name);
            Ok(found.map(|(_, bytes)| bytes.to_vec()))
        };
        let limits = CheckpointLimits::default();
        Self::parse(Path::new(network.name()), file, &limits, device)
    }
}

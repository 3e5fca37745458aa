//! Real motions that come with the library, ready for demonstrations, examples and tests.
//!
//! Six clips that DeepMimic's authors prepared from motion capture, taken from PyPI `pybullet`
//! 3.2.7 (zlib licence) and mapped to the open body: some 250 kB, see `assets/CARD.md`.
//!
//! ```
//! use physique_motion::embedded;
//!
//! let dance = embedded::clips()[0].load()?;
//! assert_eq!(dance.name, "dance");
//! assert!(dance.motion.seconds() > 2.0);
//! # Ok::<(), physique_motion::Error>(())
//! ```

use crate::{Error, ReadOptions, Recording, native, read};

/// A motion whose bytes are part of the library.
#[derive(Clone, Copy, Debug)]
pub struct EmbeddedClip {
    /// Short name, unique among the clips.
    pub name: &'static str,
    /// What moves, in a few words.
    pub summary: &'static str,
    bytes: &'static [u8],
}

impl EmbeddedClip {
    /// Reads the clip; under a millisecond.
    ///
    /// # Errors
    /// None in practice: the tests read every clip. The type keeps a corrupted build honest.
    pub fn load(&self) -> Result<Recording, Error> {
        let options = ReadOptions::default();
        let mut archive = read::open_archive(self.bytes.to_vec(), self.name.as_ref(), &options)?;
        native::from_archive(&mut archive, self.name, &options)
    }
}

macro_rules! clip {
    ($name:literal, $summary:literal) => {
        EmbeddedClip {
            name: $name,
            summary: $summary,
            bytes: include_bytes!(concat!("../assets/", $name, ".motion.npz")),
        }
    };
}

static CLIPS: [EmbeddedClip; 6] = [
    clip!(
        "dance",
        "a modern dance: swings, leaps, arms wrapped around the trunk"
    ),
    clip!(
        "get_up",
        "from lying on the back over a backward roll to standing"
    ),
    clip!("jump", "a standing jump forward"),
    clip!("spin_kick", "a kick in a turning leap"),
    clip!("walk", "one cycle of walking"),
    clip!("run", "one cycle of running"),
];

/// All clips, the best for a first look first.
pub fn clips() -> &'static [EmbeddedClip] {
    &CLIPS
}

/// The clip of this name.
pub fn clip(name: &str) -> Option<&'static EmbeddedClip> {
    CLIPS.iter().find(|clip| clip.name == name)
}

//! `physique convert`.

use std::path::Path;

use anyhow::{Result, bail};
use physique::body::{Body, Joint};
use physique::load::{Loaded, load};
use physique::motion::{Recording, amass, bvh, glb, native};

use crate::arguments::ConvertArguments;
use crate::exit::Exit;
use crate::view::load_options;

pub(crate) fn run(arguments: &ConvertArguments) -> Result<Exit> {
    let body = arguments.body.body()?;
    let format = Format::of(&arguments.output)?;
    let loaded = load(&arguments.input, &body, &load_options(&arguments.read)?)?;
    for note in &loaded.notes {
        eprintln!("note: {note}");
    }
    if let Some(report) = &loaded.mapping {
        eprintln!("{report}");
    }
    write(&loaded, &body, format, arguments)?;
    println!("{}", arguments.output.display());
    Ok(Exit::Done)
}

/// Formats that can be written.
#[derive(Clone, Copy, Debug)]
enum Format {
    Bvh,
    Amass,
    Glb,
    Native,
}

impl Format {
    /// By the ending; `.motion.npz` is our own, other `.npz` are AMASS.
    fn of(path: &Path) -> Result<Self> {
        let name = path.to_string_lossy().to_ascii_lowercase();
        let endings = [
            (".motion.npz", Self::Native),
            (".npz", Self::Amass),
            (".bvh", Self::Bvh),
            (".glb", Self::Glb),
        ];
        match endings.into_iter().find(|(ending, _)| name.ends_with(ending)) {
            Some((_, format)) => Ok(format),
            None => bail!(
                "{}: expected an ending of .bvh, .glb, .npz (AMASS) or .motion.npz",
                path.display()
            ),
        }
    }
}

//! `physique convert`.

use std::path::Path;

use anyhow::{Result, bail};
use physique::body::{Body, Joint};
use physique::load::{Loaded, load};
use physique::motion::glb::SkinnedMesh;
use physique::motion::{Recording, SkeletonClip, amass, bvh, glb, native};

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
    for note in write(loaded, &body, format, arguments)? {
        eprintln!("note: {note}");
    }
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
        match endings
            .into_iter()
            .find(|(ending, _)| name.ends_with(ending))
        {
            Some((_, format)) => Ok(format),
            None => bail!(
                "{}: expected an ending of .bvh, .glb, .npz (AMASS) or .motion.npz",
                path.display()
            ),
        }
    }
}

/// Writes the motion and returns what the format could not carry.
fn write(
    loaded: Loaded,
    body: &Body,
    format: Format,
    arguments: &ConvertArguments,
) -> Result<Vec<String>> {
    let path = &arguments.output;
    let motion = &loaded.motion;
    let rest_pelvis = body.rest_joint(Joint::Pelvis);
    match format {
        Format::Bvh => {
            let clip = SkeletonClip::from_motion(motion, &body.into())?;
            bvh::write_clip(path, &clip, &bvh::BvhWriteOptions::default())?;
        }
        Format::Amass => return Ok(amass::write(path, motion, Some(rest_pelvis))?),
        Format::Glb => glb::write(path, &SkinnedMesh::of(body), motion)?,
        Format::Native => {
            let source = arguments.input.file_name();
            let recording = Recording {
                name: arguments
                    .input
                    .file_stem()
                    .map_or_else(String::new, |stem| stem.to_string_lossy().into_owned()),
                motion: loaded.motion,
                rest_pelvis,
                source: source.map(|name| name.to_string_lossy().into_owned()),
                licence: None,
                notes: loaded.notes,
            };
            native::write(path, &recording)?;
        }
    }
    Ok(Vec::new())
}

//! `physique view`.

use anyhow::{Context, Result};
use physique::load::{LoadOptions, load};
use physique::motion::mapping::{MappingOptions, NameTable};
use physique::motion::{FrameRate, ReadOptions};
use physique::{ScoreOptions, Scorer};
use physique_view::MotionSheet;

use crate::arguments::{ReadArguments, ViewArguments};
use crate::exit::Exit;

pub(crate) fn run(arguments: &ViewArguments) -> Result<Exit> {
    let scorer = Scorer::new(arguments.body.body()?, ScoreOptions::default())?;
    let loaded = load(
        &arguments.file,
        scorer.body(),
        &load_options(&arguments.read)?,
    )?;
    for note in &loaded.notes {
        eprintln!("note: {note}");
    }
    let title = arguments.file.file_name().map_or_else(
        || arguments.file.display().to_string(),
        |name| name.to_string_lossy().into_owned(),
    );
    let intersections = scorer.self_intersections(&loaded.motion, |_| ())?;
    let sheet = MotionSheet {
        title: &title,
        motion: &loaded.motion,
        body: scorer.body(),
        intersections: &intersections,
        moments: usize::from(arguments.moments),
    };
    sheet.render()?.write_png(&arguments.png)?;
    println!("{}", arguments.png.display());
    Ok(Exit::Done)
}

/// How files are read, from the flags.
pub(crate) fn load_options(arguments: &ReadArguments) -> Result<LoadOptions> {
    let frame_rate = arguments.frame_rate.map(FrameRate::new).transpose()?;
    let table = match &arguments.mapping {
        Some(path) => {
            let text = std::fs::read_to_string(path)
                .with_context(|| format!("mapping file {}", path.display()))?;
            Some(NameTable::parse(&text, path)?)
        }
        None => None,
    };
    Ok(LoadOptions {
        read: ReadOptions {
            frame_rate,
            ..ReadOptions::default()
        },
        mapping: MappingOptions {
            table,
            ..MappingOptions::default()
        },
        ..LoadOptions::default()
    })
}

//! `physique view`.

use anyhow::{Context, Result};
use physique::load::{LoadOptions, RotationsFrom, load};
use physique::motion::features::FeatureStatistics;
use physique::motion::mapping::{MappingOptions, NameTable};
use physique::motion::{FrameRate, Limits, ReadOptions, UpAxis};
use physique::{ScoreOptions, Scorer};
use physique_view::MotionSheet;

use crate::arguments::{ReadArguments, RotationsName, UpAxisName, ViewArguments};
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
    let limits = Limits::default();
    let statistics = match (&arguments.mean, &arguments.std) {
        (Some(mean), Some(std)) => Some(FeatureStatistics::read(mean, std, &limits)?),
        _ => None,
    };
    Ok(LoadOptions {
        read: ReadOptions {
            limits,
            frame_rate,
            skeleton: arguments.skeleton.clone(),
            up_axis: arguments.up_axis.map(|name| match name {
                UpAxisName::Y => UpAxis::Y,
                UpAxisName::Z => UpAxis::Z,
            }),
            statistics,
            ..ReadOptions::default()
        },
        rotations: match arguments.rotations {
            RotationsName::InverseKinematics => RotationsFrom::InverseKinematics,
            RotationsName::PaperLayer => RotationsFrom::PaperLayer,
        },
        mapping: MappingOptions {
            table,
            ..MappingOptions::default()
        },
        ..LoadOptions::default()
    })
}

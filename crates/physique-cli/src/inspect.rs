//! `physique inspect`.

pub(crate) mod arguments;
mod full;
mod joint_table;
mod overview;

use std::io::Write;

use anyhow::Result;
use physique::inspect::{InspectReport, Inspector, MotionInspection};
use physique_files::write_file;
use rayon::prelude::*;

use crate::exit::Exit;
use crate::files::motion_files;
use crate::progress::Progress;
use crate::view::load_options;
use arguments::InspectArguments;

pub(crate) fn run(arguments: &InspectArguments) -> Result<Exit> {
    if arguments.schema {
        let schema = schemars::schema_for!(InspectReport);
        println!("{}", serde_json::to_string_pretty(&schema)?);
        return Ok(Exit::Done);
    }
    let body = arguments.body.body()?;
    let inspector = Inspector::new(&body, load_options(&arguments.read)?)?;
    let files = motion_files(&arguments.files)?;
    let progress = Progress::new(files.len());
    let files = files.par_iter().map(|file| {
        let found = inspector.file(file);
        progress.frames(found.motions.iter().map(|motion| motion.frames).sum());
        progress.motion();
        found
    });
    let report = InspectReport::new(files.collect());
    progress.finish();
    let motions = report.files.iter().map(|file| file.motions.len().max(1));
    let text = if arguments.json {
        serde_json::to_string_pretty(&report)? + "\n"
    } else if arguments.warnings {
        overview::warnings(&report)
    } else if arguments.full || motions.sum::<usize>() == 1 {
        let files: Vec<String> = report.files.iter().map(full::file).collect();
        files.join("\n")
    } else {
        overview::table(&report)
    };
    match &arguments.output {
        Some(path) => write_file(path, text.as_bytes())?,
        None => std::io::stdout().write_all(text.as_bytes())?,
    }
    Ok(exit(&report))
}

/// Warnings are no failures; what cannot be read is.
fn exit(report: &InspectReport) -> Exit {
    let unreadable = |motion: &MotionInspection| motion.source.is_none();
    let failed = report
        .files
        .iter()
        .any(|file| file.unreadable.is_some() || file.motions.iter().any(unreadable));
    if failed { Exit::Failed } else { Exit::Done }
}

//! `physique score`.

use std::io::Write;
use std::path::Path;

use anyhow::{Context, Result};
use physique::load::{self, LoadOptions};
use physique::report::{MotionReport, measure_names, measures};
use physique::{Report, ScoreOptions, Scorer};
use rayon::prelude::*;

use crate::arguments::ScoreArguments;
use crate::exit::Exit;
use crate::files::motion_files;
use crate::progress::Progress;
use crate::table::table;
use crate::view::load_options;
use physique_files::write_file;

pub(crate) fn run(arguments: &ScoreArguments) -> Result<Exit> {
    if arguments.schema {
        let schema = schemars::schema_for!(Report);
        println!("{}", serde_json::to_string_pretty(&schema)?);
        return Ok(Exit::Done);
    }
    let body = arguments.body.body()?;
    let options = ScoreOptions {
        protocol: arguments.protocol.into(),
        spacing_m: arguments.spacing,
    };
    let scorer = Scorer::new(body, options)?;
    let files = motion_files(&arguments.files)?;
    let load_options = load_options(&arguments.read)?;

    let progress = Progress::new(files.len());
    let motions: Vec<MotionReport> = files
        .par_iter()
        .flat_map_iter(|file| {
            let reports = score_file(&scorer, file, &load_options, |frames| {
                progress.frames(frames)
            });
            progress.motion();
            reports
        })
        .collect();
    progress.finish();

    let report = Report::new(options.protocol, scorer.body(), motions);
    let text = if arguments.json {
        serde_json::to_string_pretty(&report)? + "\n"
    } else if arguments.csv {
        csv(&report)?
    } else {
        table(&report, arguments.worst)
    };
    match &arguments.output {
        Some(path) => write_file(path, text.as_bytes())?,
        None => std::io::stdout().write_all(text.as_bytes())?,
    }
    Ok(judge(&report, arguments))
}

/// Scores all motions of a file; what goes wrong becomes a motion's `unscorable`.
fn score_file(
    scorer: &Scorer,
    file: &Path,
    options: &LoadOptions,
    progress: impl Fn(usize) + Sync,
) -> Vec<MotionReport> {
    let motions = match load::load_each(file, scorer.body(), options) {
        Ok(motions) => motions,
        Err(problem) => return vec![not_scored(file.display().to_string(), &problem)],
    };
    let reports = motions.into_iter().map(|(name, loaded)| {
        let name = file.with_file_name(name).display().to_string();
        let outcome = loaded.and_then(|loaded| {
            let score = scorer.score_with_progress(&loaded.motion, &progress)?;
            Ok((loaded, score))
        });
        match outcome {
            Ok((loaded, score)) => MotionReport {
                file: name,
                score: Some(score),
                unscorable: None,
                mapping: loaded.mapping_summary(),
                notes: loaded.notes,
            },
            Err(problem) => not_scored(name, &problem),
        }
    });
    reports.collect()
}

fn not_scored(file: String, problem: &physique::Error) -> MotionReport {
    MotionReport {
        file,
        score: None,
        unscorable: Some(problem.to_string()),
        mapping: None,
        notes: Vec::new(),
    }
}

fn judge(report: &Report, arguments: &ScoreArguments) -> Exit {
    let mut exit = Exit::Done;
    for motion in &report.motions {
        match (&motion.score, &arguments.fail_on) {
            (None, _) => {
                let reason = motion.unscorable.as_deref().unwrap_or_default();
                eprintln!("physique: not scored: {}: {reason}", motion.file);
                return Exit::Failed;
            }
            (Some(score), Some(condition)) => match condition.holds(score) {
                Some(true) => exit = Exit::ConditionMet,
                Some(false) => {}
                None => {
                    eprintln!("physique: --fail-on names a measure of another protocol");
                    return Exit::Failed;
                }
            },
            (Some(_), None) => {}
        }
    }
    exit
}

fn csv(report: &Report) -> Result<String> {
    let names = measure_names(report.protocol);
    let mut writer = csv::Writer::from_writer(Vec::new());
    let header = ["file"].into_iter().chain(names.iter().copied());
    writer.write_record(header.chain(["unscorable"]))?;
    for motion in &report.motions {
        let measured = motion.score.as_ref().map(measures).unwrap_or_default();
        let value = |name: &&str| {
            let found = measured.iter().find(|(measure, _)| measure == name);
            found.map_or(String::new(), |(_, value)| value.to_string())
        };
        let record = std::iter::once(motion.file.clone())
            .chain(names.iter().map(value))
            .chain([motion.unscorable.clone().unwrap_or_default()]);
        writer.write_record(record)?;
    }
    let bytes = writer.into_inner().context("writing CSV")?;
    Ok(String::from_utf8(bytes)?)
}

//! `physique score`.

pub(crate) mod arguments;
mod columns;
mod format;
mod merge;
mod protocols;

use std::io::Write;
use std::path::Path;

use anyhow::{Result, bail};
use physique::load::{LoadOptions, load_each};
use physique::report::{MotionReport, ReportHead};
use physique::{Report, Scorer};
use physique_files::write_file;
use serde::Serialize;

use crate::batch::{Job, JobIdentity};
use crate::exclude::{Excluded, without};
use crate::exit::Exit;
use crate::files::motion_files;
use crate::journal::Journal;
use crate::view::load_options;
use arguments::ScoreArguments;
use format::Format;

pub(crate) fn run(arguments: &ScoreArguments) -> Result<Exit> {
    if arguments.schema {
        let schema = schemars::schema_for!(Report);
        println!("{}", serde_json::to_string_pretty(&schema)?);
        return Ok(Exit::Done);
    }
    if arguments.protocols {
        print!("{}", protocols::listed());
        return Ok(Exit::Done);
    }
    let (report, job, journal) = match arguments.batch.merge {
        true => (merge::merge(&arguments.files)?, None, None),
        false => {
            let (report, job, journal) = score(arguments)?;
            (report, Some(job), journal)
        }
    };
    write(&report, job.as_ref(), arguments)?;
    if let Some(journal) = journal {
        journal.finish()?;
    }
    Ok(judge(&report, arguments))
}

/// What a run is: another one may continue it only if all of this is the same.
#[derive(Serialize)]
struct RunIdentity<'a> {
    head: &'a ReportHead,
    spacing_m: f32,
    series: bool,
    read: String,
    mapping: Option<String>,
    job: &'a JobIdentity,
}

fn score(
    arguments: &ScoreArguments,
) -> Result<(Report, JobIdentity, Option<Journal<MotionReport>>)> {
    let output = &arguments.output;
    if arguments.batch.shard.is_some() && !Format::of(output).can_be_a_part() {
        bail!("--shard: expected an output that ends in .jsonl or .parquet");
    }
    let options = arguments
        .measure
        .options(output.series || output.frames.is_some());
    let scorer = Scorer::new(arguments.body.body()?, options)?;
    let files = motion_files(&arguments.files)?;
    let (files, excluded) = without(files, arguments.batch.exclude.as_deref())?;
    let job = Job::new(files, excluded, arguments.batch.shard);
    let load_options = load_options(&arguments.read)?;

    let head = ReportHead::new(scorer.options(), scorer.body());
    let mapping = arguments.read.mapping.as_ref().map(std::fs::read_to_string);
    let identity = RunIdentity {
        head: &head,
        spacing_m: scorer.options().spacing_m,
        series: scorer.options().series,
        read: format!("{:?}", arguments.read),
        mapping: mapping.transpose()?,
        job: &job.identity,
    };
    let journal = output.output.as_ref().or(output.parquet.as_ref());
    let journal = journal
        .map(|path| Journal::open(path, &identity))
        .transpose()?;
    let (motions, journal) = job.run(journal, |file, progress| {
        score_file(&scorer, file, &load_options, &job.excluded, |frames| {
            progress.frames(frames)
        })
    })?;
    Ok((Report { head, motions }, job.identity, journal))
}

/// Scores all motions of a file; what goes wrong becomes a motion's `unscorable`.
fn score_file(
    scorer: &Scorer,
    path: &Path,
    options: &LoadOptions,
    excluded: &Excluded,
    progress: impl Fn(usize) + Sync,
) -> Vec<MotionReport> {
    let file = path.display().to_string();
    let file_name = path.file_name().unwrap_or(path.as_os_str());
    let unscorable =
        |name: String, reason: String| MotionReport::unscorable(file.clone(), name, reason);
    let whole = || file_name.to_string_lossy().into_owned();
    let motions = match load_each(path, scorer.body(), options) {
        Ok(motions) if motions.is_empty() => {
            return vec![unscorable(whole(), format!("{file} holds no motion."))];
        }
        Ok(mut motions) => {
            excluded.leave_out(path, &mut motions);
            motions
        }
        Err(problem) => return vec![unscorable(whole(), problem.to_string())],
    };
    let reports = motions.into_iter().map(|(name, loaded)| {
        let outcome = loaded.and_then(|loaded| {
            let score = scorer.score_with_progress(&loaded.motion, &progress)?;
            Ok((loaded, score))
        });
        match outcome {
            Ok((loaded, score)) => MotionReport {
                file: file.clone(),
                name,
                mapping: loaded.mapping_summary(),
                text: loaded.text,
                score: Some(score),
                unscorable: None,
                notes: loaded.notes,
            },
            Err(problem) => unscorable(name, problem.to_string()),
        }
    });
    reports.collect()
}

fn write(report: &Report, job: Option<&JobIdentity>, arguments: &ScoreArguments) -> Result<()> {
    let output = &arguments.output;
    if let Some(path) = &output.parquet {
        write_file(path, &Format::Parquet.bytes(report, job, None)?)?;
    }
    if let Some(path) = &output.frames {
        write_file(path, &format::frames(path, report)?)?;
    }
    let bytes = Format::of(output).bytes(report, job, output.worst)?;
    match &output.output {
        Some(path) => write_file(path, &bytes)?,
        None => std::io::stdout().write_all(&bytes)?,
    }
    Ok(())
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
                    eprintln!(
                        "physique: {}: --fail-on names a measure that was not measured",
                        motion.file
                    );
                    return Exit::Failed;
                }
            },
            (Some(_), None) => {}
        }
    }
    exit
}

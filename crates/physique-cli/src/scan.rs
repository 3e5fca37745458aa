//! `physique scan`.

pub(crate) mod arguments;

use std::path::Path;

use anyhow::{Context, Result};
use physique::defects::{Defect, DefectKind};
use physique::load::{LoadOptions, load_each};
use physique::{ClipReport, Error, ScanReport, Scanner};
use physique_files::write_file;
use serde::Serialize;

use crate::batch::{Job, JobIdentity};
use crate::exclude::Excluded;
use crate::exit::Exit;
use crate::files::motion_files;
use crate::journal::Journal;
use crate::progress::Progress;
use crate::view::load_options;
use arguments::ScanArguments;

pub(crate) fn run(arguments: &ScanArguments) -> Result<Exit> {
    if arguments.schema {
        let schema = schemars::schema_for!(ScanReport);
        println!("{}", serde_json::to_string_pretty(&schema)?);
        return Ok(Exit::Done);
    }
    let body = arguments.body.body()?;
    let kinds = arguments.look.kinds();
    let scanner = Scanner::new(&body, arguments.look.limits(), &kinds)?;
    let files = motion_files(&arguments.files)?;
    let job = Job::new(files, Excluded::default(), arguments.shard);
    let options = load_options(&arguments.read)?;

    let identity = RunIdentity {
        schema: physique::scan::SCHEMA,
        physique_version: env!("CARGO_PKG_VERSION"),
        settings: format!(
            "{:?} {:?} {:?}",
            arguments.look, arguments.body, arguments.read
        ),
        job: &job.identity,
    };
    let journal = arguments.output.as_ref();
    let journal = journal
        .map(|path| Journal::open(path, &identity))
        .transpose()?;
    let (clips, journal) = job.run(journal, |file, progress| {
        scan_file(&scanner, &body, file, &options, progress)
    })?;
    let report = ScanReport::new(clips);
    write(&report, arguments)?;
    if let Some(journal) = journal {
        journal.finish()?;
    }
    let is_bad = report.clips.iter().any(|clip| !clip.defects.is_empty());
    Ok(match arguments.strict && is_bad {
        true => Exit::ConditionMet,
        false => Exit::Done,
    })
}

/// What a run is: another one may continue it only if all of this is the same.
#[derive(Serialize)]
struct RunIdentity<'a> {
    schema: &'static str,
    physique_version: &'static str,
    settings: String,
    job: &'a JobIdentity,
}

/// Looks at all motions of a file; one that cannot be read is bad, too.
fn scan_file(
    scanner: &Scanner,
    body: &physique::body::Body,
    path: &Path,
    options: &LoadOptions,
    progress: &Progress,
) -> Vec<ClipReport> {
    let unreadable = |name: String, problem: &Error| ClipReport {
        file: path.display().to_string(),
        name,
        frames: None,
        frame_rate_fps: None,
        defects: scanner.of_kinds([Defect::of_error(problem)]),
    };
    let whole = path
        .file_name()
        .unwrap_or(path.as_os_str())
        .to_string_lossy();
    let motions = match load_each(path, body, options) {
        Ok(motions) if motions.is_empty() => {
            return vec![unreadable(whole.into_owned(), &Error::NoFrames)];
        }
        Ok(motions) => motions,
        Err(problem) => return vec![unreadable(whole.into_owned(), &problem)],
    };
    let clips = motions.into_iter().map(|(name, loaded)| {
        let scanned = loaded.and_then(|loaded| {
            let motion = &loaded.motion;
            progress.frames(motion.frame_count());
            Ok(ClipReport {
                file: path.display().to_string(),
                name: name.clone(),
                frames: Some(motion.frame_count()),
                frame_rate_fps: Some(motion.frame_rate().per_second()),
                defects: scanner.scan(motion)?,
            })
        });
        scanned.unwrap_or_else(|problem| unreadable(name, &problem))
    });
    clips.collect()
}

fn write(report: &ScanReport, arguments: &ScanArguments) -> Result<()> {
    for (path, bad) in [(&arguments.output, true), (&arguments.good, false)] {
        if let Some(path) = path {
            let wanted = report
                .clips
                .iter()
                .filter(|clip| clip.defects.is_empty() != bad);
            let lines: String = wanted.map(|clip| path_of(clip) + "\n").collect();
            write_file(path, lines.as_bytes())?;
        }
    }
    if arguments.json {
        println!("{}", serde_json::to_string_pretty(report)?);
    } else if arguments.csv {
        print!("{}", csv(report)?);
    } else {
        print!("{}", listed(report));
    }
    Ok(())
}

/// The file's path, with the motion's number or key where it holds several.
fn path_of(clip: &ClipReport) -> String {
    Path::new(&clip.file)
        .with_file_name(&clip.name)
        .display()
        .to_string()
}

fn csv(report: &ScanReport) -> Result<String> {
    let mut writer = csv::Writer::from_writer(Vec::new());
    writer.write_record(["file", "name", "kind", "at_s", "value", "limit", "message"])?;
    let number = |number: Option<f64>| number.map_or(String::new(), |number| number.to_string());
    for clip in &report.clips {
        for defect in &clip.defects {
            writer.write_record([
                &clip.file,
                &clip.name,
                defect.kind.name(),
                &number(defect.at_s),
                &number(defect.value),
                &number(defect.limit),
                &defect.message,
            ])?;
        }
    }
    let bytes = writer.into_inner().context("writing CSV")?;
    Ok(String::from_utf8(bytes)?)
}

/// Bad clips with their reasons, then how many there are of each kind.
fn listed(report: &ScanReport) -> String {
    let mut text = String::new();
    let bad = || report.clips.iter().filter(|clip| !clip.defects.is_empty());
    for clip in bad() {
        text += &path_of(clip);
        text.push('\n');
        for defect in &clip.defects {
            text += &format!("    {defect}\n");
        }
    }
    let of_kind = |kind: DefectKind| {
        let has = |clip: &&ClipReport| clip.defects.iter().any(|defect| defect.kind == kind);
        match bad().filter(has).count() {
            0 => None,
            count => Some(format!("{count} {kind}")),
        }
    };
    let kinds: Vec<_> = DefectKind::ALL.into_iter().filter_map(of_kind).collect();
    let total = report.clips.len();
    text + &match bad().count() {
        0 => format!("All {total} clips are good.\n"),
        count => format!("{count} of {total} clips are bad: {}.\n", kinds.join(", ")),
    }
}

//! `physique repair`.

pub(crate) mod arguments;
mod record;
mod table;

use std::ffi::OsStr;
use std::path::{Path, PathBuf};
use std::time::Instant;

use anyhow::{Result, bail};
use physique::Repairer;
use physique::export::{ExportOptions, Provenance, export};
use physique::load::{LoadOptions, Loaded, load, load_each};
use physique::repair::{Outcome, RepairHead, RepairReport, RepairedMotion};
use rayon::prelude::*;
use serde::Serialize;

use crate::convert::plan::{Job, Plan, Target};
use crate::convert::resume::make_room;
use crate::exit::Exit;
use crate::progress::{Progress, Rounds};
use crate::view::load_options;
use arguments::RepairArguments;
use record::Record;

pub(crate) fn run(arguments: &RepairArguments) -> Result<Exit> {
    if arguments.schema {
        let schema = schemars::schema_for!(RepairReport);
        println!("{}", serde_json::to_string_pretty(&schema)?);
        return Ok(Exit::Done);
    }
    let start = Instant::now();
    let Some(output) = &arguments.output else {
        bail!("say where the repaired motion goes: -o OUT");
    };
    let plan = Plan::new(&arguments.inputs, output, arguments.to)?;
    let body = arguments.body.body()?;
    let (_, proxy) = arguments.proxy.load()?;
    let spheres = proxy.of_body(&body)?;
    let head = RepairHead::new(arguments.options(), &body);
    let workshop = Workshop {
        repairer: Repairer::new(body, spheres, &proxy.pairs()?, head.options)?,
        read: load_options(&arguments.read)?,
        write: ExportOptions::new(plan.format),
    };
    let motions = match (&plan.target, &plan.jobs[..]) {
        (Target::File, [job]) => vec![workshop.one_file(job)?],
        (Target::File, _) => bail!("expected one file to repair"),
        (Target::Folder(folder), jobs) => workshop.folder(jobs, folder, arguments, &head)?,
    };
    for motion in &motions {
        if motion.outcome == Outcome::Failed {
            eprintln!("physique: {}", table::verdict(motion));
        }
    }
    let exit = exit_of(&motions);
    if arguments.json {
        let report = RepairReport { head, motions };
        println!("{}", serde_json::to_string_pretty(&report)?);
    } else {
        print(&motions, &plan.target, output, start);
    }
    Ok(exit)
}

fn exit_of(motions: &[RepairedMotion]) -> Exit {
    let any = |outcome| motions.iter().any(|motion| motion.outcome == outcome);
    if any(Outcome::Failed) {
        Exit::Failed
    } else if any(Outcome::HeldBack) {
        Exit::HeldBack
    } else {
        Exit::Done
    }
}

fn print(motions: &[RepairedMotion], target: &Target, output: &Path, start: Instant) {
    let seconds = start.elapsed().as_secs_f64();
    if let (Target::File, [motion]) = (target, motions) {
        print!("{}", table::of_one(motion));
        println!("{}", table::verdict(motion));
        println!("{}, {seconds:.1} s", output.display());
        return;
    }
    print!("{}", table::of_many(motions));
    let count = |outcome| motions.iter().filter(|m| m.outcome == outcome).count();
    let outcomes = [
        (Outcome::Repaired, "repaired"),
        (Outcome::RepairedInPart, "repaired in part"),
        (Outcome::Sound, "sound"),
        (Outcome::HeldBack, "held back"),
        (Outcome::Failed, "failed"),
    ];
    let told = outcomes.map(|(outcome, words)| (count(outcome), words));
    let told = told.iter().filter(|(count, _)| *count > 0);
    let told: Vec<_> = told
        .map(|(count, words)| format!("{count} {words}"))
        .collect();
    println!("{}: {}, {seconds:.1} s", output.display(), told.join(", "));
}

/// What all repairs of a run share.
struct Workshop {
    repairer: Repairer,
    read: LoadOptions,
    write: ExportOptions,
}

/// What the results of a folder depend on, apart from the inputs.
#[derive(Serialize)]
struct Settings<'a> {
    #[serde(flatten)]
    head: &'a RepairHead,
    settings: String,
}

impl Workshop {
    /// One file to one file: says all there is to say about it.
    fn one_file(&self, job: &Job) -> Result<RepairedMotion> {
        let loaded = load(&job.input, self.repairer.body(), &self.read)?;
        for note in &loaded.notes {
            eprintln!("note: {note}");
        }
        let rounds = Rounds::new();
        let motion = self.repair(job, &loaded, &job.output, &rounds);
        rounds.finish();
        let motion = motion?;
        for note in motion.notes.iter().skip(loaded.notes.len()) {
            eprintln!("note: {note}");
        }
        Ok(motion)
    }

    fn folder(
        &self,
        jobs: &[Job],
        folder: &Path,
        arguments: &RepairArguments,
        head: &RepairHead,
    ) -> Result<Vec<RepairedMotion>> {
        let settings = Settings {
            head,
            settings: format!(
                "{:?} {:?} {:?}",
                arguments.proxy, arguments.read, self.write
            ),
        };
        let record = Record::open(folder, &settings, arguments.force)?;
        let progress = Progress::new(jobs.len());
        let repair_all = || -> Result<Vec<Vec<RepairedMotion>>> {
            let motions = jobs.par_iter().map(|job| {
                let motions = match record.done(&job.input) {
                    Some(motions) => motions.clone(),
                    None => {
                        let motions = self.file_into_folder(job, &progress);
                        record.add(&job.input, &motions)?;
                        motions
                    }
                };
                progress.motion();
                Ok(motions)
            });
            motions.collect()
        };
        let motions = match arguments.jobs {
            Some(jobs) => {
                let pool = rayon::ThreadPoolBuilder::new().num_threads(jobs.get());
                pool.build()?.install(repair_all)
            }
            None => repair_all(),
        };
        progress.finish();
        let motions = motions?;
        let files = jobs.iter().map(|job| job.input.as_path());
        record.finish(files.zip(motions.iter().map(Vec::as_slice)))?;
        Ok(motions.into_iter().flatten().collect())
    }

    /// All motions of one of many files; what goes wrong becomes a motion's failure.
    fn file_into_folder(&self, job: &Job, progress: &Progress) -> Vec<RepairedMotion> {
        let file = job.input.display().to_string();
        let failed = |name, reason| RepairedMotion::failed(file.clone(), name, reason);
        let whole = || {
            let name = job.input.file_name().unwrap_or(job.input.as_os_str());
            name.to_string_lossy().into_owned()
        };
        let motions = match load_each(&job.input, self.repairer.body(), &self.read) {
            Ok(motions) if motions.is_empty() => {
                return vec![failed(whole(), "the file holds no motion".to_owned())];
            }
            Ok(motions) => motions,
            Err(problem) => return vec![failed(whole(), problem.to_string())],
        };
        let several = motions.len() > 1;
        let mut outputs: Vec<PathBuf> = Vec::new();
        let repaired = motions.into_iter().map(|(name, loaded)| {
            let output = match several {
                true => job.output_of(&name, self.write.format),
                false => job.output.clone(),
            };
            if outputs.contains(&output) {
                let reason = "another motion of the file has the same name";
                return failed(name, reason.to_owned());
            }
            outputs.push(output.clone());
            let outcome = loaded.map_err(Into::into).and_then(|loaded| {
                let rounds = Rounds::hidden();
                let motion = self.repair(job, &loaded, &output, &rounds)?;
                progress.frames(loaded.motion.frame_count());
                Ok(motion)
            });
            outcome.unwrap_or_else(|problem: anyhow::Error| failed(name, format!("{problem:#}")))
        });
        repaired.collect()
    }

    fn repair(
        &self,
        job: &Job,
        loaded: &Loaded,
        output: &Path,
        rounds: &Rounds,
    ) -> Result<RepairedMotion> {
        let start = Instant::now();
        let repaired = self
            .repairer
            .repair_with_progress(&loaded.motion, |round, score| {
                let found = score.self_intersection.as_ref();
                rounds.tell(round, found.map_or(0.0, |found| found.mean_cm3));
            })?;
        let took_s = start.elapsed().as_secs_f64();
        let source = job.input.with_file_name(&loaded.name);
        let text = |part: Option<&OsStr>| part.map(|part| part.to_string_lossy().into_owned());
        let mut notes = loaded.notes.clone();
        let provenance = Provenance {
            name: text(source.file_stem()).unwrap_or_default(),
            source: text(source.file_name()),
            notes: notes.clone(),
        };
        make_room(output)?;
        let body = self.repairer.body();
        notes.extend(export(
            output,
            &repaired.motion,
            body,
            provenance,
            &self.write,
        )?);
        let file = job.input.display().to_string();
        Ok(RepairedMotion {
            output: Some(output.display().to_string()),
            notes,
            ..RepairedMotion::of(file, loaded.name.clone(), &repaired, took_s)
        })
    }
}

#[cfg(test)]
mod tests {
    use physique::repair::Worse;

    use super::*;

    fn motion(outcome: Outcome) -> RepairedMotion {
        let worse = Worse {
            measure: "feet_slide_mean_cm_s".into(),
            before: 1.0,
            after: 3.5,
        };
        RepairedMotion {
            outcome,
            held_back_by: vec![worse],
            ..RepairedMotion::failed("walk.bvh".into(), "walk.bvh".into(), "no frames".into())
        }
    }

    #[test]
    fn exit_codes_tell_failures_then_what_was_held_back() {
        let exit = |outcomes: &[Outcome]| {
            let motions: Vec<_> = outcomes.iter().copied().map(motion).collect();
            exit_of(&motions)
        };
        assert_eq!(exit(&[Outcome::Sound, Outcome::RepairedInPart]), Exit::Done);
        assert_eq!(
            exit(&[Outcome::HeldBack, Outcome::Repaired]),
            Exit::HeldBack
        );
        assert_eq!(exit(&[Outcome::HeldBack, Outcome::Failed]), Exit::Failed);
    }

    #[test]
    fn a_repair_that_is_held_back_names_the_measure() {
        for outcome in [Outcome::HeldBack, Outcome::RepairedInPart] {
            let told = table::verdict(&motion(outcome));
            assert!(
                told.contains("feet_slide_mean_cm_s from 1.00 to 3.50"),
                "{told}"
            );
        }
    }
}

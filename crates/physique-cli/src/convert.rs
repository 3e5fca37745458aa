//! `physique convert`.

pub(crate) mod arguments;
mod outcome;
pub(crate) mod plan;
pub(crate) mod resume;

use std::collections::HashSet;
use std::ffi::OsStr;
use std::path::Path;
use std::time::Instant;

use anyhow::{Result, bail};
use physique::body::Body;
use physique::export::{ExportOptions, Provenance};
use physique::load::{LoadOptions, Loaded, load, load_motion};
use physique::motion::bvh::LengthUnit;
use physique::motion::{FrameRate, NamedMotion, read_each};
use physique::{ExportFormat, export};
use rayon::prelude::*;

use crate::exit::Exit;
use crate::progress::Progress;
use crate::view::load_options;
use arguments::ConvertArguments;
use outcome::{Outcome, Summary};
use plan::{Job, Plan, Target};
use resume::{Resume, make_room};

pub(crate) fn run(arguments: &ConvertArguments) -> Result<Exit> {
    let start = Instant::now();
    let plan = Plan::new(&arguments.inputs, &arguments.output, arguments.to)?;
    let converter = Converter {
        body: arguments.body.body()?,
        read: load_options(&arguments.read)?,
        write: export_options(arguments, plan.format)?,
    };
    match (&plan.target, &plan.jobs[..]) {
        (Target::File, [job]) => converter.one_file(job),
        (Target::File, _) => bail!("expected one file to convert"),
        (Target::Folder(folder), jobs) => {
            // What the results depend on, apart from the inputs.
            let settings = format!(
                "{{\"physique\": \"{}\", \"settings\": {:?}}}\n",
                env!("CARGO_PKG_VERSION"),
                format!(
                    "{:?} {:?} {:?}",
                    arguments.body, arguments.read, converter.write
                )
            );
            let resume = Resume::new(folder, plan.format, &settings)?;
            let resume = (!arguments.force).then_some(&resume);
            let progress = Progress::new(jobs.len());
            let convert_all = || -> Vec<Outcome> {
                let jobs = jobs.par_iter();
                jobs.map(|job| converter.file_into_folder(job, resume, &progress))
                    .collect()
            };
            let outcomes = match arguments.jobs {
                Some(jobs) => {
                    let pool = rayon::ThreadPoolBuilder::new().num_threads(jobs.get());
                    pool.build()?.install(convert_all)
                }
                None => convert_all(),
            };
            progress.finish();
            Ok(Summary::of(&outcomes, start).print(&arguments.output))
        }
    }
}

/// How to write, from the flags; refuses flags that the format has no room for.
fn export_options(arguments: &ConvertArguments, format: ExportFormat) -> Result<ExportOptions> {
    let mut options = ExportOptions::new(format);
    if format != ExportFormat::Bvh && (arguments.up.is_some() || arguments.unit.is_some()) {
        let says = match format {
            ExportFormat::Amass => "Z up and metres",
            _ => "Y up and metres",
        };
        bail!(
            "--up and --unit are for BVH; {} is {says} by definition",
            format.name()
        );
    }
    options.frame_rate = arguments.resample.map(FrameRate::new).transpose()?;
    options.up_axis = arguments.up.map_or(options.up_axis, Into::into);
    options.unit = arguments.unit.map_or(options.unit, LengthUnit::from);
    Ok(options)
}

/// What all conversions of a run share.
struct Converter {
    body: Body,
    read: LoadOptions,
    write: ExportOptions,
}

impl Converter {
    /// One file to one file: says all there is to say about it.
    fn one_file(&self, job: &Job) -> Result<Exit> {
        let loaded = load(&job.input, &self.body, &self.read)?;
        for note in &loaded.notes {
            eprintln!("note: {note}");
        }
        if let Some(report) = &loaded.mapping {
            eprintln!("{report}");
        }
        make_room(&job.output)?;
        for note in self.write(job, &job.output, &loaded)? {
            eprintln!("note: {note}");
        }
        println!("{}", job.output.display());
        Ok(Exit::Done)
    }

    /// One of many files; what goes wrong is told at the end.
    fn file_into_folder(&self, job: &Job, resume: Option<&Resume>, progress: &Progress) -> Outcome {
        let mut outcome = Outcome::default();
        let is_done = |output: &Path| resume.is_some_and(|r| r.is_done(&job.input, output));
        if is_done(&job.output) {
            outcome.kept = 1;
            progress.motion();
            return outcome;
        }
        match read_each(&job.input, &self.read.read) {
            Err(problem) => outcome.fails(&job.input, &problem),
            Ok(motions) => {
                let several = motions.len() > 1;
                let mut outputs = HashSet::new();
                for (name, motion) in motions {
                    let (input, output) = if several {
                        let output = job.output_of(&name, self.write.format);
                        (job.input.with_file_name(&name), output)
                    } else {
                        (job.input.clone(), job.output.clone())
                    };
                    if !outputs.insert(output.clone()) {
                        outcome.fails(&input, &"another motion of the file has the same name");
                    } else if is_done(&output) {
                        outcome.kept += 1;
                    } else {
                        match self.motion_into_file(job, motion, &output) {
                            Ok((frames, notes)) => {
                                outcome.written += 1;
                                outcome.frames += frames;
                                outcome.notes.extend(notes);
                                progress.frames(frames);
                            }
                            Err(problem) => outcome.fails(&input, &problem),
                        }
                    }
                }
            }
        }
        progress.motion();
        outcome
    }

    /// Frames read, and what is to be said.
    fn motion_into_file(
        &self,
        job: &Job,
        motion: Result<NamedMotion, physique::motion::Error>,
        output: &Path,
    ) -> Result<(usize, Vec<String>)> {
        let loaded = load_motion(motion?, &self.body, &self.read)?;
        make_room(output)?;
        let notes = self.write(job, output, &loaded)?;
        Ok((loaded.motion.frame_count(), notes))
    }

    fn write(&self, job: &Job, output: &Path, loaded: &Loaded) -> Result<Vec<String>> {
        let source = job.input.with_file_name(&loaded.name);
        let text = |part: Option<&OsStr>| part.map(|part| part.to_string_lossy().into_owned());
        let provenance = Provenance {
            name: text(source.file_stem()).unwrap_or_default(),
            source: text(source.file_name()),
            notes: loaded.notes.clone(),
        };
        Ok(export(
            output,
            &loaded.motion,
            &self.body,
            provenance,
            &self.write,
        )?)
    }
}

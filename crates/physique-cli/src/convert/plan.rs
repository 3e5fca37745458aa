//! What is to be made of what, decided before anything is written.

use std::collections::HashMap;
use std::path::{Path, PathBuf};

use anyhow::{Result, bail};
use physique::ExportFormat;

use super::arguments::FormatName;
use crate::files::{FoundFile, find_files, is_pattern};

/// All conversions of a run.
#[derive(Debug)]
pub(crate) struct Plan {
    pub(crate) format: ExportFormat,
    pub(crate) target: Target,
    pub(crate) jobs: Vec<Job>,
}

/// Where results go.
#[derive(Debug, PartialEq, Eq)]
pub(crate) enum Target {
    /// One file to one file.
    File,
    /// Any number of files into this folder.
    Folder(PathBuf),
}

/// One file to convert.
#[derive(Debug, PartialEq, Eq)]
pub(crate) struct Job {
    pub(crate) input: PathBuf,
    /// Where its motion goes, if it holds only one.
    pub(crate) output: PathBuf,
}

impl Job {
    /// Where one of several motions of the file goes: into a folder of the output's name.
    pub(crate) fn output_of(&self, name: &str, format: ExportFormat) -> PathBuf {
        let ending = format!(".{}", format.ending());
        let folder = self.output.to_string_lossy();
        let folder = PathBuf::from(folder.strip_suffix(&ending).unwrap_or(&folder));
        let key = name.rsplit_once('#').map_or(name, |(_, key)| key);
        // A name may be a caption: nothing in it may lead to another folder.
        let safe = |c: char| {
            if c.is_alphanumeric() || "-_. ".contains(c) {
                c
            } else {
                '_'
            }
        };
        let name: String = key.chars().map(safe).take(80).collect();
        folder.join(name.trim_matches(['.', ' ']).to_owned() + &ending)
    }
}

impl Plan {
    /// Finds the inputs and lays out the outputs.
    ///
    /// Fails where the format is not told, where two inputs would go to one output, and where an
    /// output would replace an input.
    pub(crate) fn new(inputs: &[PathBuf], output: &Path, to: Option<FormatName>) -> Result<Self> {
        let one_file = matches!(inputs,
            [input] if !input.is_dir() && (input.exists() || !is_pattern(input)));
        let ends_as_folder = output.to_string_lossy().ends_with(['/', '\\']);
        let into_folder = !one_file || output.is_dir() || ends_as_folder;
        let format = format(output, to, into_folder)?;
        let files = find_files(inputs, into_folder.then_some(output))?;
        let jobs: Vec<Job> = files
            .into_iter()
            .map(|FoundFile { path, below }| Job {
                input: path,
                output: if into_folder {
                    output.join(with_ending(&below, format))
                } else {
                    output.to_owned()
                },
            })
            .collect();
        refuse_clashes(&jobs)?;
        Ok(Self {
            format,
            target: if into_folder {
                Target::Folder(output.to_owned())
            } else {
                Target::File
            },
            jobs,
        })
    }
}

pub(crate) fn format(
    output: &Path,
    to: Option<FormatName>,
    into_folder: bool,
) -> Result<ExportFormat> {
    let path = output;
    let output = path.display();
    if let Some(name) = to {
        return Ok(name.into());
    }
    if into_folder {
        bail!(
            "{output} is a folder: say the format, such as --to bvh, amass, glb, 263 or positions"
        );
    }
    match ExportFormat::of(path) {
        Some(format) => Ok(format),
        None if path
            .extension()
            .is_some_and(|e| e.eq_ignore_ascii_case("npy")) =>
        {
            bail!("{output}: a .npy may hold several things: say --to 263, kit or positions")
        }
        None => bail!(
            "{output}: expected an ending of .bvh, .glb, .npz (AMASS), .motion.npz or .csv, or --to FORMAT"
        ),
    }
}

/// The name with the ending of the format in place of its own.
fn with_ending(below: &Path, format: ExportFormat) -> PathBuf {
    let name = below
        .file_name()
        .map_or_else(String::new, |name| name.to_string_lossy().into_owned());
    let own = ExportFormat::of(below).map(|format| format!(".{}", format.ending()));
    // `walk.motion.npz` is `walk`; of an unknown ending, the last part goes.
    let stem = own
        .and_then(|own| name.len().checked_sub(own.len()))
        .and_then(|end| name.get(..end))
        .or_else(|| name.rsplit_once('.').map(|(stem, _)| stem))
        .filter(|stem| !stem.is_empty())
        .unwrap_or(&name);
    below.with_file_name(format!("{stem}.{}", format.ending()))
}

fn refuse_clashes(jobs: &[Job]) -> Result<()> {
    let mut by_output: HashMap<&Path, &Path> = HashMap::new();
    let inputs: HashMap<PathBuf, &Path> = jobs
        .iter()
        .filter_map(|job| Some((job.input.canonicalize().ok()?, job.input.as_path())))
        .collect();
    let mut clashes = Vec::new();
    for job in jobs {
        if let Some(first) = by_output.insert(&job.output, &job.input) {
            clashes.push(format!(
                "{} and {} would both become {}",
                first.display(),
                job.input.display(),
                job.output.display()
            ));
        }
        let existing = job.output.canonicalize().ok();
        if let Some(input) = existing.and_then(|output| inputs.get(&output)) {
            clashes.push(format!("{} would be replaced", input.display()));
        }
    }
    if clashes.is_empty() {
        return Ok(());
    }
    let shown = clashes.len().min(10);
    let more = match clashes.len() - shown {
        0 => String::new(),
        more => format!("\n  and {more} more"),
    };
    bail!(
        "nothing was written, since names clash:\n  {}{more}",
        clashes[..shown].join("\n  ")
    );
}

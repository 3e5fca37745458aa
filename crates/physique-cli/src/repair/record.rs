//! What was done in a folder: a report, and what a run that was stopped continues from.

use std::collections::HashMap;
use std::fs::{self, File, OpenOptions};
use std::io::Write;
use std::path::{Path, PathBuf};
use std::sync::Mutex;

use anyhow::{Context, Result};
use physique::repair::{Outcome, RepairedMotion};
use physique_files::write_file;
use serde::{Deserialize, Serialize};

/// Name of the record in its folder.
const NAME: &str = "repair.jsonl";

/// All motions of a file.
#[derive(Clone, Debug, Serialize, Deserialize)]
struct Line {
    file: PathBuf,
    motions: Vec<RepairedMotion>,
}

/// JSON Lines: what repaired, then a line a file. A record of other settings is begun anew.
pub(crate) struct Record {
    path: PathBuf,
    head: String,
    done: HashMap<PathBuf, Vec<RepairedMotion>>,
    file: Mutex<File>,
}

impl Record {
    /// Opens the record of a folder; `head` says what the results depend on.
    pub(crate) fn open(folder: &Path, head: &impl Serialize, force: bool) -> Result<Self> {
        fs::create_dir_all(folder).with_context(|| folder.display().to_string())?;
        let path = folder.join(NAME);
        let head = serde_json::to_string(head)? + "\n";
        let mut done = HashMap::new();
        let mut kept = head.clone();
        if let Ok(text) = fs::read_to_string(&path)
            && let Some(lines) = text.strip_prefix(&head)
            && !force
        {
            // A line that was cut off by the end of a run does not count.
            let lines = lines.split_inclusive('\n');
            for line in lines.filter(|line| line.ends_with('\n')) {
                if let Ok(Line { file, motions }) = serde_json::from_str(line) {
                    done.insert(file, motions);
                    kept += line;
                }
            }
        }
        write_file(&path, kept.as_bytes())?;
        let file = OpenOptions::new().append(true).open(&path);
        let file = Mutex::new(file.with_context(|| path.display().to_string())?);
        Ok(Self {
            path,
            head,
            done,
            file,
        })
    }

    /// What an earlier run made of a file, if all of it still stands and is newer than the file.
    pub(crate) fn done(&self, input: &Path) -> Option<&Vec<RepairedMotion>> {
        let modified = |path: &Path| fs::metadata(path).and_then(|file| file.modified()).ok();
        let source = modified(input)?;
        let stands = |motion: &RepairedMotion| {
            let output = motion.output.as_deref().map(Path::new);
            motion.outcome != Outcome::Failed
                && output
                    .and_then(modified)
                    .is_some_and(|result| result >= source)
        };
        let motions = self.done.get(input)?;
        motions.iter().all(stands).then_some(motions)
    }

    /// Adds a file that is done.
    pub(crate) fn add(&self, input: &Path, motions: &[RepairedMotion]) -> Result<()> {
        let line = line(input, motions)?;
        let mut file = match self.file.lock() {
            Ok(file) => file,
            // Whoever panicked while writing left at worst a torn line.
            Err(poisoned) => poisoned.into_inner(),
        };
        file.write_all(line.as_bytes())
            .with_context(|| self.path.display().to_string())
    }

    /// Writes the record of a finished run: every file once, in order.
    pub(crate) fn finish<'a>(
        &self,
        files: impl Iterator<Item = (&'a Path, &'a [RepairedMotion])>,
    ) -> Result<()> {
        let mut text = self.head.clone();
        for (file, motions) in files {
            text += &line(file, motions)?;
        }
        Ok(write_file(&self.path, text.as_bytes())?)
    }
}

fn line(file: &Path, motions: &[RepairedMotion]) -> Result<String> {
    let line = Line {
        file: file.to_owned(),
        motions: motions.to_vec(),
    };
    Ok(serde_json::to_string(&line)? + "\n")
}

//! Repetitions that are done, so that an evaluation can go on.

use std::fs::OpenOptions;
use std::io::Write as _;
use std::path::{Path, PathBuf};

use anyhow::{Context, Result, bail};
use physique_learn::evaluation::RepetitionMeasures;
use serde::{Deserialize, Serialize};

/// A file that is written line by line; nothing where there is none.
pub(super) struct Journal {
    path: Option<PathBuf>,
    settings: String,
    done: Vec<(String, RepetitionMeasures)>,
}

#[derive(Deserialize, Serialize)]
struct Line {
    settings: String,
    row: String,
    measures: RepetitionMeasures,
}

impl Journal {
    /// Reads what an earlier run left beside `output`. Half a line at the end, as a kill may leave
    /// it, is forgotten.
    pub(super) fn open(output: Option<&Path>, settings: String) -> Result<Self> {
        let path = output.map(partial);
        let mut done = Vec::new();
        if let Some(path) = path.as_deref().filter(|path| path.exists()) {
            let text = std::fs::read_to_string(path);
            let text = text.with_context(|| path.display().to_string())?;
            let (whole, _) = text.rsplit_once('\n').unwrap_or_default();
            for line in whole.lines() {
                let line: Line =
                    serde_json::from_str(line).with_context(|| path.display().to_string())?;
                if line.settings != settings {
                    bail!(
                        "{}: belongs to an evaluation with other settings; remove it to start anew",
                        path.display()
                    );
                }
                done.push((line.row, line.measures));
            }
            let kept = if whole.is_empty() {
                String::new()
            } else {
                format!("{whole}\n")
            };
            physique_files::write_file(path, kept.as_bytes())?;
        }
        Ok(Self {
            path,
            settings,
            done,
        })
    }

    /// What is known of a repetition of a row.
    pub(super) fn known(&self, row: &str, repetition: usize) -> Option<RepetitionMeasures> {
        let known = self.done.iter();
        let mut known =
            known.filter(|(name, measures)| name == row && measures.repetition == repetition);
        known.next().map(|(_, measures)| measures.clone())
    }

    /// Keeps a repetition.
    pub(super) fn keep(&self, row: &str, measures: &RepetitionMeasures) -> Result<()> {
        let Some(path) = &self.path else {
            return Ok(());
        };
        let line = serde_json::to_string(&Line {
            settings: self.settings.clone(),
            row: row.to_owned(),
            measures: measures.clone(),
        })?;
        let file = OpenOptions::new().create(true).append(true).open(path);
        let written = file.and_then(|mut file| file.write_all(format!("{line}\n").as_bytes()));
        written.with_context(|| path.display().to_string())
    }
}

/// Removes the journal of an evaluation that is done.
pub(super) fn remove(output: &Path) -> Result<()> {
    let path = partial(output);
    match path.exists() {
        true => std::fs::remove_file(&path).with_context(|| path.display().to_string()),
        false => Ok(()),
    }
}

fn partial(output: &Path) -> PathBuf {
    let mut name = output.as_os_str().to_owned();
    name.push(".partial");
    name.into()
}

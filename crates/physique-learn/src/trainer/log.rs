//! What a run tells: `log.jsonl`, a line a report, and TensorBoard's event file.

use std::fs::{self, File, OpenOptions};
use std::io::Write as _;
use std::path::{Path, PathBuf};

use physique_files::{FileError, write_file};
use serde::{Deserialize, Serialize};
use std::collections::BTreeMap;

use super::StepReport;
use super::events::EventWriter;
use crate::Error;

/// The files of a run.
#[derive(Debug)]
pub(super) struct RunLog {
    path: PathBuf,
    lines: Option<File>,
    events: EventWriter,
}

/// A line of `log.jsonl`.
#[derive(Debug, Serialize, Deserialize)]
struct Line {
    step: u64,
    loss: f64,
    #[serde(flatten)]
    parts: BTreeMap<String, f64>,
    gradient_norm: f64,
    rate: f64,
    seconds: f64,
}

impl RunLog {
    /// The log in a folder, which is made.
    pub(super) fn new(folder: &Path) -> Result<Self, Error> {
        let io = |problem| FileError::Io {
            path: folder.into(),
            problem,
        };
        fs::create_dir_all(folder).map_err(io)?;
        Ok(Self {
            path: folder.join("log.jsonl"),
            lines: None,
            events: EventWriter::new(folder),
        })
    }

    /// Forgets what comes after a step: a run that was killed does it again.
    pub(super) fn go_on_after(&mut self, step: u64) -> Result<(), Error> {
        if self.path.exists() {
            let text = physique_files::read_file(&self.path, 1 << 34)?;
            let text = String::from_utf8_lossy(&text);
            let known = |line: &&str| {
                // The last line may be half a line.
                let line: Option<Line> = serde_json::from_str(line).ok();
                line.is_some_and(|line| line.step <= step)
            };
            let kept: String = text
                .lines()
                .filter(known)
                .flat_map(|line| [line, "\n"])
                .collect();
            write_file(&self.path, kept.as_bytes())?;
        }
        self.lines = Some(self.open()?);
        self.events.start(step)
    }

    fn open(&self) -> Result<File, Error> {
        let file = OpenOptions::new()
            .create(true)
            .append(true)
            .open(&self.path);
        Ok(file.map_err(|problem| self.io(problem))?)
    }

    fn io(&self, problem: std::io::Error) -> FileError {
        FileError::Io {
            path: self.path.clone(),
            problem,
        }
    }

    /// Writes a report to both files.
    pub(super) fn write(&mut self, report: &StepReport) -> Result<(), Error> {
        let parts = report.parts.iter();
        let line = Line {
            step: report.step,
            loss: report.loss,
            parts: parts.map(|&(name, part)| (name.to_owned(), part)).collect(),
            gradient_norm: report.gradient_norm,
            rate: report.rate,
            seconds: report.seconds,
        };
        let text = serde_json::to_string(&line).map_err(|problem| self.io(problem.into()))?;
        if let Some(mut file) = self.lines.as_ref() {
            writeln!(file, "{text}").map_err(|problem| self.io(problem))?;
        }
        let scalars = [
            ("loss", report.loss),
            ("gradient_norm", report.gradient_norm),
            ("rate", report.rate),
            ("seconds", report.seconds),
        ];
        let scalars = scalars.iter().chain(&report.parts);
        self.events.scalars(report.step, scalars.copied())
    }
}

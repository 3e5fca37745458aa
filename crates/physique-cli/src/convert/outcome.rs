//! What became of the files, in the end.

use std::collections::BTreeMap;
use std::fmt::Display;
use std::path::{Path, PathBuf};
use std::time::Instant;

use crate::exit::Exit;

/// What became of one file.
#[derive(Debug, Default)]
pub(crate) struct Outcome {
    pub(crate) written: usize,
    /// Results of an earlier run that stayed.
    pub(crate) kept: usize,
    pub(crate) frames: usize,
    pub(crate) notes: Vec<String>,
    /// Inputs, or motions in them, and why they were not converted.
    pub(crate) failures: Vec<(PathBuf, String)>,
}

impl Outcome {
    /// Something was not converted.
    pub(crate) fn fails(&mut self, input: &Path, problem: &dyn Display) {
        self.failures
            .push((input.to_owned(), format!("{problem:#}")));
    }
}

/// What became of all files.
#[derive(Debug)]
pub(crate) struct Summary<'a> {
    outcomes: &'a [Outcome],
    start: Instant,
}

impl<'a> Summary<'a> {
    pub(crate) fn of(outcomes: &'a [Outcome], start: Instant) -> Self {
        Self { outcomes, start }
    }

    /// Failures and notes on standard error, what was done on standard output.
    pub(crate) fn print(&self, output: &Path) -> Exit {
        let mut notes: BTreeMap<&str, usize> = BTreeMap::new();
        for note in self.outcomes.iter().flat_map(|outcome| &outcome.notes) {
            *notes.entry(note).or_default() += 1;
        }
        for (note, files) in notes {
            match files {
                1 => eprintln!("note: {note}"),
                files => eprintln!("note, {files} times: {note}"),
            }
        }
        let failures: Vec<_> = self
            .outcomes
            .iter()
            .flat_map(|outcome| &outcome.failures)
            .collect();
        for (path, problem) in &failures {
            let path = path.display().to_string();
            // Most errors name the file themselves.
            let problem = problem.strip_prefix(&path).unwrap_or(problem);
            let problem = problem.trim_start_matches([':', ',', ' ']);
            eprintln!("physique: not converted: {path}: {problem}");
        }
        let total = |count: fn(&Outcome) -> usize| self.outcomes.iter().map(count).sum::<usize>();
        let (written, kept) = (
            total(|outcome| outcome.written),
            total(|outcome| outcome.kept),
        );
        let mut line = format!("{}: {written} written", output.display());
        if written > 0 {
            line += &format!(" ({} frames)", total(|outcome| outcome.frames));
        }
        if kept > 0 {
            line += &format!(", {kept} kept, which are newer than their sources");
        }
        if !failures.is_empty() {
            line += &format!(", {} failed", failures.len());
        }
        println!("{line}, {:.1} s", self.start.elapsed().as_secs_f64());
        if failures.is_empty() {
            Exit::Done
        } else {
            Exit::Failed
        }
    }
}

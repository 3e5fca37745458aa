//! A report in each of the formats.

use std::path::Path;

use anyhow::{Context, Result, bail};
use physique::Report;
use physique::report::{MotionReport, ReportHead};
use serde::{Deserialize, Serialize};

use super::arguments::OutputArguments;
use super::columns;
use crate::batch::JobIdentity;
use crate::parquet::parquet;
use crate::table::table;

/// Format of a report.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Format {
    Table,
    Json,
    JsonLines,
    Csv,
    Parquet,
}

impl Format {
    /// By the flags; without any, by the ending of the output.
    pub(crate) fn of(arguments: &OutputArguments) -> Self {
        let flags = [
            (arguments.json, Self::Json),
            (arguments.jsonl, Self::JsonLines),
            (arguments.csv, Self::Csv),
        ];
        if let Some((_, format)) = flags.into_iter().find(|(asked, _)| *asked) {
            return format;
        }
        match arguments.output.as_deref().map(ending).as_deref() {
            Some("json") => Self::Json,
            Some("jsonl") => Self::JsonLines,
            Some("csv") => Self::Csv,
            Some("parquet") => Self::Parquet,
            _ => Self::Table,
        }
    }

    /// Formats that keep every figure of a part, or are read together as they are.
    pub(crate) const fn can_be_a_part(self) -> bool {
        matches!(self, Self::JsonLines | Self::Parquet)
    }

    pub(crate) fn bytes(
        self,
        report: &Report,
        job: Option<&JobIdentity>,
        worst: Option<usize>,
    ) -> Result<Vec<u8>> {
        Ok(match self {
            Self::Table => table(report, worst).into_bytes(),
            Self::Json => (serde_json::to_string_pretty(report)? + "\n").into_bytes(),
            Self::JsonLines => lines(report, job)?.into_bytes(),
            Self::Csv => columns::csv(&columns::of_motions(report))?,
            Self::Parquet => parquet(&columns::of_motions(report), &columns::about(&report.head)?)?,
        })
    }
}

fn ending(path: &Path) -> String {
    let ending = path.extension().unwrap_or_default();
    ending.to_string_lossy().to_ascii_lowercase()
}

/// First line of JSON Lines.
#[derive(Debug, Serialize, Deserialize)]
pub(crate) struct LinesHead {
    #[serde(flatten)]
    pub(crate) head: ReportHead,
    /// For a part of a job, which.
    pub(crate) part: Option<JobIdentity>,
}

fn lines(report: &Report, job: Option<&JobIdentity>) -> Result<String> {
    let head = LinesHead {
        head: report.head.clone(),
        part: job.filter(|job| job.shard.is_some()).cloned(),
    };
    let mut text = serde_json::to_string(&head)? + "\n";
    for motion in &report.motions {
        text += &serde_json::to_string(motion)?;
        text.push('\n');
    }
    Ok(text)
}

/// A row a frame, as CSV or Parquet by the ending.
pub(crate) fn frames(path: &Path, report: &Report) -> Result<Vec<u8>> {
    match ending(path).as_str() {
        "parquet" => parquet(&columns::of_frames(report), &columns::about(&report.head)?),
        "csv" => columns::csv(&columns::of_frames(report)),
        _ => bail!("{}: expected an ending of .parquet or .csv", path.display()),
    }
}

/// Reads JSON Lines back.
pub(crate) fn read_lines(path: &Path) -> Result<(LinesHead, Vec<MotionReport>)> {
    let place = || path.display().to_string();
    let text = std::fs::read_to_string(path).with_context(place)?;
    let mut lines = text.lines();
    let head = lines.next().unwrap_or_default();
    let head = serde_json::from_str(head)
        .with_context(|| format!("{}: expected the output of `score -o part.jsonl`", place()))?;
    let motions = lines.enumerate().map(|(number, line)| {
        let place = || format!("{}, line {}", place(), number + 2);
        serde_json::from_str(line).with_context(place)
    });
    Ok((head, motions.collect::<Result<_>>()?))
}

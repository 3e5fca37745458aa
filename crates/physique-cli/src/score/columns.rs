//! Reports as columns, for tables of data: a row a motion, or a row a frame.

use anyhow::{Context, Result};
use physique::Report;
use physique::measures::{measure_names, measures};
use physique::report::{MotionReport, ReportHead};

use crate::parquet::{Column, Values};

/// A row a motion: file, every measure, mapping error, and why there is no score.
pub(crate) fn of_motions(report: &Report) -> Vec<Column> {
    let motions = &report.motions;
    let measured: Vec<_> = motions
        .iter()
        .map(|motion| motion.score.as_ref().map(measures).unwrap_or_default())
        .collect();
    let words = |name: &str, of: fn(&MotionReport) -> Option<String>| Column {
        name: name.into(),
        values: Values::Words(motions.iter().map(of).collect()),
    };
    let mut columns = vec![
        words("file", |motion| Some(motion.file.clone())),
        words("name", |motion| Some(motion.name.clone())),
        words("text", |motion| motion.text.clone()),
    ];
    for name in measure_names(&report.head.protocols, &report.head.groups) {
        let value = |measures: &Vec<(std::borrow::Cow<'static, str>, f64)>| {
            let found = measures.iter().find(|(measure, _)| *measure == name);
            found.map(|&(_, value)| value)
        };
        columns.push(Column {
            values: Values::Numbers(measured.iter().map(value).collect()),
            name: name.into_owned(),
        });
    }
    let mapping = motions
        .iter()
        .map(|motion| Some(motion.mapping.as_ref()?.mean_error_cm));
    columns.push(Column {
        name: "mapping_mean_error_cm".into(),
        values: Values::Numbers(mapping.collect()),
    });
    columns.push(words("unscorable", |motion| motion.unscorable.clone()));
    columns
}

/// A row a frame of the motions that are scored: file, frame, time and every series.
pub(crate) fn of_frames(report: &Report) -> Vec<Column> {
    let (mut files, mut names, mut numbers) = (Vec::new(), Vec::new(), Vec::new());
    let mut supports = Vec::new();
    let mut series_columns: Vec<(&'static str, Vec<Option<f64>>)> = Vec::new();
    let mut has_support = false;
    for motion in &report.motions {
        let score = motion.score.as_ref();
        let Some(series) = score.and_then(|score| score.series.as_ref()) else {
            continue;
        };
        for frame in 0..series.time_s.len() {
            files.push(Some(motion.file.clone()));
            names.push(Some(motion.name.clone()));
            numbers.push(Some(frame as f64));
            let support = series.support.as_ref();
            supports.push(support.map(|support| support[frame].name().to_owned()));
        }
        has_support |= series.support.is_some();
        // Every motion of a report has the same series.
        for (name, values) in series.columns() {
            match series_columns.iter_mut().find(|(known, _)| *known == name) {
                Some((_, column)) => column.extend(values),
                None => series_columns.push((name, values)),
            }
        }
    }
    let mut columns = vec![
        Column {
            name: "file".into(),
            values: Values::Words(files),
        },
        Column {
            name: "name".into(),
            values: Values::Words(names),
        },
        Column {
            name: "frame".into(),
            values: Values::Numbers(numbers),
        },
    ];
    columns.extend(series_columns.into_iter().map(|(name, values)| Column {
        name: name.into(),
        values: Values::Numbers(values),
    }));
    if has_support {
        columns.push(Column {
            name: "support".into(),
            values: Values::Words(supports),
        });
    }
    columns
}

/// What measured, as the key and value that go beside columns.
pub(crate) fn about(head: &ReportHead) -> Result<(String, String)> {
    Ok(("physique".into(), serde_json::to_string(head)?))
}

/// Columns as comma-separated values.
pub(crate) fn csv(columns: &[Column]) -> Result<Vec<u8>> {
    let mut writer = csv::Writer::from_writer(Vec::new());
    writer.write_record(columns.iter().map(|column| &column.name))?;
    let rows = columns.first().map_or(0, Column::rows);
    for row in 0..rows {
        writer.write_record(columns.iter().map(|column| column.text(row)))?;
    }
    writer.into_inner().context("writing CSV")
}

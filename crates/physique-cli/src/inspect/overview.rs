//! Many files at a glance.

use std::collections::BTreeMap;
use std::fmt::Write as _;

use physique::inspect::{FileInspection, InspectReport, MotionInspection};

use super::full::rate;
use crate::text_table::{Column, render};

/// One line a motion.
pub(super) fn table(report: &InspectReport) -> String {
    let columns = [
        Column::words(&["file"]),
        Column::words(&["format"]),
        Column::number("", &["joints"]),
        Column::number("", &["frames"]),
        Column::number("", &["fps"]),
        Column::number("", &["s"]),
        Column::number("", &["tall", "m"]),
        Column::number("", &["way", "m"]),
        Column::number("", &["m/s"]),
        Column::words(&["warnings"]),
    ];
    let files = report.files.iter();
    let rows: Vec<Vec<String>> = files
        .flat_map(|file| {
            file_row(file)
                .into_iter()
                .chain(file.motions.iter().map(row))
        })
        .collect();
    render(&columns, &rows) + &totals(report)
}

/// A file without motions: a body, or nothing. Why nothing is told by `--warnings`.
fn file_row(file: &FileInspection) -> Option<Vec<String>> {
    let name = file.file.rsplit(['/', '\\']).next().unwrap_or(&file.file);
    let row = |format: &str, joints: String, remark: String| {
        let blank = std::iter::repeat_n("–".to_owned(), 6);
        let start = [name.to_owned(), format.to_owned(), joints];
        start.into_iter().chain(blank).chain([remark]).collect()
    };
    match (&file.body, &file.unreadable) {
        (Some(body), _) => Some(row(
            "body model",
            body.joints.to_string(),
            format!("{} vertices", body.vertices),
        )),
        (None, Some(_)) => Some(row("–", "–".into(), "unreadable".into())),
        (None, None) => None,
    }
}

fn row(motion: &MotionInspection) -> Vec<String> {
    let number = |value: Option<f64>, digits: usize| {
        value.map_or("–".to_owned(), |value| format!("{value:.digits$}"))
    };
    let movement = motion.movement.as_ref();
    let mut kinds: Vec<&str> = motion.warnings.iter().map(|warning| warning.kind).collect();
    kinds.dedup();
    vec![
        motion.name.clone(),
        motion.format.unwrap_or("–").to_owned(),
        motion
            .source
            .as_ref()
            .map_or(0, |source| source.joints)
            .to_string(),
        motion.frames.to_string(),
        rate(motion.frame_rate_fps).to_string(),
        format!("{:.1}", motion.seconds),
        number(motion.stature_m, 2),
        number(movement.map(|movement| movement.path_m), 1),
        number(movement.map(|movement| movement.mean_speed_m_s), 2),
        kinds.join(", "),
    ]
}

/// Only what looks wrong, with its sentences.
pub(super) fn warnings(report: &InspectReport) -> String {
    let mut text = String::new();
    for file in &report.files {
        if let Some(reason) = &file.unreadable {
            let _ = writeln!(text, "{}\n  unreadable: {reason}", file.file);
        }
        for motion in file
            .motions
            .iter()
            .filter(|motion| !motion.warnings.is_empty())
        {
            // Of several motions, the name tells which.
            let which = motion.name.split_once('#').map_or("", |(_, which)| which);
            let which = if which.is_empty() {
                String::new()
            } else {
                format!("#{which}")
            };
            let _ = writeln!(text, "{}{which}", file.file);
            for warning in &motion.warnings {
                let _ = writeln!(text, "  {}: {}", warning.kind, warning.message);
            }
        }
    }
    text + &totals(report)
}

fn totals(report: &InspectReport) -> String {
    let motions = || report.files.iter().flat_map(|file| &file.motions);
    let frames: usize = motions().map(|motion| motion.frames).sum();
    let seconds: f64 = motions().map(|motion| motion.seconds).sum();
    let mut kinds: BTreeMap<&str, usize> = BTreeMap::new();
    for motion in motions() {
        let mut of_motion: Vec<&str> = motion.warnings.iter().map(|w| w.kind).collect();
        of_motion.sort_unstable();
        of_motion.dedup();
        for kind in of_motion {
            *kinds.entry(kind).or_default() += 1;
        }
    }
    let with = motions()
        .filter(|motion| !motion.warnings.is_empty())
        .count();
    let mut text = format!(
        "{} files, {} motions, {frames} frames, {:.1} minutes; {with} motions with warnings",
        report.files.len(),
        motions().count(),
        seconds / 60.0
    );
    let kinds: Vec<String> = kinds
        .iter()
        .map(|(kind, count)| format!("{kind} {count}"))
        .collect();
    if !kinds.is_empty() {
        text += &format!(" ({})", kinds.join(", "));
    }
    match report
        .files
        .iter()
        .filter(|file| file.unreadable.is_some())
        .count()
    {
        0 => {}
        unreadable => text += &format!("; {unreadable} unreadable"),
    }
    text + ".\n"
}

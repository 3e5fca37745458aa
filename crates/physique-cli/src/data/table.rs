//! The report of a build for people.

use physique_data::report::Amount;
use physique_data::{BuildReport, Reason};

use crate::text_table::{Column, render};

pub(super) fn print(report: &BuildReport) {
    println!(
        "{} motions found, {} kept: {:.2} hours recorded",
        report.found, report.recorded.clips, report.recorded.hours
    );
    println!(
        "{} captions to train with, {} held out",
        report.training_captions, report.held_out_captions
    );
    let row = |name: String, amount: &Amount| {
        vec![
            name,
            amount.clips.to_string(),
            format!("{:.2}", amount.hours),
        ]
    };
    let mut rows: Vec<Vec<String>> = report
        .splits
        .iter()
        .map(|(split, amount)| row(split.name().to_owned(), amount))
        .collect();
    for (label, values) in &report.labels {
        rows.push(vec![label.clone(), String::new(), String::new()]);
        rows.extend(
            values
                .iter()
                .map(|(value, amount)| row(format!("  {value}"), amount)),
        );
    }
    let columns = [
        Column::words(&["with mirror images"]),
        Column::number("", &["clips"]),
        Column::number("", &["hours"]),
    ];
    print!("{}", render(&columns, &rows));
    let left_out = report.left_out_by_reason();
    if !left_out.is_empty() {
        println!("left out:");
    }
    for reason in Reason::ALL {
        let Some(count) = left_out.get(&reason) else {
            continue;
        };
        let first = report.left_out.iter().find(|of| of.reason == reason);
        let first = first.map_or_else(String::new, |of| format!(" ({}: {})", of.name, of.message));
        println!("  {count} {}{first}", reason.name());
    }
    if report.unnamed_files > 0 {
        let count = report.unnamed_files;
        println!("note: {count} more files could hold motions, but the recipe does not name them");
    }
    for note in &report.notes {
        println!("note: {note}");
    }
}

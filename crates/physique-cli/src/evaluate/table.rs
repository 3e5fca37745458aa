//! The paper's table.

use physique_learn::evaluation::{EvaluationRow, Interval};

use crate::text_table::{Column, render};

pub(super) fn print(rows: &[EvaluationRow]) {
    let columns = [
        Column::words(&["motions"]),
        Column::number("R-precision", &["top 1"]),
        Column::number("R-precision", &["top 2"]),
        Column::number("R-precision", &["top 3"]),
        Column::number("", &["FID"]),
        Column::number("", &["distance", "to text"]),
        Column::number("", &["diversity"]),
        Column::number("", &["multi-", "modality"]),
        Column::number("", &["SI", "cm³"]),
    ];
    let cells = rows.iter().map(|row| {
        let [first, second, third] = row.r_precision;
        vec![
            row.name.clone(),
            thousandths(first),
            thousandths(second),
            thousandths(third),
            thousandths(row.fid),
            thousandths(row.multimodal_distance),
            thousandths(row.diversity),
            row.multimodality.map_or_else(dash, thousandths),
            row.self_intersection_cm3.map_or_else(dash, whole),
        ]
    });
    print!("{}", render(&columns, &cells.collect::<Vec<_>>()));
    for row in rows.iter().filter(|row| !row.remarks.is_empty()) {
        println!("{}: {}.", row.name, row.remarks.join("; "));
    }
}

fn dash() -> String {
    "-".into()
}

/// As papers write it: `.511±.003`.
fn thousandths(interval: Interval) -> String {
    let short = |value: f64| {
        let text = format!("{value:.3}");
        text.strip_prefix('0').map(str::to_owned).unwrap_or(text)
    };
    format!("{}±{}", short(interval.mean), short(interval.half_width))
}

fn whole(interval: Interval) -> String {
    format!("{:.0}±{:.0}", interval.mean, interval.half_width)
}

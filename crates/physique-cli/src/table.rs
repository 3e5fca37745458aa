//! Scores as a table that a person likes to read.

use comfy_table::{Cell, CellAlignment, Color, ContentArrangement, LineStyle, Table, TableStyle};
use physique::report::MotionReport;
use physique::{MotionScore, Protocol, Report};

/// Three rules, as in a printed table.
const STYLE: TableStyle = TableStyle::new()
    .top_border(LineStyle::none().fill('─').junction('─'))
    .header_separator(LineStyle::none().fill('─').junction('─'))
    .bottom_border(LineStyle::none().fill('─').junction('─'));

/// A report as a table with a line about the body; only the `worst` motions, worst first, if asked.
pub(crate) fn table(report: &Report, worst: Option<usize>) -> String {
    let body = &report.body;
    let mut table = Table::new();
    table.load_style(STYLE);
    table.set_content_arrangement(ContentArrangement::Dynamic);
    let figures: &[&str] = match report.protocol {
        Protocol::Native => &[
            "self-intersection\nmean, cm³",
            "worst\ncm³",
            "at\ns",
            "frames above\n50 cm³, %",
            "creases\nmean, cm³",
            "in ground\nmean, cm",
            "floating\nmean, cm",
            "sliding\ncm/s",
            "jerk\nm/s³",
        ],
        Protocol::Sia => &["SI mean\ncm³ of the ball", "SI\n% of volume"],
    };
    let mut header = vec!["motion", "length\ns"];
    header.extend(figures);
    header.push(match report.protocol {
        Protocol::Native => "worst pair\nmean, cm³",
        Protocol::Sia => "remarks",
    });
    table.set_header(header);
    for motion in shown(report, worst) {
        table.add_row(row(motion, report.protocol, figures.len()));
    }
    for column in 1..=figures.len() + 1 {
        if let Some(column) = table.column_mut(column) {
            column.set_cell_alignment(CellAlignment::Right);
        }
    }
    format!(
        "{table}\n{} on the {} of {:.2} m and {:.0} kg.\n",
        counted(report),
        body.model,
        body.stature_m,
        body.mass_kg
    )
}

/// All motions in order; or those without a score and the worst ones, worst first.
fn shown(report: &Report, worst: Option<usize>) -> Vec<&MotionReport> {
    let mut motions: Vec<_> = report.motions.iter().collect();
    if let Some(worst) = worst {
        // Stable: equally bad motions stay in order.
        motions.sort_by(|a, b| badness(b).total_cmp(&badness(a)));
        motions.truncate(worst);
    }
    motions
}

/// Mean self-intersection; what could not be scored is worst.
fn badness(motion: &MotionReport) -> f64 {
    let Some(score) = &motion.score else {
        return f64::INFINITY;
    };
    let native = score.self_intersection.as_ref().map(|found| found.mean_cm3);
    let sia = score.sia.as_ref().map(|found| found.self_intersection_cm3);
    native.or(sia).unwrap_or(f64::INFINITY)
}

fn counted(report: &Report) -> String {
    let scored = report
        .motions
        .iter()
        .filter_map(|motion| motion.score.as_ref());
    let (count, frames) = scored.fold((0, 0), |(count, frames), score| {
        (count + 1, frames + score.frames)
    });
    let missing = match report.motions.len() - count {
        0 => String::new(),
        missing => format!(" ({missing} not scored)"),
    };
    format!("{count} motions, {frames} frames{missing}")
}

fn row(motion: &MotionReport, protocol: Protocol, figures: usize) -> Vec<Cell> {
    let mut row = vec![Cell::new(short_name(&motion.file))];
    let Some(score) = &motion.score else {
        row.extend((0..=figures).map(|_| Cell::new("–")));
        let reason = motion.unscorable.as_deref().unwrap_or("not scored");
        row.push(Cell::new(reason).fg(Color::Red));
        return row;
    };
    row.push(Cell::new(format!("{:.1}", score.duration_s)));
    match protocol {
        Protocol::Native => native(score, &mut row),
        Protocol::Sia => sia(score, &mut row),
    }
    row
}

fn native(score: &MotionScore, row: &mut Vec<Cell>) {
    let Some(found) = &score.self_intersection else {
        return;
    };
    let worst = found.pairs.iter().find(|pair| !pair.crease);
    let pair = worst.map_or(String::new(), |pair| {
        format!("{} – {} {:.1}", pair.parts[0], pair.parts[1], pair.mean_cm3)
    });
    row.extend([
        Cell::new(format!("{:.1}", found.mean_cm3)),
        Cell::new(format!("{:.0}", found.worst_cm3)),
        Cell::new(format!("{:.2}", found.worst_s)),
        Cell::new(format!("{:.0}", found.frames_above_50_cm3_percent)),
        Cell::new(format!("{:.0}", found.crease_mean_cm3)),
    ]);
    row.extend(physics(score));
    row.push(Cell::new(pair));
}

/// Ground, feet and smoothness; a dash for what the clip does not have. Balance stays in the JSON
/// until its figures on mapped walking are understood.
fn physics(score: &MotionScore) -> [Cell; 4] {
    let found = score.physics.as_ref();
    let smoothness = found.and_then(|found| found.smoothness.as_ref());
    let cell = |value: Option<f64>, digits| match value {
        Some(value) => Cell::new(format!("{value:.digits$}")),
        None => Cell::new("–"),
    };
    [
        cell(found.map(|found| found.ground.penetration_mean_cm), 1),
        cell(found.map(|found| found.ground.floating_mean_cm), 1),
        cell(found.map(|found| found.feet.slide_mean_cm_s), 1),
        cell(smoothness.map(|smoothness| smoothness.jerk_mean_m_s3), 0),
    ]
}

fn sia(score: &MotionScore, row: &mut Vec<Cell>) {
    let Some(found) = &score.sia else { return };
    row.extend([
        Cell::new(format!("{:.0}", found.self_intersection_cm3)),
        Cell::new(format!("{:.2}", found.self_intersection_percent)),
        Cell::new(""),
    ]);
}

/// The last part of a path: what tells the rows apart.
fn short_name(file: &str) -> &str {
    file.rsplit(['/', '\\']).next().unwrap_or(file)
}

//! Scores as a table that a person likes to read.

use physique::report::MotionReport;
use physique::{Group, MotionScore, Protocol, Report};

use crate::text_table::{Column, render};

/// A report as tables with a line about the body; only the `worst` motions, worst first, if asked.
pub(crate) fn table(report: &Report, worst: Option<usize>) -> String {
    let motions = shown(report, worst);
    let mut text = String::new();
    for &protocol in &report.head.protocols {
        text += &match protocol {
            Protocol::Native => native(&motions, &report.head.groups),
            Protocol::Sia => sia(&motions),
            Protocol::Published(_) => published(&motions, protocol),
        };
    }
    for motion in &motions {
        if let Some(reason) = &motion.unscorable {
            text += &format!("not scored: {}: {reason}\n", motion.name);
        }
    }
    let body = &report.head.body;
    text + &format!(
        "{} on the {} of {:.2} m and {:.0} kg.\n",
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

/// Mean self-intersection, where it was measured, else depth in the ground and sliding; what could
/// not be scored is worst.
fn badness(motion: &MotionReport) -> f64 {
    let Some(score) = &motion.score else {
        return f64::INFINITY;
    };
    let native = score.self_intersection.as_ref().map(|found| found.mean_cm3);
    let sia = score.sia.as_ref().map(|found| found.self_intersection_cm3);
    let ground = score.ground.as_ref().map(|found| found.penetration_mean_cm);
    let feet = score.feet.as_ref().map(|found| found.slide_mean_cm_s);
    native.or(sia).or(ground).or(feet).unwrap_or(0.0)
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

/// A column and how to fill it.
type Figure = (Column, fn(&MotionScore) -> Option<String>);

/// Physique's own measures, grouped.
fn native(motions: &[&MotionReport], groups: &[Group]) -> String {
    let figures: Vec<Figure> = groups.iter().flat_map(|&group| figures(group)).collect();
    let mut columns = vec![
        Column::words(&["motion"]),
        Column::number("", &["length", "s"]),
    ];
    columns.extend(figures.iter().map(|(column, _)| column.clone()));
    let with_pair = groups.contains(&Group::SelfIntersection);
    if with_pair {
        columns.push(Column::words(&["worst pair"]));
    }
    let rows = motions.iter().map(|motion| {
        let score = motion.score.as_ref();
        let length = score.map(|score| format!("{:.1}", score.duration_s));
        let mut row = vec![motion.name.clone(), or_dash(length)];
        let cells = figures
            .iter()
            .map(|(_, figure)| or_dash(score.and_then(figure)));
        row.extend(cells);
        if with_pair {
            row.push(score.map_or(String::new(), worst_pair));
        }
        row
    });
    render(&columns, &rows.collect::<Vec<_>>())
}

/// The figures of a group that a table shows.
fn figures(group: Group) -> Vec<Figure> {
    match group {
        Group::SelfIntersection => {
            let number = |heading: [&str; 2]| Column::number("self-intersection", &heading);
            vec![
                (number(["mean", "cm³"]), |score| {
                    Some(format!("{:.1}", score.self_intersection.as_ref()?.mean_cm3))
                }),
                (number(["worst", "cm³"]), |score| {
                    Some(format!(
                        "{:.0}",
                        score.self_intersection.as_ref()?.worst_cm3
                    ))
                }),
            ]
        }
        Group::Ground => {
            let number = |heading: [&str; 2]| Column::number("ground", &heading);
            vec![
                (number(["in", "cm"]), |score| {
                    Some(format!("{:.1}", score.ground.as_ref()?.penetration_mean_cm))
                }),
                (number(["above", "cm"]), |score| {
                    Some(format!("{:.1}", score.ground.as_ref()?.floating_mean_cm))
                }),
            ]
        }
        Group::Feet => vec![(Column::number("feet", &["slide", "cm/s"]), |score| {
            Some(format!("{:.1}", score.feet.as_ref()?.slide_mean_cm_s))
        })],
        Group::Balance => vec![(Column::number("balance", &["in base", "%"]), |score| {
            Some(format!("{:.0}", score.balance.as_ref()?.stable_percent?))
        })],
        Group::Smoothness => vec![(Column::number("", &["jerk", "m/s³"]), |score| {
            Some(format!("{:.0}", score.smoothness.as_ref()?.jerk_mean_m_s3))
        })],
    }
}

fn or_dash(cell: Option<String>) -> String {
    cell.unwrap_or_else(|| "–".to_owned())
}

/// Names of the parts, with L and R for left and right.
fn worst_pair(score: &MotionScore) -> String {
    let pairs = score.self_intersection.as_ref().map(|found| &found.pairs);
    let worst = pairs.and_then(|pairs| pairs.iter().find(|pair| !pair.crease));
    worst.map_or(String::new(), |pair| {
        let [one, other] = [0, 1].map(|index| {
            let part: &str = &pair.parts[index];
            part.replace("left ", "L ").replace("right ", "R ")
        });
        format!("{one} – {other}")
    })
}

fn sia(motions: &[&MotionReport]) -> String {
    let columns = [
        Column::words(&["motion"]),
        Column::number("sia", &["mean, cm³", "of the unit ball"]),
        Column::number("sia", &["% of", "volume"]),
    ];
    let rows = motions.iter().map(|motion| {
        let found = motion.score.as_ref().and_then(|score| score.sia);
        vec![
            motion.name.clone(),
            or_dash(found.map(|found| format!("{:.0}", found.self_intersection_cm3))),
            or_dash(found.map(|found| format!("{:.2}", found.self_intersection_percent))),
        ]
    });
    render(&columns, &rows.collect::<Vec<_>>())
}

/// The measures of another protocol under their own names, a word a line.
fn published(motions: &[&MotionReport], protocol: Protocol) -> String {
    let Protocol::Published(names) = protocol else {
        return String::new();
    };
    let names = names.measure_names();
    let mut columns = vec![Column::words(&["motion"])];
    columns.extend(names.iter().map(|name| {
        let (name, unit) = name_and_unit(name);
        let words: Vec<_> = name.split('_').chain([unit]).collect();
        Column::number(protocol.name(), &words)
    }));
    let rows = motions.iter().map(|motion| {
        let score = motion.score.as_ref();
        let found = score.and_then(|score| {
            let mut published = score.published.iter();
            published.find(|published| published.protocol == protocol)
        });
        let value = |name: &&str| {
            let value = found.and_then(|found| *found.measures.get(*name)?);
            or_dash(value.map(|value| format!("{value:.3}")))
        };
        let mut row = vec![motion.name.clone()];
        row.extend(names.iter().map(value));
        row
    });
    render(&columns, &rows.collect::<Vec<_>>())
}

/// Units as names end in them, and as people write them; longer ones first.
const UNITS: [(&str, &str); 10] = [
    ("_cm_per_frame", "cm/frame"),
    ("_mm_per_frame", "mm/frame"),
    ("_m_s2", "m/s²"),
    ("_cm_s", "cm/s"),
    ("_m_s", "m/s"),
    ("_percent", "%"),
    ("_cm", "cm"),
    ("_mm", "mm"),
    ("_m", "m"),
    ("_ratio", "ratio"),
];

fn name_and_unit(name: &str) -> (&str, &str) {
    let mut units = UNITS.into_iter();
    units
        .find_map(|(ending, unit)| Some((name.strip_suffix(ending)?, unit)))
        .unwrap_or((name, ""))
}

//! Repairs as tables that a person likes to read.

use physique::MotionScore;
use physique::measures::measures;
use physique::repair::{Outcome, PROMISE, RepairedMotion};

use crate::text_table::{Column, render};

/// Everything about one repair: the measures of the promise before and after, what was done, and
/// what held it back.
pub(crate) fn of_one(motion: &RepairedMotion) -> String {
    let (Some(before), Some(after)) = (&motion.before, &motion.after) else {
        return String::new();
    };
    let columns = [
        Column::words(&["measure"]),
        Column::number("", &["before"]),
        Column::number("", &["after"]),
    ];
    let rows = PROMISE.iter().filter_map(|promise| {
        let figure = |score| value(score, promise.measure);
        let (before, after) = (figure(before)?, figure(after));
        let after = after.map_or("–".to_owned(), |after| format!("{after:.2}"));
        Some(vec![
            promise.measure.to_owned(),
            format!("{before:.2}"),
            after,
        ])
    });
    let mut text = render(&columns, &rows.collect::<Vec<_>>());
    if let Some(change) = &motion.change
        && change.frames_percent > 0.0
    {
        text += &format!(
            "{:.0} % of the frames changed; joints turned by {:.1}° on average and {:.0}° at most, the root \
             moved by {:.1} cm.\n",
            change.frames_percent,
            change.mean_turn_degrees,
            change.greatest_turn_degrees,
            change.mean_displacement_cm
        );
        if change.touching_frames > 0 {
            text += &format!(
                "Hands keep touching where they do: in {} frames.\n",
                change.touching_frames
            );
        }
    }
    text
}

/// What to say of how it ended, beside the figures.
pub(crate) fn verdict(motion: &RepairedMotion) -> String {
    let worse: Vec<_> = motion
        .held_back_by
        .iter()
        .map(ToString::to_string)
        .collect();
    let worse = worse.join(", ");
    match motion.outcome {
        Outcome::Sound => "Nothing is worth a change: the motion stays as it is.".to_owned(),
        Outcome::Repaired => "Repaired; no measure got worse.".to_owned(),
        Outcome::RepairedInPart => {
            format!("Repaired in part: going further would have brought {worse}.")
        }
        Outcome::HeldBack => {
            format!(
                "Held back: every repair would have brought {worse}. The motion stays as it is."
            )
        }
        Outcome::Failed => {
            let reason = motion.failure.as_deref().unwrap_or_default();
            format!("not repaired: {}: {reason}", motion.file)
        }
    }
}

/// A measure that the table of many motions shows before and after.
struct Shown {
    band: &'static str,
    measure: &'static str,
    digits: usize,
}

const SHOWN: [Shown; 6] = [
    Shown::new("self, cm³", "self_intersection_mean_cm3", 1),
    Shown::new("in ground, cm", "ground_penetration_mean_cm", 1),
    Shown::new("above, cm", "ground_floating_mean_cm", 1),
    Shown::new("slide, cm/s", "feet_slide_mean_cm_s", 1),
    Shown::new("in base, %", "balance_stable_percent", 0),
    Shown::new("jerk, m/s³", "smoothness_jerk_mean_m_s3", 0),
];

impl Shown {
    const fn new(band: &'static str, measure: &'static str, digits: usize) -> Self {
        Self {
            band,
            measure,
            digits,
        }
    }
}

/// One row a motion, and how they ended.
pub(crate) fn of_many(motions: &[RepairedMotion]) -> String {
    let mut columns = vec![Column::words(&["motion"])];
    for shown in &SHOWN {
        columns.push(Column::number(shown.band, &["before"]));
        columns.push(Column::number(shown.band, &["after"]));
    }
    columns.push(Column::words(&["outcome"]));
    let rows = motions.iter().map(|motion| {
        let mut row = vec![motion.name.clone()];
        for shown in &SHOWN {
            for score in [&motion.before, &motion.after] {
                let figure = score.as_ref().and_then(|score| value(score, shown.measure));
                row.push(figure.map_or("–".to_owned(), |figure| {
                    format!("{figure:.*}", shown.digits)
                }));
            }
        }
        row.push(motion.outcome.words().to_owned());
        row
    });
    render(&columns, &rows.collect::<Vec<_>>())
}

fn value(score: &MotionScore, name: &str) -> Option<f64> {
    let measures = measures(score);
    let found = measures.iter().find(|(measure, _)| *measure == name);
    found.map(|(_, value)| *value)
}

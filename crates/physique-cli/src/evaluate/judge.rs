//! `--judge`: is it what was asked for?

use anyhow::{Context, Result};
use indicatif::{ProgressBar, ProgressStyle};
use physique_data::{Dataset, Split, Wording};
use physique_learn::evaluation::judge::{
    ContentJudge, JudgeAccuracy, Trial, TrialOptions, TrialReport, TrialRow,
};
use physique_learn::evaluation::{MotionGenerator, TextToMotionGenerator};
use serde::Serialize;

use super::arguments::EvaluateArguments;
use crate::text_table::{Column, render};

/// Motions that are generated at once.
const TOGETHER: usize = 20;

/// What the judge says of a network.
#[derive(Debug, Serialize)]
pub(super) struct Judged {
    name: String,
    about: String,
    #[serde(flatten)]
    trial: TrialReport,
}

/// Judges each network with training wordings and with held-out ones.
pub(super) fn judge(
    arguments: &EvaluateArguments,
    dataset: &Dataset,
    models: &[TextToMotionGenerator],
) -> Result<Vec<Judged>> {
    let Some(label) = &arguments.judge.judge else {
        return Ok(Vec::new());
    };
    let judge = ContentJudge::of_dataset(dataset, Split::Train, label)?;
    if models.is_empty() {
        let accuracy = judge.accuracy(dataset, Split::Validation, label)?;
        println!("The judge is right about {accuracy}.");
    }
    let mut judged = Vec::new();
    for model in models {
        for wording in [Wording::Training, Wording::HeldOut] {
            let options = TrialOptions {
                label: label.clone(),
                values: arguments.judge.values,
                samples: arguments.judge.samples,
                wording,
                seed: arguments.seed,
            };
            let trial = Trial::new(dataset, &options);
            let trial = trial.with_context(|| format!("--judge {label}"))?;
            let bar = bar(trial.prompts.len(), model.name());
            let mut motions = Vec::new();
            for prompts in trial.prompts.chunks(TOGETHER) {
                motions.extend(model.generate_cut(prompts)?);
                bar.inc(prompts.len() as u64);
            }
            bar.finish_and_clear();
            judged.push(Judged {
                name: model.name().to_owned(),
                about: model.about(),
                trial: trial.report(dataset, &judge, &motions)?,
            });
        }
    }
    Ok(judged)
}

fn bar(motions: usize, name: &str) -> ProgressBar {
    let bar = ProgressBar::new(motions as u64);
    // A constant template; were it wrong, indicatif's own style would show.
    let template = "{bar:40} {pos}/{len} motions, {msg}, {elapsed} (left: {eta})";
    if let Ok(style) = ProgressStyle::with_template(template) {
        bar.set_style(style);
    }
    bar.set_message(name.to_owned());
    bar.enable_steady_tick(std::time::Duration::from_millis(200));
    bar
}

pub(super) fn print(judged: &[Judged]) {
    let columns = [
        Column::words(&["asked for"]),
        Column::number("", &["right"]),
        Column::number("", &["other", "side"]),
        Column::number("jerk", &["m/s³"]),
        Column::number("jerk", &["of real"]),
        Column::number("foot slide", &["cm/s"]),
        Column::number("foot slide", &["of real"]),
        Column::words(&["taken for"]),
    ];
    for Judged { name, trial, .. } in judged {
        let wording = match trial.wording {
            Wording::Training => "training wordings",
            Wording::HeldOut => "held-out wordings",
        };
        println!(
            "{name}, {wording}; the judge is right about {}",
            trial.judge
        );
        if !trial.judge.is_trusted() {
            let (share, clips) = JudgeAccuracy::TRUSTED;
            println!(
                "Not to be relied on: a judge should be right about {:.0} % of {clips} clips or more.",
                100.0 * share
            );
        }
        let rows = trial.rows.iter().chain([&trial.all]);
        print!("{}", render(&columns, &rows.map(cells).collect::<Vec<_>>()));
    }
}

fn cells(row: &TrialRow) -> Vec<String> {
    let ratio = |value: f64, real: f64| format!("{:.2}", value / real);
    let mut others: Vec<_> = row.taken_for.iter().collect();
    others.sort_by_key(|(_, count)| std::cmp::Reverse(**count));
    let others = others.iter().take(2);
    let others = others.map(|(label, count)| format!("{label} {count}"));
    vec![
        row.value.clone(),
        format!("{}/{}", row.right, row.samples),
        row.swapped.to_string(),
        format!("{:.0}", row.quality.jerk_m_s3),
        ratio(row.quality.jerk_m_s3, row.real.jerk_m_s3),
        format!("{:.1}", 100.0 * row.quality.foot_slide_m_s),
        ratio(row.quality.foot_slide_m_s, row.real.foot_slide_m_s),
        others.collect::<Vec<_>>().join(", "),
    ]
}

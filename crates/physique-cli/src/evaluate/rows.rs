//! The rows of the table.

use anyhow::Result;
use indicatif::{ProgressBar, ProgressStyle};
use physique_data::Dataset;
use physique_learn::evaluation::{
    EvaluationProtocol, EvaluationRow, MotionGenerator, MultimodalityOptions, PairEvaluator,
    ProtocolOptions, RepetitionMeasures, SelfIntersectionMeter, TextToMotionGenerator,
};
use serde::Serialize;

use super::arguments::EvaluateArguments;
use super::journal::Journal;

/// Row of the real motions.
const REAL: &str = "Real";

/// The table and what it was made by.
#[derive(Debug, Serialize)]
pub(super) struct Evaluation {
    /// The evaluator, in words.
    evaluator: String,
    protocol: ProtocolOptions,
    /// Body that self-intersection is measured on.
    body: Option<String>,
    pub(super) rows: Vec<EvaluationRow>,
}

pub(super) fn measure(
    arguments: &EvaluateArguments,
    dataset: &Dataset,
    evaluator: &dyn PairEvaluator,
    models: &[TextToMotionGenerator],
) -> Result<Evaluation> {
    let options = options(arguments);
    let meter = match arguments.protocol.no_self_intersection {
        true => None,
        false => Some(SelfIntersectionMeter::new(arguments.body.body()?)?),
    };
    let protocol = EvaluationProtocol::new(dataset, evaluator, meter.as_ref(), options.clone())?;
    let body = meter.is_some().then(|| arguments.body.body.clone());
    let settings = (&options, evaluator.about(), &body, &arguments.data);
    let about: Vec<String> = models.iter().map(MotionGenerator::about).collect();
    let settings = serde_json::to_string(&(settings, about))?;
    let journal = Journal::open(arguments.json.as_deref(), settings)?;
    let rows = Rows {
        bar: bar(&protocol, models.len()),
        protocol,
        journal,
        repetitions: options.repetitions,
    };
    let mut found = vec![
        rows.row(REAL, &dataset.index().name, |protocol, repetition, _| {
            protocol.real(repetition)
        })?,
    ];
    for model in models {
        found.push(rows.row(
            model.name(),
            &model.about(),
            |protocol, repetition, told| protocol.generated(model, repetition, told),
        )?);
    }
    rows.bar.finish_and_clear();
    Ok(Evaluation {
        evaluator: evaluator.about(),
        protocol: options,
        body,
        rows: found,
    })
}

fn options(arguments: &EvaluateArguments) -> ProtocolOptions {
    let protocol = &arguments.protocol;
    ProtocolOptions {
        split: arguments.split.into(),
        repetitions: protocol.repetitions,
        generated: protocol.motions,
        multimodality: (protocol.multimodality > 0).then(|| MultimodalityOptions {
            repetitions: protocol.multimodality,
            ..MultimodalityOptions::default()
        }),
        caption_length_bug: protocol.caption_length_bug,
        seed: arguments.seed,
        ..ProtocolOptions::default()
    }
}

/// Counts motions of all rows and repetitions.
fn bar(protocol: &EvaluationProtocol<'_>, models: usize) -> ProgressBar {
    let repetitions = protocol.options().repetitions;
    let of_a_model = (0..repetitions).map(|repetition| protocol.motions_to_generate(repetition));
    let generated = models * of_a_model.sum::<usize>();
    let bar = ProgressBar::new((generated + repetitions) as u64);
    // A constant template; were it wrong, indicatif's own style would show.
    let template = "{bar:40} {pos}/{len} motions, {msg}, {elapsed} (left: {eta})";
    if let Ok(style) = ProgressStyle::with_template(template) {
        bar.set_style(style);
    }
    bar.enable_steady_tick(std::time::Duration::from_millis(200));
    bar
}

struct Rows<'a> {
    protocol: EvaluationProtocol<'a>,
    journal: Journal,
    bar: ProgressBar,
    repetitions: usize,
}

impl<'a> Rows<'a> {
    fn row(
        &self,
        name: &str,
        about: &str,
        measure: impl Fn(
            &EvaluationProtocol<'a>,
            usize,
            &mut dyn FnMut(usize),
        ) -> Result<RepetitionMeasures, physique_learn::Error>,
    ) -> Result<EvaluationRow> {
        let mut measures = Vec::with_capacity(self.repetitions);
        for repetition in 0..self.repetitions {
            let message = format!("{name}, repetition {}", repetition + 1);
            self.bar.set_message(message);
            if let Some(known) = self.journal.known(name, repetition) {
                let skipped = match name {
                    REAL => 1,
                    _ => self.protocol.motions_to_generate(repetition),
                };
                self.bar.inc(skipped as u64);
                self.bar.reset_eta();
                measures.push(known);
                continue;
            }
            let mut told = |motions: usize| self.bar.inc(motions as u64);
            let found = measure(&self.protocol, repetition, &mut told)?;
            if name == REAL {
                self.bar.inc(1);
            }
            self.journal.keep(name, &found)?;
            measures.push(found);
        }
        Ok(self.protocol.row(name, about, &measures))
    }
}

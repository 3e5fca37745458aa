//! What was found, as JSON.

use std::path::Path;

use anyhow::Result;
use physique_data::{Dataset, Split};
use physique_learn::diffusion::GuideWeights;
use serde::Serialize;

use super::arguments::EvaluateArguments;
use super::judge::Judged;
use super::rows::Evaluation;

/// The file of `--json`.
#[derive(Debug, Serialize)]
pub(super) struct EvaluationReport {
    version: u32,
    physique_version: &'static str,
    data: Data,
    seed: u64,
    sampling: Sampling,
    pub(super) evaluation: Option<Evaluation>,
    pub(super) judge: Vec<Judged>,
}

#[derive(Debug, Serialize)]
struct Data {
    name: String,
    licence: String,
    file: String,
    split: Split,
    clips: usize,
}

#[derive(Debug, Serialize)]
struct Sampling {
    guidance: f64,
    /// Null: all that a network was trained with.
    steps: Option<usize>,
    /// Share of the noise; null: drawn from the posterior.
    ddim: Option<f64>,
    guides: GuideWeights,
    /// Cutoff of the low-pass filter; null: none.
    smooth_hz: Option<f64>,
}

impl EvaluationReport {
    pub(super) fn new(arguments: &EvaluateArguments, dataset: &Dataset) -> Self {
        let (index, split) = (dataset.index(), Split::from(arguments.split));
        Self {
            version: 1,
            physique_version: env!("CARGO_PKG_VERSION"),
            data: Data {
                name: index.name.clone(),
                licence: index.licence.clone(),
                file: arguments.data.display().to_string(),
                split,
                clips: dataset.clips_of(split).count(),
            },
            seed: arguments.seed,
            sampling: Sampling {
                guidance: arguments.sampling.guidance,
                steps: arguments.sampling.steps,
                ddim: arguments.sampling.ddim,
                guides: arguments.sampling.guide,
                smooth_hz: arguments.sampling.smooth.filter(|&cutoff| cutoff != 0.0),
            },
            evaluation: None,
            judge: Vec::new(),
        }
    }

    pub(super) fn write(&self, file: &Path) -> Result<()> {
        let text = serde_json::to_string_pretty(self)? + "\n";
        Ok(physique_files::write_file(file, text.as_bytes())?)
    }
}

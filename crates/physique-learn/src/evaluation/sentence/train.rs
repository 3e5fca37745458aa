//! From a data file to an evaluator.

use std::collections::BTreeMap;
use std::path::Path;

use burn::tensor::Device;
use physique_data::{Dataset, SamplerOptions, Split};
use physique_files::{FileError, write_file};
use physique_text::{MiniLm, TextEncoder as _};
use serde::Serialize;

use super::{SentenceConfig, SentenceEvaluator, SentenceNetworks, SentenceTask, SentenceTraining};
use crate::Error;
use crate::data::CaptionedMotions;
use crate::text::{CaptionCentre, Embeddings, PromptEncoder};
use crate::trainer::{AdamWConfig, RateSchedule, StepReport, Trainer, TrainerConfig};

/// How an evaluator is trained on a data file.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct EvaluatorRun {
    /// Shape of the networks; `None`: [`SentenceConfig::small`].
    pub networks: Option<SentenceConfig>,
    /// The task.
    pub training: SentenceTraining,
    /// The run.
    pub trainer: TrainerConfig,
}

impl Default for EvaluatorRun {
    /// 3,000 steps: some minutes on a core.
    fn default() -> Self {
        Self {
            networks: None,
            training: SentenceTraining::default(),
            trainer: TrainerConfig {
                steps: 3000,
                seed: 10,
                optimiser: AdamWConfig {
                    rate: 1e-3,
                    weight_decay: 0.01,
                    ..AdamWConfig::default()
                },
                rate: RateSchedule::WarmUpThenCosine {
                    warm_up: 100,
                    final_share: 0.05,
                },
                clip: Some(0.5),
                average: Some(0.99),
                save_every: 500,
                log_every: 10,
                ..TrainerConfig::default()
            },
        }
    }
}

/// What must not change while a run goes on, besides the trainer's own settings.
#[derive(Serialize)]
struct Settings<'a> {
    data: &'a str,
    networks: &'a SentenceConfig,
    training: &'a SentenceTraining,
}

/// Trains an evaluator on the training split of a data file, in `folder/run`, and writes it into
/// `folder`. A run that was stopped or killed goes on where it was; `observe` may stop it by
/// returning false, and `None` is returned.
///
/// The result depends on data and settings only. Cost: with the default settings some 0.2 s a step.
///
/// # Errors
/// [`Error::Input`] for data without captions; [`Error::Checkpoint`] where the folder holds a run
/// with other settings; those of [`Trainer`].
pub fn train_evaluator(
    dataset: &Dataset,
    run: &EvaluatorRun,
    folder: &Path,
    device: &Device,
    observe: impl FnMut(&StepReport) -> bool,
) -> Result<Option<SentenceEvaluator>, Error> {
    let prompts = prompts(dataset)?;
    let columns = dataset.skeleton().feature_count();
    let networks = run.networks.clone();
    let networks =
        networks.unwrap_or_else(|| SentenceConfig::small(columns, prompts.encoder().width()));
    let run_folder = folder.join("run");
    keep_settings(
        &run_folder,
        &Settings {
            data: &dataset.index().name,
            networks: &networks,
            training: &run.training,
        },
    )?;
    let source = CaptionedMotions::new(dataset, SamplerOptions::default(), Some(&prompts))?;
    let device = device.clone().autodiff();
    let task = SentenceTask::new(source, run.training, &device)?;
    let network = SentenceNetworks::new(&networks, run.trainer.seed, &device)?;
    let mut trainer = Trainer::open(task, network, run.trainer.clone(), &run_folder)?;
    trainer.run(observe)?;
    let steps = trainer.steps_done();
    let network = trainer.network();
    drop(trainer);
    if steps < run.trainer.steps {
        return Ok(None);
    }
    let index = dataset.index();
    let notes = [
        ("data", index.name.clone()),
        ("licence", index.licence.clone()),
        ("steps", steps.to_string()),
        ("seed", run.trainer.seed.to_string()),
    ];
    let notes: BTreeMap<String, String> = notes
        .into_iter()
        .map(|(name, note)| (name.to_owned(), note))
        .collect();
    let statistics = dataset.statistics().clone();
    let evaluator = SentenceEvaluator::new(network, statistics, prompts, notes)?;
    evaluator.write(folder)?;
    Ok(Some(evaluator))
}

/// The embedded encoder, centred at the captions of the training split.
fn prompts(dataset: &Dataset) -> Result<PromptEncoder, Error> {
    let index = dataset.index();
    let mut captions: Vec<usize> = dataset
        .clips_of(Split::Train)
        .flat_map(|clip| &index.caption_sets[index.clips[clip].captions].training)
        .copied()
        .collect();
    captions.sort_unstable();
    captions.dedup();
    let texts: Vec<&str> = captions
        .iter()
        .map(|&caption| index.captions[caption].text.as_str())
        .collect();
    let encoder = MiniLm::embedded()?;
    let centre = CaptionCentre::of(&Embeddings::from(&encoder.encode(&texts)))?;
    PromptEncoder::new(Box::new(encoder), Some(centre))
}

/// Writes the settings of a new run, or holds them against those of the run that is there.
fn keep_settings(folder: &Path, settings: &Settings<'_>) -> Result<(), Error> {
    let path = folder.join("settings.json");
    let io = |path: &Path, problem| FileError::Io {
        path: path.into(),
        problem,
    };
    std::fs::create_dir_all(folder).map_err(|problem| io(folder, problem))?;
    let text = serde_json::to_string_pretty(settings);
    let text = text.map_err(|problem| io(&path, problem.into()))?;
    if !path.exists() {
        return Ok(write_file(&path, text.as_bytes())?);
    }
    let found = physique_files::read_file(&path, 1 << 20)?;
    if found == text.as_bytes() {
        return Ok(());
    }
    let line = |text: &str| text.split_whitespace().collect::<Vec<_>>().join(" ");
    Err(Error::Checkpoint {
        file: path,
        place: "the whole file".into(),
        expected: format!("the settings of this run, {}", line(&text)),
        found: line(&String::from_utf8_lossy(&found)),
    })
}

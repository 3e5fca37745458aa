//! Which evaluator the flags ask for.

use anyhow::{Context, Result, bail};
use physique::motion::Limits;
use physique::motion::features::FeatureStatistics;
use physique_learn::DeviceChoice;
use physique_learn::checkpoint::CheckpointLimits;
use physique_learn::evaluation::sentence::SentenceEvaluator;
use physique_learn::evaluation::{
    Evaluator, PairEvaluator, PublishedEvaluator, WordLimits, WordVectors,
};

use super::arguments::EvaluatorArguments;

/// Our own evaluator from a folder, or a published one from its files; none where only the judge is
/// asked.
pub(super) fn open(
    arguments: &EvaluatorArguments,
    device: DeviceChoice,
) -> Result<Option<Box<dyn PairEvaluator>>> {
    let Some(path) = &arguments.evaluator else {
        return Ok(None);
    };
    let limits = CheckpointLimits::default();
    let device = device.open()?;
    if path.is_dir() {
        if arguments.glove.is_some() || arguments.mean.is_some() {
            bail!(
                "{}: an evaluator of `physique train evaluator` reads sentences, and has its own mean and deviation; --glove, --mean and --std are for published ones",
                path.display()
            );
        }
        return Ok(Some(Box::new(SentenceEvaluator::read(
            path, &limits, &device,
        )?)));
    }
    let (Some(glove), Some(mean), Some(std)) = (&arguments.glove, &arguments.mean, &arguments.std)
    else {
        bail!(
            "{}: a published evaluator needs --glove, --mean and --std",
            path.display()
        );
    };
    let statistics = FeatureStatistics::read(mean, std, &Limits::default())?;
    let columns = statistics.mean().len();
    let networks = Evaluator::read(path, columns, &limits, &device)
        .with_context(|| path.display().to_string())?;
    let words = WordVectors::read(glove, &WordLimits::default())?;
    let name = path.display().to_string();
    let evaluator = PublishedEvaluator::new(networks, words, statistics, name)?;
    Ok(Some(Box::new(evaluator)))
}

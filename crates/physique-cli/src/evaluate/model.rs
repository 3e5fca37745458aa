//! Networks as generators.

use std::path::Path;

use anyhow::{Context, Result, bail};
use physique_data::Dataset;
use physique_learn::evaluation::TextToMotionGenerator;
use physique_learn::mdm::TextToMotion;

use super::arguments::EvaluateArguments;
use crate::generate::sampling;
use crate::{network, text_encoder};

/// The networks of the flags, in their order.
pub(super) fn open_all(
    arguments: &EvaluateArguments,
    dataset: &Dataset,
) -> Result<Vec<TextToMotionGenerator>> {
    let sampling = sampling(&arguments.sampling);
    let models = arguments.models.iter();
    models
        .map(|folder| {
            let model = open(folder, arguments, dataset)?;
            let name = name(folder, arguments);
            let frames = dataset.index().longest_window;
            Ok(TextToMotionGenerator::new(model, sampling, name, frames))
        })
        .collect()
}

fn open(path: &Path, arguments: &EvaluateArguments, dataset: &Dataset) -> Result<TextToMotion> {
    // Published networks have the mean and deviation of their data set.
    let statistics = || Ok(dataset.statistics().clone());
    let model = network::read(path, arguments.device.device, statistics)?;
    let skeleton = model.statistics.skeleton();
    if skeleton != dataset.skeleton() {
        bail!(
            "{}: makes motions of {skeleton:?}, the data set has those of {:?}",
            path.display(),
            dataset.skeleton()
        );
    }
    if model.network.config().planner.is_some() {
        bail!(
            "{}: goes on with motions that there are; the protocol is for networks that make whole ones",
            path.display()
        );
    }
    let encoder = text_encoder::wanted(&model.description.text_encoder, &arguments.text)
        .with_context(|| path.display().to_string())?;
    TextToMotion::new(model, encoder).with_context(|| path.display().to_string())
}

/// The folder's name, or as much of its path as tells it from the others.
fn name(folder: &Path, arguments: &EvaluateArguments) -> String {
    let last = |path: &Path| path.file_name().map(|name| name.to_owned());
    let same = |other: &&std::path::PathBuf| last(other) == last(folder);
    match arguments.models.iter().filter(same).count() {
        1 => last(folder).map_or_else(String::new, |name| name.to_string_lossy().into_owned()),
        _ => folder.display().to_string(),
    }
}

//! Which network generates.

use std::path::Path;

use anyhow::{Context, Result, bail};
use physique::motion::Limits;
use physique::motion::features::FeatureStatistics;
use physique_learn::DeviceChoice;
use physique_learn::checkpoint::CheckpointLimits;
use physique_learn::mdm::{MdmFolder, TextToMotion};

use super::arguments::ModelArguments;
use crate::arguments::ReadArguments;
use crate::text_encoder;

/// Opens the network of the flags with its text encoder.
pub(super) fn open(arguments: &ModelArguments, read: &ReadArguments) -> Result<TextToMotion> {
    let choice = arguments.device.device;
    let Some(path) = &arguments.model else {
        return embedded(choice);
    };
    let limits = CheckpointLimits::default();
    let device = choice.open()?;
    let folder = match path.is_dir() {
        true => MdmFolder::read(path, &limits, &device)?,
        false => MdmFolder::published(path, statistics(path, read)?, &limits, &device)?,
    };
    let encoder = match &arguments.text {
        Some(name) => text_encoder::named(name)?,
        None => text_encoder::wanted(&folder.description.text_encoder, &[])
            .with_context(|| path.display().to_string())?,
    };
    TextToMotion::new(folder, encoder).with_context(|| path.display().to_string())
}

/// The embedded network.
pub(crate) fn embedded(device: DeviceChoice) -> Result<TextToMotion> {
    let folder = MdmFolder::embedded(&device.open()?)?;
    Ok(TextToMotion::new(folder, text_encoder::named("minilm")?)?)
}

/// The statistics of a published checkpoint's data set.
fn statistics(path: &Path, read: &ReadArguments) -> Result<FeatureStatistics> {
    let (Some(mean), Some(std)) = (&read.mean, &read.std) else {
        bail!(
            "{}: a published checkpoint needs the statistics of its data set: --mean Mean.npy --std Std.npy",
            path.display()
        );
    };
    Ok(FeatureStatistics::read(mean, std, &Limits::default())?)
}

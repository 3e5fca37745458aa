//! Which network generates.

use std::path::Path;

use anyhow::{Context, Result, bail};
use physique::motion::Limits;
use physique::motion::features::FeatureStatistics;
use physique_learn::mdm::TextToMotion;

use super::arguments::ModelArguments;
use crate::arguments::ReadArguments;
use crate::{network, text_encoder};

/// Opens the network of the flags with its text encoder.
pub(super) fn open(arguments: &ModelArguments, read: &ReadArguments) -> Result<TextToMotion> {
    let device = arguments.device.device;
    let Some(path) = &arguments.model else {
        return network::default(device);
    };
    let folder = network::read(path, device, || statistics(path, read))?;
    let encoder = match &arguments.text {
        Some(name) => text_encoder::named(name)?,
        None => text_encoder::wanted(&folder.description.text_encoder, &[])
            .with_context(|| path.display().to_string())?,
    };
    TextToMotion::new(folder, encoder).with_context(|| path.display().to_string())
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

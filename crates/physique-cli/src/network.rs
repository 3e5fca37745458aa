//! Networks by name, folder or file.

use std::path::Path;

use anyhow::{Result, bail};
use physique::motion::features::FeatureStatistics;
use physique_learn::DeviceChoice;
use physique_learn::checkpoint::CheckpointLimits;
use physique_learn::mdm::{EmbeddedNetwork, MdmFolder, TextToMotion};

use crate::text_encoder;

/// The network that is asked where none is named, with its text encoder.
pub(crate) fn default(device: DeviceChoice) -> Result<TextToMotion> {
    let folder = MdmFolder::embedded(EmbeddedNetwork::default(), &device.open()?)?;
    Ok(TextToMotion::new(folder, text_encoder::named("minilm")?)?)
}

/// A network by its name, its folder, or its published checkpoint with the statistics of its data set.
pub(crate) fn read(
    path: &Path,
    device: DeviceChoice,
    statistics: impl FnOnce() -> Result<FeatureStatistics>,
) -> Result<MdmFolder> {
    let (device, limits) = (device.open()?, CheckpointLimits::default());
    if let Some(network) = path.to_str().and_then(EmbeddedNetwork::named) {
        if path.exists() {
            let name = network.name();
            eprintln!("note: {name} is a network inside the program; ./{name} would be the folder");
        }
        return Ok(MdmFolder::embedded(network, &device)?);
    }
    if !path.exists() {
        let names = EmbeddedNetwork::ALL.map(EmbeddedNetwork::name).join(", ");
        bail!(
            "{}: expected {names}, a folder of `physique train` or a published checkpoint, found nothing",
            path.display()
        );
    }
    Ok(match path.is_dir() {
        true => MdmFolder::read(path, &limits, &device)?,
        false => MdmFolder::published(path, statistics()?, &limits, &device)?,
    })
}

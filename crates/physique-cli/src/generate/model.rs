//! Which network generates.

use std::collections::BTreeMap;
use std::path::Path;

use anyhow::{Context, Result, bail};
use physique::motion::Limits;
use physique::motion::features::{FeatureSkeleton, FeatureStatistics};
use physique_learn::DeviceChoice;
use physique_learn::checkpoint::CheckpointLimits;
use physique_learn::mdm::{MdmDescription, MdmFolder, TextToMotion, read_published};

use super::arguments::ModelArguments;
use crate::arguments::ReadArguments;
use crate::text_encoder;

/// What networks of `physique train` call the embedded encoder.
const EMBEDDED: &str = "all-MiniLM-L6-v2";

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
        false => published(path, read, &limits, choice)?,
    };
    let wanted = folder.description.text_encoder.as_str();
    let encoder = match &arguments.text {
        Some(name) => text_encoder::named(name)?,
        None if wanted.is_empty() => None,
        None if wanted == EMBEDDED => text_encoder::named("minilm")?,
        None => bail!(
            "{}: was trained with the text encoder {wanted}; say where it lies: --text FOLDER",
            path.display()
        ),
    };
    TextToMotion::new(folder, encoder).with_context(|| path.display().to_string())
}

/// The embedded network.
pub(crate) fn embedded(device: DeviceChoice) -> Result<TextToMotion> {
    let folder = MdmFolder::embedded(&device.open()?)?;
    Ok(TextToMotion::new(folder, text_encoder::named("minilm")?)?)
}

/// A published checkpoint with the statistics of its data set.
fn published(
    path: &Path,
    read: &ReadArguments,
    limits: &CheckpointLimits,
    device: DeviceChoice,
) -> Result<MdmFolder> {
    let (Some(mean), Some(std)) = (&read.mean, &read.std) else {
        bail!(
            "{}: a published checkpoint needs the statistics of its data set: --mean Mean.npy --std Std.npy",
            path.display()
        );
    };
    let (network, published) = read_published(path, limits, &device.open()?)?;
    let statistics = FeatureStatistics::read(mean, std, &Limits::default())?;
    let frame_rate = match statistics.skeleton() {
        FeatureSkeleton::HumanMl3d => 20.0,
        FeatureSkeleton::Kit => 12.5,
    };
    Ok(MdmFolder {
        network,
        statistics,
        captions: None,
        description: MdmDescription {
            frame_rate,
            longest_frames: Some(196),
            diffusion_steps: published.diffusion_steps,
            signal: 1.0,
            text_encoder: published.text_encoder_type,
            notes: BTreeMap::new(),
        },
    })
}

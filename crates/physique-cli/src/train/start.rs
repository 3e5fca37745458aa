//! Runs that start from a trained network.

use std::path::{Path, PathBuf};

use anyhow::{Result, bail};
use physique_data::Dataset;
use physique_files::read_file;
use physique_learn::checkpoint::CheckpointLimits;
use physique_learn::mdm::{MdmPlan, StartingNetwork};
use physique_learn::text::{CaptionCentre, KnownCaptions};
use physique_learn::trainer::steps_in;
use physique_text::TextEncoder;

use super::arguments::MdmArguments;

/// Where a run keeps the captions of the network that it started from.
const CAPTIONS: &str = "start-captions.safetensors";

/// The network that a run is still to start from: none where there is nothing of the kind, or where
/// the run is on its way.
pub(super) fn open(
    arguments: &MdmArguments,
    kept: Option<&MdmPlan>,
) -> Result<Option<StartingNetwork>> {
    let Some(plan) = kept else {
        return arguments.start_from.as_deref().map(read).transpose();
    };
    let folder = arguments.output.display();
    let (origin, asked) = match (&plan.started_from, &arguments.start_from) {
        (None, None) => return Ok(None),
        (None, Some(_)) => bail!(
            "{folder}: holds a run that started from a new network; give another folder, or leave out --start-from to go on with that run"
        ),
        (Some(origin), asked) => (origin, asked.as_deref()),
    };
    let same = asked.is_none_or(|asked| asked == Path::new(&origin.path));
    if same && steps_in(&arguments.output)?.is_some() {
        return Ok(None);
    }
    let path = asked.map_or_else(|| PathBuf::from(&origin.path), Path::to_path_buf);
    let start = read(&path)?;
    if start.origin.sha256 != origin.sha256 {
        bail!(
            "{folder}: holds a run that started from {} with the SHA-256 {}; {} has {}: give another folder, or leave out --start-from to go on with that run",
            origin.path,
            origin.sha256,
            start.origin.path,
            start.origin.sha256
        );
    }
    match steps_in(&arguments.output)? {
        Some(_) => Ok(None),
        None => Ok(Some(start)),
    }
}

fn read(path: &Path) -> Result<StartingNetwork> {
    let device = physique_learn::device();
    let limits = CheckpointLimits::default();
    Ok(StartingNetwork::read(path, &limits, &device)?)
}

/// Whether the network can go on with these captions and motions; says what will be new to it.
pub(super) fn check(
    start: &StartingNetwork,
    plan: &MdmPlan,
    encoder: Option<&dyn TextEncoder>,
    dataset: &Dataset,
) -> Result<()> {
    let path = &start.origin.path;
    let reads = encoder.map_or("", TextEncoder::name);
    if let Some(read) = start.text_encoder.as_deref().filter(|read| *read != reads) {
        let name = |name: &str| match name {
            "" => "no text encoder".to_owned(),
            name => format!("the text encoder {name}"),
        };
        bail!(
            "{path}: was trained with {}, the run has {}; choose it by --text",
            name(read),
            name(reads)
        );
    }
    start.check(&plan.network)?;
    let noise = (plan.training.diffusion_steps, plan.training.signal);
    if noise != (start.diffusion_steps, start.signal) {
        eprintln!(
            "note: {path} was trained with {} steps of noise and the signal {}, the run has {} and {}",
            start.diffusion_steps, start.signal, noise.0, noise.1
        );
    }
    let statistics = start.statistics.as_ref();
    if statistics.is_some_and(|statistics| statistics != dataset.statistics()) {
        eprintln!(
            "note: {path} was trained on motions with another mean and deviation; it has to learn those of {}",
            dataset.index().name
        );
    }
    Ok(())
}

/// Keeps what the network was told with the run, whose captions are centred as that network's were.
pub(super) fn keep_captions(start: &StartingNetwork, folder: &Path) -> Result<()> {
    if let Some(captions) = &start.captions {
        std::fs::create_dir_all(folder)?;
        captions.write(&folder.join(CAPTIONS))?;
    }
    Ok(())
}

/// What captions are centred by in a run that started from a network.
pub(super) fn kept_centre(folder: &Path) -> Result<Option<CaptionCentre>> {
    let path = folder.join(CAPTIONS);
    if !path.exists() {
        return Ok(None);
    }
    let limits = CheckpointLimits::default();
    let captions = KnownCaptions::parse(&read_file(&path, limits.bytes)?, &path, &limits)?;
    Ok(captions.centre().cloned())
}

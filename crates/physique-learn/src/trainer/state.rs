//! What a run needs to go on.

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

use burn::module::Module;
use burn::tensor::{Device, Tensor};

use super::{AdamW, TrainerConfig};
use crate::Error;
use crate::checkpoint::{CheckpointLimits, Precision, read_safetensors, write_safetensors};
use crate::parameters::{ParameterArray, Parameters};
use crate::tensors::{numbers, tensor};

const NETWORK: &str = "network.";
const AVERAGE: &str = "average.";
const MOMENTS: [&str; 2] = ["first.", "second."];

/// The file of a step.
pub(super) fn path(folder: &Path, step: u64) -> PathBuf {
    folder.join(format!("state-{step:09}.safetensors"))
}

/// The file of the last step in a folder, and the step.
pub(super) fn newest(folder: &Path) -> Result<Option<(PathBuf, u64)>, Error> {
    Ok(all(folder)?.pop().map(|(step, path)| (path, step)))
}

/// Steps of the newest checkpoint in a folder; `None` where there is no run.
///
/// # Errors
/// [`Error::File`].
pub fn steps_in(folder: &Path) -> Result<Option<u64>, Error> {
    match folder.exists() {
        true => Ok(newest(folder)?.map(|(_, step)| step)),
        false => Ok(None),
    }
}

/// Removes all but the newest files.
pub(super) fn keep_newest(folder: &Path, count: usize) -> Result<(), Error> {
    let mut states = all(folder)?;
    states.truncate(states.len().saturating_sub(count.max(1)));
    for (_, path) in states {
        let removed = std::fs::remove_file(&path);
        removed.map_err(|problem| physique_files::FileError::Io { path, problem })?;
    }
    Ok(())
}

/// Steps and files in a folder, the newest last.
fn all(folder: &Path) -> Result<Vec<(u64, PathBuf)>, Error> {
    let io = |problem| physique_files::FileError::Io {
        path: folder.into(),
        problem,
    };
    let mut states = Vec::new();
    for entry in std::fs::read_dir(folder).map_err(io)? {
        let path = entry.map_err(io)?.path();
        let step = path.file_name().and_then(|name| {
            let digits = name.to_str()?.strip_prefix("state-")?;
            digits.strip_suffix(".safetensors")?.parse().ok()
        });
        states.extend(step.map(|step| (step, path)));
    }
    states.sort_unstable();
    Ok(states)
}

/// Writes the state of a run, whole or not at all.
pub(super) fn write<N: Module>(
    path: &Path,
    (network, average): (&N, Option<&N>),
    optimiser: &AdamW,
    config: &TrainerConfig,
) -> Result<(), Error> {
    let mut arrays = BTreeMap::new();
    let mut add = |prefix: &str, parameters: Parameters| {
        let named = parameters.arrays.into_iter();
        arrays.extend(named.map(|(name, array)| (format!("{prefix}{name}"), array)));
    };
    add(NETWORK, Parameters::of(network, "", &[])?);
    if let Some(average) = average {
        add(AVERAGE, Parameters::of(average, "", &[])?);
    }
    for (name, moments) in &optimiser.moments {
        for (prefix, moment) in MOMENTS.iter().zip(moments) {
            let values = numbers(moment.clone())?;
            let shape = vec![values.len()];
            arrays.insert(format!("{prefix}{name}"), ParameterArray { shape, values });
        }
    }
    let parameters = Parameters {
        source: String::new(),
        arrays,
    };
    let words = BTreeMap::from([
        ("step".to_owned(), optimiser.steps.to_string()),
        ("config".to_owned(), describe(config)),
    ]);
    write_safetensors(path, &parameters, words, Precision::Single)
}

/// What [`write`] wrote: network, average and optimiser. `networks` are of the same shape.
pub(super) fn read<N: Module>(
    path: &Path,
    (network, average): (N, Option<N>),
    config: &TrainerConfig,
) -> Result<(N, Option<N>, AdamW), Error> {
    let (state, words) = read_safetensors(path, &limits())?;
    let refuse = |place: &str, expected: String, found: String| Error::Checkpoint {
        file: path.into(),
        place: place.to_owned(),
        expected,
        found,
    };
    let expected = describe(config);
    match words.get("config") {
        Some(found) if *found == expected => {}
        found => {
            let found = found.cloned().unwrap_or_default();
            let expected = format!("the state of a run with {expected}");
            return Err(refuse("the words `config`", expected, found));
        }
    }
    let steps = words.get("step").and_then(|step| step.parse().ok());
    let Some(steps) = steps else {
        let expected = "a number of steps".to_owned();
        return Err(refuse("the word `step`", expected, "none".into()));
    };
    let device = network
        .devices()
        .into_iter()
        .next()
        .map_or_else(crate::device, Device::inner);
    let network = state.clone().below(NETWORK).load(network, "the run", &[])?;
    let average = match average {
        Some(average) => Some(state.clone().below(AVERAGE).load(average, "the run", &[])?),
        None => None,
    };
    let [first, second] = MOMENTS.map(|prefix| state.clone().below(prefix).arrays);
    let mut optimiser = AdamW::new(config.optimiser);
    optimiser.steps = steps;
    for ((name, first), (other, second)) in first.into_iter().zip(second) {
        if name != other || first.values.len() != second.values.len() {
            let expected = "both moments of every parameter".to_owned();
            return Err(refuse(&name, expected, format!("`{other}` beside it")));
        }
        let moments = [first, second].map(|moment| -> Tensor<1> {
            let count = moment.values.len();
            tensor(moment.values, [count], &device)
        });
        optimiser.moments.insert(name, moments);
    }
    Ok((network, average, optimiser))
}

/// The network to use of a run's state: the running average where there is one.
///
/// # Errors
/// [`Error::File`]; [`Error::Checkpoint`] for a broken file.
pub(crate) fn read_network(path: &Path) -> Result<Parameters, Error> {
    let (state, _) = read_safetensors(path, &limits())?;
    let average = state.clone().below(AVERAGE);
    Ok(match average.arrays.is_empty() {
        true => state.below(NETWORK),
        false => average,
    })
}

/// A state holds every parameter four times.
fn limits() -> CheckpointLimits {
    CheckpointLimits {
        bytes: 1 << 36,
        ..CheckpointLimits::default()
    }
}

/// What must not change within a run. More steps may be asked for, where the rate does not depend
/// on their number.
fn describe(config: &TrainerConfig) -> String {
    let TrainerConfig {
        steps,
        seed,
        optimiser,
        rate,
        clip,
        average,
        save_every: _,
        keep: _,
        log_every: _,
    } = config;
    let steps = match rate {
        super::RateSchedule::Constant => None,
        super::RateSchedule::WarmUpThenCosine { .. } => Some(steps),
    };
    format!(
        "seed {seed}, {optimiser:?}, {rate:?} over {steps:?} steps, clip {clip:?}, average {average:?}"
    )
}

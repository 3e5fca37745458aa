//! What a fit needs to go on after it was stopped.

use std::collections::HashMap;
use std::path::Path;

use physique_files::write_file;
use safetensors::{Dtype, SafeTensors, serialize, tensor::TensorView};

use super::adam::Adam;
use crate::Error;
use crate::regressor::Network;

/// Writes the state after `epoch` passes, whole or not at all.
pub(crate) fn write(
    path: &Path,
    recipe: &str,
    epoch: usize,
    network: &Network,
    adam: &Adam,
) -> Result<(), Error> {
    let arrays = [
        ("parameters", network.parameters()),
        ("first", &adam.first),
        ("second", &adam.second),
    ];
    let arrays = arrays.map(|(name, values)| (name, bytes(values), values.len()));
    let mut views = Vec::with_capacity(arrays.len());
    for (name, bytes, count) in &arrays {
        let view = TensorView::new(Dtype::F32, vec![*count], bytes);
        views.push((*name, view.map_err(|error| refuse(path, error))?));
    }
    let metadata = HashMap::from([
        ("recipe".to_owned(), recipe.to_owned()),
        ("epoch".to_owned(), epoch.to_string()),
        ("steps".to_owned(), adam.steps.to_string()),
    ]);
    let file = serialize(views, Some(metadata)).map_err(|error| refuse(path, error))?;
    Ok(write_file(path, &file)?)
}

/// Takes up the state that [`write`] wrote, and says after how many passes that was; `None` if
/// there is none.
///
/// # Errors
/// [`Error::Checkpoint`] if it is of another recipe or body, or broken.
pub(crate) fn read(
    path: &Path,
    recipe: &str,
    network: &mut Network,
    adam: &mut Adam,
) -> Result<Option<usize>, Error> {
    if !path.exists() {
        return Ok(None);
    }
    let file = physique_files::read_file(path, 1 << 32)?;
    let (_, header) = SafeTensors::read_metadata(&file).map_err(|error| refuse(path, error))?;
    let tensors = SafeTensors::deserialize(&file).map_err(|error| refuse(path, error))?;
    let entry = |key: &str| header.metadata().as_ref().and_then(|all| all.get(key));
    if entry("recipe").map(String::as_str) != Some(recipe) {
        return Err(refuse(path, "a fit of another recipe or body"));
    }
    let number = |key: &str| entry(key).and_then(|text| text.parse::<u64>().ok());
    let (Some(epoch), Some(steps)) = (number("epoch"), number("steps")) else {
        return Err(refuse(path, "no count of epochs and steps"));
    };
    let read = |name: &str| -> Result<Vec<f32>, Error> {
        let tensor = tensors.tensor(name).map_err(|error| refuse(path, error))?;
        let expected = network.parameters().len();
        if tensor.dtype() != Dtype::F32 || tensor.shape() != [expected] {
            return Err(refuse(path, format!("another shape of `{name}`")));
        }
        let values = tensor.data().as_chunks::<4>().0.iter();
        Ok(values.map(|&value| f32::from_le_bytes(value)).collect())
    };
    let (parameters, first, second) = (read("parameters")?, read("first")?, read("second")?);
    network.update(|old| old.copy_from_slice(&parameters));
    *adam = Adam {
        steps,
        first,
        second,
    };
    Ok(Some(usize::try_from(epoch).unwrap_or(usize::MAX)))
}

fn refuse(path: &Path, found: impl ToString) -> Error {
    Error::Checkpoint {
        path: path.into(),
        found: found.to_string(),
    }
}

fn bytes(values: &[f32]) -> Vec<u8> {
    values
        .iter()
        .flat_map(|value| value.to_le_bytes())
        .collect()
}

//! Our own files of parameters: safetensors with a few words beside the numbers.

use std::collections::{BTreeMap, HashMap};
use std::path::Path;

use physique_files::write_file;
use safetensors::tensor::TensorView;
use safetensors::{Dtype, SafeTensors, serialize};

use super::CheckpointLimits;
use crate::Error;
use crate::parameters::{ParameterArray, Parameters};

/// How numbers are stored.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Precision {
    /// 32 bits: as they are.
    #[default]
    Single,
    /// 16 bits: to three digits, in half the space.
    Half,
}

/// Writes parameters and `words` about them, whole or not at all.
///
/// # Errors
/// [`Error::File`]; [`Error::Checkpoint`] where an array is not as long as its shape says.
pub fn write_safetensors(
    path: &Path,
    parameters: &Parameters,
    words: BTreeMap<String, String>,
    precision: Precision,
) -> Result<(), Error> {
    let kind = match precision {
        Precision::Single => Dtype::F32,
        Precision::Half => Dtype::F16,
    };
    let arrays: Vec<_> = parameters
        .arrays
        .iter()
        .map(|(name, array)| {
            let values = array.values.iter();
            let bytes: Vec<u8> = match precision {
                Precision::Single => values.flat_map(|value| value.to_le_bytes()).collect(),
                Precision::Half => values
                    .flat_map(|&value| half::f16::from_f32(value).to_le_bytes())
                    .collect(),
            };
            (name, &array.shape, bytes)
        })
        .collect();
    let mut views = Vec::with_capacity(arrays.len());
    for (name, shape, bytes) in &arrays {
        let view = TensorView::new(kind, shape.to_vec(), bytes);
        views.push((*name, view.map_err(|problem| refuse(path, name, problem))?));
    }
    let words: HashMap<String, String> = words.into_iter().collect();
    let file = serialize(views, Some(words)).map_err(|problem| refuse(path, "", problem))?;
    Ok(write_file(path, &file)?)
}

/// Reads what [`write_safetensors`] wrote, or any safetensors file of 16- or 32-bit numbers.
///
/// # Errors
/// [`Error::File`]; [`Error::Checkpoint`] for a broken file or numbers of another kind.
pub fn read_safetensors(
    path: &Path,
    limits: &CheckpointLimits,
) -> Result<(Parameters, BTreeMap<String, String>), Error> {
    parse_safetensors(
        &physique_files::read_file(path, limits.bytes)?,
        path,
        limits,
    )
}

/// As [`read_safetensors`], of bytes that were read; the path only names them in errors.
///
/// # Errors
/// [`Error::Checkpoint`].
pub fn parse_safetensors(
    file: &[u8],
    path: &Path,
    limits: &CheckpointLimits,
) -> Result<(Parameters, BTreeMap<String, String>), Error> {
    let broken = |problem| refuse(path, "", problem);
    let (_, header) = SafeTensors::read_metadata(file).map_err(broken)?;
    let tensors = SafeTensors::deserialize(file).map_err(broken)?;
    if tensors.len() > limits.arrays {
        let found = format!(
            "{} arrays, above the limit of {}",
            tensors.len(),
            limits.arrays
        );
        return Err(refuse(path, "", found));
    }
    let mut arrays = BTreeMap::new();
    for (name, tensor) in tensors.iter() {
        let bytes = tensor.data();
        let values: Vec<f32> = match tensor.dtype() {
            Dtype::F32 => decode(bytes, f32::from_le_bytes),
            Dtype::F16 => decode(bytes, |half| half::f16::from_le_bytes(half).to_f32()),
            Dtype::BF16 => decode(bytes, |half| half::bf16::from_le_bytes(half).to_f32()),
            other => return Err(refuse(path, name, format!("numbers of type {other:?}"))),
        };
        let shape = tensor.shape().to_vec();
        arrays.insert(name.to_owned(), ParameterArray { shape, values });
    }
    let words = header.metadata().clone().unwrap_or_default();
    let parameters = Parameters {
        source: path.display().to_string(),
        arrays,
    };
    Ok((parameters, words.into_iter().collect()))
}

fn decode<const SIZE: usize>(bytes: &[u8], number: impl Fn([u8; SIZE]) -> f32) -> Vec<f32> {
    let numbers = bytes.as_chunks::<SIZE>().0.iter();
    numbers.map(|&bytes| number(bytes)).collect()
}

fn refuse(path: &Path, place: &str, found: impl ToString) -> Error {
    let place = match place {
        "" => "the whole file".to_owned(),
        name => format!("`{name}`"),
    };
    Error::Checkpoint {
        file: path.into(),
        place,
        expected: "a sound safetensors file of 16- or 32-bit floating-point numbers".into(),
        found: found.to_string(),
    }
}

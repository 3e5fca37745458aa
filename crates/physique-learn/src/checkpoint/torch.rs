//! PyTorch's checkpoints.

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

use physique_files::npz::ArrayLimits;
use physique_files::pickle::{PickleLimits, Value, View};
use physique_files::torch::TorchFile;

use super::CheckpointLimits;
use crate::Error;
use crate::error::Names;
use crate::parameters::{ParameterArray, Parameters};

/// A file that `torch.save` wrote: a state dictionary, or a dictionary of several.
///
/// Read as data by an allow-list: no code in the file can run.
#[derive(Debug)]
pub struct TorchCheckpoint {
    file: PathBuf,
    torch: TorchFile,
    limits: CheckpointLimits,
}

impl TorchCheckpoint {
    /// Reads a file.
    ///
    /// # Errors
    /// [`Error::File`]; [`Error::Content`] for a broken file or one that holds more than data;
    /// [`Error::Checkpoint`] unless it is a dictionary.
    pub fn open(path: &Path, limits: &CheckpointLimits) -> Result<Self, Error> {
        let bytes = physique_files::read_file(path, limits.bytes)?;
        let arrays = ArrayLimits {
            bytes: limits.bytes,
            entries: limits.arrays,
            ..ArrayLimits::default()
        };
        let torch = TorchFile::read(bytes, &arrays, &PickleLimits::default());
        let torch = torch.map_err(|problem| Error::Content {
            file: path.into(),
            problem: Box::new(problem),
        })?;
        let checkpoint = Self {
            file: path.into(),
            torch,
            limits: *limits,
        };
        match checkpoint.torch.root().view() {
            View::Dict(_) => Ok(checkpoint),
            View::Object(object) => {
                Err(checkpoint.refuse("the whole file", "a dictionary", object.class))
            }
            _ => {
                let found = checkpoint.torch.root().kind();
                Err(checkpoint.refuse("the whole file", "a dictionary", found))
            }
        }
    }

    /// Keys of the dictionary.
    pub fn keys(&self) -> Vec<&str> {
        let entries = self.torch.root().entries();
        entries.filter_map(|(key, _)| key.text()).collect()
    }

    /// The tensors of the dictionary itself, or of the one under `key`, by name.
    ///
    /// # Errors
    /// [`Error::Checkpoint`] for anything but a dictionary of tensors by text;
    /// [`Error::Content`] for a tensor whose numbers are not in the file.
    pub fn state_dictionary(&self, key: Option<&str>) -> Result<Parameters, Error> {
        let root = self.torch.root();
        let dictionary = match key {
            None => root,
            Some(key) => root.get(key).ok_or_else(|| {
                let keys = self.keys().into_iter().map(str::to_owned);
                let found = format!("only {}", Names(keys.collect()));
                self.refuse("the whole file", &format!("the key `{key}`"), found)
            })?,
        };
        let place = key.unwrap_or("the whole file");
        let View::Dict(_) = dictionary.view() else {
            return Err(self.refuse(place, "a dictionary of tensors", dictionary.kind()));
        };
        let (mut arrays, mut left) = (BTreeMap::new(), self.limits.bytes);
        for (name, value) in dictionary.entries() {
            let Some(name) = name.text() else {
                return Err(self.refuse(place, "names of tensors", name.kind()));
            };
            let array = self.array(name, value)?;
            let bytes = array.values.len() as u64 * 4;
            left = left.checked_sub(bytes).ok_or_else(|| {
                let expected = format!("at most {} bytes of tensors", self.limits.bytes);
                self.refuse(place, &expected, "more")
            })?;
            arrays.insert(name.to_owned(), array);
        }
        let source = match key {
            None => self.file.display().to_string(),
            Some(key) => format!("{}, `{key}`", self.file.display()),
        };
        Ok(Parameters { source, arrays })
    }

    fn array(&self, name: &str, value: Value<'_>) -> Result<ParameterArray, Error> {
        if !matches!(value.view(), View::Tensor(_) | View::Array) {
            return Err(self.refuse(name, "a tensor", value.kind()));
        }
        let content = |problem| Error::Content {
            file: self.file.clone(),
            problem: Box::new(problem),
        };
        let array = self.torch.array(value, name).map_err(content)?;
        let values = array.to_f32().map_err(|problem| content(problem.into()))?;
        Ok(ParameterArray {
            shape: array.shape().to_vec(),
            values,
        })
    }

    fn refuse(&self, place: &str, expected: &str, found: impl ToString) -> Error {
        Error::Checkpoint {
            file: self.file.clone(),
            place: place.to_owned(),
            expected: expected.to_owned(),
            found: found.to_string(),
        }
    }
}

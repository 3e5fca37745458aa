//! Named tensors of a file, whatever the file is.

mod file;
mod rows;

pub(crate) use file::OPENAI_FILE;
pub(crate) use rows::Rows;

use std::collections::BTreeMap;
use std::path::PathBuf;

use crate::Error;

/// Numbers of a tensor as they are stored.
#[derive(Clone, Debug)]
enum Numbers {
    Full(Vec<f32>),
    /// Eight bits, with a scale for each row under the same name and `.scale`.
    Rounded(Vec<i8>),
}

/// A tensor of a file.
#[derive(Clone, Debug)]
struct Tensor {
    shape: Vec<usize>,
    numbers: Numbers,
}

/// Tensors by name; a model takes what it needs.
#[derive(Debug)]
pub(crate) struct Weights {
    path: PathBuf,
    tensors: BTreeMap<String, Tensor>,
    /// What all names begin with.
    prefix: String,
}

impl Weights {
    /// Lets names be said without what stands before `known` in the file.
    pub(crate) fn under(mut self, known: &str) -> Result<Self, Error> {
        let found = self
            .tensors
            .keys()
            .find_map(|name| name.strip_suffix(known));
        match found {
            Some(prefix) => self.prefix = prefix.to_owned(),
            None => return Err(self.missing(known)),
        }
        Ok(self)
    }

    pub(crate) fn has(&self, name: &str) -> bool {
        self.tensors.contains_key(&format!("{}{name}", self.prefix))
    }

    /// Shape of a tensor.
    pub(crate) fn shape(&self, name: &str) -> Result<&[usize], Error> {
        let tensor = self.tensors.get(&format!("{}{name}", self.prefix));
        tensor.map_or_else(
            || Err(self.missing(name)),
            |tensor| Ok(tensor.shape.as_slice()),
        )
    }

    /// Numbers of a tensor of this shape, row after row.
    pub(crate) fn floats(&mut self, name: &str, shape: &[usize]) -> Result<Vec<f32>, Error> {
        Ok(self.rows(name, shape)?.into_floats())
    }

    /// The rows of a tensor, kept as small as they are stored.
    pub(crate) fn rows(&mut self, name: &str, shape: &[usize]) -> Result<Rows, Error> {
        let tensor = self.take(name)?;
        if tensor.shape != shape {
            return Err(self.wrong(
                name,
                format!("shape {shape:?}"),
                format!("{:?}", tensor.shape),
            ));
        }
        let width = shape.last().copied().unwrap_or(1).max(1);
        match tensor.numbers {
            Numbers::Full(numbers) => {
                if let Some(at) = numbers.iter().position(|number| !number.is_finite()) {
                    let found = format!("{} at {at}", numbers[at]);
                    return Err(self.wrong(name, "finite numbers".into(), found));
                }
                Ok(Rows::full(numbers, width))
            }
            Numbers::Rounded(numbers) => {
                let scales = self.floats(&format!("{name}.scale"), &[numbers.len() / width])?;
                Ok(Rows::rounded(numbers, scales, width))
            }
        }
    }

    fn take(&mut self, name: &str) -> Result<Tensor, Error> {
        let tensor = self.tensors.remove(&format!("{}{name}", self.prefix));
        tensor.ok_or_else(|| self.missing(name))
    }

    fn missing(&self, name: &str) -> Error {
        let found = match self.tensors.len() {
            0 => "none".to_owned(),
            count => format!("{count} others"),
        };
        self.wrong(name, "such a tensor".into(), found)
    }

    pub(crate) fn wrong(&self, name: &str, expected: String, found: String) -> Error {
        Error::Format {
            path: self.path.clone(),
            place: format!("tensor {}{name}", self.prefix),
            expected,
            found,
        }
    }
}

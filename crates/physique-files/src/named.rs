//! All arrays of a file by name, whatever the file is.

use crate::npz::{Archive, Array, ArrayLimits, objects_from_npy};
use crate::pickle::{Pickle, PickleLimits, Value, View};
use crate::torch::TorchFile;
use crate::{Error, npz::ArrayError};

/// Paths deeper than this are no data of ours.
const DEEPEST: usize = 32;
/// Values that are looked at, shared ones once for every path to them.
const MOST_VALUES: u64 = 1 << 20;

/// All numeric arrays of a `.npy`, `.npz`, `.pkl` or `.pt` file, told apart by content.
///
/// Arrays in dictionaries, lists and objects are named by their path: `motion`, `people.0.pose`,
/// `shapedirs.x`. The array of a `.npy` without a name of its own is called `array`. Other
/// values, such as text and single numbers, are passed over; arrays of objects in a `.npz` are
/// looked into. Cost: a copy of every array.
///
/// # Errors
/// Those of the readers; [`Error::NamedArrays`] when the arrays take more than `arrays.bytes`
/// together (a pickle may show one array under many names); [`Error::UnknownFormat`].
pub fn named_arrays(
    bytes: Vec<u8>,
    arrays: &ArrayLimits,
    pickles: &PickleLimits,
) -> Result<Vec<Array>, Error> {
    let mut found = Collector::new(arrays.bytes);
    if bytes.starts_with(b"\x93NUMPY") {
        match Array::from_npy("array", bytes.clone(), arrays) {
            Ok(array) => found.add(array)?,
            Err(ArrayError::ElementType { .. }) => {
                let pickle = objects_from_npy("array", bytes, pickles)?;
                found.walk(pickle.root(), "", &|value, name| Ok(value.array(name)?))?;
            }
            Err(error) => return Err(error.into()),
        }
    } else if Archive::looks_like(&bytes) {
        let mut archive = Archive::open(bytes.clone(), *arrays)?;
        if archive.entries().any(|name| name.ends_with("data.pkl")) {
            found.torch(&TorchFile::read(bytes, arrays, pickles)?)?;
            return Ok(found.arrays);
        }
        for key in archive.keys().to_vec() {
            match archive.array(&key) {
                Ok(array) => found.add(array)?,
                Err(ArrayError::ElementType { .. }) => {
                    let pickle = archive.objects(&key, pickles)?;
                    found.walk(pickle.root(), &key, &|value, name| Ok(value.array(name)?))?;
                }
                Err(error) => return Err(error.into()),
            }
        }
    } else if TorchFile::looks_like_legacy(&bytes) {
        found.torch(&TorchFile::read(bytes, arrays, pickles)?)?;
    } else if Pickle::looks_like(&bytes) {
        let pickle = Pickle::read(bytes, pickles)?;
        found.walk(pickle.root(), "", &|value, name| Ok(value.array(name)?))?;
    } else {
        let start = bytes[..bytes.len().min(16)].escape_ascii().to_string();
        return Err(Error::UnknownFormat { start });
    }
    Ok(found.arrays)
}

struct Collector {
    arrays: Vec<Array>,
    left: u64,
    limit: u64,
    values: u64,
}

impl Collector {
    const fn new(limit: u64) -> Self {
        Self {
            arrays: Vec::new(),
            left: limit,
            limit,
            values: 0,
        }
    }

    fn add(&mut self, array: Array) -> Result<(), Error> {
        let bytes = array.byte_count() as u64;
        self.left = self.left.checked_sub(bytes).ok_or(Error::NamedArrays {
            what: "their size in bytes",
            limit: self.limit,
        })?;
        self.arrays.push(array);
        Ok(())
    }

    fn torch(&mut self, file: &TorchFile) -> Result<(), Error> {
        self.walk(file.root(), "", &|value, name| file.array(value, name))
    }

    /// Visits a value and all within it, in the order of the file, without recursion.
    fn walk(
        &mut self,
        root: Value<'_>,
        name: &str,
        array: &dyn Fn(Value<'_>, &str) -> Result<Array, Error>,
    ) -> Result<(), Error> {
        let mut waiting = vec![(name.to_owned(), 0, root)];
        while let Some((name, depth, value)) = waiting.pop() {
            self.values += 1;
            if self.values > MOST_VALUES {
                return Err(Error::NamedArrays {
                    what: "the number of values",
                    limit: MOST_VALUES,
                });
            }
            let first = waiting.len();
            let within = match value.view() {
                View::Dict(pairs) => pairs,
                _ => value.list().map_or(0, |items| items.len()),
            };
            if (first + within) as u64 > MOST_VALUES {
                return Err(Error::NamedArrays {
                    what: "the number of values",
                    limit: MOST_VALUES,
                });
            }
            match value.view() {
                View::Array | View::Tensor(_) => {
                    let name = if name.is_empty() { "array" } else { &name };
                    self.add(array(value, name)?)?;
                }
                // An array of objects without dimensions is a wrapper of `numpy.save`.
                View::ObjectArray([], items) => {
                    waiting.extend(items.iter().map(|item| (name.clone(), depth + 1, item)));
                }
                View::Dict(_) => {
                    for (key, value) in value.entries() {
                        let key = match key.view() {
                            View::Integer(number) => number.to_string(),
                            _ => match key.text() {
                                Some(text) => text.to_owned(),
                                None => continue,
                            },
                        };
                        waiting.push((joined(&name, &key), depth + 1, value));
                    }
                }
                View::Object(object) => {
                    waiting.extend(
                        object
                            .attributes
                            .map(|dict| (name.clone(), depth + 1, dict)),
                    );
                }
                _ => {
                    if let Some(items) = value.list() {
                        for (index, item) in items.iter().enumerate() {
                            if is_container(item) {
                                let name = joined(&name, &index.to_string());
                                waiting.push((name, depth + 1, item));
                            }
                        }
                    }
                }
            }
            if depth >= DEEPEST && waiting.len() > first {
                return Err(Error::NamedArrays {
                    what: "the depth of its containers",
                    limit: DEEPEST as u64,
                });
            }
            waiting[first..].reverse();
        }
        Ok(())
    }
}

fn joined(name: &str, part: &str) -> String {
    // Keys of a stranger may be long.
    let part: String = part.chars().take(80).collect();
    match name {
        "" => part,
        _ => format!("{name}.{part}"),
    }
}

fn is_container(value: Value<'_>) -> bool {
    !matches!(
        value.view(),
        View::None
            | View::Bool(_)
            | View::Integer(_)
            | View::Float(_)
            | View::Bytes(_)
            | View::Text(_)
            | View::Other(_)
    )
}

//! From a file of any kind to its tree of values.

use super::Data;
use crate::Error;
use crate::npz::{Archive, Array, ArrayError, ArrayLimits, objects_from_npy};
use crate::pickle::{Pickle, PickleLimits, Value, View};
use crate::torch::TorchFile;

/// Containers within containers deeper than this are no data of ours; so recursion is bounded.
const DEEPEST: usize = 32;
/// Letters of a key that names show: keys of a stranger may be long.
const LETTERS: usize = 80;

pub(super) fn read(
    bytes: Vec<u8>,
    arrays: &ArrayLimits,
    pickles: &PickleLimits,
) -> Result<Data, Error> {
    let limit = arrays.bytes;
    if bytes.starts_with(b"\x93NUMPY") {
        return match Array::from_npy("array", bytes.clone(), arrays) {
            Ok(array) => Ok(Data::Array(array)),
            Err(ArrayError::ElementType { .. }) => {
                of_pickle(&objects_from_npy("array", bytes, pickles)?, "", limit)
            }
            Err(error) => Err(error.into()),
        };
    }
    if Archive::looks_like(&bytes) {
        let mut archive = Archive::open(bytes.clone(), *arrays)?;
        if archive.entries().any(|name| name.ends_with("data.pkl")) {
            return of_torch(&TorchFile::read(bytes, arrays, pickles)?, limit);
        }
        return of_archive(&mut archive, limit, pickles);
    }
    if TorchFile::looks_like_legacy(&bytes) {
        return of_torch(&TorchFile::read(bytes, arrays, pickles)?, limit);
    }
    if Pickle::looks_like(&bytes) {
        return of_pickle(&Pickle::read(bytes, pickles)?, "", limit);
    }
    let start = bytes[..bytes.len().min(16)].escape_ascii().to_string();
    Err(Error::UnknownFormat { start })
}

pub(super) fn of_pickle(pickle: &Pickle, name: &str, limit: u64) -> Result<Data, Error> {
    let array = |value: Value<'_>, name: &str| Ok(value.array(name)?);
    Builder::new(limit, &array).build(pickle.root(), name, 0)
}

fn of_torch(file: &TorchFile, limit: u64) -> Result<Data, Error> {
    let array = |value: Value<'_>, name: &str| file.array(value, name);
    Builder::new(limit, &array).build(file.root(), "", 0)
}

fn of_archive(archive: &mut Archive, limit: u64, pickles: &PickleLimits) -> Result<Data, Error> {
    let array = |value: Value<'_>, name: &str| Ok(value.array(name)?);
    let mut builder = Builder::new(limit, &array);
    let mut entries = Vec::new();
    for key in archive.keys().to_vec() {
        let value = match archive.array(&key) {
            Ok(array) => builder.charged(array)?,
            Err(ArrayError::ElementType { .. }) => {
                let pickle = archive.objects(&key, pickles)?;
                builder.build(pickle.root(), &key, 1)?
            }
            Err(error) => return Err(error.into()),
        };
        entries.push((key, value));
    }
    Ok(Data::Dict(entries))
}

/// How a value of a pickle becomes an array: tensors need their file.
type ArrayOf<'a> = dyn Fn(Value<'_>, &str) -> Result<Array, Error> + 'a;

/// Builds trees within a limit of bytes that all values share.
struct Builder<'a> {
    left: u64,
    limit: u64,
    array: &'a ArrayOf<'a>,
}

impl<'a> Builder<'a> {
    const fn new(limit: u64, array: &'a ArrayOf<'a>) -> Self {
        Self {
            left: limit,
            limit,
            array,
        }
    }

    fn build(&mut self, value: Value<'_>, name: &str, depth: usize) -> Result<Data, Error> {
        if depth > DEEPEST {
            return Err(Error::NamedArrays {
                what: "the depth of its containers",
                limit: DEEPEST as u64,
            });
        }
        self.charge(size_of::<Data>())?;
        match value.view() {
            View::Array | View::Tensor(_) => {
                let name = if name.is_empty() { "array" } else { name };
                let array = (self.array)(value, name)?;
                self.charged(array)
            }
            View::Bool(value) => Ok(Data::Number(f64::from(u8::from(value)))),
            View::Integer(value) => Ok(Data::Number(value as f64)),
            View::Float(value) => Ok(Data::Number(value)),
            // `numpy.save` wraps an object in an array without dimensions.
            View::ObjectArray([], items) => match items.get(0) {
                Some(item) => self.build(item, name, depth + 1),
                None => Ok(Data::Other("an empty array of objects")),
            },
            View::Dict(_) => self.dict(value, name, depth),
            View::Object(object) => match object.attributes {
                Some(attributes) => self.build(attributes, name, depth + 1),
                None => Ok(Data::Other(object.class)),
            },
            _ => {
                if let Some(text) = value.text() {
                    self.charge(text.len())?;
                    return Ok(Data::Text(text.to_owned()));
                }
                let Some(items) = value.list() else {
                    return Ok(Data::Other(value.kind()));
                };
                let items = items.iter().enumerate().map(|(index, item)| {
                    self.build(item, &joined(name, &index.to_string()), depth + 1)
                });
                items.collect::<Result<_, _>>().map(Data::List)
            }
        }
    }

    fn dict(&mut self, dict: Value<'_>, name: &str, depth: usize) -> Result<Data, Error> {
        let mut entries = Vec::new();
        for (key, value) in dict.entries() {
            let key = match key.view() {
                View::Integer(number) => number.to_string(),
                _ => match key.text() {
                    Some(text) => text.to_owned(),
                    None => continue,
                },
            };
            self.charge(size_of::<String>() + key.len())?;
            let value = self.build(value, &joined(name, &key), depth + 1)?;
            entries.push((key, value));
        }
        Ok(Data::Dict(entries))
    }

    fn charged(&mut self, array: Array) -> Result<Data, Error> {
        self.charge(array.byte_count())?;
        Ok(Data::Array(array))
    }

    fn charge(&mut self, bytes: usize) -> Result<(), Error> {
        let left = self.left.checked_sub(bytes as u64);
        self.left = left.ok_or(Error::NamedArrays {
            what: "their size in bytes",
            limit: self.limit,
        })?;
        Ok(())
    }
}

fn joined(name: &str, part: &str) -> String {
    let part: String = part.chars().take(LETTERS).collect();
    match name {
        "" => part,
        _ => format!("{name}.{part}"),
    }
}

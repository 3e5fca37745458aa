//! The plain values of a file as a tree, whatever kind of file it is.

mod read;

use crate::Error;
use crate::npz::{Array, ArrayLimits};
use crate::pickle::PickleLimits;

/// A value from a `.npy`, `.npz`, `.pkl` or `.pt` file, owned and plain.
///
/// Objects of listed classes are their attributes; shared parts are copied, at the expense of the
/// reader's limit. No deeper than 32 containers.
#[derive(Clone, Debug)]
#[non_exhaustive]
pub enum Data {
    /// Numbers or text of one type in a shape; named by its path, such as `people.0.pose`.
    Array(Array),
    /// A number of Python's own.
    Number(f64),
    /// Text, or Python 2's bytes where they are UTF-8.
    Text(String),
    /// A list, tuple, set or array of objects.
    List(Vec<Data>),
    /// A dictionary in the order of the file; keys are text or integers written as text.
    Dict(Vec<(String, Data)>),
    /// Something without content for us, in words: `None`, bytes, a class.
    Other(&'static str),
}

impl Data {
    /// Reads a file of any of the four kinds, told apart by content. An array of objects without
    /// dimensions, as `numpy.save` wraps a dictionary, is the object itself.
    ///
    /// # Errors
    /// Those of the readers; [`Error::NamedArrays`] when the values take more than `arrays.bytes`
    /// together; [`Error::UnknownFormat`].
    pub fn read(
        bytes: Vec<u8>,
        arrays: &ArrayLimits,
        pickles: &PickleLimits,
    ) -> Result<Self, Error> {
        read::read(bytes, arrays, pickles)
    }

    /// The tree of a pickle that is already read, as [`Data::read`] makes it.
    ///
    /// # Errors
    /// [`Error::NamedArrays`] when the values take more than `limit` bytes.
    pub fn of_pickle(
        pickle: &crate::pickle::Pickle,
        name: &str,
        limit: u64,
    ) -> Result<Self, Error> {
        read::of_pickle(pickle, name, limit)
    }

    /// The value of a dictionary under a key; the last one, where the key comes twice.
    pub fn get(&self, key: &str) -> Option<&Self> {
        let mut entries = self.entries().iter().rev();
        entries
            .find(|(known, _)| known == key)
            .map(|(_, value)| value)
    }

    /// Keys and values of a dictionary, or nothing.
    pub fn entries(&self) -> &[(String, Self)] {
        match self {
            Self::Dict(entries) => entries,
            _ => &[],
        }
    }

    /// The values of a list.
    pub fn list(&self) -> Option<&[Self]> {
        match self {
            Self::List(items) => Some(items),
            _ => None,
        }
    }

    /// Text, or an array that is one text.
    pub fn text(&self) -> Option<String> {
        match self {
            Self::Text(text) => Some(text.clone()),
            Self::Array(array) => array.text().ok(),
            _ => None,
        }
    }

    /// One number: Python's own, or an array of one.
    pub fn number(&self) -> Option<f64> {
        match self {
            Self::Number(number) => Some(*number),
            Self::Array(array) => array.number().ok(),
            _ => None,
        }
    }

    /// Numbers in a row: an array of any shape, one number, or a list of numbers.
    pub fn numbers(&self) -> Option<Vec<f64>> {
        match self {
            Self::Array(array) => array.to_f64().ok(),
            Self::Number(number) => Some(vec![*number]),
            Self::List(items) => items.iter().map(Self::number).collect(),
            _ => None,
        }
    }

    /// What it is, in a few words, for errors: `an array [60][22][3]`.
    pub fn kind(&self) -> String {
        match self {
            Self::Array(array) => {
                let lengths = array.shape().iter().take(8);
                let shape: String = lengths.map(|length| format!("[{length}]")).collect();
                match shape.as_str() {
                    "" => "one number or text".into(),
                    _ => format!("an array {shape}"),
                }
            }
            Self::Number(number) => format!("the number {number}"),
            Self::Text(_) => "a text".into(),
            Self::List(items) => format!("a list of {}", items.len()),
            Self::Dict(entries) => format!("a dictionary of {}", entries.len()),
            Self::Other(kind) => (*kind).into(),
        }
    }
}

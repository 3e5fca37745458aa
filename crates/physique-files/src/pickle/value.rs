//! Views of a pickle's values.

use std::fmt;

use super::PickleError;
use super::blob::Blob;
use super::document::Pickle;
use super::instruction::shown;
use super::node::{Id, Node, Storage, TensorNode};
use crate::npz::Array;

/// One value of a [`Pickle`]; values may be shared, and lists may contain themselves.
#[derive(Clone, Copy)]
pub struct Value<'a> {
    pickle: &'a Pickle,
    id: Id,
}

/// What a value is.
#[derive(Clone, Debug)]
#[non_exhaustive]
pub enum View<'a> {
    /// Python's `None`.
    None,
    /// A truth value.
    Bool(bool),
    /// An integer of up to 64 bits.
    Integer(i64),
    /// A number, or an integer beyond 64 bits rounded to one.
    Float(f64),
    /// Bytes; Python 2's text is bytes, too, see [`Value::text`].
    Bytes(&'a [u8]),
    /// Text.
    Text(&'a str),
    /// A list.
    List(Items<'a>),
    /// A tuple.
    Tuple(Items<'a>),
    /// A set, in the order of the file.
    Set(Items<'a>),
    /// A dictionary: see [`Value::get`] and [`Value::entries`].
    Dict(usize),
    /// A NumPy array of plain elements: see [`Value::array`].
    Array,
    /// A NumPy array of objects, in the order of the file.
    ObjectArray(&'a [usize], Items<'a>),
    /// An object that is known by class and attributes.
    Object(Object<'a>),
    /// A PyTorch tensor, whose numbers lie outside the pickle.
    Tensor(Tensor<'a>),
    /// Something without content: a class, an element type, a storage.
    Other(&'static str),
}

/// An object that is known by class and attributes.
#[derive(Clone, Copy, Debug)]
pub struct Object<'a> {
    /// Name of the class, such as `chumpy.ch.Ch`; old homes of a class give its present name.
    pub class: &'static str,
    /// Its attributes: a dictionary, where the file has any.
    pub attributes: Option<Value<'a>>,
}

/// A PyTorch tensor: a window into a storage, checked to lie within it.
#[derive(Clone, Copy, Debug)]
pub struct Tensor<'a> {
    /// Where the numbers are.
    pub storage: &'a Storage,
    /// Index of the first number.
    pub offset: usize,
    /// Length of every dimension.
    pub shape: &'a [usize],
    /// Numbers from one element to the next, by dimension.
    pub strides: &'a [usize],
}

impl<'a> Value<'a> {
    pub(super) const fn new(pickle: &'a Pickle, id: Id) -> Self {
        Self { pickle, id }
    }

    /// What it is.
    pub fn view(self) -> View<'a> {
        let bytes = |blob: &Blob| self.pickle.bytes.get(*blob);
        match self.node() {
            Node::None => View::None,
            Node::Bool(value) => View::Bool(*value),
            Node::Integer(value) => View::Integer(*value),
            Node::Float(value) => View::Float(*value),
            Node::Bytes(blob) => View::Bytes(bytes(blob)),
            // Checked when it was read.
            Node::Text(blob) => View::Text(str::from_utf8(bytes(blob)).unwrap_or_default()),
            Node::List(items) => View::List(self.items(items)),
            Node::Tuple(items) => View::Tuple(self.items(items)),
            Node::Set(items) => View::Set(self.items(items)),
            Node::Dict(pairs) => View::Dict(pairs.len()),
            Node::Array(_) => View::Array,
            Node::ObjectArray(array) => View::ObjectArray(&array.shape, self.items(&array.items)),
            Node::Object(object) => View::Object(Object {
                class: object.class,
                attributes: object.attributes.map(|id| self.of(id)),
            }),
            Node::Tensor(tensor) => match self.tensor(tensor) {
                Some(tensor) => View::Tensor(tensor),
                None => View::Other("a tensor without storage"),
            },
            other => View::Other(other.kind()),
        }
    }

    /// Text, or Python 2's bytes where they are UTF-8.
    pub fn text(self) -> Option<&'a str> {
        match self.view() {
            View::Text(text) => Some(text),
            View::Bytes(bytes) => str::from_utf8(bytes).ok(),
            _ => None,
        }
    }

    /// An integer or a number.
    pub fn number(self) -> Option<f64> {
        match self.view() {
            View::Integer(value) => Some(value as f64),
            View::Float(value) => Some(value),
            _ => None,
        }
    }

    /// The value of a dictionary under a text key. Cost: linear in the size of the dictionary.
    pub fn get(self, key: &str) -> Option<Value<'a>> {
        let Node::Dict(pairs) = self.node() else {
            return None;
        };
        let mut pairs = pairs.iter().rev();
        let found = pairs.find(|&&(known, _)| self.of(known).text() == Some(key));
        found.map(|&(_, value)| self.of(value))
    }

    /// Keys and values of a dictionary in the order of the file, or nothing. A key may come
    /// twice; then the last one counts.
    pub fn entries(self) -> impl Iterator<Item = (Value<'a>, Value<'a>)> + 'a {
        let pairs: &[(Id, Id)] = match self.node() {
            Node::Dict(pairs) => pairs,
            _ => &[],
        };
        pairs
            .iter()
            .map(move |&(key, value)| (self.of(key), self.of(value)))
    }

    /// The values of a list, tuple, set or array of objects.
    pub fn list(self) -> Option<Items<'a>> {
        match self.view() {
            View::List(items) | View::Tuple(items) | View::Set(items) => Some(items),
            View::ObjectArray(_, items) => Some(items),
            _ => None,
        }
    }

    /// An attribute of an object.
    pub fn attribute(self, name: &str) -> Option<Value<'a>> {
        match self.view() {
            View::Object(object) => object.attributes?.get(name),
            _ => None,
        }
    }

    /// A copy of a NumPy array, or of a plain number as an array without dimensions; `key` names
    /// it in errors. Tensors need their file: [`crate::torch::TorchFile::array`].
    ///
    /// # Errors
    /// [`PickleError::Content`] for anything else.
    pub fn array(self, key: &str) -> Result<Array, PickleError> {
        match self.node() {
            Node::Array(array) => Ok(Array::from_parts(
                key,
                array.shape.clone(),
                array.element,
                array.byte_order,
                array.fortran_order,
                self.pickle.bytes.get(array.data).to_vec(),
            )),
            Node::Bool(value) => Ok(Array::boolean(key, *value)),
            Node::Integer(value) => Ok(Array::integer(key, *value)),
            Node::Float(value) => Ok(Array::float(key, *value)),
            _ => Err(self.content(key, "an array")),
        }
    }

    /// What it is, in words.
    pub fn kind(self) -> &'static str {
        self.node().kind()
    }

    /// The error that a value is not what was asked for.
    pub fn content(self, place: &str, expected: &'static str) -> PickleError {
        PickleError::Content {
            place: place.into(),
            expected,
            found: self.kind().into(),
        }
    }

    fn tensor(self, tensor: &'a TensorNode) -> Option<Tensor<'a>> {
        let Node::Storage(storage) = self.of(tensor.storage).node() else {
            return None;
        };
        Some(Tensor {
            storage,
            offset: tensor.offset,
            shape: &tensor.shape,
            strides: &tensor.strides,
        })
    }

    fn node(self) -> &'a Node {
        &self.pickle.nodes[self.id as usize]
    }

    fn items(self, ids: &'a [Id]) -> Items<'a> {
        Items {
            pickle: self.pickle,
            ids,
        }
    }

    const fn of(self, id: Id) -> Self {
        Self {
            pickle: self.pickle,
            id,
        }
    }
}

/// One level only: values may contain themselves.
impl fmt::Debug for Value<'_> {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self.node() {
            Node::Text(blob) | Node::Bytes(blob) => {
                formatter.write_str(&shown(self.pickle.bytes.get(*blob)))
            }
            Node::Integer(value) => value.fmt(formatter),
            Node::Float(value) => value.fmt(formatter),
            other => formatter.write_str(other.kind()),
        }
    }
}

/// Values in a row.
#[derive(Clone, Copy, Debug)]
pub struct Items<'a> {
    pickle: &'a Pickle,
    ids: &'a [Id],
}

impl<'a> Items<'a> {
    /// How many there are.
    pub const fn len(&self) -> usize {
        self.ids.len()
    }

    /// Whether there are none.
    pub const fn is_empty(&self) -> bool {
        self.ids.is_empty()
    }

    /// One of them.
    pub fn get(&self, index: usize) -> Option<Value<'a>> {
        let &id = self.ids.get(index)?;
        Some(Value {
            pickle: self.pickle,
            id,
        })
    }

    /// All of them, in order.
    pub fn iter(&self) -> impl ExactSizeIterator<Item = Value<'a>> + 'a {
        let pickle = self.pickle;
        self.ids.iter().map(move |&id| Value { pickle, id })
    }
}

//! Values as the machine keeps them: numbered, referring to each other by number.

use super::blob::Blob;
use super::global::Global;
use crate::npz::{ByteOrder, Element};

/// Number of a value in its [`super::Pickle`].
pub(super) type Id = u32;

#[derive(Debug)]
pub(super) enum Node {
    None,
    Bool(bool),
    Integer(i64),
    Float(f64),
    Bytes(Blob),
    /// Checked to be UTF-8.
    Text(Blob),
    List(Vec<Id>),
    Tuple(Vec<Id>),
    Set(Vec<Id>),
    /// In the order of the file; of equal keys the last one counts.
    Dict(Vec<(Id, Id)>),
    Global(Global),
    ElementType(ElementType),
    /// An array that is announced but has no content yet.
    UnfilledArray,
    Array(Box<ArrayNode>),
    /// NumPy's array of Python objects.
    ObjectArray(Box<ObjectArrayNode>),
    Object(Box<ObjectNode>),
    Storage(Box<Storage>),
    Tensor(Box<TensorNode>),
}

/// A NumPy `dtype`.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum ElementType {
    Plain(Element, ByteOrder),
    /// References to Python objects.
    Object,
}

/// A NumPy array whose shape and type have been checked against its bytes.
#[derive(Debug)]
pub(super) struct ArrayNode {
    pub(super) shape: Vec<usize>,
    pub(super) element: Element,
    pub(super) byte_order: ByteOrder,
    pub(super) fortran_order: bool,
    pub(super) data: Blob,
}

/// Items in the order of the file.
#[derive(Debug)]
pub(super) struct ObjectArrayNode {
    pub(super) shape: Vec<usize>,
    pub(super) items: Vec<Id>,
}

/// An object that is known by class and attributes only.
#[derive(Debug)]
pub(super) struct ObjectNode {
    pub(super) class: &'static str,
    /// Its attributes, a dictionary, once the file has told them.
    pub(super) attributes: Option<Id>,
}

/// Numbers of a PyTorch tensor; they lie outside the pickle.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Storage {
    /// Type of the numbers.
    pub element: StorageElement,
    /// Name under which the file holds them.
    pub key: String,
    /// How many there are.
    pub count: usize,
}

/// Type of the numbers in a PyTorch storage.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum StorageElement {
    /// A type that NumPy has, too.
    Plain(Element),
    /// The upper half of an `f32`.
    BFloat16,
}

impl StorageElement {
    /// Bytes of one element.
    pub fn size(self) -> usize {
        match self {
            Self::Plain(element) => element.size().unwrap_or(0),
            Self::BFloat16 => 2,
        }
    }
}

#[derive(Debug)]
pub(super) struct TensorNode {
    pub(super) storage: Id,
    pub(super) offset: usize,
    pub(super) shape: Vec<usize>,
    pub(super) strides: Vec<usize>,
}

impl Node {
    /// What it is, in words, for errors.
    pub(super) const fn kind(&self) -> &'static str {
        match self {
            Self::None => "None",
            Self::Bool(_) => "a truth value",
            Self::Integer(_) => "an integer",
            Self::Float(_) => "a number",
            Self::Bytes(_) => "bytes",
            Self::Text(_) => "text",
            Self::List(_) => "a list",
            Self::Tuple(_) => "a tuple",
            Self::Set(_) => "a set",
            Self::Dict(_) => "a dictionary",
            Self::Global(_) => "a function or class",
            Self::ElementType(_) => "an element type",
            Self::UnfilledArray => "an array without content",
            Self::Array(_) => "an array",
            Self::ObjectArray(_) => "an array of objects",
            Self::Object(_) => "an object",
            Self::Storage(_) => "a tensor's storage",
            Self::Tensor(_) => "a tensor",
        }
    }
}

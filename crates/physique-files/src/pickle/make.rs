//! What the listed functions and classes make.

use super::PickleError;
use super::global::Global;
use super::machine::Machine;
use super::node::{Id, Node, ObjectNode, Storage, TensorNode};

/// NumPy's own bound is 64.
const MOST_DIMENSIONS: usize = 64;

impl Machine {
    /// A listed function or class called with arguments.
    pub(super) fn call(&mut self, callable: Global, arguments: &[Id]) -> Result<Id, PickleError> {
        match callable {
            Global::NumpyReconstruct => match arguments {
                [class, _shape, _type]
                    if matches!(self.node(*class), Node::Global(Global::NumpyArray)) =>
                {
                    self.add(Node::UnfilledArray)
                }
                _ => Err(self.wrong(callable, "numpy.ndarray, a shape and a type", arguments)),
            },
            Global::NumpyFromBuffer => self.array_from_buffer(arguments),
            Global::NumpyScalar => self.scalar(arguments),
            Global::NumpyElementType => self.element_type(arguments),
            Global::CodecsEncode => self.encode(arguments),
            Global::CopyReconstructor => match arguments {
                [class, base, state]
                    if matches!(self.node(*base), Node::Global(Global::BaseObject))
                        && matches!(self.node(*state), Node::None) =>
                {
                    match *self.node(*class) {
                        Node::Global(class) => self.construct(class, &[]),
                        _ => Err(self.wrong(callable, "a class", arguments)),
                    }
                }
                _ => Err(self.wrong(callable, "a class, `object` and None", arguments)),
            },
            Global::TorchTensor => self.tensor(arguments),
            Global::TorchParameter => match *arguments {
                [tensor, ..] if matches!(self.node(tensor), Node::Tensor(_)) => Ok(tensor),
                _ => Err(self.wrong(callable, "a tensor first", arguments)),
            },
            Global::ScriptValue => match *arguments {
                [value] | [value, _] => Ok(value),
                _ => Err(self.wrong(callable, "a value", arguments)),
            },
            class => self.construct(class, arguments),
        }
    }

    /// A new object of a listed class.
    pub(super) fn construct(&mut self, class: Global, arguments: &[Id]) -> Result<Id, PickleError> {
        match class {
            Global::Record(name) => match arguments {
                [] => self.object(name),
                _ => Err(self.wrong(class, "no arguments", arguments)),
            },
            Global::JoblibArray if arguments.is_empty() => self.object(class.name()),
            Global::NumpyElementType => self.element_type(arguments),
            Global::Bytes => match *arguments {
                [] => {
                    let empty = self.keep(&[])?;
                    self.add(Node::Bytes(empty))
                }
                [bytes] if matches!(self.node(bytes), Node::Bytes(_)) => Ok(bytes),
                [text, encoding] => self.encode(&[text, encoding]),
                _ => Err(self.wrong(class, "bytes", arguments)),
            },
            Global::Set => match *arguments {
                [] => self.add(Node::Set(Vec::new())),
                [items] => match self.node(items) {
                    Node::List(items) | Node::Tuple(items) => {
                        let items = items.clone();
                        self.charge_items(items.len())?;
                        self.add(Node::Set(items))
                    }
                    _ => Err(self.wrong(class, "a list", arguments)),
                },
                _ => Err(self.wrong(class, "a list", arguments)),
            },
            Global::OrderedDict => self.ordered_dict(arguments),
            Global::DefaultDict => match *arguments {
                [] => self.add(Node::Dict(Vec::new())),
                [factory]
                    if matches!(
                        self.node(factory),
                        Node::None | Node::Global(Global::Factory)
                    ) =>
                {
                    self.add(Node::Dict(Vec::new()))
                }
                _ => Err(self.wrong(class, "a plain type for missing values", arguments)),
            },
            _ => Err(self.wrong(class, "to be called otherwise", arguments)),
        }
    }

    /// Gives an object its state.
    pub(super) fn build(&mut self, target: Id, state: Id) -> Result<(), PickleError> {
        match self.node(target) {
            Node::UnfilledArray => self.fill_array(target, state),
            Node::ElementType(_) => self.finish_element_type(target, state),
            Node::Object(_) => {
                // Classes with slots put their dictionary first in a pair.
                let dictionary = match *self.node(state) {
                    Node::Tuple(ref pair) if pair.len() == 2 => pair[0],
                    _ => state,
                };
                if !matches!(self.node(dictionary), Node::Dict(_)) {
                    let found = self.kind(dictionary).into();
                    return Err(self.malformed("attributes in a dictionary", found));
                }
                if let Node::Object(object) = &mut self.nodes[target as usize] {
                    object.attributes = Some(dictionary);
                }
                Ok(())
            }
            // PyTorch gives ordered dictionaries attributes (`_metadata`): no data of theirs.
            Node::Dict(_) => match self.node(state) {
                Node::Dict(_) => Ok(()),
                other => Err(self.malformed("attributes in a dictionary", other.kind().into())),
            },
            other => Err(self.malformed("an object that takes a state", other.kind().into())),
        }
    }

    /// What a persistent reference stands for: PyTorch's
    /// `('storage', class, key, device, count, ...)`.
    pub(super) fn storage(&self, reference: Id) -> Result<Storage, PickleError> {
        let expected = "a reference to a storage of PyTorch";
        let wrong = |found: &str| self.malformed(expected, found.into());
        let items = self.tuple(reference)?;
        let [tag, class, key, _device, count, ..] = items else {
            return Err(wrong("a shorter tuple"));
        };
        if self.text(*tag) != Some("storage") {
            return Err(wrong(self.kind(*tag)));
        }
        let &Node::Global(Global::TorchStorage(element)) = self.node(*class) else {
            return Err(wrong(self.kind(*class)));
        };
        let (Some(key), Some(count)) = (self.text(*key), self.length(*count)) else {
            return Err(wrong("a key or count of another type"));
        };
        if key.len() > 200 {
            return Err(wrong("a key of more than 200 letters"));
        }
        Ok(Storage {
            element,
            key: key.into(),
            count,
        })
    }

    /// Text, or Python 2's bytes that are text.
    pub(super) fn text(&self, id: Id) -> Option<&str> {
        match self.node(id) {
            Node::Text(blob) | Node::Bytes(blob) => str::from_utf8(self.bytes.get(*blob)).ok(),
            _ => None,
        }
    }

    /// A number of things.
    pub(super) fn length(&self, id: Id) -> Option<usize> {
        match *self.node(id) {
            Node::Integer(length) => usize::try_from(length).ok(),
            _ => None,
        }
    }

    /// A tuple of lengths.
    pub(super) fn lengths(&self, id: Id) -> Result<Vec<usize>, PickleError> {
        let items = self.tuple(id)?;
        if items.len() > MOST_DIMENSIONS {
            let found = format!("{} dimensions", items.len());
            return Err(self.malformed("at most 64 dimensions", found));
        }
        let lengths = items.iter().map(|&item| self.length(item)).collect();
        let lengths: Option<Vec<usize>> = lengths;
        lengths.ok_or_else(|| self.malformed("a tuple of lengths", "something else".into()))
    }

    pub(super) fn wrong(
        &self,
        callable: Global,
        expected: &'static str,
        arguments: &[Id],
    ) -> PickleError {
        let shown = arguments.iter().take(8).map(|&id| self.kind(id));
        let found: Vec<_> = shown.collect();
        PickleError::Call {
            byte: self.byte,
            callable: callable.name(),
            expected,
            found: match found.len() {
                0 => "no arguments".into(),
                _ => found.join(", "),
            },
        }
    }

    fn object(&mut self, class: &'static str) -> Result<Id, PickleError> {
        self.budget.charge(self.byte, size_of::<ObjectNode>())?;
        self.add(Node::Object(Box::new(ObjectNode {
            class,
            attributes: None,
        })))
    }

    /// `_codecs.encode(text, 'latin1')`: how Python 3 writes bytes in protocols 0 to 2.
    fn encode(&mut self, arguments: &[Id]) -> Result<Id, PickleError> {
        let callable = Global::CodecsEncode;
        let expected = "text of the first 256 characters, and `latin1`";
        let [text, encoding] = *arguments else {
            return Err(self.wrong(callable, expected, arguments));
        };
        let latin = matches!(self.text(encoding), Some("latin1" | "latin-1"));
        let (true, &Node::Text(blob)) = (latin, self.node(text)) else {
            return Err(self.wrong(callable, expected, arguments));
        };
        // Charged before it is decoded: the text may be shared by many calls.
        self.budget.charge(self.byte, blob.length)?;
        let text = str::from_utf8(self.bytes.get(blob)).unwrap_or_default();
        let encoded: Option<Vec<u8>> = text
            .chars()
            .map(|letter| u8::try_from(u32::from(letter)).ok())
            .collect();
        let Some(encoded) = encoded else {
            return Err(self.wrong(callable, expected, arguments));
        };
        let blob = self.keep(&encoded)?;
        self.add(Node::Bytes(blob))
    }

    /// Empty, or from a list of pairs as Python 2 wrote it.
    fn ordered_dict(&mut self, arguments: &[Id]) -> Result<Id, PickleError> {
        let wrong =
            |machine: &Self| machine.wrong(Global::OrderedDict, "a list of pairs", arguments);
        let mut pairs = Vec::new();
        if let Some(&list) = arguments.first() {
            let Node::List(items) = self.node(list) else {
                return Err(wrong(self));
            };
            let count = items.len();
            self.charge_items(count.saturating_mul(2))?;
            let Node::List(items) = self.node(list) else {
                return Err(wrong(self));
            };
            for &item in items {
                match self.node(item) {
                    Node::List(pair) | Node::Tuple(pair) if pair.len() == 2 => {
                        pairs.push((pair[0], pair[1]));
                    }
                    _ => return Err(wrong(self)),
                }
            }
        }
        self.add(Node::Dict(pairs))
    }

    /// `_rebuild_tensor_v2(storage, offset, shape, strides, requires_grad, hooks)`.
    fn tensor(&mut self, arguments: &[Id]) -> Result<Id, PickleError> {
        let expected = "a storage, an offset, a shape and strides within the storage";
        let wrong = |machine: &Self| machine.wrong(Global::TorchTensor, expected, arguments);
        let [storage, offset, shape, strides, ..] = *arguments else {
            return Err(wrong(self));
        };
        let Some(offset) = self.length(offset) else {
            return Err(wrong(self));
        };
        let (shape, strides) = (self.lengths(shape)?, self.lengths(strides)?);
        let Node::Storage(numbers) = self.node(storage) else {
            return Err(wrong(self));
        };
        // The last number that the tensor reaches, unless it is empty.
        let within = shape.len() == strides.len()
            && (shape.contains(&0)
                || shape
                    .iter()
                    .zip(&strides)
                    .try_fold(offset, |last, (&length, &stride)| {
                        last.checked_add((length - 1).checked_mul(stride)?)
                    })
                    .is_some_and(|last| last < numbers.count));
        if !within {
            return Err(wrong(self));
        }
        let held = size_of::<TensorNode>() + 2 * size_of_val(&shape[..]);
        self.budget.charge(self.byte, held)?;
        self.add(Node::Tensor(Box::new(TensorNode {
            storage,
            offset,
            shape,
            strides,
        })))
    }
}

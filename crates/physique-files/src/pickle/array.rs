//! NumPy's arrays, element types and scalars inside pickles.

use super::PickleError;
use super::blob::Blob;
use super::global::Global;
use super::machine::Machine;
use super::node::{ArrayNode, ElementType, Id, Node, ObjectArrayNode};
use crate::npz::{ByteOrder, Element};

impl Machine {
    /// `dtype('f8', False, True)`; the byte order comes later, as its state.
    pub(super) fn element_type(&mut self, arguments: &[Id]) -> Result<Id, PickleError> {
        let name = arguments.first().and_then(|&name| self.text(name));
        let parsed = name.and_then(|name| match name {
            "O" | "O8" | "O4" | "|O" => Some(ElementType::Object),
            plain if plain.starts_with(['<', '>', '|', '=']) => parse(plain),
            plain => parse(&format!("<{plain}")),
        });
        match parsed {
            Some(element_type) => self.add(Node::ElementType(element_type)),
            None => {
                let expected = "numbers, text or objects";
                let Some(name) = name else {
                    return Err(self.wrong(Global::NumpyElementType, expected, arguments));
                };
                Err(PickleError::Call {
                    byte: self.byte,
                    callable: Global::NumpyElementType.name(),
                    expected,
                    found: format!("`{}`", name.chars().take(40).collect::<String>()),
                })
            }
        }
    }

    /// State of a `dtype`: version, byte order, and fields, which plain types do not have.
    pub(super) fn finish_element_type(&mut self, target: Id, state: Id) -> Result<(), PickleError> {
        let expected = "a plain element type: a version, a byte order and no fields";
        let state = self.tuple(state)?;
        let found = || format!("a tuple of {} values", state.len());
        let &[_version, order, subtype, names, fields, ..] = state else {
            return Err(self.malformed(expected, found()));
        };
        let plain = [subtype, names, fields]
            .iter()
            .all(|&id| matches!(self.node(id), Node::None));
        let order = match self.text(order) {
            Some("<" | "|" | "=") if plain => ByteOrder::Little,
            Some(">") if plain => ByteOrder::Big,
            _ => return Err(self.malformed(expected, found())),
        };
        if let Node::ElementType(ElementType::Plain(_, stored)) = &mut self.nodes[target as usize] {
            *stored = order;
        }
        Ok(())
    }

    /// State of an `ndarray`: `(version, shape, dtype, is_fortran, bytes or list)`; the version
    /// is missing in the oldest.
    pub(super) fn fill_array(&mut self, target: Id, state: Id) -> Result<(), PickleError> {
        let state = self.tuple(state)?;
        let (&[shape, element_type, fortran, data] | &[_, shape, element_type, fortran, data]) =
            state
        else {
            let found = format!("a tuple of {} values", state.len());
            return Err(self.malformed("the state of an array", found));
        };
        let fortran_order = match *self.node(fortran) {
            Node::Bool(fortran) => fortran,
            Node::Integer(fortran) => fortran != 0,
            _ => return Err(self.malformed("a memory order", self.kind(fortran).into())),
        };
        let node = self.array(shape, element_type, fortran_order, data)?;
        self.nodes[target as usize] = node;
        Ok(())
    }

    /// `_frombuffer(bytes, dtype, shape, 'C')`: protocol 5.
    pub(super) fn array_from_buffer(&mut self, arguments: &[Id]) -> Result<Id, PickleError> {
        let wrong = |machine: &Self| {
            let expected = "bytes, an element type, a shape and `C` or `F`";
            machine.wrong(Global::NumpyFromBuffer, expected, arguments)
        };
        let &[data, element_type, shape, order] = arguments else {
            return Err(wrong(self));
        };
        let fortran_order = match self.text(order) {
            Some("C") => false,
            Some("F") => true,
            _ => return Err(wrong(self)),
        };
        let node = self.array(shape, element_type, fortran_order, data)?;
        self.add(node)
    }

    /// `scalar(dtype, bytes)`: an array without dimensions.
    pub(super) fn scalar(&mut self, arguments: &[Id]) -> Result<Id, PickleError> {
        let &[element_type, data] = arguments else {
            let expected = "an element type and bytes";
            return Err(self.wrong(Global::NumpyScalar, expected, arguments));
        };
        let node = self.checked_array(Vec::new(), element_type, false, data)?;
        self.add(node)
    }

    /// joblib writes the bytes of an array right behind the object that describes it. Returns
    /// where the pickle goes on.
    pub(super) fn bytes_behind_joblib_array(
        &mut self,
        position: usize,
        end: usize,
    ) -> Result<usize, PickleError> {
        let target = self.top()?;
        let Node::Object(object) = self.node(target) else {
            return Ok(position);
        };
        if object.class != Global::JoblibArray.name() {
            return Ok(position);
        }
        let attribute = |name: &str| {
            let Node::Dict(pairs) = self.node(object.attributes?) else {
                return None;
            };
            let mut pairs = pairs.iter().rev();
            let found = pairs.find(|&&(key, _)| self.text(key) == Some(name));
            found.map(|&(_, value)| value)
        };
        let (Some(shape), Some(element_type)) = (attribute("shape"), attribute("dtype")) else {
            return Err(self.malformed("a shape and a dtype", "none".into()));
        };
        let &Node::ElementType(ElementType::Plain(element, byte_order)) = self.node(element_type)
        else {
            let found = self.kind(element_type).into();
            return Err(self.malformed("an array of plain elements", found));
        };
        let fortran_order = attribute("order").and_then(|order| self.text(order)) == Some("F");
        let aligned = attribute("numpy_array_alignment_bytes")
            .is_some_and(|alignment| !matches!(self.node(alignment), Node::None));
        let shape = self.lengths(shape)?;
        let length = self.data_length(&shape, element)?;
        // Newer versions: one byte says how many follow before the data is aligned.
        let padding = match self.bytes.file().get(position) {
            Some(&padding) if aligned => 1 + usize::from(padding),
            _ => 0,
        };
        let start = position + padding;
        let limit = end.min(self.bytes.file().len());
        if limit.checked_sub(start).is_none_or(|left| left < length) {
            return Err(PickleError::Truncated {
                byte: position,
                expected: "the data of an array",
            });
        }
        self.budget.charge(self.byte, size_of::<ArrayNode>())?;
        self.nodes[target as usize] = Node::Array(Box::new(ArrayNode {
            shape,
            element,
            byte_order,
            fortran_order,
            data: Blob { start, length },
        }));
        Ok(start + length)
    }

    fn array(
        &mut self,
        shape: Id,
        element_type: Id,
        fortran_order: bool,
        data: Id,
    ) -> Result<Node, PickleError> {
        // Protocol 5 may write a shape of one dimension as a number.
        let shape = match self.length(shape) {
            Some(length) => vec![length],
            None => self.lengths(shape)?,
        };
        self.checked_array(shape, element_type, fortran_order, data)
    }

    /// An array whose bytes or items are exactly as many as its shape asks for.
    fn checked_array(
        &mut self,
        shape: Vec<usize>,
        element_type: Id,
        fortran_order: bool,
        data: Id,
    ) -> Result<Node, PickleError> {
        let &Node::ElementType(element_type) = self.node(element_type) else {
            let found = self.kind(element_type).into();
            return Err(self.malformed("an element type", found));
        };
        let held = size_of::<ArrayNode>() + 2 * size_of_val(&shape[..]);
        self.budget.charge(self.byte, held)?;
        match (element_type, self.node(data)) {
            (ElementType::Plain(element, byte_order), &Node::Bytes(data)) => {
                let expected = self.data_length(&shape, element)?;
                if expected != data.length {
                    let found = format!("{} bytes for shape {shape:?} of {element:?}", data.length);
                    return Err(self.malformed("as many bytes as the shape asks for", found));
                }
                Ok(Node::Array(Box::new(ArrayNode {
                    shape,
                    element,
                    byte_order,
                    fortran_order,
                    data,
                })))
            }
            (ElementType::Object, Node::List(items)) => {
                let count = items.len();
                let product = shape.iter().copied().try_fold(1, usize::checked_mul);
                if product != Some(count) {
                    let found = format!("{count} objects for shape {shape:?}");
                    return Err(self.malformed("as many objects as the shape asks for", found));
                }
                self.charge_items(count)?;
                let Node::List(items) = self.node(data) else {
                    return Err(self.malformed("a list of objects", self.kind(data).into()));
                };
                Ok(Node::ObjectArray(Box::new(ObjectArrayNode {
                    shape,
                    items: items.clone(),
                })))
            }
            (_, other) => Err(self.malformed("the data of an array", other.kind().into())),
        }
    }

    /// Bytes of an array; the error tells of overflow and of elements without bytes.
    fn data_length(&self, shape: &[usize], element: Element) -> Result<usize, PickleError> {
        let size = element.size().filter(|&size| size > 0);
        // An empty dimension must not hide the overflow of its neighbours.
        let product = |least: usize| {
            let mut lengths = shape.iter().map(|&length| length.max(least));
            lengths.try_fold(size?, usize::checked_mul)
        };
        match (product(1), product(0)) {
            (Some(_), Some(length)) => Ok(length),
            _ => {
                let found = format!("shape {shape:?} of {element:?}");
                Err(self.malformed("an array that fits this machine", found))
            }
        }
    }
}

fn parse(type_string: &str) -> Option<ElementType> {
    let type_string = type_string.replacen('=', "<", 1);
    let (element, order) = Element::parse(&type_string).ok()?;
    Some(ElementType::Plain(element, order))
}

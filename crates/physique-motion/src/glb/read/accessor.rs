//! Arrays of numbers in buffers.

use std::collections::HashMap;
use std::rc::Rc;

use super::Context;
use super::buffers::Buffers;
use super::document::{Accessor, Document, Sparse};
use crate::Error;

/// The arrays of a document. Each is decoded once; together they stay within the limit.
pub(super) struct Accessors<'a> {
    document: &'a Document<'a>,
    buffers: Buffers<'a>,
    decoded: HashMap<usize, Rc<[f32]>>,
    /// Bytes of all that were decoded.
    total: u64,
}

/// How a number is stored.
#[derive(Clone, Copy)]
enum Component {
    I8,
    U8,
    I16,
    U16,
    U32,
    F32,
}

impl Component {
    fn from_code(code: u32) -> Option<Self> {
        Some(match code {
            5120 => Self::I8,
            5121 => Self::U8,
            5122 => Self::I16,
            5123 => Self::U16,
            5125 => Self::U32,
            5126 => Self::F32,
            _ => return None,
        })
    }

    const fn size(self) -> usize {
        match self {
            Self::I8 | Self::U8 => 1,
            Self::I16 | Self::U16 => 2,
            Self::U32 | Self::F32 => 4,
        }
    }

    /// The number that the first bytes hold; 0 where there are too few. `normalized` spreads
    /// whole numbers over -1 to 1, or 0 to 1.
    fn number(self, bytes: &[u8], normalized: bool) -> f32 {
        let half = || bytes.first_chunk::<2>().copied().unwrap_or_default();
        let word = || bytes.first_chunk::<4>().copied().unwrap_or_default();
        let byte = bytes.first().copied().unwrap_or_default();
        let (number, largest) = match self {
            Self::I8 => (f32::from(byte.cast_signed()), 127.0),
            Self::U8 => (f32::from(byte), 255.0),
            Self::I16 => (f32::from(i16::from_le_bytes(half())), 32767.0),
            Self::U16 => (f32::from(u16::from_le_bytes(half())), 65535.0),
            Self::U32 => return u32::from_le_bytes(word()) as f32,
            Self::F32 => return f32::from_le_bytes(word()),
        };
        if normalized {
            (number / largest).max(-1.0)
        } else {
            number
        }
    }
}

impl<'a> Accessors<'a> {
    pub(super) fn new(document: &'a Document<'a>, buffers: Buffers<'a>) -> Self {
        Self {
            document,
            buffers,
            decoded: HashMap::new(),
            total: 0,
        }
    }

    /// Numbers of an accessor of this `kind` (`SCALAR`, `VEC3`, `VEC4`, `MAT4`), all of
    /// ordinary size.
    pub(super) fn numbers(
        &mut self,
        index: usize,
        kind: &str,
        context: &Context<'_>,
    ) -> Result<Rc<[f32]>, Error> {
        let place = format!("accessor {index}");
        let Some(accessor) = self.document.accessors.get(index) else {
            let found = format!("{} of them", self.document.accessors.len());
            return Err(context.format(place, "an accessor of this number", found));
        };
        if accessor.kind != kind {
            let found: String = accessor.kind.chars().take(20).collect();
            return Err(context.format(place, kind, found.escape_debug().to_string()));
        }
        if let Some(numbers) = self.decoded.get(&index) {
            return Ok(Rc::clone(numbers));
        }
        let width = match kind {
            "SCALAR" => 1,
            "VEC3" => 3,
            "VEC4" => 4,
            _ => 16,
        };
        let bytes = (accessor.count as u64).saturating_mul(4 * width as u64);
        let total = self.total.saturating_add(bytes);
        let what = "the size in bytes of its arrays";
        context.check(what, total, context.options.limits.bytes)?;
        let numbers = self.decode(accessor, width, &place, context)?;
        // What stays finite in 32 bits, however many scales multiply.
        let is_ordinary = |number: &f32| number.abs() < 1e12;
        if let Some(at) = numbers.iter().position(|number| !is_ordinary(number)) {
            let place = format!("{place}, element {}", at / width);
            return Err(context.format(place, "numbers of ordinary size", numbers[at].to_string()));
        }
        self.total = total;
        let numbers: Rc<[f32]> = numbers.into();
        self.decoded.insert(index, Rc::clone(&numbers));
        Ok(numbers)
    }

    fn decode(
        &mut self,
        accessor: &Accessor,
        width: usize,
        place: &str,
        context: &Context<'_>,
    ) -> Result<Vec<f32>, Error> {
        let component = component(accessor.component_type, place, context)?;
        let size = component.size() * width;
        let store = |numbers: &mut [f32], element: &[u8]| {
            let parts = element.chunks_exact(component.size());
            for (number, part) in numbers.iter_mut().zip(parts) {
                *number = component.number(part, accessor.normalized);
            }
        };
        // Where the bytes lie is checked before memory is taken.
        let mut numbers = Vec::new();
        if let Some(view) = accessor.buffer_view {
            let source = Source {
                view,
                offset: accessor.byte_offset,
                size,
                count: accessor.count,
            };
            let elements = self.elements(&source, place, context)?;
            numbers = vec![0.0; accessor.count * width];
            for (numbers, element) in numbers.chunks_exact_mut(width).zip(elements) {
                store(numbers, element);
            }
        }
        numbers.resize(accessor.count * width, 0.0);
        if let Some(sparse) = &accessor.sparse {
            let replaced = self.sparse_indices(sparse, accessor.count, place, context)?;
            let source = Source {
                view: sparse.values.buffer_view,
                offset: sparse.values.byte_offset,
                size,
                count: sparse.count,
            };
            let elements = self.elements(&source, place, context)?;
            for (index, element) in replaced.into_iter().zip(elements) {
                store(&mut numbers[index * width..], element);
            }
        }
        Ok(numbers)
    }

    /// Which elements a sparse accessor replaces, all below `count`.
    fn sparse_indices(
        &mut self,
        sparse: &Sparse,
        count: usize,
        place: &str,
        context: &Context<'_>,
    ) -> Result<Vec<usize>, Error> {
        if sparse.count > count {
            let expected = format!("at most {count} sparse elements");
            return Err(context.format(place, expected, sparse.count.to_string()));
        }
        let component = component(sparse.indices.component_type, place, context)?;
        let source = Source {
            view: sparse.indices.buffer_view,
            offset: sparse.indices.byte_offset,
            size: component.size(),
            count: sparse.count,
        };
        // Little-endian, of one, two or four bytes.
        let index = |element: &[u8]| {
            let bytes = element.iter().rev();
            bytes.fold(0, |index, &byte| index << 8 | usize::from(byte))
        };
        let elements = self.elements(&source, place, context)?;
        let indices: Vec<usize> = elements.map(index).collect();
        match indices.iter().find(|&&index| index >= count) {
            None => Ok(indices),
            Some(index) => {
                let expected = format!("sparse indices below {count}");
                Err(context.format(place, expected, index.to_string()))
            }
        }
    }

    /// The elements of a view, one after the other.
    fn elements(
        &mut self,
        source: &Source,
        place: &str,
        context: &Context<'_>,
    ) -> Result<impl Iterator<Item = &[u8]>, Error> {
        let Some(view) = self.document.buffer_views.get(source.view) else {
            let expected = format!("buffer view {}", source.view);
            let found = format!("{} of them", self.document.buffer_views.len());
            return Err(context.format(place, expected, found));
        };
        if let Some(name) = view
            .extensions
            .keys()
            .find(|name| name.contains("compression"))
        {
            let found = name.escape_debug().to_string();
            return Err(context.format(place, "a plain buffer view", found));
        }
        let stride = view
            .byte_stride
            .filter(|&stride| stride > 0)
            .unwrap_or(source.size);
        let buffer = self.buffers.get(view.buffer, context)?;
        let bytes = view
            .byte_offset
            .checked_add(view.byte_length)
            .and_then(|end| buffer.get(view.byte_offset..end))
            .and_then(|bytes| bytes.get(source.offset..));
        // The last element may be shorter than a stride.
        let needed = match source.count.checked_sub(1) {
            None => Some(0),
            Some(others) => others
                .checked_mul(stride)
                .and_then(|others| others.checked_add(source.size)),
        };
        match (bytes, needed) {
            (Some(bytes), Some(needed)) if needed <= bytes.len() && stride >= source.size => {
                let size = source.size;
                Ok(bytes[..needed]
                    .chunks(stride)
                    .map(move |element| &element[..size]))
            }
            _ => {
                let expected = format!(
                    "{} elements of {} bytes within buffer view {} and its buffer",
                    source.count, source.size, source.view
                );
                Err(context.format(place, expected, "fewer bytes"))
            }
        }
    }
}

/// Where elements lie.
struct Source {
    view: usize,
    /// From the start of the view.
    offset: usize,
    /// Bytes of an element.
    size: usize,
    count: usize,
}

fn component(code: u32, place: &str, context: &Context<'_>) -> Result<Component, Error> {
    Component::from_code(code)
        .ok_or_else(|| context.format(place, "a component type of glTF 2.0", code.to_string()))
}

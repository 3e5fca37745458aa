//! One array: its shape, its type, and its elements as the caller wants them.

use half::f16;

use super::header::Header;
use super::{ArrayError, ArrayLimits, ByteOrder, Element};

/// A checked array of plain elements.
///
/// Elements are decoded when asked for, always in C order (the last index runs fastest), whatever
/// the order in the file.
#[derive(Clone, Debug)]
pub struct Array {
    key: String,
    shape: Vec<usize>,
    element: Element,
    byte_order: ByteOrder,
    fortran_order: bool,
    count: usize,
    data: Vec<u8>,
}

impl Array {
    /// Reads the bytes of a `.npy` file; `key` names it in errors.
    ///
    /// # Errors
    /// [`ArrayError::Header`], [`ArrayError::ElementType`], [`ArrayError::Shape`],
    /// [`ArrayError::Bytes`] or [`ArrayError::DataLength`].
    pub fn from_npy(
        key: &str,
        mut bytes: Vec<u8>,
        limits: &ArrayLimits,
    ) -> Result<Self, ArrayError> {
        let header = Header::parse(key, &bytes, limits)?;
        let found = bytes.len() - header.data_start;
        if found != header.data_bytes {
            return Err(ArrayError::DataLength {
                key: key.into(),
                expected: header.data_bytes as u64,
                found: found as u64,
            });
        }
        bytes.drain(..header.data_start);
        Ok(Self {
            key: key.into(),
            shape: header.shape,
            element: header.element,
            byte_order: header.byte_order,
            fortran_order: header.fortran_order,
            count: header.count,
            data: bytes,
        })
    }

    /// An array whose data has been checked to be as long as shape and element ask for.
    pub(crate) fn from_parts(
        key: &str,
        shape: Vec<usize>,
        element: Element,
        byte_order: ByteOrder,
        fortran_order: bool,
        data: Vec<u8>,
    ) -> Self {
        Self {
            key: key.into(),
            count: shape.iter().product(),
            shape,
            element,
            byte_order,
            fortran_order,
            data,
        }
    }

    /// One number, in an array without dimensions.
    pub(crate) fn float(key: &str, value: f64) -> Self {
        Self::single(key, Element::Float(8), value.to_le_bytes().into())
    }

    /// One integer, in an array without dimensions.
    pub(crate) fn integer(key: &str, value: i64) -> Self {
        Self::single(key, Element::Int(8), value.to_le_bytes().into())
    }

    /// One truth value, in an array without dimensions.
    pub(crate) fn boolean(key: &str, value: bool) -> Self {
        Self::single(key, Element::Bool, vec![value.into()])
    }

    fn single(key: &str, element: Element, data: Vec<u8>) -> Self {
        Self::from_parts(key, Vec::new(), element, ByteOrder::Little, false, data)
    }

    /// Name of the array in its archive.
    pub fn key(&self) -> &str {
        &self.key
    }

    /// Length of every dimension; empty for a single value.
    pub fn shape(&self) -> &[usize] {
        &self.shape
    }

    /// Type of the elements.
    pub const fn element(&self) -> Element {
        self.element
    }

    /// Bytes of all elements.
    pub const fn byte_count(&self) -> usize {
        self.data.len()
    }

    /// Elements of any numeric type as `f64`; 64-bit integers above 2^53 are rounded.
    ///
    /// # Errors
    /// [`ArrayError::Content`] for text.
    pub fn to_f64(&self) -> Result<Vec<f64>, ArrayError> {
        match self.element {
            Element::Float(2) => self.decode(|bytes| f16::from_le_bytes(bytes).to_f64()),
            Element::Float(4) => self.decode(|bytes| f64::from(f32::from_le_bytes(bytes))),
            Element::Float(_) => self.decode(f64::from_le_bytes),
            Element::Uint(8) => self.decode(|bytes| u64::from_le_bytes(bytes) as f64),
            Element::Text(_) | Element::Bytes(_) => Err(self.content("numbers")),
            _ => Ok(self
                .to_i64()?
                .into_iter()
                .map(|value| value as f64)
                .collect()),
        }
    }

    /// Elements of any numeric type as `f32`, rounded to nearest.
    ///
    /// # Errors
    /// [`ArrayError::Content`] for text.
    pub fn to_f32(&self) -> Result<Vec<f32>, ArrayError> {
        match self.element {
            Element::Float(4) => self.decode(f32::from_le_bytes),
            Element::Float(2) => self.decode(|bytes| f16::from_le_bytes(bytes).to_f32()),
            _ => Ok(self
                .to_f64()?
                .into_iter()
                .map(|value| value as f32)
                .collect()),
        }
    }

    /// Elements of any integer or truth type.
    ///
    /// # Errors
    /// [`ArrayError::Content`] for floating-point numbers and text, and for values above `i64`.
    pub fn to_i64(&self) -> Result<Vec<i64>, ArrayError> {
        match self.element {
            Element::Bool => self.decode(|[byte]: [u8; 1]| i64::from(byte != 0)),
            Element::Int(1) => self.decode(|bytes| i64::from(i8::from_le_bytes(bytes))),
            Element::Int(2) => self.decode(|bytes| i64::from(i16::from_le_bytes(bytes))),
            Element::Int(4) => self.decode(|bytes| i64::from(i32::from_le_bytes(bytes))),
            Element::Int(_) => self.decode(i64::from_le_bytes),
            Element::Uint(1) => self.decode(|bytes| i64::from(u8::from_le_bytes(bytes))),
            Element::Uint(2) => self.decode(|bytes| i64::from(u16::from_le_bytes(bytes))),
            Element::Uint(4) => self.decode(|bytes| i64::from(u32::from_le_bytes(bytes))),
            Element::Uint(_) => {
                let values = self.decode(u64::from_le_bytes)?;
                let signed = values
                    .into_iter()
                    .map(i64::try_from)
                    .collect::<Result<_, _>>();
                signed.map_err(|_| self.content("integers below 2^63"))
            }
            _ => Err(self.content("integers")),
        }
    }

    /// The only element, as a number.
    ///
    /// # Errors
    /// [`ArrayError::Content`] for text and for any count but one.
    pub fn number(&self) -> Result<f64, ArrayError> {
        match self.to_f64()?.as_slice() {
            [value] => Ok(*value),
            _ => Err(self.content("one number")),
        }
    }

    /// The only element, as text without the zeros that pad it.
    ///
    /// # Errors
    /// [`ArrayError::Content`] for numbers, for any count but one, and for broken characters.
    pub fn text(&self) -> Result<String, ArrayError> {
        if self.count != 1 {
            return Err(self.content("one text"));
        }
        let text = match self.element {
            Element::Bytes(_) => String::from_utf8(self.data.clone()).ok(),
            Element::Text(_) => {
                let characters = self.data.chunks_exact(4).map(|bytes| {
                    let code = [bytes[0], bytes[1], bytes[2], bytes[3]];
                    char::from_u32(match self.byte_order {
                        ByteOrder::Little => u32::from_le_bytes(code),
                        ByteOrder::Big => u32::from_be_bytes(code),
                    })
                });
                characters.collect()
            }
            _ => return Err(self.content("text")),
        };
        let text = text.ok_or_else(|| self.content("text of valid characters"))?;
        Ok(text.trim_end_matches('\0').to_owned())
    }

    /// Decodes every element from its bytes in little-endian order.
    fn decode<const SIZE: usize, T: Copy>(
        &self,
        from_le_bytes: impl Fn([u8; SIZE]) -> T,
    ) -> Result<Vec<T>, ArrayError> {
        let (elements, _) = self.data.as_chunks::<SIZE>();
        let values: Vec<T> = match self.byte_order {
            ByteOrder::Little => elements.iter().map(|&bytes| from_le_bytes(bytes)).collect(),
            ByteOrder::Big => {
                let reversed = elements.iter().map(|&(mut bytes)| {
                    bytes.reverse();
                    from_le_bytes(bytes)
                });
                reversed.collect()
            }
        };
        Ok(if self.fortran_order {
            c_order(&self.shape, &values)
        } else {
            values
        })
    }

    fn content(&self, expected: &'static str) -> ArrayError {
        ArrayError::Content {
            key: self.key.clone(),
            expected,
            found: format!("{:?} in shape {:?}", self.element, self.shape),
        }
    }
}

/// Reorders values whose first index runs fastest so that the last one does.
fn c_order<T: Copy>(shape: &[usize], values: &[T]) -> Vec<T> {
    let mut index = vec![0_usize; shape.len()];
    let strides: Vec<usize> = shape
        .iter()
        .scan(1, |stride, &length| {
            let here = *stride;
            *stride *= length;
            Some(here)
        })
        .collect();
    let mut ordered = Vec::with_capacity(values.len());
    let mut source = 0;
    while ordered.len() < values.len() {
        ordered.push(values[source]);
        // Count up the last index, carrying into those before it.
        for axis in (0..shape.len()).rev() {
            index[axis] += 1;
            source += strides[axis];
            if index[axis] < shape[axis] {
                break;
            }
            source -= strides[axis] * shape[axis];
            index[axis] = 0;
        }
    }
    ordered
}

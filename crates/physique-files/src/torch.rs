//! PyTorch's `.pt` and `.pth` files as data.
//!
//! `torch.save` writes a pickle that describes tensors, and beside it their numbers: since
//! PyTorch 1.6 as entries of a ZIP archive, before that one after the other behind five pickles.
//! Both are read; modules, optimisers and anything else that is more than data is refused by name,
//! as everywhere in [`crate::pickle`]. `torch.jit.save` writes the same archive around a program:
//! its modules are objects of which only the attributes are read, parameters and modules among them;
//! its code is not looked at. The tar files of PyTorch 0.1 are refused.

mod legacy;
mod zipped;

use std::collections::HashMap;
use std::ops::Range;

use crate::Error;
use crate::npz::{Archive, Array, ArrayLimits, ByteOrder, Element};
use crate::pickle::{Pickle, PickleLimits, StorageElement, Tensor, Value, View};

/// A PyTorch file: a pickle and the numbers of its tensors.
#[derive(Debug)]
pub struct TorchFile {
    pickle: Pickle,
    storages: HashMap<String, Numbers>,
    byte_order: ByteOrder,
    limit: u64,
}

/// The bytes of one storage.
#[derive(Debug)]
enum Numbers {
    /// Unpacked from the archive.
    Own(Vec<u8>),
    /// Within the bytes of the old format.
    Within(std::sync::Arc<[u8]>, Range<usize>),
}

impl Numbers {
    fn bytes(&self) -> &[u8] {
        match self {
            Self::Own(bytes) => bytes,
            Self::Within(bytes, range) => &bytes[range.clone()],
        }
    }
}

impl TorchFile {
    /// Reads a file of either form.
    ///
    /// # Errors
    /// [`Error::Torch`] where it is none, and all of [`Archive::entry`] and [`Pickle::read`].
    pub fn read(
        bytes: Vec<u8>,
        arrays: &ArrayLimits,
        pickles: &PickleLimits,
    ) -> Result<Self, Error> {
        if Archive::looks_like(&bytes) {
            zipped::read(bytes, arrays, pickles)
        } else {
            legacy::read(bytes, arrays, pickles)
        }
    }

    /// Whether bytes start as the form before PyTorch 1.6 does.
    pub fn looks_like_legacy(bytes: &[u8]) -> bool {
        bytes.starts_with(legacy::START)
    }

    /// The saved value; its tensors are read by [`TorchFile::array`].
    pub const fn root(&self) -> Value<'_> {
        self.pickle.root()
    }

    /// The numbers of a tensor, or of a NumPy array in the file, in C order; `key` names it in
    /// errors.
    ///
    /// # Errors
    /// [`Error::Torch`] for a storage that is missing or too short, or for a tensor that unfolds
    /// to more than the limit (a tensor may show one number many times).
    pub fn array(&self, value: Value<'_>, key: &str) -> Result<Array, Error> {
        match value.view() {
            View::Tensor(tensor) => self.tensor(&tensor, key),
            _ => Ok(value.array(key)?),
        }
    }

    fn tensor(&self, tensor: &Tensor<'_>, key: &str) -> Result<Array, Error> {
        let storage = tensor.storage;
        let error = |expected, found: String| Error::Torch {
            place: format!("tensor `{key}`"),
            expected,
            found,
        };
        let numbers = self.storages.get(&storage.key).map(Numbers::bytes);
        let numbers = numbers.ok_or_else(|| {
            let found = format!("none called `{}`", storage.key.escape_debug());
            error("its storage in the file", found)
        })?;
        let size = storage.element.size();
        if storage.count.checked_mul(size) != Some(numbers.len()) {
            let found = format!("{} bytes for {} numbers", numbers.len(), storage.count);
            return Err(error("a storage as long as the pickle says", found));
        }
        let lengths = tensor.shape.iter().copied();
        let count = lengths.clone().try_fold(1, usize::checked_mul);
        let unfolded = count.and_then(|count| count.checked_mul(size));
        let unfolded = unfolded.filter(|&bytes| bytes as u64 <= self.limit);
        let (Some(count), Some(unfolded)) = (count, unfolded) else {
            let found = format!("shape {:?}", tensor.shape);
            return Err(error("a tensor within the limit of bytes", found));
        };

        let mut data = Vec::with_capacity(unfolded);
        let mut index = vec![0; tensor.shape.len()];
        let mut source = tensor.offset;
        for _ in 0..count {
            // The pickle reader has checked that every index lies within the storage.
            data.extend_from_slice(&numbers[source * size..(source + 1) * size]);
            for axis in (0..index.len()).rev() {
                index[axis] += 1;
                source += tensor.strides[axis];
                if index[axis] < tensor.shape[axis] {
                    break;
                }
                source -= tensor.strides[axis] * tensor.shape[axis];
                index[axis] = 0;
            }
        }
        let shape = tensor.shape.to_vec();
        let (element, order) = match storage.element {
            StorageElement::Plain(element) => (element, self.byte_order),
            StorageElement::BFloat16 => {
                data = widened(&data, self.byte_order);
                (Element::Float(4), ByteOrder::Little)
            }
        };
        Ok(Array::from_parts(key, shape, element, order, false, data))
    }
}

/// Little-endian `f32` from their upper halves.
fn widened(halves: &[u8], order: ByteOrder) -> Vec<u8> {
    let halves = halves.as_chunks::<2>().0.iter();
    let widened = halves.flat_map(|&half| match order {
        ByteOrder::Little => [0, 0, half[0], half[1]],
        ByteOrder::Big => [0, 0, half[1], half[0]],
    });
    widened.collect()
}

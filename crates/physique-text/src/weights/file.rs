//! Reading `.safetensors`, `.pt` and `.bin`.

use std::collections::BTreeMap;
use std::path::Path;

use half::{bf16, f16};
use physique_files::npz::Archive;
use physique_files::{named_arrays, read_file};
use safetensors::{Dtype, SafeTensors};

use super::{Numbers, Tensor, Weights};
use crate::{Error, TextLimits};

/// OpenAI's own file of CLIP: a TorchScript program, of which the parameters are read.
pub(crate) const OPENAI_FILE: &str = "ViT-B-32.pt";

/// Names under which folders keep weights, the better one first.
const FILES: [&str; 5] = [
    "model.safetensors",
    "pytorch_model.bin",
    "open_clip_pytorch_model.bin",
    "model.pt",
    OPENAI_FILE,
];

impl Weights {
    /// The weights of a folder, or of a file named outright.
    pub(crate) fn read(path: &Path, limits: &TextLimits) -> Result<Self, Error> {
        let file = if path.is_dir() {
            let files = FILES.iter().map(|name| path.join(name));
            let found = files.into_iter().find(|file| file.exists());
            found.ok_or_else(|| Error::Missing {
                folder: path.into(),
                expected: "model.safetensors or pytorch_model.bin",
            })?
        } else {
            path.to_owned()
        };
        let bytes = read_file(&file, limits.weight_bytes)?;
        if Archive::looks_like(&bytes) || bytes.starts_with(b"\x80") {
            Self::torch(bytes, &file, limits)
        } else {
            Self::safetensors(&bytes, &file)
        }
    }

    /// The tensors of a safetensors file; `path` names it in errors.
    pub(crate) fn safetensors(bytes: &[u8], path: &Path) -> Result<Self, Error> {
        let file = SafeTensors::deserialize(bytes).map_err(|problem| Error::Format {
            path: path.into(),
            place: "head".into(),
            expected: "a safetensors file".into(),
            found: problem.to_string(),
        })?;
        let mut tensors = BTreeMap::new();
        for (name, view) in file.iter() {
            let numbers = match view.dtype() {
                Dtype::F32 => Numbers::Full(each(view.data(), f32::from_le_bytes)),
                Dtype::F16 => Numbers::Full(each(view.data(), |b| f16::from_le_bytes(b).to_f32())),
                Dtype::BF16 => {
                    Numbers::Full(each(view.data(), |b| bf16::from_le_bytes(b).to_f32()))
                }
                Dtype::I8 => Numbers::Rounded(each(view.data(), i8::from_le_bytes)),
                // Buffers such as position numbers: no encoder asks for them.
                _ => continue,
            };
            let shape = view.shape().to_vec();
            tensors.insert(name.to_owned(), Tensor { shape, numbers });
        }
        Ok(Self {
            path: path.into(),
            tensors,
            prefix: String::new(),
        })
    }

    fn torch(bytes: Vec<u8>, path: &Path, limits: &TextLimits) -> Result<Self, Error> {
        let data = |problem| Error::Data {
            path: path.into(),
            problem,
        };
        let arrays = named_arrays(bytes, &limits.arrays(), &limits.pickles()).map_err(data)?;
        let mut tensors = BTreeMap::new();
        for array in arrays {
            let Ok(numbers) = array.to_f32() else {
                continue;
            };
            let shape = array.shape().to_vec();
            let numbers = Numbers::Full(numbers);
            tensors.insert(array.key().to_owned(), Tensor { shape, numbers });
        }
        Ok(Self {
            path: path.into(),
            tensors,
            prefix: String::new(),
        })
    }
}

/// Numbers of `SIZE` bytes each; safetensors has checked that they are whole.
fn each<const SIZE: usize, T>(bytes: &[u8], number: impl Fn([u8; SIZE]) -> T) -> Vec<T> {
    let numbers = bytes.as_chunks::<SIZE>().0.iter();
    numbers.map(|&bytes| number(bytes)).collect()
}

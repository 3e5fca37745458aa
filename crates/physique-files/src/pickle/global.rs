//! The list of functions and classes that make plain data.

use super::node::StorageElement;
use crate::npz::Element;

/// A function or class that a pickle may name.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Global {
    NumpyReconstruct,
    NumpyFromBuffer,
    NumpyScalar,
    NumpyArray,
    NumpyElementType,
    CodecsEncode,
    CopyReconstructor,
    BaseObject,
    Bytes,
    Set,
    OrderedDict,
    DefaultDict,
    /// What a default dictionary makes of missing keys; never called.
    Factory,
    JoblibArray,
    /// A class of which only the attributes are read.
    Record(&'static str),
    TorchTensor,
    TorchParameter,
    TorchStorage(StorageElement),
    /// TorchScript's marks of a value's type: the value.
    ScriptValue,
}

/// What every class of a TorchScript program is to us: its attributes.
const SCRIPT_MODULE: &str = "a TorchScript module";

impl Global {
    /// Looks a name up; `None` means that it is refused.
    ///
    /// Modules moved over the years: each name is listed under all its homes.
    pub(super) fn find(module: &[u8], name: &[u8]) -> Option<Self> {
        Some(match (module, name) {
            (b"numpy.core.multiarray" | b"numpy._core.multiarray", b"_reconstruct") => {
                Self::NumpyReconstruct
            }
            (b"numpy.core.numeric" | b"numpy._core.numeric", b"_frombuffer") => {
                Self::NumpyFromBuffer
            }
            (b"numpy.core.multiarray" | b"numpy._core.multiarray", b"scalar") => Self::NumpyScalar,
            (b"numpy", b"ndarray") => Self::NumpyArray,
            (b"numpy", b"dtype") => Self::NumpyElementType,
            (b"_codecs", b"encode") => Self::CodecsEncode,
            (b"copy_reg" | b"copyreg", b"_reconstructor") => Self::CopyReconstructor,
            (b"__builtin__" | b"builtins", b"object") => Self::BaseObject,
            (b"__builtin__" | b"builtins", b"bytes" | b"bytearray") => Self::Bytes,
            (b"__builtin__" | b"builtins", b"set" | b"frozenset") => Self::Set,
            (b"__builtin__" | b"builtins", b"dict" | b"list" | b"int" | b"float") => Self::Factory,
            (b"collections", b"OrderedDict") => Self::OrderedDict,
            (b"collections", b"defaultdict") => Self::DefaultDict,
            (b"joblib.numpy_pickle", b"NumpyArrayWrapper") => Self::JoblibArray,
            (b"chumpy.ch", b"Ch") => Self::Record("chumpy.ch.Ch"),
            (b"chumpy.reordering", b"Select") => Self::Record("chumpy.reordering.Select"),
            (b"scipy.sparse.csc" | b"scipy.sparse._csc", b"csc_matrix" | b"csc_array") => {
                Self::Record("scipy.sparse.csc_matrix")
            }
            (b"scipy.sparse.csr" | b"scipy.sparse._csr", b"csr_matrix" | b"csr_array") => {
                Self::Record("scipy.sparse.csr_matrix")
            }
            (b"torch._utils", b"_rebuild_tensor_v2" | b"_rebuild_tensor") => Self::TorchTensor,
            (b"torch._utils", b"_rebuild_parameter") => Self::TorchParameter,
            (b"torch" | b"torch.cuda", storage) => Self::TorchStorage(storage_element(storage)?),
            (
                b"torch.jit._pickle",
                b"build_intlist" | b"build_doublelist" | b"build_boollist" | b"build_tensorlist"
                | b"restore_type_tag",
            ) => Self::ScriptValue,
            (module, _) if module == b"__torch__" || module.starts_with(b"__torch__.") => {
                Self::Record(SCRIPT_MODULE)
            }
            _ => return None,
        })
    }

    pub(super) const fn name(self) -> &'static str {
        match self {
            Self::NumpyReconstruct => "numpy.core.multiarray._reconstruct",
            Self::NumpyFromBuffer => "numpy.core.numeric._frombuffer",
            Self::NumpyScalar => "numpy.core.multiarray.scalar",
            Self::NumpyArray => "numpy.ndarray",
            Self::NumpyElementType => "numpy.dtype",
            Self::CodecsEncode => "_codecs.encode",
            Self::CopyReconstructor => "copyreg._reconstructor",
            Self::BaseObject => "object",
            Self::Bytes => "bytes",
            Self::Set => "set",
            Self::OrderedDict => "collections.OrderedDict",
            Self::DefaultDict => "collections.defaultdict",
            Self::Factory => "a maker of default values",
            Self::JoblibArray => "joblib.numpy_pickle.NumpyArrayWrapper",
            Self::Record(name) => name,
            Self::TorchTensor => "torch._utils._rebuild_tensor_v2",
            Self::TorchParameter => "torch._utils._rebuild_parameter",
            Self::TorchStorage(_) => "a storage of torch",
            Self::ScriptValue => "a mark of torch.jit._pickle",
        }
    }
}

fn storage_element(name: &[u8]) -> Option<StorageElement> {
    Some(StorageElement::Plain(match name {
        b"DoubleStorage" => Element::Float(8),
        b"FloatStorage" => Element::Float(4),
        b"HalfStorage" => Element::Float(2),
        b"BFloat16Storage" => return Some(StorageElement::BFloat16),
        b"LongStorage" => Element::Int(8),
        b"IntStorage" => Element::Int(4),
        b"ShortStorage" => Element::Int(2),
        b"CharStorage" => Element::Int(1),
        b"ByteStorage" => Element::Uint(1),
        b"BoolStorage" => Element::Bool,
        _ => return None,
    }))
}

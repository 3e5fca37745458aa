//! PyTorch files in both forms, and all arrays of a file by name.

#![allow(clippy::unwrap_used)]

use std::fs;
use std::path::PathBuf;

use physique_files::npz::{Array, ArrayLimits};
use physique_files::pickle::{PickleError, PickleLimits};
use physique_files::torch::TorchFile;
use physique_files::{Error, named_arrays};

fn fixture(name: &str) -> Vec<u8> {
    fs::read(PathBuf::from("tests/fixtures").join(name)).unwrap()
}

fn open(bytes: Vec<u8>) -> Result<TorchFile, Error> {
    TorchFile::read(bytes, &ArrayLimits::default(), &PickleLimits::default())
}

fn named(name: &str) -> Vec<Array> {
    let limits = (ArrayLimits::default(), PickleLimits::default());
    named_arrays(fixture(name), &limits.0, &limits.1).unwrap()
}

fn keys(arrays: &[Array]) -> Vec<&str> {
    arrays.iter().map(Array::key).collect()
}

#[test]
fn tensors_of_both_forms() {
    for name in ["tensors.pt", "tensors_legacy.pt"] {
        let file = open(fixture(name)).unwrap();
        let tensor = |key: &str| {
            let array = file.array(file.root().get(key).unwrap(), key).unwrap();
            (array.shape().to_vec(), array.to_f64().unwrap())
        };
        let counted: Vec<f64> = (0..24).map(f64::from).collect();
        assert_eq!(tensor("base"), (vec![2, 3, 4], counted.clone()), "{name}");
        // base.permute(2, 0, 1)[1:]
        let mut transposed = Vec::new();
        for k in 1..4 {
            transposed.extend((0..6).map(|ij| counted[ij * 4 + k]));
        }
        assert_eq!(tensor("transposed"), (vec![3, 2, 3], transposed), "{name}");
        assert_eq!(tensor("expanded"), (vec![3], vec![7.0; 3]), "{name}");
        assert_eq!(
            tensor("half"),
            (vec![3, 4], counted[..12].to_vec()),
            "{name}"
        );
        assert_eq!(tensor("bfloat16"), (vec![2], vec![1.0, -2.5]), "{name}");
        assert_eq!(tensor("long"), (vec![3], vec![0.0, 1.0, 2.0]), "{name}");
        assert_eq!(tensor("boolean"), (vec![2], vec![1.0, 0.0]), "{name}");
        assert_eq!(tensor("parameter"), (vec![2], vec![1.0; 2]), "{name}");
        assert_eq!(tensor("empty"), (vec![0, 3], vec![]), "{name}");
        assert_eq!(tensor("numpy").1[5], 1.25, "{name}");
    }
}

#[test]
fn a_module_is_refused_by_name() {
    match open(fixture("module.pt")) {
        Err(Error::Pickle(PickleError::Refused { module, name, .. })) => {
            assert_eq!(
                (module.as_str(), name.as_str()),
                ("torch.nn.modules.linear", "Linear")
            );
        }
        other => panic!("{other:?}"),
    }
}

#[test]
fn a_tensor_that_unfolds_beyond_the_limit_is_refused() {
    let limits = ArrayLimits {
        bytes: 4000,
        ..ArrayLimits::default()
    };
    let file = TorchFile::read(fixture("tensors.pt"), &limits, &PickleLimits::default()).unwrap();
    assert!(file.array(file.root().get("base").unwrap(), "base").is_ok());
    let limits = ArrayLimits {
        bytes: 60,
        ..limits
    };
    let error = TorchFile::read(fixture("tensors.pt"), &limits, &PickleLimits::default());
    assert!(error.is_err());
}

#[test]
fn arrays_by_name() {
    assert_eq!(keys(&named("results.npy")), ["motion", "lengths"]);
    assert_eq!(
        keys(&named("mixed.npz")),
        ["plain", "results.motion", "results.lengths"]
    );
    assert_eq!(keys(&named("joblib.pkl")), ["0.pose", "0.frames", "cam"]);
    let both = [named("tensors.pt"), named("tensors_legacy.pt")];
    assert_eq!(keys(&both[0]), keys(&both[1]));
    assert_eq!(
        keys(&both[0])[10..],
        ["nested.list.0", "nested.list.1"],
        "{:?}",
        keys(&both[0])
    );
}

#[test]
fn values_that_contain_themselves_end_at_a_limit() {
    let limits = (ArrayLimits::default(), PickleLimits::default());
    let error = named_arrays(fixture("values_py2_p2.pkl"), &limits.0, &limits.1);
    assert!(matches!(error, Err(Error::NamedArrays { .. })), "{error:?}");
}

#[test]
fn a_file_of_no_known_kind() {
    let limits = (ArrayLimits::default(), PickleLimits::default());
    for bytes in [&b""[..], b"HIERARCHY", b"{\"Frames\": []}"] {
        let error = named_arrays(bytes.to_vec(), &limits.0, &limits.1);
        assert!(
            matches!(error, Err(Error::UnknownFormat { .. })),
            "{bytes:?}"
        );
    }
}

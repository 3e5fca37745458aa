//! PyTorch files in both forms, and all arrays of a file by name.

#![allow(clippy::unwrap_used)]

use std::fs;
use std::path::PathBuf;

use physique_files::npz::{Array, ArrayLimits};
use physique_files::pickle::{Pickle, PickleError, PickleLimits};
use physique_files::torch::TorchFile;
use physique_files::{Data, Error, named_arrays};

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

/// Of a TorchScript program the parameters are read, by their path through its modules.
#[test]
fn a_program_is_its_parameters() {
    let file = open(fixture("script.pt")).unwrap();
    assert_eq!(file.root().kind(), "an object");
    let inner = file.root().attribute("inner").unwrap();
    let weight = inner.attribute("0").unwrap().attribute("weight").unwrap();
    let weight = file.array(weight, "weight").unwrap();
    assert_eq!(weight.shape(), [2, 3]);
    assert_eq!(weight.to_f64().unwrap(), [0.0, 1.0, 2.0, 3.0, 4.0, 5.0]);

    let arrays = named("script.pt");
    let of = |key: &str| arrays.iter().find(|array| array.key() == key).unwrap();
    for key in ["weight", "inner.0.weight", "again.0.weight"] {
        let expected: Vec<f64> = (0..6).map(f64::from).collect();
        assert_eq!(of(key).to_f64().unwrap(), expected, "{key}");
    }
    assert_eq!(of("mask").to_f64().unwrap(), [1.0, 0.0]);
    assert_eq!(of("several.0").to_f64().unwrap(), [1.0, 1.0]);
    assert_eq!(of("inner.0.bias").shape(), [2]);
}

#[test]
fn a_broken_program_is_refused() {
    let whole = fixture("script.pt");
    let limits = (ArrayLimits::default(), PickleLimits::default());
    for length in (0..whole.len()).step_by(61) {
        let error = named_arrays(whole[..length].to_vec(), &limits.0, &limits.1);
        assert!(error.is_err(), "{length} bytes of {}", whole.len());
    }
    let small = ArrayLimits {
        bytes: 100,
        ..limits.0
    };
    assert!(named_arrays(whole, &small, &limits.1).is_err());
}

/// Instructions of protocol 2 for a module with one attribute for each of the values.
fn module(attributes: &[(&str, &[u8])]) -> Vec<u8> {
    let mut bytes = b"c__torch__.a.stranger\nM\n)\x81}(".to_vec();
    for (name, value) in attributes {
        bytes.extend([b'X', name.len() as u8, 0, 0, 0]);
        bytes.extend(name.as_bytes());
        bytes.extend(*value);
    }
    bytes.extend(b"ub");
    bytes
}

fn read_pickle(body: &[u8]) -> Result<Pickle, PickleError> {
    Pickle::read([b"\x80\x02", body, b"."].concat(), &PickleLimits::default())
}

#[test]
fn modules_that_contain_themselves_or_each_other_many_times_end_at_a_limit() {
    // Memo 0 is the module itself.
    let body = module(&[("me", b"h\x00")]);
    let at = body.iter().position(|&byte| byte == 0x81).unwrap();
    let itself = [&body[..=at], b"q\x00", &body[at + 1..]].concat();
    let error = Data::of_pickle(&read_pickle(&itself).unwrap(), "", 1 << 20);
    assert!(matches!(error, Err(Error::NamedArrays { .. })), "{error:?}");

    // Fourteen modules, each twice in the next: 16,384 copies of the innermost.
    let mut nested = [module(&[]), b"q\x00".to_vec()].concat();
    for depth in 1..15_u8 {
        let before = [b'h', depth - 1];
        nested.extend(b"0");
        nested.extend(module(&[("a", &before), ("b", &before)]));
        nested.extend([b'q', depth]);
    }
    let pickle = read_pickle(&nested).unwrap();
    let error = Data::of_pickle(&pickle, "", 1 << 16);
    assert!(matches!(error, Err(Error::NamedArrays { .. })), "{error:?}");
}

#[test]
fn programs_name_their_own_classes_only() {
    for (body, name) in [
        (&b"c__torch__evil\nM\n)\x81"[..], "__torch__evil"),
        (b"ctorch.jit._pickle\nrun\n)R", "torch.jit._pickle"),
        (b"ctorch.jit\nload\n)R", "torch.jit"),
    ] {
        match read_pickle(body) {
            Err(PickleError::Refused { module, .. }) => assert_eq!(module, name),
            other => panic!("{other:?}"),
        }
    }
    // A class makes an object of no arguments; it is never called with any.
    let called = read_pickle(b"c__torch__\nM\nX\x01\x00\x00\x00a\x85R");
    assert!(
        matches!(called, Err(PickleError::Call { .. })),
        "{called:?}"
    );
    let marked = read_pickle(b"ctorch.jit._pickle\nbuild_intlist\n)R");
    assert!(
        matches!(marked, Err(PickleError::Call { .. })),
        "{marked:?}"
    );
}

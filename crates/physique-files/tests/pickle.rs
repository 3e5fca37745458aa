//! Pickles of known values, written by Python 2.7 and 3.11 in every protocol.

#![allow(clippy::unwrap_used)]

use std::fs;
use std::path::PathBuf;

use physique_files::Error;
use physique_files::npz::{Archive, ArrayLimits, Element, objects_from_npy};
use physique_files::pickle::{Pickle, PickleError, PickleLimits, Value, View};

fn fixture(name: &str) -> Vec<u8> {
    fs::read(PathBuf::from("tests/fixtures").join(name)).unwrap()
}

fn read(bytes: &[u8]) -> Result<Pickle, PickleError> {
    Pickle::read(bytes.to_vec(), &PickleLimits::default())
}

/// Every writer and protocol.
fn each(check: impl Fn(&str, Value<'_>, u8)) {
    for (python, protocols) in [(2, 0..=2), (3, 0..=5)] {
        for protocol in protocols {
            let name = format!("values_py{python}_p{protocol}.pkl");
            let pickle = read(&fixture(&name)).unwrap_or_else(|error| panic!("{name}: {error}"));
            check(&name, pickle.root(), python);
        }
    }
}

fn numbers(value: Option<Value<'_>>) -> (Vec<usize>, Vec<f64>, Element) {
    let array = value.unwrap().array("value").unwrap();
    (
        array.shape().to_vec(),
        array.to_f64().unwrap(),
        array.element(),
    )
}

#[test]
fn plain_values() {
    each(|name, root, _| {
        let get = |key: &str| root.get(key).unwrap();
        assert!(matches!(get("none").view(), View::None), "{name}");
        assert!(matches!(get("true").view(), View::Bool(true)), "{name}");
        assert!(matches!(get("false").view(), View::Bool(false)), "{name}");
        let integers = get("integers").list().unwrap();
        let integers = integers.iter().map(|value| match value.view() {
            View::Integer(value) => value,
            other => panic!("{name}: {other:?}"),
        });
        let integers: Vec<_> = integers.collect();
        let expected = [
            0,
            1,
            -1,
            255,
            256,
            65536,
            -70000,
            1 << 31,
            -(1 << 40),
            1 << 62,
        ];
        assert_eq!(integers, expected, "{name}");
        assert_eq!(get("long").number(), Some(2.0_f64.powi(80)), "{name}");
        assert_eq!(get("number").number(), Some(0.1), "{name}");
        assert_eq!(get("infinity").number(), Some(f64::INFINITY), "{name}");
        assert_eq!(get("text").text(), Some("Grüße 😀\n\\"), "{name}");
        match get("bytes").view() {
            View::Bytes(bytes) => assert_eq!(bytes, b"it's \x00\xff\n\\", "{name}"),
            other => panic!("{name}: {other:?}"),
        }
        let many = get("many").list().unwrap();
        assert_eq!(many.len(), 2000, "{name}");
        assert_eq!(many.get(1999).unwrap().number(), Some(1999.0), "{name}");
        assert_eq!(
            get("ordered").get("b").unwrap().number(),
            Some(2.0),
            "{name}"
        );
        assert_eq!(get("ordered").entries().count(), 2, "{name}");
        assert_eq!(get("set").list().unwrap().len(), 3, "{name}");
        assert_eq!(get("frozen").list().unwrap().len(), 1, "{name}");
        let empty = get("empty").list().unwrap();
        assert!(
            matches!(empty.get(3).unwrap().view(), View::Bytes(b"")),
            "{name}"
        );
        assert_eq!(empty.get(4).unwrap().text(), Some(""), "{name}");

        let mut tuple = get("tuple");
        for depth in 1..=4 {
            let items = tuple.list().unwrap();
            assert_eq!(
                items.get(0).unwrap().number(),
                Some(f64::from(depth)),
                "{name}"
            );
            tuple = items.get(1).unwrap();
        }
        let itself = get("itself").list().unwrap().get(1).unwrap();
        assert_eq!(
            itself.list().unwrap().get(1).unwrap().list().unwrap().len(),
            2,
            "{name}"
        );
    });
}

#[test]
fn arrays() {
    each(|name, root, _| {
        let quarters: Vec<f64> = (0..6).map(|n| f64::from(n) / 4.0).collect();
        for key in ["float64", "again", "fortran"] {
            let expected = (vec![2, 3], quarters.clone(), Element::Float(8));
            assert_eq!(numbers(root.get(key)), expected, "{name}, {key}");
        }
        let counted = vec![0.0, 1.0, 2.0, 3.0];
        for (key, element) in [
            ("float32", Element::Float(4)),
            ("float16", Element::Float(2)),
            ("big_endian", Element::Int(4)),
        ] {
            let expected = (vec![4], counted.clone(), element);
            assert_eq!(numbers(root.get(key)), expected, "{name}, {key}");
        }
        let (shape, values, element) = numbers(root.get("uint32"));
        assert_eq!(
            (shape, values),
            (vec![1, 2], vec![4_294_967_295.0, 0.0]),
            "{name}"
        );
        assert_eq!(element, Element::Uint(4), "{name}");
        assert_eq!(numbers(root.get("boolean")).1, [1.0, 0.0], "{name}");
        assert_eq!(numbers(root.get("no_items")).0, [0, 3], "{name}");
        assert_eq!(
            numbers(root.get("scalar")),
            (vec![], vec![1.5], Element::Float(8)),
            "{name}"
        );
        assert_eq!(
            numbers(root.get("scalar_int")),
            (vec![], vec![-3.0], Element::Int(8))
        );
        let strings = root.get("strings").unwrap().array("strings").unwrap();
        assert_eq!(
            (strings.shape(), strings.element()),
            (&[2][..], Element::Text(2)),
            "{name}"
        );

        let objects = root.get("objects").unwrap().list().unwrap();
        assert_eq!(objects.get(1).unwrap().text(), Some("walk"), "{name}");
        assert_eq!(numbers(objects.get(2)).1, quarters, "{name}");
    });
}

#[test]
fn sparse_matrices_are_their_attributes() {
    each(|name, root, _| {
        let csc = root.get("csc").unwrap();
        match csc.view() {
            View::Object(object) => assert_eq!(object.class, "scipy.sparse.csc_matrix", "{name}"),
            other => panic!("{name}: {other:?}"),
        }
        assert_eq!(numbers(csc.attribute("data")).1, [1.0, 2.0, 3.0], "{name}");
        assert_eq!(
            numbers(csc.attribute("indices")).1,
            [2.0, 0.0, 1.0],
            "{name}"
        );
        assert_eq!(
            numbers(csc.attribute("indptr")).1,
            [0.0, 1.0, 2.0, 3.0],
            "{name}"
        );
        let shape = csc.attribute("_shape").unwrap().list().unwrap();
        assert_eq!(shape.get(0).unwrap().number(), Some(3.0), "{name}");
    });
}

#[test]
fn shared_values_are_stored_once() {
    // Twenty lists, each of which holds the one before ten times: 10^20 leaves when unfolded.
    let mut laughs = b"\x80\x02]q\x00".to_vec();
    for level in 1..=20 {
        laughs.extend(b"](");
        laughs.extend([b'h', level - 1].repeat(10));
        laughs.extend([b'e', b'q', level]);
    }
    laughs.push(b'.');
    let pickle = read(&laughs).unwrap();
    assert_eq!(pickle.root().list().unwrap().len(), 10);
}

#[test]
fn arrays_of_objects_in_npy_and_npz() {
    let check = |pickle: &Pickle| {
        let results = pickle.root().list().unwrap().get(0).unwrap();
        let (shape, motion, _) = numbers(results.get("motion"));
        assert_eq!(shape, [2, 22, 3, 5]);
        assert_eq!(motion.last(), Some(&659.0));
        assert_eq!(numbers(results.get("lengths")).1, [5.0, 4.0]);
        let texts: Vec<_> = results
            .get("text")
            .unwrap()
            .list()
            .unwrap()
            .iter()
            .collect();
        assert_eq!(texts[1].text(), Some("a person kicks"));
    };
    let limits = PickleLimits::default();
    check(&objects_from_npy("results", fixture("results.npy"), &limits).unwrap());
    let mut archive = Archive::open(fixture("mixed.npz"), ArrayLimits::default()).unwrap();
    check(&archive.objects("results", &limits).unwrap());
    assert!(archive.array("plain").is_ok());
    assert!(archive.array("results").is_err());
    assert!(matches!(
        archive.objects("plain", &limits),
        Err(Error::Array(_))
    ));
}

#[test]
fn joblib_writes_arrays_behind_their_description() {
    let pickle = read(&fixture("joblib.pkl")).unwrap();
    let quarters: Vec<f64> = (0..6).map(|n| f64::from(n) / 4.0).collect();
    let (_, person) = pickle.root().entries().next().unwrap();
    let (shape, pose, _) = numbers(person.get("pose"));
    assert_eq!((shape, pose), (vec![2, 3], quarters));
    assert_eq!(numbers(person.get("frames")).1, [0.0, 1.0, 2.0, 3.0]);
    let (shape, cam, _) = numbers(pickle.root().get("cam"));
    assert_eq!(
        (shape, cam),
        (vec![3, 2], vec![0.0, 0.75, 0.25, 1.0, 0.5, 1.25])
    );
    assert!(matches!(
        read(&fixture("joblib_zlib.pkl")),
        Err(PickleError::Malformed { .. })
    ));
}

#[test]
fn buffers_outside_the_pickle() {
    let (pickle, data) = (fixture("out_of_band.pkl"), fixture("out_of_band.bin"));
    assert!(matches!(read(&pickle), Err(PickleError::Malformed { .. })));
    let limits = PickleLimits::default();
    let (array, bytes) = data.split_at(48);
    let read = Pickle::read_with_buffers(pickle, &[array, bytes], &limits).unwrap();
    assert_eq!(numbers(read.root().get("a")).1.last(), Some(&1.25));
}

#[test]
fn limits_hold() {
    let bytes = fixture("values_py3_p2.pkl");
    let tight = |change: fn(&mut PickleLimits)| {
        let mut limits = PickleLimits::default();
        change(&mut limits);
        match Pickle::read(bytes.clone(), &limits) {
            Err(PickleError::Limit { what, .. }) => what,
            other => panic!("{:?}", other.map(|pickle| pickle.end())),
        }
    };
    assert!(tight(|limits| limits.bytes = 10_000).contains("memory"));
    assert!(tight(|limits| limits.values = 100).contains("values"));
    assert!(tight(|limits| limits.memo = 20).contains("memo"));
    assert!(tight(|limits| limits.depth = 1).contains("open containers"));
}

#[test]
fn errors_name_what_they_refuse() {
    let error = read(b"cos\nsystem\n(S'true'\ntR.").unwrap_err().to_string();
    assert!(
        error.contains("byte 0") && error.contains("`os.system`"),
        "{error}"
    );
    assert!(error.contains("nothing was run"), "{error}");
}

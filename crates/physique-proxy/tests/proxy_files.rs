//! Proxy files: what is written is read, what is broken is refused.

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

use physique_files::npz::{Archive, ArrayLimits};
use physique_proxy::files::{
    Precision, ProxyLimits, parse_proxy, proxy_bytes, read_proxy, read_published, write_proxy,
};
use physique_proxy::{Error, PairChoice, PairStatistics, Pairs, SphereProxy};

fn published_folder() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/fixtures/published")
}

/// The golden proxy of 24 spheres, from its published layout.
fn published() -> SphereProxy {
    read_published(&published_folder(), &ProxyLimits::default()).expect("sound files")
}

/// The same with statistics and notes, as ours have.
fn ours() -> SphereProxy {
    let published = published();
    let counts = (0..24 * 23 / 2).map(|index| index % 101).collect();
    let statistics = PairStatistics::from_counts(24, 100, counts).expect("possible");
    SphereProxy::new(
        published.sphere_regressor().clone(),
        published.joint_regressor().clone(),
        published.blend_weights().to_vec(),
        PairChoice::Statistics(statistics),
        BTreeMap::from([("body".into(), "a test: of colons".into())]),
    )
    .expect("fits")
}

fn parse(bytes: &[u8]) -> Result<SphereProxy, Error> {
    parse_proxy("test", bytes, &ProxyLimits::default())
}

#[test]
fn the_published_layout_gives_the_golden_proxy() {
    let bytes = include_bytes!("fixtures/sphere_proxy_posed.npz").to_vec();
    let mut archive = Archive::open(bytes, ArrayLimits::default()).expect("a sound archive");
    let mut array = |key: &str| archive.array(key).expect(key).to_f32().expect(key);
    let body = published().normalised(&array("beta")).expect("finite");
    let near = |found: &mut dyn Iterator<Item = f32>, expected: Vec<f32>| {
        let mut count = 0;
        for (found, expected) in found.zip(&expected) {
            assert!((found - expected).abs() < 1e-5, "{found} for {expected}");
            count += 1;
        }
        assert_eq!(count, expected.len());
    };
    near(
        &mut body.centres.iter().flat_map(|c| c.to_array()),
        array("centers_rest"),
    );
    near(&mut body.radii.iter().copied(), array("radii"));
    near(
        &mut body.rest_joints.iter().flat_map(|j| j.to_array()),
        array("joints_rest"),
    );
    let excluded = archive
        .array("excluded_pairs")
        .expect("pairs")
        .to_i64()
        .expect("booleans");
    let all = Pairs::all(24).expect("few");
    let kept = all.filtered(|i, j| excluded[i * 24 + j] == 0);
    assert_eq!(published().pairs().expect("few"), kept);
}

#[test]
fn what_is_missing_from_a_published_folder_is_named() {
    for missing in [
        "SR/sphere_regressor.pth",
        "boneweights.npy",
        "coll_mat_1jd90.npy",
    ] {
        let folder = tempfile::tempdir().expect("a folder");
        for name in ["SR", "JR"] {
            std::fs::create_dir(folder.path().join(name)).expect("made");
        }
        for name in [
            "SR/sphere_regressor.pth",
            "JR/joint_regressor.pth",
            "boneweights.npy",
            "coll_mat_1jd90.npy",
        ] {
            if name != missing {
                std::fs::copy(published_folder().join(name), folder.path().join(name))
                    .expect("copied");
            }
        }
        let error = read_published(folder.path(), &ProxyLimits::default()).expect_err("missing");
        let stem = missing.rsplit('/').next().unwrap_or(missing);
        let stem = stem.trim_end_matches("jd90.npy");
        assert!(error.to_string().contains(stem), "{error}");
    }
}

#[test]
fn exact_files_keep_every_bit() {
    let folder = tempfile::tempdir().expect("a folder");
    let path = folder.path().join("proxy.safetensors");
    for proxy in [ours(), published()] {
        write_proxy(&path, &proxy, Precision::Exact).expect("written");
        let read = read_proxy(&path, &ProxyLimits::default()).expect("sound");
        let parameters =
            |proxy: &SphereProxy| proxy.sphere_regressor().network().parameters().to_vec();
        assert_eq!(parameters(&read), parameters(&proxy));
        let joints = |proxy: &SphereProxy| proxy.joint_regressor().network().parameters().to_vec();
        assert_eq!(joints(&read), joints(&proxy));
        assert_eq!(read.blend_weights(), proxy.blend_weights());
        assert_eq!(read.pair_choice(), proxy.pair_choice());
        assert_eq!(read.notes(), proxy.notes());
        let bytes = proxy_bytes(&proxy, Precision::Exact).expect("bytes");
        assert_eq!(
            std::fs::read(&path).expect("there"),
            bytes,
            "the same bytes every time"
        );
    }
}

#[test]
fn rounded_files_give_nearly_the_same_spheres() {
    let proxy = ours();
    let betas = [1.0, -2.0, 0.5, 0.3, 1.5, -0.7, 0.0, 2.0, -1.0, 0.2];
    let exact = proxy.normalised(&betas).expect("finite");
    for (precision, tolerance) in [(Precision::Half, 5e-3), (Precision::Compact, 5e-2)] {
        let bytes = proxy_bytes(&proxy, precision).expect("bytes");
        let read = parse(&bytes)
            .expect("sound")
            .normalised(&betas)
            .expect("finite");
        for (found, expected) in read.centres.iter().zip(&exact.centres) {
            assert!(found.distance(*expected) < tolerance, "{precision:?}");
        }
        for (found, expected) in read.radii.iter().zip(&exact.radii) {
            assert!((found / expected - 1.0).abs() < tolerance, "{precision:?}");
        }
    }
    let size = |precision| proxy_bytes(&proxy, precision).expect("bytes").len();
    assert!(size(Precision::Compact) < size(Precision::Half));
    assert!(size(Precision::Half) < size(Precision::Exact));
}

#[test]
fn truncated_files_are_refused() {
    let bytes = proxy_bytes(&ours(), Precision::Compact).expect("bytes");
    let cuts = (0..2_000).chain((2_000..bytes.len()).step_by(997));
    for cut in cuts.filter(|&cut| cut < bytes.len()) {
        assert!(parse(&bytes[..cut]).is_err(), "cut at {cut}");
    }
}

#[test]
fn damaged_headers_never_panic() {
    let bytes = proxy_bytes(&ours(), Precision::Half).expect("bytes");
    for place in 0..4_000 {
        for value in [0x00, 0x22, 0x39, 0x7D, 0xFF] {
            let mut damaged = bytes.clone();
            damaged[place] = value;
            // Some damage changes nothing that counts; none may crash.
            let _ = parse(&damaged);
        }
    }
}

#[test]
fn files_that_are_no_proxy_are_refused_by_name() {
    let message = |bytes: &[u8]| parse(bytes).expect_err("no proxy").to_string();
    assert!(message(b"").contains("safetensors"));
    assert!(message(&[0xFF; 100]).contains("safetensors"));
    let empty = b"\x02\0\0\0\0\0\0\0{}";
    assert!(message(empty).contains("physique-proxy 1"));
    let header = br#"{"__metadata__":{"proxy":"physique-proxy 2"}}"#;
    let mut other = (header.len() as u64).to_le_bytes().to_vec();
    other.extend(header);
    assert!(message(&other).contains("`physique-proxy 2`"));
    let header = br#"{"__metadata__":{"proxy":"physique-proxy 1"}}"#;
    let mut none = (header.len() as u64).to_le_bytes().to_vec();
    none.extend(header);
    assert!(message(&none).contains("spheres.net1.0.weight_v"));
}

#[test]
fn limits_hold() {
    let bytes = proxy_bytes(&ours(), Precision::Exact).expect("bytes");
    let refused = |limits: &ProxyLimits| {
        parse_proxy("test", &bytes, limits)
            .expect_err("too much")
            .to_string()
    };
    let default = ProxyLimits::default();
    assert!(
        refused(&ProxyLimits {
            spheres: 23,
            ..default
        })
        .contains("at most 23 spheres")
    );
    assert!(
        refused(&ProxyLimits {
            parameters: 5_000,
            ..default
        })
        .contains("at most 5000 parameters")
    );
    let folder = tempfile::tempdir().expect("a folder");
    let path = folder.path().join("proxy.safetensors");
    std::fs::write(&path, &bytes).expect("written");
    let limits = ProxyLimits {
        bytes: 1_000,
        ..default
    };
    assert!(matches!(read_proxy(&path, &limits), Err(Error::File(_))));
}

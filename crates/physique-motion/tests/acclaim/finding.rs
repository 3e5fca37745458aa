//! The skeleton that goes with a motion is found beside it.

use std::fs;

use physique_motion::{ReadOptions, SourceMotion, parse_motion, read_motion};

use crate::arm::{ARM, WAVE, metres};

#[test]
fn the_skeleton_is_found_beside_the_motion() {
    let folder = tempfile::tempdir().unwrap();
    let at = |name: &str| folder.path().join(name);
    fs::write(at("02_01.amc"), WAVE).unwrap();
    let error = read_motion(at("02_01.amc"), &metres())
        .unwrap_err()
        .to_string();
    assert!(
        error.contains("02_01.asf beside it") && error.contains("no .asf"),
        "{error}"
    );

    let joints = |options: &ReadOptions| match read_motion(at("02_01.amc"), options).unwrap() {
        SourceMotion::Skeleton(clip) => clip.skeleton().joints()[1].name.clone(),
        other => panic!("{other:?}"),
    };
    let named = |name: &str| ARM.replace("upper", name);
    let amc = |name: &str| fs::write(at("02_01.amc"), WAVE.replace("upper", name)).unwrap();
    // The only one there; the subject's; the motion's own; the one that is given.
    for (file, name) in [
        ("a.asf", "only"),
        ("02.ASF", "subject"),
        ("02_01.asf", "own"),
    ] {
        fs::write(at(file), named(name)).unwrap();
        amc(name);
        assert_eq!(joints(&metres()), name);
    }
    fs::write(at("given.txt"), named("given")).unwrap();
    amc("given");
    let given = ReadOptions {
        skeleton: Some(at("given.txt")),
        ..metres()
    };
    assert_eq!(joints(&given), "given");
    // A skeleton alone is no motion, and is told so.
    let error = read_motion(at("02.ASF"), &metres())
        .unwrap_err()
        .to_string();
    assert!(error.contains("give the .amc"), "{error}");
    // A motion without a header is known, too.
    let bare = b"\r\n1\r\nroot 0 0 0 0 0 0\r\nupper 0\r\nlower 0 0\r\n";
    fs::write(at("02_01.asf"), ARM.replace('\n', "\r\n")).unwrap();
    assert!(parse_motion(bare.to_vec(), at("02_01.amc"), &metres()).is_ok());
}

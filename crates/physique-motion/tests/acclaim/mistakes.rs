//! What is wrong is refused with its place, and nothing panics.

use physique_motion::{Error, Limits, ReadOptions};

use crate::arm::{ARM, WAVE, metres, parse};
use crate::human::human;

#[test]
fn mistakes_are_named_with_their_place() {
    for (what, asf, amc, words) in [
        (
            "nan",
            ARM.into(),
            WAVE.replace("upper 90", "upper nan"),
            ["wave.amc, line 10", "nan"],
        ),
        (
            "huge",
            ARM.into(),
            WAVE.replace("1 2 3", "1 1e99 3"),
            ["line 9", "1e99"],
        ),
        (
            "few",
            ARM.into(),
            WAVE.replace("lower 90 90", "lower 90"),
            ["line 15", "as many"],
        ),
        (
            "many",
            ARM.into(),
            WAVE.replace("upper 0\n", "upper 0 1\n"),
            ["line 6", "1 numbers"],
        ),
        (
            "name",
            ARM.into(),
            WAVE.replace("upper 90", "uper 90"),
            ["line 10", "\"uper\""],
        ),
        (
            "twice",
            ARM.into(),
            WAVE.replace("lower 0 0\n2", "upper 0\n2"),
            ["line 7", "once"],
        ),
        (
            "gap",
            ARM.into(),
            WAVE.replace("\n3\n", "\n4\n"),
            ["line 12", "after frame 2"],
        ),
        (
            "none",
            ARM.into(),
            ":DEGREES\n".into(),
            ["wave.amc", "one frame"],
        ),
        (
            "start",
            ARM.into(),
            "upper 0\n".into(),
            ["line 1", "first frame"],
        ),
        (
            "stretch",
            ARM.replace("dof rx\n", "dof rx l\n"),
            WAVE.into(),
            ["arm.asf, line 22", "\"l\""],
        ),
        (
            "order",
            ARM.replace("90 XYZ", "90 XXZ"),
            WAVE.into(),
            ["line 21", "XXZ"],
        ),
        (
            "direction",
            ARM.replace("n 1 0 0", "n 1 0"),
            WAVE.into(),
            ["line 19", "direction"],
        ),
        (
            "open",
            ARM.replace("  end\n:h", ":h"),
            WAVE.into(),
            ["arm.asf", "end after"],
        ),
        (
            "nested",
            ARM.replace("id 2", "begin"),
            WAVE.into(),
            ["line 26", "before the next"],
        ),
        (
            "nameless",
            ARM.replace("name upper", ""),
            WAVE.into(),
            ["line 24", "name"],
        ),
        (
            "same",
            ARM.replace("name lower", "name Upper"),
            WAVE.into(),
            ["arm.asf", "twice"],
        ),
        (
            "root",
            ARM.replace("name upper", "name Root"),
            WAVE.into(),
            ["arm.asf", "twice"],
        ),
        (
            "stranger",
            ARM.replace("upper lower\n", "upper lowest\n"),
            WAVE.into(),
            ["hierarchy", "lowest"],
        ),
        (
            "loop",
            ARM.replace("root upper", "lower upper"),
            WAVE.into(),
            ["below the root", "0 of them"],
        ),
        (
            "parents",
            ARM.replace("root upper", "root upper lower"),
            WAVE.into(),
            ["second parent", "lower"],
        ),
        (
            "childless",
            ARM.replace("upper lower\n", "upper\n"),
            WAVE.into(),
            ["line 38", "children"],
        ),
        (
            "factor",
            ARM.replace("length 2.54", "length 0"),
            WAVE.into(),
            ["line 6", "above 0"],
        ),
        (
            "angle",
            ARM.replace("angle deg", "angle grad"),
            WAVE.into(),
            ["line 7", "grad"],
        ),
        (
            "boneless",
            ARM.split(":bonedata").next().unwrap().into(),
            WAVE.into(),
            [":bonedata", "none"],
        ),
    ] {
        let error = parse(&asf, &amc, &metres()).expect_err(what).to_string();
        for word in words {
            assert!(
                error.contains(word),
                "{what}: \"{word}\" is not in: {error}"
            );
        }
    }
}

#[test]
fn limits_hold_before_memory_is_taken() {
    let limited = |limits: Limits| {
        let options = ReadOptions { limits, ..metres() };
        match parse(ARM, WAVE, &options).unwrap_err() {
            Error::Limit { what, .. } => what,
            other => panic!("{other}"),
        }
    };
    let usual = Limits::default;
    assert!(
        limited(Limits {
            frames: 2,
            ..usual()
        })
        .contains("frames")
    );
    assert!(
        limited(Limits {
            joints: 1,
            ..usual()
        })
        .contains("joints")
    );
    assert!(
        limited(Limits {
            depth: 2,
            ..usual()
        })
        .contains("depth")
    );
    assert!(
        limited(Limits {
            bytes: 100,
            ..usual()
        })
        .contains("rotations")
    );
}

#[test]
fn truncated_and_damaged_files_never_panic() {
    let (asf, amc) = human(3);
    for end in (0..asf.len()).step_by(5) {
        let _ = parse(&asf[..end], &amc, &ReadOptions::default());
    }
    for end in (0..amc.len()).step_by(5) {
        let cut = &amc[..end];
        if parse(&asf, cut, &ReadOptions::default()).is_ok() {
            // Only a cut within the last number of a frame's last bone leaves a whole file.
            assert!(cut.lines().last().unwrap().starts_with("rhand"), "{end}");
        }
    }
}

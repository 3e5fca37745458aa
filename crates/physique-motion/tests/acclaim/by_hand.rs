//! Places, units, orders and what frames leave out, checked by hand.

use physique_motion::{FrameRate, ReadOptions, UpAxis};

use crate::arm::{ARM, WAVE, assert_near, ends, metres, parse};

#[test]
fn a_chain_of_two_bones_moves_as_reckoned_by_hand() {
    let clip = parse(ARM, WAVE, &metres()).unwrap();
    assert_eq!((clip.frame_count(), clip.skeleton().joint_count()), (3, 3));
    assert_eq!(clip.frame_rate().per_second(), 120.0);
    assert!(clip.conversion().notes[0].contains("120"));

    let [shoulder, elbow] = ends(&clip, 0, "upper");
    assert_near(shoulder, [0.0, 0.0, 0.0]);
    assert_near(elbow, [2.0, 0.0, 0.0]);
    assert_near(ends(&clip, 0, "lower")[1], [3.0, 0.0, 0.0]);

    // The upper bone's own X axis is the world's Y: a quarter about it takes +X to -Z.
    let [shoulder, elbow] = ends(&clip, 1, "upper");
    assert_near(shoulder, [1.0, 2.0, 3.0]);
    assert_near(elbow, [1.0, 2.0, 1.0]);
    assert_near(ends(&clip, 1, "lower")[1], [1.0, 2.0, 0.0]);

    // The root turns about the fixed X first, then about the fixed Z: +X stays, then is +Y. The
    // lower bone turns about Z first, so +X is +Y, then about X, so it is +Z; the root's turns
    // take that to -Y, then to +X.
    assert_near(ends(&clip, 2, "upper")[1], [0.0, 2.0, 0.0]);
    assert_near(ends(&clip, 2, "lower")[1], [1.0, 2.0, 0.0]);
}

#[test]
fn units_angles_rates_and_axes_are_as_the_files_say() {
    let inches = parse(ARM, WAVE, &ReadOptions::default()).unwrap();
    // 3 inches over 2.54 are no human size, so the unit is inferred.
    assert!(inches.conversion().notes[1].contains("longest way"));
    let cmu = ARM
        .replace("length 2.54", "length 0.45")
        .replace("length 2\n", "length 20\n");
    let cmu = parse(
        &cmu.replace("length 1\n", "length 20\n"),
        WAVE,
        &ReadOptions::default(),
    );
    let cmu = cmu.unwrap();
    assert!((cmu.conversion().metres_per_unit - 0.0564444).abs() < 1e-6);
    assert!((ends(&cmu, 0, "upper")[1].x - 20.0 * 0.0254 / 0.45).abs() < 1e-5);
    // The root's path is in the same unit.
    assert!((cmu.translation(1, 0).z - 3.0 * 0.0254 / 0.45).abs() < 1e-6);

    let turned = "1\nroot 0 0 0 0 0 0\nupper 1.5707963267948966\nlower 0 0\n";
    let radians = parse(ARM, &format!(":RADIANS\n{turned}"), &metres()).unwrap();
    assert_near(ends(&radians, 0, "upper")[1], [0.0, 0.0, -2.0]);
    // Without a word in the motion, the skeleton's unit of angles counts, for axes too.
    let rad = ARM
        .replace("angle deg", "angle rad")
        .replace("0 0 90", "0 0 1.5707963267948966");
    let radians = parse(&rad, turned, &metres()).unwrap();
    assert_near(ends(&radians, 0, "upper")[1], [0.0, 0.0, -2.0]);

    let sampled = WAVE.replace(":DEGREES", ":DEGREES\n:SAMPLES-PER-SECOND 60");
    let rate = |amc: &str, options: &ReadOptions| parse(ARM, amc, options).unwrap().frame_rate();
    assert_eq!(rate(&sampled, &metres()).per_second(), 60.0);
    let given = ReadOptions {
        frame_rate: Some(FrameRate::new(30.0).unwrap()),
        ..metres()
    };
    assert_eq!(rate(&sampled, &given), given.frame_rate.unwrap());

    let z_up = ReadOptions {
        up_axis: Some(UpAxis::Z),
        ..metres()
    };
    assert_near(
        parse(ARM, WAVE, &z_up).unwrap().translation(1, 0),
        [1.0, 3.0, -2.0],
    );
}

#[test]
fn roots_and_bones_may_move_in_any_order() {
    let asf = ARM
        .replace("order TX TY TZ RX RY RZ", "order RZ TZ TX")
        .replace("dof rx\n", "dof tx rx\n");
    let clip = parse(&asf, "7\nroot 90 5 4\nUPPER 1.5 90\nlower 0 0\n", &metres()).unwrap();
    // Along the bone's own X axis, which is the world's Y, which the root turned to -X.
    assert_near(ends(&clip, 0, "upper")[0], [4.0 - 1.5, 0.0, 5.0]);
    assert_eq!(clip.translated_joints(), [0, 1]);

    // Presets go before the motion: the body is turned to +Y and put at X = 1 before it moves.
    let preset = ARM
        .replace("position 0 0 0", "position 1 0 0")
        .replace("orientation 0 0 0", "orientation 0 0 90");
    let clip = parse(&preset, WAVE, &metres()).unwrap();
    assert_near(ends(&clip, 1, "upper")[0], [2.0, 2.0, 3.0]);
    assert_near(ends(&clip, 0, "upper")[1], [1.0, 2.0, 0.0]);
}

#[test]
fn frames_that_are_not_fully_specified_hold_what_they_leave_out() {
    let amc = "1\nroot 0 0 0 0 0 0\nupper 90\nlower 0 0\n2\nroot 1 0 0 0 0 0\n";
    let clip = parse(ARM, amc, &metres()).unwrap();
    assert_near(ends(&clip, 1, "upper")[1], [1.0, 0.0, -2.0]);
    let error = parse(ARM, &format!(":FULLY-SPECIFIED\n{amc}"), &metres()).unwrap_err();
    let words = ["wave.amc", "line 7", "upper", "frame 2"];
    assert!(
        words.iter().all(|word| error.to_string().contains(word)),
        "{error}"
    );
}

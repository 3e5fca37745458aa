//! Each kind of damage is found, and hardly any other with it; good clips have none.

use glam::{Quat, Vec3};
use physique::Error;
use physique::body::{Body, Joint, Sex, open_body_low};
use physique::defects::{Defect, DefectFinder, DefectKind, DefectLimits};
use physique::load::load_recording;
use physique::motion::{FrameRate, Motion, embedded};
use physique::physics::protocol::resampled;

fn body() -> Body {
    Body::mean(open_body_low().unwrap(), Sex::Neutral).unwrap()
}

fn finder() -> DefectFinder {
    DefectFinder::new(&body(), DefectLimits::default()).unwrap()
}

fn clip(name: &str) -> Motion {
    let recording = embedded::clip(name).unwrap().load().unwrap();
    load_recording(recording, &body()).unwrap().motion
}

fn found(motion: &Motion) -> Vec<Defect> {
    finder().find(motion).unwrap()
}

fn kinds(motion: &Motion) -> Vec<DefectKind> {
    found(motion)
        .into_iter()
        .map(|defect| defect.kind)
        .collect()
}

/// The motion with frames chosen by number, told at a rate, each changed.
fn remade(
    motion: &Motion,
    frames: impl IntoIterator<Item = usize>,
    fps: f64,
    change: impl Fn(usize, &mut Vec3, &mut [Quat]),
) -> Motion {
    let (mut roots, mut rotations) = (Vec::new(), Vec::new());
    for frame in frames {
        let mut root = motion.root_translation()[frame];
        let mut turned = motion.frame_rotations(frame).to_vec();
        change(frame, &mut root, &mut turned);
        roots.push(root);
        rotations.extend(turned);
    }
    Motion::new(FrameRate::new(fps).unwrap(), None, roots, rotations).unwrap()
}

fn fps(motion: &Motion) -> f64 {
    motion.frame_rate().per_second()
}

fn all(motion: &Motion) -> std::ops::Range<usize> {
    0..motion.frame_count()
}

#[test]
fn good_clips_have_none_at_any_common_frame_rate() {
    // The dance has a fault of its own: see below.
    for clip in embedded::clips().iter().filter(|clip| clip.name != "dance") {
        let motion = load_recording(clip.load().unwrap(), &body())
            .unwrap()
            .motion;
        assert_eq!(found(&motion), [], "{}", clip.name);
        for rate in [20.0, 60.0, 120.0] {
            let motion = resampled(&motion, FrameRate::new(rate).unwrap()).unwrap();
            assert_eq!(found(&motion), [], "{} at {rate}", clip.name);
        }
    }
}

#[test]
fn a_sunk_clip_is_below_ground_and_a_lifted_one_floats() {
    let walk = clip("walk");
    let shifted = |by: f32| remade(&walk, all(&walk), fps(&walk), |_, root, _| root.y += by);
    assert_eq!(kinds(&shifted(-0.1)), [DefectKind::BelowGround]);
    let [lifted] = &found(&shifted(0.1))[..] else {
        panic!("one defect");
    };
    assert_eq!(lifted.kind, DefectKind::Floating);
    assert!((lifted.value.unwrap() - 10.0).abs() < 2.0, "{lifted}");
}

/// Its right hip turns round and back within four frames, as recorded.
#[test]
fn a_fault_of_the_recording_is_found() {
    let [defect] = &found(&clip("dance"))[..] else {
        panic!("one defect");
    };
    assert_eq!(defect.kind, DefectKind::Jump);
    // Frames 105 to 108 of 60 a second; which of them is worst depends on the mapping.
    assert!((1.74..1.81).contains(&defect.at_s.unwrap()), "{defect}");
}

#[test]
fn a_limb_or_a_body_that_is_elsewhere_for_a_frame_jumps() {
    let walk = clip("walk");
    let flip = remade(&walk, all(&walk), fps(&walk), |frame, _, turned| {
        if frame == 20 {
            turned[Joint::LeftElbow.index()] *= Quat::from_rotation_y(2.0);
        }
    });
    let [defect] = &found(&flip)[..] else {
        panic!("one defect: {:?}", found(&flip));
    };
    assert_eq!(defect.kind, DefectKind::Jump);
    let seconds = 20.0 / fps(&walk);
    assert!(
        (defect.at_s.unwrap() - seconds).abs() < 1.5 / fps(&walk),
        "{defect}"
    );
    assert!(defect.message.contains("left"), "{defect}");
    let cut = remade(&walk, all(&walk), fps(&walk), |frame, root, _| {
        root.x += if frame < 30 { 0.0 } else { 0.4 };
    });
    assert!(kinds(&cut).contains(&DefectKind::Jump));
}

#[test]
fn a_held_pose_is_frozen() {
    let walk = clip("walk");
    let last = walk.frame_count() - 1;
    let padded = remade(
        &walk,
        all(&walk).chain([last; 40]),
        fps(&walk),
        |_, _, _| (),
    );
    let [defect] = &found(&padded)[..] else {
        panic!("one defect: {:?}", found(&padded));
    };
    assert_eq!(defect.kind, DefectKind::Frozen);
    assert!((defect.value.unwrap() - 40.0 / fps(&walk)).abs() < 1e-9);
}

#[test]
fn frames_shown_twice_tell_the_true_rate() {
    let walk = clip("walk");
    let twice = remade(
        &walk,
        all(&walk).flat_map(|frame| [frame; 2]),
        2.0 * fps(&walk),
        |_, _, _| (),
    );
    let defects = found(&twice);
    assert!(
        defects
            .iter()
            .all(|defect| defect.kind == DefectKind::RepeatedFrames),
        "{defects:?}"
    );
    let rate = format!("probably {:.0} a second", fps(&walk));
    assert!(defects[0].message.contains(&rate), "{}", defects[0]);
}

#[test]
fn gravity_tells_a_wrong_frame_rate() {
    let jump = clip("jump");
    for wrong in [0.5, 2.0] {
        let told = remade(&jump, all(&jump), wrong * fps(&jump), |_, _, _| ());
        let defects = found(&told);
        let rate = defects
            .iter()
            .find(|defect| defect.kind == DefectKind::FrameRate);
        let rate = rate.unwrap_or_else(|| panic!("{defects:?}"));
        assert!((rate.value.unwrap() / wrong - 1.0).abs() < 0.2, "{rate}");
    }
}

#[test]
fn unusual_rates_and_stubs_are_found() {
    let walk = clip("walk");
    let rate = |fps: f64| kinds(&remade(&walk, all(&walk), fps, |_, _, _| ()));
    assert!(rate(1000.0).contains(&DefectKind::FrameRate));
    assert!(rate(2.0).contains(&DefectKind::FrameRate));
    assert!(rate(FrameRate::FASTEST).contains(&DefectKind::FrameRate));
    let stub = remade(&walk, 0..3, fps(&walk), |_, _, _| ());
    assert_eq!(kinds(&stub), [DefectKind::TooShort]);
    let empty = remade(&walk, [], fps(&walk), |_, _, _| ());
    assert_eq!(kinds(&empty), [DefectKind::TooShort]);
    assert_eq!(
        kinds(&remade(&walk, [0], fps(&walk), |_, _, _| ())),
        [DefectKind::TooShort]
    );
}

#[test]
fn what_cannot_be_read_is_a_defect_with_its_reason() {
    let not_finite = Motion::new(
        FrameRate::new(30.0).unwrap(),
        None,
        vec![Vec3::NAN],
        vec![Quat::IDENTITY; Joint::COUNT],
    );
    let defect = Defect::of_error(&Error::from(not_finite.unwrap_err()));
    assert_eq!(defect.kind, DefectKind::NotFinite);
    assert!(defect.message.contains("Frame 0"), "{defect}");
    let missing = physique::load::load(
        "no such file.bvh".as_ref(),
        &body(),
        &physique::load::LoadOptions::default(),
    );
    let defect = Defect::of_error(&missing.unwrap_err());
    assert_eq!(defect.kind, DefectKind::Unreadable);
}

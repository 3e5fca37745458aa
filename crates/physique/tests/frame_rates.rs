//! The same recorded clip scores the same at other frame rates.

use physique::body::{Body, Sex, open_body_low};
use physique::load::load_recording;
use physique::measures::measures;
use physique::motion::{FrameRate, Motion, embedded};
use physique::physics::protocol::resampled;
use physique::{Group, ScoreOptions, Scorer};

/// Measures, and by how much of its value each may differ between 120 and 20 frames a second, or by
/// how much in its own unit where it is small.
const AGREEMENT: [(&str, f64, f64); 9] = [
    ("self_intersection_mean_cm3", 0.05, 1.0),
    ("crease_mean_cm3", 0.05, 1.0),
    ("ground_penetration_mean_cm", 0.05, 0.02),
    ("ground_floating_mean_cm", 0.05, 0.05),
    ("feet_slide_mean_cm_s", 0.1, 0.5),
    ("balance_stable_percent", 0.05, 0.0),
    ("balance_margin_mean_cm", 0.1, 0.5),
    ("smoothness_acceleration_mean_m_s2", 0.05, 0.0),
    ("smoothness_jerk_mean_m_s3", 0.05, 0.0),
];

/// A recording that goes on long enough for a mean: the dance, from before its fault.
fn recorded() -> Motion {
    let body = Body::mean(open_body_low().unwrap(), Sex::Neutral).unwrap();
    let recording = embedded::clip("dance").unwrap().load().unwrap();
    load_recording(recording, &body).unwrap().motion
}

#[test]
fn at_120_and_at_20_frames_a_second() {
    let body = Body::mean(open_body_low().unwrap(), Sex::Neutral).unwrap();
    let options = ScoreOptions {
        groups: Group::ALL.to_vec(),
        ..ScoreOptions::default()
    };
    let scorer = Scorer::new(body, options).unwrap();
    let [fine, coarse] = [120.0, 20.0].map(|fps| {
        let motion = resampled(&recorded(), FrameRate::new(fps).unwrap()).unwrap();
        measures(&scorer.score(&motion).unwrap())
    });
    let value = |found: &[(std::borrow::Cow<'static, str>, f64)], name: &str| {
        found.iter().find(|(known, _)| known == name).unwrap().1
    };
    for (name, part, amount) in AGREEMENT {
        let [fine, coarse] = [value(&fine, name), value(&coarse, name)];
        println!("{name} {fine} {coarse}");
        assert!(
            (fine - coarse).abs() <= f64::max(part * fine.abs(), amount),
            "{name}: {fine} at 120 fps, {coarse} at 20"
        );
    }
}

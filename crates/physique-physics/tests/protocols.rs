//! Published metrics on motions whose values follow from their definitions.

use std::sync::LazyLock;

use glam::{Quat, Vec3};
use physique_body::{Body, Joint, Sex, open_body};
use physique_motion::{FrameRate, Motion};
use physique_physics::protocol::{measure, resampled};
use physique_physics::{Floor, Physics, Protocol};

static PHYSICS: LazyLock<Physics> = LazyLock::new(|| {
    let body = Body::mean(open_body().unwrap(), Sex::Neutral).unwrap();
    Physics::new(&body).unwrap()
});

/// Two seconds of the rest pose at 60 fps, the soles at `path(t)`.
fn rigid(path: impl Fn(f32) -> Vec3) -> Motion {
    let standing = Vec3::Y * PHYSICS.body().rest_ground();
    let frames = 121;
    Motion::new(
        FrameRate::new(60.0).unwrap(),
        None,
        (0..frames)
            .map(|frame| path(frame as f32 / 60.0) - standing)
            .collect(),
        vec![Quat::IDENTITY; frames * Joint::COUNT],
    )
    .unwrap()
}

fn value_above(motion: &Motion, protocol: Protocol, floor: Floor, name: &str) -> Option<f64> {
    let measures = measure(&PHYSICS, motion, protocol, floor).unwrap();
    let found = measures.iter().find(|measure| measure.name == name);
    found
        .unwrap_or_else(|| panic!("{name} in {measures:?}"))
        .value
}

fn value(motion: &Motion, protocol: Protocol, name: &str) -> f64 {
    value_above(motion, protocol, Floor::AsGiven, name).unwrap()
}

fn assert_close(found: f64, expected: f64) {
    assert!(
        (found - expected).abs() < 1e-3 * expected.abs().max(0.01),
        "{found} {expected}"
    );
}

/// Height of a toe joint of the standing body.
fn toe_height() -> f64 {
    f64::from(PHYSICS.body().rest_joint(Joint::LeftFoot).y - PHYSICS.body().rest_ground())
}

#[test]
fn sinking_and_floating_come_in_the_published_units() {
    let sunk = rigid(|_| Vec3::Y * -0.03);
    assert_close(value(&sunk, Protocol::PhysDiff, "penetrate_mm"), 30.0);
    assert_close(value(&sunk, Protocol::PhysDiff, "phys_err_mm"), 30.0);
    assert_close(value(&sunk, Protocol::HumosReleased, "penetrate_cm"), 3.0);
    assert_close(value(&sunk, Protocol::HumosCorrected, "penetrate_cm"), 3.0);
    let floating = rigid(|_| Vec3::Y * 0.2);
    assert_close(value(&floating, Protocol::PhysDiff, "float_mm"), 200.0);
    assert_close(value(&floating, Protocol::HumosReleased, "float_cm"), 20.0);
    assert_close(
        value(&floating, Protocol::ReinDiffuse, "float_m"),
        0.2 + toe_height(),
    );
    let deep = rigid(|_| Vec3::Y * (-0.05 - toe_height() as f32));
    assert_close(
        value(&deep, Protocol::Humor, "toes_below_3_cm_percent"),
        100.0,
    );
    assert_close(
        value(&deep, Protocol::Humor, "toes_below_6_cm_percent"),
        0.0,
    );
    assert_close(value(&deep, Protocol::Humor, "penetration_depth_cm"), 5.0);
    assert_close(value(&deep, Protocol::ReinDiffuse, "penetrate_m"), 0.05);
}

#[test]
fn conditional_means_differ_from_true_ones() {
    // Sunk by 4 cm in the second half only.
    let half = rigid(|t| Vec3::Y * if t > 1.0 { -0.04 } else { 0.0 });
    assert_close(value(&half, Protocol::HumosReleased, "penetrate_cm"), 4.0);
    let true_mean = value(&half, Protocol::HumosCorrected, "penetrate_cm");
    assert!((1.8..2.1).contains(&true_mean), "{true_mean}");
}

#[test]
fn floors_hide_or_show_a_sunken_clip() {
    let sunk = rigid(|_| Vec3::Y * -0.1);
    let penetration =
        |floor| value_above(&sunk, Protocol::PhysDiff, floor, "penetrate_mm").unwrap();
    assert_close(penetration(Floor::AsGiven), 100.0);
    assert_close(penetration(Floor::Lowest), 0.0);
    assert_close(penetration(Floor::HumosSink), 20.0);
}

#[test]
fn gliding_skates_everywhere_at_its_speed() {
    // Low enough for every definition of contact.
    let low = (0.005 - toe_height()) as f32;
    let glide = rigid(|t| Vec3::new(0.9 * t, low, 0.0));
    assert_close(value(&glide, Protocol::Gmd, "skating_ratio"), 1.0);
    assert_close(
        value(&glide, Protocol::ReinDiffuse, "skate_2_5_cm_ratio"),
        1.0,
    );
    assert_close(
        value(&glide, Protocol::ReinDiffuse, "skate_5_cm_ratio"),
        0.0,
    );
    assert_close(
        value(&glide, Protocol::Kimodo, "skating_contact_ratio"),
        1.0,
    );
    assert_close(
        value(&glide, Protocol::Kimodo, "toe_speed_in_contact_m_s"),
        0.9,
    );
    // Two of four foot joints are low enough.
    assert_close(
        value(&glide, Protocol::HumosReleased, "skate_percent"),
        50.0,
    );
    assert_close(value(&glide, Protocol::HumosReleased, "skate_cm_s"), 45.0);
    let weight = 2.0 - 2.0_f64.powf(0.005 / 0.025);
    assert_close(
        value(&glide, Protocol::Mann, "skate_cm_per_frame"),
        1.5 * weight,
    );
    // Nothing accelerates: no force that a foot would have to carry.
    assert!(value(&glide, Protocol::EdgePfc, "pfc") < 20.0);
    let still = rigid(|_| Vec3::Y * low);
    for (protocol, name) in [
        (Protocol::Gmd, "skating_ratio"),
        (Protocol::Kimodo, "skating_contact_ratio"),
        (Protocol::Mann, "skate_cm_per_frame"),
        (Protocol::EdgePfc, "pfc"),
    ] {
        assert_eq!(value(&still, protocol, name), 0.0, "{name}");
    }
}

#[test]
fn edge_pfc_of_a_uniform_acceleration() {
    // Horizontal 2 m/s2: displacements a frame d_k = a h^2 (k + 1/2), the score the mean of d_k^2.
    let motion = rigid(|t| Vec3::X * (t * t));
    let found = value(&motion, Protocol::EdgePfc, "pfc");
    let step = |k: i32| 2.0 / 900.0 * (f64::from(k) + 0.5);
    let expected = 1e4 * (0..59).map(|k| step(k).powi(2)).sum::<f64>() / 59.0;
    assert!((found / expected - 1.0).abs() < 0.02, "{found} {expected}");
}

#[test]
fn standing_is_stable_and_flying_is_not_judged_but_as_released() {
    let standing = rigid(|_| Vec3::ZERO);
    for protocol in [Protocol::HumosReleased, Protocol::HumosCorrected] {
        assert_close(value(&standing, protocol, "dyn_stability_percent"), 100.0);
    }
    assert_close(
        value(&standing, Protocol::Ipman, "com_in_base_of_support_percent"),
        100.0,
    );
    assert!(value(&standing, Protocol::Ipman, "com_cop_distance_mm") < 100.0);
    let flying = rigid(|t| Vec3::Y * (0.3 + 10.0 * t - 4.905 * t * t));
    assert_close(
        value(&flying, Protocol::HumosReleased, "dyn_stability_percent"),
        0.0,
    );
    let judged = value_above(
        &flying,
        Protocol::HumosCorrected,
        Floor::AsGiven,
        "dyn_stability_percent",
    );
    assert_eq!(judged, None);
    assert_close(
        value(&flying, Protocol::HumosCorrected, "unjudged_percent"),
        100.0,
    );
}

#[test]
fn resampling_keeps_ends_and_straight_lines() {
    let glide = rigid(|t| Vec3::X * t);
    for fps in [20.0, 30.0, 120.0] {
        let found = resampled(&glide, FrameRate::new(fps).unwrap()).unwrap();
        assert_eq!(found.frame_count(), (2.0 * fps) as usize + 1);
        for (frame, root) in found.root_translation().iter().enumerate() {
            assert!((f64::from(root.x) - frame as f64 / fps).abs() < 1e-6);
        }
    }
    assert_eq!(
        resampled(&glide, FrameRate::new(60.0).unwrap()).unwrap(),
        glide
    );
}

#[test]
fn every_protocol_measures_what_it_names() {
    let standing = rigid(|_| Vec3::ZERO);
    for protocol in Protocol::ALL {
        let measures = measure(&PHYSICS, &standing, protocol, Floor::AsGiven).unwrap();
        let names: Vec<_> = measures.iter().map(|measure| measure.name).collect();
        assert_eq!(names, protocol.measure_names(), "{protocol}");
    }
}

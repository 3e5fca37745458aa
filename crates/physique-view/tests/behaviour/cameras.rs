//! Cameras show what they promise, from where they say.

use glam::{Vec3, vec3};
use physique_view::{Bounds, Camera, View};
use proptest::prelude::*;

const VIEWS: [View; 5] = [
    View::FRONT,
    View::SIDE,
    View::THREE_QUARTER,
    View::TOP,
    View::BACK,
];

#[test]
fn left_is_on_the_right_from_before_and_on_the_left_from_above() {
    let body = Bounds {
        min: vec3(-1., 0., -0.2),
        max: vec3(1., 1.8, 0.2),
    };
    let x = |view: &View, point: Vec3| {
        let camera = Camera::framing(&body, view, 1.0, 0.1);
        camera.project(point, 100, 100).expect("in sight")[0]
    };
    let left_hand = vec3(0.9, 1.0, 0.0);
    assert!(x(&View::FRONT, left_hand) > 80.0);
    assert!(x(&View::BACK, left_hand) < 20.0);
    assert!(x(&View::TOP, left_hand) < 20.0);
    // Walking (+Z) goes to the right when seen from the body's right.
    assert!(x(&View::SIDE, vec3(0., 1., 0.2)) > x(&View::SIDE, vec3(0., 1., -0.2)));
}

#[test]
fn from_above_walking_goes_up_the_picture() {
    let body = Bounds {
        min: vec3(-1., 0., -1.),
        max: vec3(1., 1.8, 1.),
    };
    let camera = Camera::framing(&body, &View::TOP, 1.0, 0.1);
    let [_, ahead] = camera.project(Vec3::Z, 100, 100).expect("in sight");
    let [_, behind] = camera.project(-Vec3::Z, 100, 100).expect("in sight");
    assert!(ahead < 20.0 && behind > 80.0);
}

#[test]
fn a_view_turns_with_the_body() {
    let quarter = std::f32::consts::FRAC_PI_2;
    let body = Bounds {
        min: vec3(-1., 0., -1.),
        max: vec3(1., 1.8, 1.),
    };
    let camera = Camera::framing(&body, &View::FRONT.around(quarter), 1.0, 0.1);
    assert!(
        camera.eye.x > 3.0 && camera.eye.z.abs() < 0.1,
        "before a body that faces +X: {}",
        camera.eye
    );
}

#[test]
fn what_is_behind_is_not_in_the_picture() {
    let body = Bounds {
        min: vec3(-1., 0., -1.),
        max: vec3(1., 1.8, 1.),
    };
    let camera = Camera::framing(&body, &View::FRONT, 1.0, 0.1);
    assert!(camera.project(camera.eye + Vec3::Z, 10, 10).is_none());
}

proptest! {
    /// All points lie inside the margins, and some touch them.
    #[test]
    fn framing_shows_all_points_as_large_as_can_be(
        points in prop::collection::vec(prop::array::uniform3(-2.0_f32..2.0), 4..40),
        aspect in 0.4_f32..3.0,
        view in 0..VIEWS.len(),
    ) {
        let points: Vec<Vec3> = points.into_iter().map(Vec3::from).collect();
        let margin = 0.1;
        let camera = Camera::framing_points(points.iter().copied(), &VIEWS[view], aspect, margin);
        let (width, height) = ((1000.0 * aspect) as u32, 1000);
        let mut reach = 0.0_f32;
        for &point in &points {
            let [x, y] = camera.project(point, width, height).expect("in sight");
            reach = reach
                .max((x / width as f32 - 0.5).abs())
                .max((y / height as f32 - 0.5).abs());
        }
        prop_assert!((reach - (0.5 - margin)).abs() < 0.005, "reaches {reach}");
    }
}

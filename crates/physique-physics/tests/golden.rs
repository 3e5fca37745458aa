//! Golden values of zero moment point, pressure and base of support.
//!
//! `fixtures/physics.json` was made by an independent implementation in NumPy, Z up, on made-up
//! motions; it is turned to Y up here.

use glam::{DVec2, DVec3};
use physique_physics::{Centroid, GRAVITY, PressureModel, SupportPolygon};
use serde_json::Value;

fn golden() -> Value {
    serde_json::from_str(include_str!("fixtures/physics.json")).unwrap()
}

fn numbers(value: &Value) -> Vec<f64> {
    let list = value.as_array().unwrap();
    list.iter().map(|number| number.as_f64().unwrap()).collect()
}

/// A vector of the file in Y up.
fn vector(value: &Value) -> DVec3 {
    let v = numbers(value);
    DVec3::new(v[0], v[2], -v[1])
}

/// A place on the ground of the file, as `(x, z)`.
fn place(value: &Value) -> DVec2 {
    let v = numbers(value);
    DVec2::new(v[0], -v[1])
}

fn list<T>(value: &Value, of: impl Fn(&Value) -> T) -> Vec<T> {
    value.as_array().unwrap().iter().map(of).collect()
}

/// Centroid of particles in the middle of three frames by `[1, -2, 1] / h^2`.
fn centroid(masses: &[f64], frames: &[Vec<DVec3>], step: f64) -> Centroid {
    let mass: f64 = masses.iter().sum();
    let mean = |points: &[DVec3]| {
        let sum: DVec3 = points.iter().zip(masses).map(|(p, m)| *p * *m).sum();
        sum / mass
    };
    let accelerations: Vec<_> = (0..masses.len())
        .map(|k| (frames[0][k] - 2.0 * frames[1][k] + frames[2][k]) / (step * step))
        .collect();
    let centre = mean(&frames[1]);
    let turns =
        (0..masses.len()).map(|k| masses[k] * (frames[1][k] - centre).cross(accelerations[k]));
    Centroid {
        mass,
        centre,
        acceleration: mean(&accelerations),
        angular_momentum_rate: turns.sum(),
        ..Centroid::default()
    }
}

#[test]
fn zero_moment_point_of_particles() {
    let golden = &golden()["zmp"];
    assert_eq!(golden["g"].as_f64(), Some(GRAVITY));
    let step = 1.0 / golden["fps"].as_f64().unwrap();
    let masses = numbers(&golden["mass"]);
    let frames = list(&golden["pos"], |frame| list(frame, vector));
    let expected = list(&golden["expect_zmp_xy"], place);
    let rates = list(&golden["Hdot"], vector);
    assert_eq!(expected.len(), frames.len() - 2);
    let mut error = 0.0_f64;
    for (three, (expected, rate)) in frames.windows(3).zip(expected.iter().zip(rates)) {
        let centroid = centroid(&masses, three, step);
        error = error.max((centroid.angular_momentum_rate - rate).length());
        error = error.max(centroid.zero_moment_point(0.0).unwrap().distance(*expected));
    }
    println!("largest error of the zero moment point and momentum rate: {error:e}");
    assert!(error < 1e-12, "{error:e}");
}

#[test]
fn zero_moment_point_of_one_particle() {
    for case in golden()["zmp_point"].as_array().unwrap() {
        let number = |key: &str| case[key].as_f64().unwrap();
        let centroid = Centroid {
            mass: 70.0,
            centre: DVec3::new(number("x"), number("h"), 0.0),
            acceleration: DVec3::new(number("ax"), number("az"), 0.0),
            ..Centroid::default()
        };
        let found = centroid.zero_moment_point(0.0).unwrap();
        assert!((found.x - number("expect")).abs() < 1e-14);
    }
}

#[test]
fn pressure() {
    for (name, model) in [
        ("cop_ipman", PressureModel::IPMAN),
        ("cop_humos", PressureModel::HUMOS),
    ] {
        let golden = &golden()[name];
        let points = list(&golden["pts"], vector);
        for (point, weight) in points.iter().zip(numbers(&golden["weights"])) {
            assert!((model.pressure(point.y) - weight).abs() < 1e-15);
        }
        let points = points.into_iter().map(|point| (point, 1.0));
        let found = model.centre(points, 0.0, 5e-4).unwrap();
        assert!(found.distance(place(&golden["expect"])) < 1e-15);
    }
}

#[test]
fn signed_distance_to_the_base_of_support() {
    let golden = &golden()["bos"];
    let hull = SupportPolygon::around(&mut list(&golden["hull"], place)).unwrap();
    assert!((hull.area() - 1.0).abs() < 1e-15);
    for case in golden["cases"].as_array().unwrap() {
        let found = hull.signed_distance(place(&case["p"]));
        assert!((found - case["d"].as_f64().unwrap()).abs() < 1e-15);
    }
}

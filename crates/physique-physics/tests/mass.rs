//! Masses of bodies, and their moments against sums over points.

use std::sync::Arc;

use glam::{DMat3, DMat4, DVec3};
use physique_body::{Attributes, Body, Joint, Sex, open_body, open_body_low};
use physique_physics::{MassPoints, Rig, Segment};

/// Five shapes: both means, and three far from them.
fn shapes() -> Vec<(&'static str, Sex, Body)> {
    let person = |sex, stature, mass| Attributes {
        sex,
        stature: Some(stature),
        mass: Some(mass),
        age: None,
    };
    let model = open_body().unwrap();
    let body = |person| Body::from_attributes(Arc::clone(&model), &person).unwrap();
    vec![
        (
            "mean woman",
            Sex::Female,
            Body::mean(model.clone(), Sex::Female).unwrap(),
        ),
        (
            "mean man",
            Sex::Male,
            Body::mean(model.clone(), Sex::Male).unwrap(),
        ),
        (
            "small light woman",
            Sex::Female,
            body(person(Sex::Female, 1.53, 46.0)),
        ),
        ("tall man", Sex::Male, body(person(Sex::Male, 1.93, 90.0))),
        ("heavy man", Sex::Male, body(person(Sex::Male, 1.75, 110.0))),
    ]
}

#[test]
fn segments_weigh_about_what_de_leva_measured() {
    for (name, sex, body) in shapes() {
        let points = MassPoints::new(&body, 0.02).unwrap();
        let total: f64 = points.masses().iter().sum();
        assert!((total - body.mass()).abs() < 1e-9 * total);
        for segment in Segment::ALL {
            let percent = 100.0 * points.segment_mass(segment) / total;
            let table = segment.de_leva_percent(sex);
            // Fitted cuts and Dempster's densities are not de Leva's subjects: within a third of the
            // small segments and 5.5 points of the large ones.
            let allowed = (0.35 * table).min(5.5);
            println!("{name:18} {:16} {percent:6.2} {table:6.2}", segment.name());
            assert!(
                (percent - table).abs() < allowed,
                "{name}, {segment:?}: {percent} {table}"
            );
        }
    }
}

#[test]
fn moments_are_the_sums_over_posed_points() {
    let body = Body::mean(open_body_low().unwrap(), Sex::Neutral).unwrap();
    let points = MassPoints::new(&body, 0.03).unwrap();
    let moments = points.moments();
    let rig = Rig::new(&body);
    let pose = |phase: f64| {
        let rotations = (0..Joint::COUNT)
            .map(|j| DMat3::from_rotation_y(0.7 * (phase + j as f64).sin()))
            .collect::<Vec<_>>();
        let mut transforms = Vec::new();
        rig.pose(rotations, DVec3::new(0.2, phase, 3.0), &mut transforms);
        transforms
    };
    let (transforms, others) = (pose(0.0), pose(1.0));
    let rates: Vec<DMat4> = transforms
        .iter()
        .zip(&others)
        .map(|(a, b)| *b - *a)
        .collect();

    let (posed, moved) = (points.posed(&transforms), points.posed(&rates));
    let masses = points.masses();
    let mass: f64 = masses.iter().sum();
    let mean = |points: &[DVec3]| -> DVec3 {
        points
            .iter()
            .zip(masses)
            .map(|(p, m)| *p * *m)
            .sum::<DVec3>()
            / mass
    };
    let about_centre: DVec3 = posed
        .iter()
        .zip(&moved)
        .zip(masses)
        .map(|((p, v), m)| *m * (*p - mean(&posed)).cross(*v))
        .sum();
    assert!((moments.mass() - mass).abs() < 1e-12 * mass);
    assert!((moments.mean(&transforms) - mean(&posed)).length() < 1e-12);
    assert!((moments.mean(&rates) - mean(&moved)).length() < 1e-12);
    let found = moments.moment_about_centre(&transforms, &rates);
    assert!(
        (found - about_centre).length() < 1e-10,
        "{found} {about_centre}"
    );
}

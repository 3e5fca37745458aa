//! The embedded bodies are what their card says, and people are made as asked.

use std::collections::HashMap;
use std::sync::Arc;

use glam::Vec3;
use physique_body::{
    Attributes, Body, BodyModel, Error, Joint, Sex, compact, open_body, open_body_low,
};

fn models() -> [Arc<BodyModel>; 2] {
    [open_body().unwrap(), open_body_low().unwrap()]
}

#[test]
fn sizes_are_those_of_the_card() {
    let [full, low] = models();
    assert!((6_800..=7_000).contains(&full.vertex_count()), "{full:?}");
    assert!((2_900..=3_100).contains(&low.vertex_count()), "{low:?}");
    for model in [full, low] {
        assert_eq!(model.beta_count(), 10);
        assert_eq!(model.joint_count(), Joint::COUNT);
        assert!(model.blend_weights().influences() <= 4);
    }
}

#[test]
fn the_surface_is_one_closed_sphere() {
    for model in models() {
        let mut directed = HashMap::new();
        for &[a, b, c] in model.triangles() {
            for edge in [(a, b), (b, c), (c, a)] {
                *directed.entry(edge).or_insert(0) += 1;
            }
        }
        for (&(a, b), &count) in &directed {
            assert_eq!(
                (count, directed.get(&(b, a))),
                (1, Some(&1)),
                "edge {a}-{b}"
            );
        }
        let edges = directed.len() / 2;
        let euler = model.vertex_count() + model.triangles().len() - edges;
        assert_eq!(euler, 2, "one closed surface of genus 0");
        assert_eq!(components(&model), 1);
    }
}

fn components(model: &BodyModel) -> usize {
    let mut root: Vec<usize> = (0..model.vertex_count()).collect();
    fn find(root: &mut [usize], mut vertex: usize) -> usize {
        while root[vertex] != vertex {
            root[vertex] = root[root[vertex]];
            vertex = root[vertex];
        }
        vertex
    }
    for &[a, b, c] in model.triangles() {
        for other in [b, c] {
            let (a, b) = (find(&mut root, a as usize), find(&mut root, other as usize));
            root[a] = b;
        }
    }
    (0..root.len()).filter(|&v| root[v] == v).count()
}

#[test]
fn left_and_right_mirror_each_other_to_the_bit() {
    for model in models() {
        let mirror = model.mirror_vertices();
        let image = |v: &Vec3| Vec3::new(-v.x, v.y, v.z);
        let symmetric = |field: &[Vec3]| {
            (0..field.len()).all(|v| field[mirror[v] as usize] == image(&field[v]))
        };
        assert!(symmetric(model.template()));
        assert!(
            model
                .shape_directions()
                .iter()
                .all(|field| symmetric(field))
        );
        for (vertex, &mirrored) in mirror.iter().enumerate() {
            let part = model.vertex_parts()[vertex];
            assert_eq!(
                model.vertex_parts()[mirrored as usize],
                part.mirrored(),
                "vertex {vertex}"
            );
        }
    }
}

#[test]
fn the_rest_pose_is_a_t_pose_that_faces_forward() {
    for model in models() {
        let body = Body::new(model, &[]).unwrap();
        let at = |joint| body.rest_joint(joint);
        assert!(at(Joint::LeftWrist).x > 0.55 && at(Joint::RightWrist).x < -0.55);
        let arm = at(Joint::LeftWrist) - at(Joint::LeftShoulder);
        assert!(arm.x / arm.length() > 0.98, "arms are horizontal: {arm}");
        let leg = at(Joint::LeftAnkle) - at(Joint::LeftHip);
        assert!(leg.y / leg.length() < -0.98, "legs are vertical: {leg}");
        assert!(
            at(Joint::LeftFoot).z > at(Joint::LeftAnkle).z + 0.08,
            "toes point to +Z"
        );
        assert!(at(Joint::Head).y > at(Joint::Pelvis).y + 0.4);
    }
}

#[test]
fn people_get_the_stature_and_mass_asked_for() {
    for model in models() {
        for (sex, stature, mass) in [
            (Sex::Female, 1.55, 48.0),
            (Sex::Female, 1.63, 66.0),
            (Sex::Female, 1.65, 95.0),
            (Sex::Neutral, 1.70, 70.0),
            (Sex::Male, 1.76, 78.0),
            (Sex::Male, 1.95, 110.0),
        ] {
            let person = Attributes {
                sex,
                stature: Some(stature),
                mass: Some(mass),
                age: None,
            };
            let body = Body::from_attributes(Arc::clone(&model), &person).unwrap();
            assert!((body.stature() / stature - 1.0).abs() < 2e-5, "{person:?}");
            assert!((body.mass() / mass - 1.0).abs() < 2e-5, "{person:?}");
        }
    }
}

#[test]
fn mean_bodies_differ_as_people_do() {
    let model = open_body().unwrap();
    let mean = |sex| Body::mean(Arc::clone(&model), sex).unwrap();
    let (female, neutral, male) = (mean(Sex::Female), mean(Sex::Neutral), mean(Sex::Male));
    assert!(
        (1.60..1.66).contains(&female.stature()),
        "{}",
        female.stature()
    );
    assert!((1.73..1.79).contains(&male.stature()), "{}", male.stature());
    assert!(female.stature() < neutral.stature() && neutral.stature() < male.stature());
    for body in [female, neutral, male] {
        assert!(
            (22.0..28.0).contains(&body.body_mass_index()),
            "{}",
            body.body_mass_index()
        );
    }
}

#[test]
fn impossible_people_are_refused_by_name() {
    let model = open_body().unwrap();
    for (stature, mass) in [
        (-1.0, 70.0),
        (f64::NAN, 70.0),
        (1.7, 0.0),
        (9.0, 70.0),
        (1.7, 900.0),
    ] {
        let person = Attributes {
            stature: Some(stature),
            mass: Some(mass),
            ..Attributes::default()
        };
        let outcome = Body::from_attributes(Arc::clone(&model), &person);
        assert!(
            matches!(outcome, Err(Error::Attributes { .. })),
            "{person:?}"
        );
    }
}

#[test]
fn betas_beyond_the_model_are_refused() {
    let model = open_body().unwrap();
    for betas in [vec![0.0; 11], vec![f32::NAN], vec![f32::INFINITY]] {
        let outcome = Body::new(Arc::clone(&model), &betas);
        assert!(matches!(outcome, Err(Error::Betas { available: 10, .. })));
    }
}

#[test]
fn truncated_and_damaged_files_are_errors() {
    let bytes = include_bytes!("../assets/open_body_low.npz");
    for length in (0..bytes.len()).step_by(997) {
        assert!(
            compact::read("cut", &bytes[..length]).is_err(),
            "cut at {length}"
        );
    }
    // A flipped bit may fall into padding of the archive and be harmless; it must never panic.
    for position in (0..bytes.len()).step_by(499) {
        let mut damaged = bytes.to_vec();
        damaged[position] ^= 0x10;
        let _ = compact::read("damaged", &damaged);
    }
}

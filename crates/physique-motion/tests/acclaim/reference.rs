//! A whole human against matrices on row vectors, as the format's textbooks have it.

use glam::{DMat4, DVec3, DVec4};
use physique_motion::ReadOptions;
use physique_motion::bvh::{self, BvhOptions, BvhWriteOptions};
use physique_motion::mapping::find_joints;

use crate::arm::{ends, parse};
use crate::human::human;

/// Bone ends by the textbook: row vectors, `L = C⁻¹ M C B`, matrices from the leaf to the root.
fn reference_ends(asf: &str, amc: &str) -> Vec<Vec<(String, DVec3)>> {
    struct Bone<'a> {
        name: &'a str,
        reach: DVec3,
        axis: DMat4,
        dof: Vec<&'a str>,
        parent: Option<&'a str>,
    }
    let number = |word: &str| word.parse::<f64>().unwrap();
    // As row vectors take it: the transpose of what glam makes for columns.
    let turn = |token: &str, degrees: f64| {
        let radians = degrees.to_radians();
        match token {
            "rx" => DMat4::from_rotation_x(radians).transpose(),
            "ry" => DMat4::from_rotation_y(radians).transpose(),
            _ => DMat4::from_rotation_z(radians).transpose(),
        }
    };
    let mut bones: Vec<Bone<'_>> = Vec::new();
    for line in asf.lines() {
        let words: Vec<&str> = line.split_whitespace().collect();
        let known = |word: &str| bones.iter().any(|bone: &Bone<'_>| bone.name == word);
        match words[..] {
            ["name", name] => bones.push(Bone {
                name,
                reach: DVec3::ZERO,
                axis: DMat4::IDENTITY,
                dof: Vec::new(),
                parent: None,
            }),
            ["direction", x, y, z] => {
                bones.last_mut().unwrap().reach =
                    DVec3::new(number(x), number(y), number(z)).normalize();
            }
            ["length", length] if !bones.is_empty() => {
                bones.last_mut().unwrap().reach *= number(length);
            }
            ["axis", x, y, z, "XYZ"] => {
                let [x, y, z] = [("rx", x), ("ry", y), ("rz", z)].map(|(t, v)| turn(t, number(v)));
                bones.last_mut().unwrap().axis = row_product(&[x, y, z]);
            }
            ["dof", ..] => bones.last_mut().unwrap().dof = words[1..].to_vec(),
            [parent, child] if known(child) => {
                let bone = bones.iter_mut().find(|bone| bone.name == child).unwrap();
                bone.parent = (parent != "root").then_some(parent);
            }
            _ => {}
        }
    }
    let metres = 2.54 / 0.45 / 100.0;
    let frames: Vec<&str> = amc.split("\nroot ").skip(1).collect();
    let frames = frames.iter().map(|frame| {
        let mut lines = frame.lines();
        let root: Vec<f64> = lines
            .next()
            .unwrap()
            .split_whitespace()
            .map(number)
            .collect();
        let root_matrix = row_product(&[
            turn("rx", root[3]),
            turn("ry", root[4]),
            turn("rz", root[5]),
            DMat4::from_translation(DVec3::new(root[0], root[1], root[2])).transpose(),
        ]);
        let values = |name: &str| -> Vec<f64> {
            let line = frame
                .lines()
                .find(|line| line.split(' ').next() == Some(name));
            let words = line.into_iter().flat_map(|line| line.split(' ').skip(1));
            words.map(number).collect()
        };
        let ends = bones.iter().map(|bone| {
            let mut matrices = Vec::new();
            let mut at = Some(bone);
            while let Some(bone) = at {
                let mut moved = vec![DMat4::IDENTITY];
                let turns = bone.dof.iter().zip(values(bone.name));
                moved.extend(turns.map(|(token, degrees)| turn(token, degrees)));
                let parent = bones.iter().find(|other| Some(other.name) == bone.parent);
                let start = parent.map_or(DVec3::ZERO, |parent| parent.reach);
                matrices.push(bone.axis.inverse());
                matrices.push(row_product(&moved));
                matrices.push(bone.axis);
                matrices.push(DMat4::from_translation(start).transpose());
                at = parent;
            }
            matrices.push(root_matrix);
            let whole = row_product(&matrices);
            // Row vector times matrix is the transpose times the column.
            let end = whole.transpose() * DVec4::from((bone.reach, 1.0));
            (bone.name.to_owned(), end.truncate() * metres)
        });
        ends.collect()
    });
    frames.collect()
}

/// The product of matrices that row vectors meet from left to right.
fn row_product(matrices: &[DMat4]) -> DMat4 {
    matrices
        .iter()
        .fold(DMat4::IDENTITY, |all, next| all * *next)
}

#[test]
fn a_human_moves_as_by_matrices_on_row_vectors() {
    let (asf, amc) = human(12);
    let clip = parse(&asf, &amc, &ReadOptions::default()).unwrap();
    assert!(
        clip.conversion().notes[1].contains("5.644 cm"),
        "{:?}",
        clip.conversion()
    );
    let reference = reference_ends(&asf, &amc);
    assert_eq!(reference.len(), clip.frame_count());
    let mut worst = 0.0f32;
    for (frame, bones) in reference.iter().enumerate() {
        assert_eq!(bones.len() + 1, clip.skeleton().joint_count());
        for (name, end) in bones {
            worst = worst.max(ends(&clip, frame, name)[1].distance(end.as_vec3()));
        }
    }
    assert!(worst < 2e-6, "{worst} m");
    println!(
        "largest difference of a bone's end: {:.4} mm",
        worst * 1000.0
    );
}

#[test]
fn as_bvh_it_is_the_same_motion_and_names_are_cmus() {
    let (asf, amc) = human(20);
    let clip = parse(&asf, &amc, &ReadOptions::default()).unwrap();
    assert!(find_joints(clip.skeleton()).is_some());
    let text = bvh::format_clip(&clip, &BvhWriteOptions::default());
    let again = bvh::parse(text.as_bytes(), "again.bvh", &BvhOptions::default()).unwrap();
    let mut worst = 0.0f32;
    for frame in 0..clip.frame_count() {
        for joint in clip.skeleton().joints() {
            let [a, b] = ends(&clip, frame, &joint.name);
            let [c, d] = ends(&again, frame, &joint.name);
            worst = worst.max(a.distance(c)).max(b.distance(d));
        }
    }
    assert!(worst < 1e-5, "{worst} m");
}

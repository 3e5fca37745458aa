//! ASF/AMC: what the two files say together, checked by hand and against row-vector matrices.

#![allow(clippy::unwrap_used)]

use std::fs;

use glam::{DMat4, DVec3, DVec4, Vec3};
use physique_motion::bvh::{self, BvhOptions, BvhWriteOptions, LengthUnit};
use physique_motion::mapping::find_joints;
use physique_motion::{
    Error, FrameRate, Limits, ReadOptions, SkeletonClip, SourceMotion, UpAxis, acclaim,
    parse_motion, read_motion,
};

/// A root and a chain of two bones, whose numbers turn about axes of their own.
const ARM: &str = "# made by hand
:version 1.10
:name arm
:units
  mass 1.0
  length 2.54
  angle deg
:documentation
  Anything, begin end :not-a-keyword
:root
  order TX TY TZ RX RY RZ
  axis XYZ
  position 0 0 0
  orientation 0 0 0
:bonedata
  begin
    id 1
    name upper
    direction 1 0 0
    length 2
    axis 0 0 90 XYZ
    dof rx
    limits (-160.0 20.0)
  end
  begin
    id 2
    name lower
    direction 1 0 0
    length 1
    axis 0 0 0
    dof rz rx
    limits (-160.0 20.0)
           (-inf inf)
  end
:hierarchy
  begin
    root upper
    upper lower
  end
";

const WAVE: &str = "#!OML:ASF somewhere
:FULLY-SPECIFIED
:DEGREES
1
root 0 0 0 0 0 0
upper 0
lower 0 0
2
root 1 2 3 0 0 0
upper 90
lower 0 0
3
root 0 0 0 90 0 90
upper 0
lower 90 90
";

fn metres() -> ReadOptions {
    ReadOptions {
        unit: Some(LengthUnit::Metre),
        ..ReadOptions::default()
    }
}

fn parse(asf: &str, amc: &str, options: &ReadOptions) -> Result<SkeletonClip, Error> {
    acclaim::parse(
        asf.as_bytes(),
        "arm.asf",
        amc.as_bytes(),
        "wave.amc",
        options,
    )
}

/// World positions of a bone's start and of its tip.
fn ends(clip: &SkeletonClip, frame: usize, name: &str) -> [Vec3; 2] {
    let pose = clip.pose(frame);
    let joint = clip.skeleton().find(name).unwrap();
    let skeleton = clip.skeleton();
    let tip = match skeleton.children(joint).next() {
        Some(child) => pose.positions[child],
        None => {
            pose.positions[joint] + pose.rotations[joint] * skeleton.joints()[joint].end_sites[0]
        }
    };
    [pose.positions[joint], tip]
}

fn assert_near(found: Vec3, expected: [f32; 3]) {
    assert!(
        found.distance(expected.into()) < 1e-5,
        "{found} {expected:?}"
    );
}

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

/// A human of CMU's bones; every number from a wave, so that all axes and orders matter.
fn human(frames: usize) -> (String, String) {
    let bones = [
        // name, parent, direction, length, axis, dof
        (
            "lhipjoint",
            "root",
            [0.65, -0.71, 0.25],
            2.5,
            [0.0, 0.0, 0.0],
            "",
        ),
        (
            "lfemur",
            "lhipjoint",
            [0.34202, -0.939693, 0.0],
            7.6,
            [0.0, 0.0, 20.0],
            "rx ry rz",
        ),
        (
            "ltibia",
            "lfemur",
            [0.34202, -0.939693, 0.0],
            7.3,
            [0.0, 0.0, 20.0],
            "rx",
        ),
        (
            "lfoot",
            "ltibia",
            [0.09, -0.24, 0.966],
            2.2,
            [-90.0, 0.0, 20.0],
            "rx rz",
        ),
        (
            "ltoes",
            "lfoot",
            [0.0, 0.0, 1.0],
            1.1,
            [-90.0, 0.0, 20.0],
            "rx",
        ),
        (
            "rhipjoint",
            "root",
            [-0.65, -0.72, 0.25],
            2.5,
            [0.0, 0.0, 0.0],
            "",
        ),
        (
            "rfemur",
            "rhipjoint",
            [-0.34202, -0.939693, 0.0],
            7.6,
            [0.0, 0.0, -20.0],
            "rx ry rz",
        ),
        (
            "rtibia",
            "rfemur",
            [-0.34202, -0.939693, 0.0],
            7.2,
            [0.0, 0.0, -20.0],
            "rx",
        ),
        (
            "rfoot",
            "rtibia",
            [-0.1, -0.28, 0.95],
            2.2,
            [-90.0, 0.0, -20.0],
            "rx rz",
        ),
        (
            "rtoes",
            "rfoot",
            [0.0, 0.0, 1.0],
            1.1,
            [-90.0, 0.0, -20.0],
            "rx",
        ),
        (
            "lowerback",
            "root",
            [0.01, 0.998, -0.07],
            2.06,
            [0.0, 0.0, 0.0],
            "rx ry rz",
        ),
        (
            "upperback",
            "lowerback",
            [0.0, 1.0, -0.03],
            2.06,
            [0.0, 0.0, 0.0],
            "rx ry rz",
        ),
        (
            "thorax",
            "upperback",
            [0.0, 1.0, 0.0],
            2.07,
            [0.0, 0.0, 0.0],
            "rx ry rz",
        ),
        (
            "lowerneck",
            "thorax",
            [0.0, 0.995, 0.095],
            1.57,
            [0.0, 0.0, 0.0],
            "rx ry rz",
        ),
        (
            "upperneck",
            "lowerneck",
            [0.02, 0.998, -0.06],
            1.56,
            [0.0, 0.0, 0.0],
            "rx ry rz",
        ),
        (
            "head",
            "upperneck",
            [0.01, 0.999, -0.03],
            1.63,
            [0.0, 0.0, 0.0],
            "rx ry rz",
        ),
        (
            "lclavicle",
            "thorax",
            [0.968, 0.247, -0.047],
            3.66,
            [0.0, 0.0, 0.0],
            "ry rz",
        ),
        (
            "lhumerus",
            "lclavicle",
            [1.0, 0.0, 0.0],
            4.87,
            [180.0, -30.0, -90.0],
            "rx ry rz",
        ),
        (
            "lradius",
            "lhumerus",
            [1.0, 0.0, 0.0],
            3.36,
            [180.0, -30.0, -90.0],
            "rx",
        ),
        (
            "lwrist",
            "lradius",
            [1.0, 0.0, 0.0],
            1.68,
            [0.0, 90.0, 90.0],
            "ry",
        ),
        (
            "lhand",
            "lwrist",
            [1.0, 0.0, 0.0],
            0.66,
            [0.0, 90.0, 90.0],
            "rx rz",
        ),
        (
            "rclavicle",
            "thorax",
            [-0.973, 0.211, -0.09],
            3.6,
            [0.0, 0.0, 0.0],
            "ry rz",
        ),
        (
            "rhumerus",
            "rclavicle",
            [-1.0, 0.0, 0.0],
            5.03,
            [180.0, 30.0, 90.0],
            "rz ry rx",
        ),
        (
            "rradius",
            "rhumerus",
            [-1.0, 0.0, 0.0],
            3.36,
            [180.0, 30.0, 90.0],
            "rx",
        ),
        (
            "rwrist",
            "rradius",
            [-1.0, 0.0, 0.0],
            1.68,
            [0.0, -90.0, -90.0],
            "ry",
        ),
        (
            "rhand",
            "rwrist",
            [-1.0, 0.0, 0.0],
            0.73,
            [0.0, -90.0, -90.0],
            "rx rz",
        ),
    ];
    let mut asf = String::from(
        ":version 1.10\n:units\n mass 1\n length 0.45\n angle deg\n:root\n order TX TY TZ RX RY RZ\n \
         axis XYZ\n position 0 0 0\n orientation 0 0 0\n:bonedata\n",
    );
    let mut tree = String::new();
    for (name, parent, [x, y, z], length, [a, b, c], dof) in bones {
        asf += &format!("begin\n name {name}\n direction {x} {y} {z}\n length {length}\n");
        asf += &format!(" axis {a} {b} {c} XYZ\n");
        if !dof.is_empty() {
            asf += &format!(" dof {dof}\n");
        }
        asf += "end\n";
        tree += &format!("{parent} {name}\n");
    }
    asf += &format!(":hierarchy\nbegin\n{tree}end\n");

    let mut amc = String::from(":FULLY-SPECIFIED\n:DEGREES\n");
    let wave = |n: usize| 25.0 * (n as f64 * 1.7).sin();
    for frame in 0..frames {
        let [x, y, z] = [1.0, 17.0, 0.3 * frame as f64];
        amc += &format!("{}\nroot {x} {y} {z} 3 {} -4\n", frame + 1, wave(frame));
        for (bone, (name, .., dof)) in bones.iter().enumerate() {
            let numbers = dof.split_whitespace().enumerate();
            let numbers: String = numbers
                .map(|(at, _)| format!(" {:.6}", wave(frame + 7 * bone + 3 * at)))
                .collect();
            if !numbers.is_empty() {
                amc += &format!("{name}{numbers}\n");
            }
        }
    }
    (asf, amc)
}

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

#[test]
fn the_skeleton_is_found_beside_the_motion() {
    let folder = tempfile::tempdir().unwrap();
    let at = |name: &str| folder.path().join(name);
    fs::write(at("02_01.amc"), WAVE).unwrap();
    let error = read_motion(at("02_01.amc"), &metres())
        .unwrap_err()
        .to_string();
    assert!(
        error.contains("02_01.asf beside it") && error.contains("no .asf"),
        "{error}"
    );

    let joints = |options: &ReadOptions| match read_motion(at("02_01.amc"), options).unwrap() {
        SourceMotion::Skeleton(clip) => clip.skeleton().joints()[1].name.clone(),
        other => panic!("{other:?}"),
    };
    let named = |name: &str| ARM.replace("upper", name);
    let amc = |name: &str| fs::write(at("02_01.amc"), WAVE.replace("upper", name)).unwrap();
    // The only one there; the subject's; the motion's own; the one that is given.
    for (file, name) in [
        ("a.asf", "only"),
        ("02.ASF", "subject"),
        ("02_01.asf", "own"),
    ] {
        fs::write(at(file), named(name)).unwrap();
        amc(name);
        assert_eq!(joints(&metres()), name);
    }
    fs::write(at("given.txt"), named("given")).unwrap();
    amc("given");
    let given = ReadOptions {
        skeleton: Some(at("given.txt")),
        ..metres()
    };
    assert_eq!(joints(&given), "given");
    // A skeleton alone is no motion, and is told so.
    let error = read_motion(at("02.ASF"), &metres())
        .unwrap_err()
        .to_string();
    assert!(error.contains("give the .amc"), "{error}");
    // A motion without a header is known, too.
    let bare = b"\r\n1\r\nroot 0 0 0 0 0 0\r\nupper 0\r\nlower 0 0\r\n";
    fs::write(at("02_01.asf"), ARM.replace('\n', "\r\n")).unwrap();
    assert!(parse_motion(bare.to_vec(), at("02_01.amc"), &metres()).is_ok());
}

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

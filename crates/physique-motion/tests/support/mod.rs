//! Rigs for tests: one true motion of a figure, written as BVH in the ways of many exporters.

#![allow(dead_code, unreachable_pub)] // Every test file uses some of it.

use std::fmt::Write as _;

use glam::{EulerRot, Quat, Vec3};
use physique_body::Joint;
use physique_motion::{FrameRate, Motion, mapping::BodyRest};

/// A plain figure of 1.7 m in T-pose, feet pointing outwards a little.
pub fn figure() -> BodyRest {
    #[rustfmt::skip]
    let half = [
        (Joint::Pelvis, [0.0, 0.95, 0.0]), (Joint::LeftHip, [0.08, 0.86, 0.0]),
        (Joint::Spine1, [0.0, 1.06, -0.02]), (Joint::LeftKnee, [0.1, 0.48, 0.005]),
        (Joint::Spine2, [0.0, 1.18, 0.0]), (Joint::LeftAnkle, [0.09, 0.07, -0.03]),
        (Joint::Spine3, [0.0, 1.24, 0.01]), (Joint::LeftFoot, [0.11, 0.02, 0.09]),
        (Joint::Neck, [0.0, 1.44, -0.03]), (Joint::LeftCollar, [0.07, 1.36, -0.02]),
        (Joint::Head, [0.0, 1.53, 0.02]), (Joint::LeftShoulder, [0.18, 1.4, -0.03]),
        (Joint::LeftElbow, [0.44, 1.39, -0.05]), (Joint::LeftWrist, [0.69, 1.4, -0.055]),
    ];
    let mut joints = [Vec3::ZERO; Joint::COUNT];
    for (joint, position) in half {
        let position = Vec3::from_array(position);
        joints[joint.mirrored().index()] = position * Vec3::new(-1.0, 1.0, 1.0);
        joints[joint.index()] = position;
    }
    BodyRest {
        joints,
        ground: 0.0,
    }
}

/// World orientations and positions of a frame.
pub fn pose(motion: &Motion, body: &BodyRest, frame: usize) -> ([Quat; 22], [Vec3; 22]) {
    let local = motion.frame_rotations(frame);
    let mut world = [local[0]; 22];
    let mut positions = [body.joint(Joint::Pelvis) + motion.root_translation()[frame]; 22];
    for joint in Joint::ALL {
        if let Some(parent) = joint.parent() {
            let (joint_index, parent) = (joint.index(), parent.index());
            world[joint_index] = world[parent] * local[joint_index];
            positions[joint_index] = positions[parent] + world[parent] * body.offset(joint);
        }
    }
    (world, positions)
}

/// Largest angle in degrees between joints' world orientations over all frames, and the joint.
pub fn largest_turn(a: &Motion, b: &Motion, body: &BodyRest) -> (f32, Joint) {
    assert_eq!(a.frame_count(), b.frame_count());
    let frames = (0..a.frame_count()).flat_map(|frame| {
        let (ours, theirs) = (pose(a, body, frame).0, pose(b, body, frame).0);
        Joint::ALL.map(|joint| {
            let turn = ours[joint.index()].angle_between(theirs[joint.index()]);
            (turn.to_degrees(), joint)
        })
    });
    frames.fold((0.0, Joint::Pelvis), |most, next| {
        if next.0 > most.0 { next } else { most }
    })
}

/// Largest distance in metres between joints over all frames, and the joint.
pub fn largest_distance(a: &Motion, b: &Motion, body: &BodyRest) -> (f32, Joint) {
    assert_eq!(a.frame_count(), b.frame_count());
    let frames = (0..a.frame_count()).flat_map(|frame| {
        let (ours, theirs) = (pose(a, body, frame).1, pose(b, body, frame).1);
        Joint::ALL.map(|joint| (ours[joint.index()].distance(theirs[joint.index()]), joint))
    });
    frames.fold((0.0, Joint::Pelvis), |most, next| {
        if next.0 > most.0 { next } else { most }
    })
}

/// A person who walks towards +X, swings bent arms, turns the trunk, nods and raises the heels.
/// The lower sole of every frame stands at height 0.
pub fn walk(frames: usize) -> Motion {
    let body = figure();
    let mut translations = Vec::new();
    let mut rotations = Vec::new();
    for frame in 0..frames {
        let phase = frame as f32 * 0.21;
        let (swing, counter) = (phase.sin(), (phase + 0.4).sin());
        let x = Quat::from_rotation_x;
        let lean = 0.03;
        let mut local = [Quat::IDENTITY; 22];
        let mut set = |joint: Joint, rotation| local[joint.index()] = rotation;
        set(
            Joint::Pelvis,
            Quat::from_rotation_y(1.57 + 0.1 * swing) * x(lean),
        );
        set(
            Joint::Spine1,
            x(0.04) * Quat::from_rotation_y(-0.06 * swing),
        );
        set(Joint::Spine2, Quat::from_rotation_z(0.03 * counter));
        set(Joint::Spine3, Quat::from_rotation_y(-0.08 * swing));
        set(Joint::Neck, x(0.05 * counter));
        set(Joint::Head, Quat::from_rotation_y(0.2 * counter));
        for (hip, knee, ankle, sign) in [
            (Joint::LeftHip, Joint::LeftKnee, Joint::LeftAnkle, 1.0),
            (Joint::RightHip, Joint::RightKnee, Joint::RightAnkle, -1.0),
        ] {
            let (thigh, shin) = (-0.1 - 0.35 * sign * swing, 0.45 + 0.4 * sign * counter);
            set(hip, x(thigh));
            set(knee, x(shin));
            // The sole is level but for a heel raised behind.
            set(
                ankle,
                x(-lean - thigh - shin + 0.3 * (-sign * swing).max(0.0)),
            );
        }
        for (collar, shoulder, elbow, wrist, sign) in [
            (
                Joint::LeftCollar,
                Joint::LeftShoulder,
                Joint::LeftElbow,
                Joint::LeftWrist,
                1.0,
            ),
            (
                Joint::RightCollar,
                Joint::RightShoulder,
                Joint::RightElbow,
                Joint::RightWrist,
                -1.0,
            ),
        ] {
            set(collar, Quat::from_rotation_z(0.04 * counter));
            let down = Quat::from_rotation_z(-sign * 1.3);
            set(shoulder, x(0.4 * sign * swing) * down);
            set(elbow, Quat::from_rotation_y(-sign * (0.6 + 0.3 * counter)));
            set(wrist, Quat::from_rotation_z(0.1 * swing));
        }
        rotations.extend(local);
        translations.push(Vec3::new(0.03 * frame as f32, 0.0, 0.02 * swing));
    }
    let rate = FrameRate::new(30.0).unwrap();
    let flying = Motion::new(rate, None, translations.clone(), rotations.clone()).unwrap();
    for (frame, translation) in translations.iter_mut().enumerate() {
        let positions = pose(&flying, &body, frame).1;
        let soles = Joint::FEET.map(|joint| positions[joint.index()].y - body.height(joint));
        translation.y -= soles.into_iter().fold(f32::INFINITY, f32::min);
    }
    Motion::new(rate, None, translations, rotations).unwrap()
}

/// How an exporter writes the figure.
#[derive(Clone)]
pub struct Rig {
    pub body: BodyRest,
    /// By joint: the body's orientation when the joint's own is the identity. The zero pose of
    /// the file is the body in these orientations.
    pub joint_from_body: [Quat; 22],
    pub names: [String; 22],
    /// Rotation channels, outermost first, and how glam calls their order.
    pub order: (&'static str, EulerRot),
    /// Units a metre.
    pub units: f32,
    /// From our world to the file's.
    pub file_from_world: Quat,
    /// Joints left out, with all below them.
    pub without: Vec<Joint>,
}

impl Rig {
    /// SMPL's names, T-pose, centimetres.
    pub fn t_pose() -> Self {
        Self {
            body: figure(),
            joint_from_body: [Quat::IDENTITY; 22],
            names: Joint::ALL.map(|joint| joint.name().to_owned()),
            order: ("ZXY", EulerRot::ZXY),
            units: 100.0,
            file_from_world: Quat::IDENTITY,
            without: Vec::new(),
        }
    }

    /// Arms let down by so many degrees in the zero pose.
    pub fn arms_down(degrees: f32) -> Self {
        let mut rig = Self::t_pose();
        for (joints, sign) in [
            (
                [Joint::LeftShoulder, Joint::LeftElbow, Joint::LeftWrist],
                -1.0,
            ),
            (
                [Joint::RightShoulder, Joint::RightElbow, Joint::RightWrist],
                1.0,
            ),
        ] {
            for joint in joints {
                let down = Quat::from_rotation_z(sign * degrees.to_radians());
                rig.joint_from_body[joint.index()] = down;
            }
        }
        rig
    }

    /// Every bone along one local axis, hinges along another: the zero pose is no human pose.
    /// On the right side the bone runs against the axis if `mirrored`.
    pub fn bones_along(bone: Vec3, hinge: Vec3, mirrored: bool) -> Self {
        let mut rig = Self::t_pose();
        for joint in Joint::ALL {
            let name = joint.name();
            let is_right = name.starts_with("right");
            let outward = if is_right { Vec3::NEG_X } else { Vec3::X };
            let (along, across) = match joint {
                Joint::Pelvis | Joint::Spine1 | Joint::Spine2 | Joint::Spine3 => (Vec3::Y, Vec3::X),
                Joint::Neck | Joint::Head => (Vec3::Y, Vec3::X),
                Joint::LeftHip | Joint::RightHip | Joint::LeftKnee | Joint::RightKnee => {
                    (Vec3::NEG_Y, Vec3::X)
                }
                Joint::LeftAnkle | Joint::RightAnkle | Joint::LeftFoot | Joint::RightFoot => {
                    (Vec3::Z, Vec3::X)
                }
                _ => (outward, outward.cross(Vec3::Z)),
            };
            let sign = if mirrored && is_right { -1.0 } else { 1.0 };
            let from = glam::Mat3::from_cols(along, across, along.cross(across));
            let to = glam::Mat3::from_cols(bone * sign, hinge, (bone * sign).cross(hinge));
            rig.joint_from_body[joint.index()] = Quat::from_mat3(&(to * from.transpose()));
        }
        rig
    }

    /// Names that say nothing.
    pub fn nameless(mut self) -> Self {
        self.names = Joint::ALL.map(|joint| format!("bone_{:02}", (joint.index() * 7) % 22));
        self
    }

    /// The motion of the rig's body as BVH text.
    pub fn bvh(&self, motion: &Motion) -> String {
        let mut text = String::from("HIERARCHY\n");
        let mut order = Vec::new();
        self.joint(Joint::Pelvis, &mut text, &mut order);
        let seconds = motion.frame_rate().frame_seconds();
        let frames = motion.frame_count();
        write!(text, "MOTION\nFrames: {frames}\nFrame Time: {seconds:.7}\n").unwrap();
        for frame in 0..frames {
            let (world, positions) = pose(motion, &self.body, frame);
            let own = |joint: Joint| {
                let index = joint.index();
                self.file_from_world * world[index] * self.joint_from_body[index].inverse()
            };
            let root = self.file_from_world * positions[0] * self.units;
            let mut numbers = vec![root.x, root.y, root.z];
            for &joint in &order {
                let local = match joint.parent() {
                    None => own(joint),
                    Some(parent) => own(parent).inverse() * own(joint),
                };
                let (a, b, c) = local.to_euler(self.order.1);
                numbers.extend([a, b, c].map(f32::to_degrees));
            }
            let numbers: Vec<String> = numbers
                .iter()
                .map(|number| format!("{number:.6}"))
                .collect();
            text += &numbers.join(" ");
            text.push('\n');
        }
        text
    }

    fn joint(&self, joint: Joint, text: &mut String, order: &mut Vec<Joint>) {
        order.push(joint);
        let (keyword, offset, position) = match joint.parent() {
            None => ("ROOT", Vec3::ZERO, "Xposition Yposition Zposition "),
            Some(parent) => {
                let from_body = self.joint_from_body[parent.index()];
                (
                    "JOINT",
                    from_body * self.body.offset(joint) * self.units,
                    "",
                )
            }
        };
        let name = &self.names[joint.index()];
        let channels = if position.is_empty() { 3 } else { 6 };
        write!(
            text,
            "{keyword} {name}\n{{\nOFFSET {:.6} {:.6} {:.6}\nCHANNELS {channels} {position}",
            offset.x, offset.y, offset.z
        )
        .unwrap();
        for axis in self.order.0.chars() {
            write!(text, "{axis}rotation ").unwrap();
        }
        text.push('\n');
        let children = Joint::ALL
            .into_iter()
            .filter(|child| child.parent() == Some(joint));
        let children: Vec<Joint> = children
            .filter(|child| !self.without.contains(child))
            .collect();
        for &child in &children {
            self.joint(child, text, order);
        }
        if children.is_empty() {
            text.push_str("End Site\n{\nOFFSET 0 0 0\n}\n");
        }
        text.push_str("}\n");
    }
}

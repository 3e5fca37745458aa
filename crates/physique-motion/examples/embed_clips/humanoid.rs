//! DeepMimic's humanoid to the 22 joints of a body.
//!
//! Every bone of the body points where the humanoid's points, the twist included; the trunk's and
//! the neck's rotation is spread over the joints there; steps grow with the legs; the whole clip
//! is then set on the ground.

use std::error::Error;

use glam::{Quat, Vec3};
use physique_body::{Body, Joint, Pose};
use physique_motion::{Motion, SkeletonClip};

/// Where a joint's world rotation comes from: between two joints of the humanoid.
struct From {
    above: &'static str,
    below: &'static str,
    weight: f32,
}

const fn of(name: &'static str) -> From {
    From {
        above: name,
        below: name,
        weight: 0.0,
    }
}

const fn between(above: &'static str, below: &'static str, weight: f32) -> From {
    From {
        above,
        below,
        weight,
    }
}

fn source(joint: Joint) -> From {
    match joint {
        Joint::Pelvis => of("root"),
        Joint::Spine1 => between("root", "chest", 1.0 / 3.0),
        Joint::Spine2 => between("root", "chest", 2.0 / 3.0),
        Joint::Spine3 | Joint::LeftCollar | Joint::RightCollar => of("chest"),
        Joint::Neck => between("chest", "neck", 0.5),
        Joint::Head => of("neck"),
        Joint::LeftHip => of("left_hip"),
        Joint::RightHip => of("right_hip"),
        Joint::LeftKnee => of("left_knee"),
        Joint::RightKnee => of("right_knee"),
        Joint::LeftAnkle | Joint::LeftFoot => of("left_ankle"),
        Joint::RightAnkle | Joint::RightFoot => of("right_ankle"),
        Joint::LeftShoulder => of("left_shoulder"),
        Joint::RightShoulder => of("right_shoulder"),
        Joint::LeftElbow | Joint::LeftWrist => of("left_elbow"),
        Joint::RightElbow | Joint::RightWrist => of("right_elbow"),
    }
}

/// The bone whose direction counts for a joint; the humanoid's limbs hang straight down at rest.
fn hanging_bone(joint: Joint) -> Option<(Joint, Joint)> {
    match joint {
        Joint::LeftHip => Some((Joint::LeftHip, Joint::LeftKnee)),
        Joint::RightHip => Some((Joint::RightHip, Joint::RightKnee)),
        Joint::LeftKnee => Some((Joint::LeftKnee, Joint::LeftAnkle)),
        Joint::RightKnee => Some((Joint::RightKnee, Joint::RightAnkle)),
        Joint::LeftShoulder => Some((Joint::LeftShoulder, Joint::LeftElbow)),
        Joint::RightShoulder => Some((Joint::RightShoulder, Joint::RightElbow)),
        Joint::LeftElbow | Joint::LeftWrist => Some((Joint::LeftElbow, Joint::LeftWrist)),
        Joint::RightElbow | Joint::RightWrist => Some((Joint::RightElbow, Joint::RightWrist)),
        _ => None,
    }
}

/// The clip on a body.
pub(crate) fn motion(clip: &SkeletonClip, body: &Body) -> Result<Motion, Box<dyn Error>> {
    let find = |name: &str| clip.skeleton().find(name).ok_or(format!("no joint {name}"));
    let mut plan = Vec::new();
    for joint in Joint::ALL {
        let From {
            above,
            below,
            weight,
        } = source(joint);
        let hang = hanging_bone(joint).map_or(Quat::IDENTITY, |(from, to)| {
            let bone = body.rest_joint(to) - body.rest_joint(from);
            Quat::from_rotation_arc(bone.normalize(), Vec3::NEG_Y)
        });
        plan.push((find(above)?, find(below)?, weight, hang));
    }

    let leg = |hip: Vec3, knee: Vec3, ankle: Vec3| hip.distance(knee) + knee.distance(ankle);
    let rest = clip.skeleton().rest_pose().positions;
    let scale = leg(
        body.rest_joint(Joint::LeftHip),
        body.rest_joint(Joint::LeftKnee),
        body.rest_joint(Joint::LeftAnkle),
    ) / leg(
        rest[find("left_hip")?],
        rest[find("left_knee")?],
        rest[find("left_ankle")?],
    );
    let pelvis = body.rest_joint(Joint::Pelvis);
    let hips = (body.rest_joint(Joint::LeftHip) + body.rest_joint(Joint::RightHip)) / 2.0;

    let mut rotations = Vec::new();
    let mut root_translation = Vec::new();
    for frame in 0..clip.frame_count() {
        let pose = clip.pose(frame);
        let world: Vec<Quat> = plan
            .iter()
            .map(|&(above, below, weight, hang)| {
                pose.rotations[above].slerp(pose.rotations[below], weight) * hang
            })
            .collect();
        for joint in Joint::ALL {
            let rotation = world[joint.index()];
            rotations.push(match joint.parent() {
                None => rotation,
                Some(parent) => world[parent.index()].inverse() * rotation,
            });
        }
        // The humanoid's root lies between its hips, the body's pelvis above them.
        let hips_at = pose.positions[0] * scale;
        root_translation.push(hips_at - world[0] * (hips - pelvis) - pelvis);
    }

    // On the ground: one frame in twenty may touch it or sink in, the others are above.
    let mut lowest = lowest_points(body, &root_translation, &rotations)?;
    lowest.sort_by(f32::total_cmp);
    let ground = lowest[lowest.len() / 20];
    for translation in &mut root_translation {
        translation.y -= ground;
    }
    Ok(Motion::new(
        clip.frame_rate(),
        None,
        root_translation,
        rotations,
    )?)
}

/// Height of the lowest vertex of every frame.
fn lowest_points(
    body: &Body,
    root_translation: &[Vec3],
    rotations: &[Quat],
) -> Result<Vec<f32>, physique_body::Error> {
    let mut posed = body.posed();
    let frames = root_translation
        .iter()
        .zip(rotations.chunks_exact(Joint::COUNT));
    frames
        .map(|(&root_translation, rotations)| {
            let pose = Pose {
                root_translation,
                rotations,
            };
            body.pose(&pose, &mut posed)?;
            let heights = posed.vertices().iter().map(|vertex| vertex.y);
            Ok(heights.fold(f32::MAX, f32::min))
        })
        .collect()
}

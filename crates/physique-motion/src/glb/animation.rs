//! The motion as one animation: rotations of the joints, translation of the pelvis.

use glam::Quat;
use gltf_json::animation::{Channel, Interpolation, Property, Sampler, Target};
use gltf_json::validation::Checked::Valid;
use gltf_json::{Accessor, Animation, Index, Node};
use physique_body::Joint;

use super::SkinnedMesh;
use super::buffer::Buffer;
use crate::Motion;

/// Adds the animation; `Err` says what glTF cannot hold.
pub(super) fn add(
    buffer: &mut Buffer,
    mesh: &SkinnedMesh<'_>,
    motion: &Motion,
    joints: &[Index<Node>],
    name: &str,
) -> Result<(), String> {
    let step = motion.frame_rate().frame_seconds();
    let times: Vec<[f32; 1]> = (0..motion.frame_count())
        .map(|frame| [(frame as f64 * step) as f32])
        .collect();
    if !times.is_sorted_by(|a, b| a < b) {
        let rate = motion.frame_rate().per_second();
        return Err(format!(
            "frames at {rate} a second fall together in its 32-bit times"
        ));
    }
    let input = buffer.bounded_floats(&times, None);

    let mut tracks = Tracks::default();
    let pelvis = Joint::Pelvis.index();
    let translations: Vec<[f32; 3]> = motion
        .root_translation()
        .iter()
        .map(|&translation| (mesh.rest_joints[pelvis] + translation).to_array())
        .collect();
    let output = buffer.floats(&translations, None);
    tracks.add(input, output, joints[pelvis], Property::Translation);
    for joint in Joint::ALL {
        let output = buffer.floats(&rotations(motion, joint), None);
        tracks.add(input, output, joints[joint.index()], Property::Rotation);
    }
    buffer.root.push(Animation {
        channels: tracks.channels,
        samplers: tracks.samplers,
        name: Some(name.into()),
        extensions: None,
        extras: Default::default(),
    });
    Ok(())
}

/// A joint's quaternions, each with the sign nearer to the one before: players that interpolate
/// without looking then take the short way.
fn rotations(motion: &Motion, joint: Joint) -> Vec<[f32; 4]> {
    let mut before = Quat::IDENTITY;
    (0..motion.frame_count())
        .map(|frame| {
            let rotation = motion.frame_rotations(frame)[joint.index()].normalize();
            before = if before.dot(rotation) < 0.0 {
                -rotation
            } else {
                rotation
            };
            before.to_array()
        })
        .collect()
}

#[derive(Default)]
struct Tracks {
    channels: Vec<Channel>,
    samplers: Vec<Sampler>,
}

impl Tracks {
    fn add(
        &mut self,
        input: Index<Accessor>,
        output: Index<Accessor>,
        node: Index<Node>,
        property: Property,
    ) {
        let sampler = Index::push(
            &mut self.samplers,
            Sampler {
                input,
                interpolation: Valid(Interpolation::Linear),
                output,
                extensions: None,
                extras: Default::default(),
            },
        );
        self.channels.push(Channel {
            sampler,
            target: Target {
                node,
                path: Valid(property),
                extensions: None,
                extras: Default::default(),
            },
            extensions: None,
            extras: Default::default(),
        });
    }
}

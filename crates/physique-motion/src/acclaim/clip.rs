//! From a figure and its motion to a clip in metres with Y up.

use glam::{DVec3, Quat};

use super::figure::{Bone, Figure};
use super::motion::Motion;
use crate::unspoken::{self, LengthUnit};
use crate::{Conversion, Error, FrameRate, ReadOptions, Skeleton, SkeletonClip, SkeletonJoint};

/// CMU's recordings; no other rate is as common, and the format has no place for it.
const USUAL_RATE: f64 = 120.0;

/// Decides unit, frame rate and up axis, then builds the clip.
pub(super) fn clip(
    figure: &Figure,
    motion: Motion,
    options: &ReadOptions,
) -> Result<SkeletonClip, Error> {
    let mut notes = Vec::new();
    let frame_rate = match (options.frame_rate, motion.rate) {
        (Some(given), _) => given,
        (None, Some(stated)) => FrameRate::new(stated)?,
        (None, None) => {
            notes.push("frame rate: 120 a second, CMU's, since the file says none".into());
            FrameRate::new(USUAL_RATE)?
        }
    };
    let unit = unit(figure, options.unit, &mut notes);
    let metres = unit.metres();
    if figure.bones[0].axes != glam::DQuat::IDENTITY || figure.bones[0].reach != DVec3::ZERO {
        notes.push("the root's preset position and orientation go before its motion".into());
    }

    let starts: Vec<DVec3> = figure
        .bones
        .iter()
        .map(|bone| start(figure, bone))
        .collect();
    let joints = figure.bones.iter().zip(&starts).zip(figure.ends_chain());
    let joints = joints.map(|((bone, start), ends_chain)| SkeletonJoint {
        name: bone.name.clone(),
        parent: bone.parent,
        rest_translation: (*start * metres).as_vec3(),
        rest_rotation: match bone.parent {
            None => bone.axes.as_quat().normalize(),
            Some(_) => Quat::IDENTITY,
        },
        end_sites: match bone.parent {
            Some(_) if ends_chain => vec![(bone.reach * metres).as_vec3()],
            _ => Vec::new(),
        },
    });
    let skeleton = Skeleton::new(joints.collect())?;
    let translations = motion.shifts.iter().zip(motion.moved.iter().cycle());
    let translations =
        translations.map(|(&shift, &bone)| ((starts[bone] + shift) * metres).as_vec3());
    let clip = SkeletonClip::new(
        skeleton,
        frame_rate,
        Conversion::default(),
        motion.rotations,
        motion.moved.clone(),
        translations.collect(),
    )?;
    let up_axis = options.up_axis.unwrap_or_else(|| {
        let (up_axis, note) = unspoken::up_axis(&clip);
        notes.extend(note);
        up_axis
    });
    clip.turned_upright(Conversion {
        metres_per_unit: metres,
        up_axis,
        notes,
    })
}

/// Where a bone starts in its parent's frame at rest: at the parent's end, or at the root.
fn start(figure: &Figure, bone: &Bone) -> DVec3 {
    match bone.parent {
        None => bone.reach,
        Some(parent) if figure.bones[parent].parent.is_none() => DVec3::ZERO,
        Some(parent) => figure.bones[parent].reach,
    }
}

fn unit(figure: &Figure, given: Option<LengthUnit>, notes: &mut Vec<String>) -> LengthUnit {
    if let Some(given) = given {
        return given;
    }
    let stated = LengthUnit::Metres(LengthUnit::Inch.metres() / figure.length_factor);
    let bones = figure.bones.iter().zip(figure.ends_chain());
    let bones = bones.map(|(bone, ends_chain)| unspoken::Bone {
        parent: bone.parent,
        length: start(figure, bone).length() as f32,
        tips: usize::from(ends_chain),
        longest_tip: if ends_chain {
            bone.reach.length() as f32
        } else {
            0.0
        },
    });
    let size = unspoken::tip_to_tip(&bones.collect::<Vec<_>>());
    if stated.is_human(size) {
        notes.push(format!(
            "unit: inches over {}, so {:.3} cm, as Acclaim's files mean it",
            figure.length_factor,
            stated.metres() * 100.0
        ));
        return stated;
    }
    let (unit, note) = unspoken::unit(size);
    notes.push(note);
    unit
}

//! A translation and 22 rotations of six numbers: 135, and HY-Motion's 201 with positions behind.
//!
//! HY-Motion 1.0, arXiv 2512.23464: 3 of translation, 6 of orientation, 21 x 6 of the joints,
//! 22 x 3 of their positions; its six numbers are the first two columns of a matrix, row by row.

use glam::{DQuat, DVec3};
use physique_body::Joint;

use super::{Body, no_rotation, rotation};
use crate::Error;
use crate::ShapeSpace;
use crate::features::FeatureSkeleton;
use crate::fields::Fields;
use crate::smpl_motion::{Path, mean_pelvis};

/// How six numbers make a matrix.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Order {
    /// Two columns, row by row: a b / c d / e f.
    ColumnsInterleaved,
    /// One column after the other.
    Columns,
    /// One row after the other.
    Rows,
}

impl Order {
    const ALL: [Self; 3] = [Self::ColumnsInterleaved, Self::Columns, Self::Rows];

    fn rotation(self, n: &[f64; 6]) -> Option<DQuat> {
        let (first, second) = match self {
            Self::ColumnsInterleaved => ([n[0], n[2], n[4]], [n[1], n[3], n[5]]),
            Self::Columns | Self::Rows => ([n[0], n[1], n[2]], [n[3], n[4], n[5]]),
        };
        let (first, second) = (DVec3::from_array(first), DVec3::from_array(second));
        rotation(first, second, self == Self::Rows)
    }

    const fn words(self) -> &'static str {
        match self {
            Self::ColumnsInterleaved => "two columns of a matrix, row by row",
            Self::Columns => "one column of a matrix after the other",
            Self::Rows => "one row of a matrix after the other",
        }
    }
}

/// Numbers of all rotations.
const ROTATIONS: usize = 6 * Joint::COUNT;

pub(super) fn read(fields: &Fields<'_>, rows: &[&[f64]]) -> Result<Body, Error> {
    let mut best: Option<(f64, Order, usize, Vec<DQuat>)> = None;
    let mut trouble = None;
    for order in Order::ALL {
        // Translation first, or rotations first.
        for (start, trans) in [(3, 0), (0, ROTATIONS)] {
            match rotations(rows, start, order) {
                Ok(rotations) => {
                    let bend = knee_bend(&rotations);
                    if best.as_ref().is_none_or(|(most, ..)| bend > *most) {
                        best = Some((bend, order, trans, rotations));
                    }
                }
                Err(place) => trouble = trouble.or(Some(place)),
            }
        }
    }
    let Some((_, order, trans, rotations)) = best else {
        let (frame, joint) = trouble.unwrap_or_default();
        return Err(no_rotation(fields, frame, joint));
    };
    let places: Vec<DVec3> = rows
        .iter()
        .map(|row| DVec3::new(row[trans], row[trans + 1], row[trans + 2]))
        .collect();
    let mut notes = vec![format!(
        "The translation lies {} the rotations, whose six numbers were read as {}.",
        if trans == 0 { "before" } else { "behind" },
        order.words()
    )];
    let path = path(places, &rotations, &mut notes);
    Ok(Body {
        rotations,
        path,
        betas: Vec::new(),
        notes,
    })
}

/// All rotations in this order, or frame and joint of the first that is none.
fn rotations(rows: &[&[f64]], start: usize, order: Order) -> Result<Vec<DQuat>, (usize, usize)> {
    let frames = rows.iter().enumerate().flat_map(|(frame, row)| {
        let numbers = row[start..start + ROTATIONS].as_chunks::<6>().0;
        let joints = numbers.iter().enumerate();
        joints.map(move |(joint, numbers)| order.rotation(numbers).ok_or((frame, joint)))
    });
    frames.collect()
}

/// Mean bend of the knees in radians, positive for shins that go back.
fn knee_bend(rotations: &[DQuat]) -> f64 {
    let frames = rotations.chunks_exact(Joint::COUNT);
    let count = 2.0 * frames.len().max(1) as f64;
    let bends = frames.flat_map(|frame| {
        [Joint::LeftKnee, Joint::RightKnee].map(|knee| frame[knee.index()].to_scaled_axis().x)
    });
    bends.sum::<f64>() / count
}

/// Whether the translation is the pelvis or SMPL's `trans`: the feet tell, which stand on the
/// ground in one of the two.
fn path(places: Vec<DVec3>, rotations: &[DQuat], notes: &mut Vec<String>) -> Path {
    /// Height of the joint of a foot that stands.
    const FOOT: f64 = 0.04;
    let frames = rotations.chunks_exact(Joint::COUNT).zip(&places);
    let lowest = frames
        .map(|(frame, at)| at.y + lowest_joint(frame))
        .fold(f64::INFINITY, f64::min);
    let below = f64::from(mean_pelvis(ShapeSpace::Smpl).y);
    if (lowest - FOOT).abs() < (lowest + below - FOOT).abs() {
        notes.push(
            "The translation was taken for the pelvis's place: feet stand on the ground then."
                .into(),
        );
        Path::Pelvis(places)
    } else {
        notes.push(
            "The translation was taken for SMPL's `trans`: feet stand on the ground then.".into(),
        );
        Path::Translation(places)
    }
}

/// Height of the lowest joint over the pelvis, for HumanML3D's mean person.
fn lowest_joint(local: &[DQuat]) -> f64 {
    let skeleton = FeatureSkeleton::HumanMl3d;
    let directions = skeleton.smpl_rest_directions();
    let offsets = skeleton.offsets();
    let mut world = [DQuat::IDENTITY; Joint::COUNT];
    let mut positions = [DVec3::ZERO; Joint::COUNT];
    for joint in Joint::ALL {
        let index = joint.index();
        world[index] = local[index];
        if let Some(parent) = joint.parent().map(Joint::index) {
            let bone = (directions[index] * offsets[index].length()).as_dvec3();
            positions[index] = positions[parent] + world[parent] * bone;
            world[index] = world[parent] * local[index];
        }
    }
    positions
        .iter()
        .map(|position| position.y)
        .fold(f64::INFINITY, f64::min)
}

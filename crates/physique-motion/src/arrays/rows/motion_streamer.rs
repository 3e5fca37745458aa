//! MotionStreamer's 272 numbers.
//!
//! Xiao et al., "MotionStreamer: Streaming Motion Generation via Diffusion-based Autoregressive
//! Model in Causal Latent Space", ICCV 2025.

use glam::{DQuat, DVec3};
use physique_body::Joint;

use super::{Body, no_rotation, rotation};
use crate::Error;
use crate::fields::Fields;
use crate::smpl_motion::{Path, vectors_of};

/// Where joints' positions and rotations start.
const POSITIONS: usize = 8;
const ROTATIONS: usize = POSITIONS + 6 * Joint::COUNT;

pub(super) fn read(fields: &Fields<'_>, rows: &[&[f64]]) -> Result<Body, Error> {
    let mut rotations = Vec::with_capacity(rows.len() * Joint::COUNT);
    let mut places = Vec::with_capacity(rows.len());
    // Takes the heading off: the product of all turns so far, the newest on the left.
    let mut upright_from_world = DQuat::IDENTITY;
    let mut place = DVec3::ZERO;
    for (frame, row) in rows.iter().enumerate() {
        let step = DVec3::new(row[0], 0.0, row[1]);
        // A step is told in the heading before it; the first in the world.
        place += upright_from_world.inverse() * step;
        let turn =
            by_rows(&row[2..POSITIONS]).ok_or_else(|| no_rotation(fields, frame, Joint::COUNT))?;
        upright_from_world = (turn * upright_from_world).normalize();
        places.push(DVec3::new(place.x, row[POSITIONS + 1], place.z));
        for (joint, numbers) in row[ROTATIONS..].chunks_exact(6).enumerate() {
            let local = by_rows(numbers).ok_or_else(|| no_rotation(fields, frame, joint))?;
            rotations.push(if joint == 0 {
                upright_from_world.inverse() * local
            } else {
                local
            });
        }
    }
    Ok(Body {
        rotations,
        path: Path::Pelvis(places),
        betas: Vec::new(),
        notes: Vec::new(),
    })
}

/// The first two rows of a matrix.
fn by_rows(numbers: &[f64]) -> Option<DQuat> {
    let mut rows = vectors_of(numbers);
    rotation(rows.next()?, rows.next()?, true)
}

//! Writing AMASS.

use std::path::Path;

use glam::Vec3;
use physique_body::Joint;

use super::{SMPL_REST_PELVIS, SMPLX_REST_PELVIS};
use crate::npz::{ArchiveWriter, ArrayError};
use crate::smpl_motion::{SMPLH_JOINTS, SMPLX_JOINTS};
use crate::world::World;
use crate::write_file::write_file;
use crate::{Error, Motion, ShapeSpace};

/// Shape coefficients that AMASS stores.
const BETAS: usize = 16;

/// An AMASS file in memory.
#[derive(Clone, Debug)]
pub struct AmassFile {
    /// The bytes of the `.npz`.
    pub bytes: Vec<u8>,
    /// What the format could not carry: full sentences.
    pub notes: Vec<String>,
}

/// Writes a motion as AMASS `.npz`, beside it first, then renamed; see [`to_npz`].
///
/// Returns what the format could not carry: full sentences.
///
/// # Errors
/// [`Error::Io`], and [`Error::Array`] for a motion that outgrows the ZIP format.
pub fn write(
    path: impl AsRef<Path>,
    motion: &Motion,
    rest_pelvis: Option<Vec3>,
) -> Result<Vec<String>, Error> {
    let path = path.as_ref();
    let file = to_npz(motion, rest_pelvis).map_err(|problem| Error::Array {
        path: path.into(),
        problem,
    })?;
    write_file(path, &file.bytes)?;
    Ok(file.notes)
}

/// The motion as an AMASS `.npz`, Z up, with 64-bit numbers and flat hands.
///
/// The form is SMPL-H (`poses` `[frames][156]`), or SMPL-X (`[frames][165]`) for a motion with
/// SMPL-X's betas. `rest_pelvis` is that of the body the file will drive; without it a mean body's
/// is taken, as the reader does, so that a round trip is exact to rounding (below 1e-6 m and
/// 1e-6 rad). Betas of our open body mean nothing to SMPL: they are left out with a note.
///
/// # Errors
/// [`ArrayError::Write`] for a motion that outgrows the ZIP format.
pub fn to_npz(motion: &Motion, rest_pelvis: Option<Vec3>) -> Result<AmassFile, ArrayError> {
    let world = World::ZUp;
    let shape = motion.shape();
    let is_smplx = shape.is_some_and(|shape| shape.space == ShapeSpace::SmplX);
    let (joints, mean_pelvis) = if is_smplx {
        (SMPLX_JOINTS, SMPLX_REST_PELVIS)
    } else {
        (SMPLH_JOINTS, SMPL_REST_PELVIS)
    };
    let pelvis = rest_pelvis.unwrap_or(mean_pelvis).as_dvec3();
    let frames = motion.frame_count();

    let file_from_ours = world.ours_from_file().inverse();
    let mut poses = Vec::with_capacity(frames * joints * 3);
    for frame in 0..frames {
        for (joint, rotation) in motion.frame_rotations(frame).iter().enumerate() {
            let local = rotation.as_dquat().normalize();
            let is_root = joint == Joint::Pelvis.index();
            let turned = if is_root {
                file_from_ours * local
            } else {
                local
            };
            // The shorter of the two ways round, below half a turn.
            let short = if turned.w < 0.0 { -turned } else { turned };
            poses.extend(short.to_scaled_axis().to_array());
        }
        poses.resize((frame + 1) * joints * 3, 0.0);
    }
    let trans: Vec<f64> = motion
        .root_translation()
        .iter()
        .flat_map(|ours| (world.to_file(ours.as_dvec3() + pelvis) - pelvis).to_array())
        .collect();

    let mut notes = Vec::new();
    let mut betas = vec![0.0; BETAS];
    let mut gender = "neutral";
    if let Some(shape) = shape {
        gender = shape.gender.as_deref().unwrap_or(gender);
        if shape.space == ShapeSpace::Open {
            notes.push("Betas of the open body were left out: they mean nothing to SMPL.".into());
        } else if !shape.betas.is_empty() {
            betas = shape.betas.iter().map(|&beta| f64::from(beta)).collect();
        }
    }

    let rate = motion.frame_rate().per_second();
    let rate_key = if is_smplx {
        "mocap_frame_rate"
    } else {
        "mocap_framerate"
    };
    let mut archive = ArchiveWriter::new();
    archive.f64("trans", &[frames, 3], &trans)?;
    archive.text("gender", gender)?;
    archive.f64(rate_key, &[], &[rate])?;
    archive.f64("betas", &[betas.len()], &betas)?;
    archive.f64("poses", &[frames, joints * 3], &poses)?;
    if is_smplx {
        archive.text("surface_model_type", "smplx")?;
    }
    Ok(AmassFile {
        bytes: archive.finish()?,
        notes,
    })
}

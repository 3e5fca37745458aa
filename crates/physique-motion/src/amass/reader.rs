//! Reading AMASS: any of its forms to a [`Recording`].

use std::path::Path as FilePath;

use glam::DQuat;
use physique_body::Joint;

use crate::fields::Fields;
use crate::npz::Archive;
use crate::read::open_archive;
use crate::read_file::read_file;
use crate::smpl_motion::{
    Path, Rotations, SMPL_JOINTS, SMPLH_JOINTS, SMPLX_JOINTS, SmplMotion, left_out, read_shape,
    space_of, vectors_of,
};
use crate::world::World;
use crate::{Error, FrameRate, ReadOptions, Recording, ShapeSpace, UpAxis};

/// Reads an AMASS file.
///
/// # Errors
/// [`Error::Io`], and those of [`from_archive`].
pub fn read(path: impl AsRef<FilePath>, options: &ReadOptions) -> Result<Recording, Error> {
    let path = path.as_ref();
    let mut archive = open_archive(read_file(path, options.limits.bytes)?, path, options)?;
    from_archive(&mut archive, path, options)
}

/// Reads an opened AMASS archive; `path` only names it in errors.
///
/// # Errors
/// [`Error::Array`] for broken arrays, [`Error::Format`] for missing or disagreeing ones and for
/// numbers that are not finite, [`Error::Limit`] for too many frames.
pub fn from_archive(
    archive: &mut Archive,
    path: impl AsRef<FilePath>,
    options: &ReadOptions,
) -> Result<Recording, Error> {
    from_fields(&mut Fields::of_archive(archive, path.as_ref(), options))
}

/// Whether a dictionary has the rotations of an AMASS file.
pub(crate) fn holds(fields: &Fields<'_>) -> bool {
    fields.contains("poses") || fields.contains("pose_body")
}

/// Reads a dictionary of AMASS's arrays.
pub(crate) fn from_fields(fields: &mut Fields<'_>) -> Result<Recording, Error> {
    let mut notes = Vec::new();
    let frame_rate = frame_rate(fields)?;
    let poses = poses(fields, &mut notes)?;
    let frames = poses.frames();
    let trans = fields.matrix("trans", &[3])?;
    if trans.rows() != frames {
        let expected = format!("{frames} frames as in the poses");
        let found = format!("{} frames", trans.rows());
        return Err(fields.format("trans", &expected, &found));
    }
    let (model, note) = fields.optional_text("surface_model_type")?;
    notes.extend(note);
    let space = match model {
        Some(model) if model.to_lowercase().contains("smplx") => ShapeSpace::SmplX,
        Some(_) => ShapeSpace::Smpl,
        // The form in several arrays is SMPL-X's.
        None if fields.contains("root_orient") => ShapeSpace::SmplX,
        None => space_of(poses.joints),
    };
    let shape = read_shape(fields, space, &mut notes)?;
    if fields.contains("dmpls") {
        notes.push("Soft-tissue coefficients (`dmpls`) were left out.".into());
    }
    let motion = SmplMotion {
        frame_rate,
        world: World::from(fields.options.up_axis.unwrap_or(UpAxis::Z)),
        shape,
        rotations: poses.first(Joint::COUNT),
        path: Path::Translation(vectors_of(&trans.values).collect()),
        notes,
    };
    motion.into_recording(fields)
}

fn frame_rate(fields: &mut Fields<'_>) -> Result<FrameRate, Error> {
    if let Some(given) = fields.options.frame_rate {
        return Ok(given);
    }
    for key in ["mocap_framerate", "mocap_frame_rate"] {
        if fields.contains(key) {
            let value = fields.number(key)?;
            return FrameRate::new(value).map_err(|_| {
                fields.format(key, "a positive number below 1,000,000", &value.to_string())
            });
        }
    }
    Err(fields.format_at(
        "the frame rate",
        "`mocap_framerate` or `mocap_frame_rate`, or a frame rate given as an option",
        "neither",
    ))
}

fn poses(fields: &mut Fields<'_>, notes: &mut Vec<String>) -> Result<Rotations, Error> {
    if fields.contains_all(&["root_orient", "pose_body"]) {
        let root = Rotations::read(fields, "root_orient", &[1])?;
        let body = Rotations::read(fields, "pose_body", &[Joint::COUNT - 1])?;
        if root.frames() != body.frames() {
            let expected = format!("{} frames as in `root_orient`", root.frames());
            let found = format!("{} frames", body.frames());
            return Err(fields.format("pose_body", &expected, &found));
        }
        if fields.contains("pose_hand") {
            notes.push(left_out("hands, jaw and eyes"));
        }
        let body = body.values.chunks_exact(Joint::COUNT - 1);
        let frames = root.values.iter().zip(body);
        let values: Vec<DQuat> = frames
            .flat_map(|(root, body)| std::iter::once(root).chain(body).copied())
            .collect();
        let joints = Joint::COUNT;
        return Ok(Rotations { values, joints });
    }
    let known = [Joint::COUNT, SMPL_JOINTS, SMPLH_JOINTS, SMPLX_JOINTS];
    let poses = Rotations::read(fields, "poses", &known)?;
    match poses.joints {
        SMPLX_JOINTS => notes.push(left_out("hands, jaw and eyes")),
        SMPLH_JOINTS | SMPL_JOINTS => notes.push(left_out("hands")),
        _ => {}
    }
    Ok(poses)
}

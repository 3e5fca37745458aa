//! Reading AMASS: any of its forms to a [`Recording`].

use std::path::Path;

use glam::{DQuat, DVec3, Quat, Vec3};
use physique_body::Joint;

use super::{SMPL_REST_PELVIS, SMPLH_JOINTS, SMPLX_JOINTS, SMPLX_REST_PELVIS, turn};
use crate::npz::{Archive, Array, ArrayError};
use crate::read::{open_archive, stem};
use crate::read_file::read_file;
use crate::{Error, FrameRate, Motion, MotionShape, ReadOptions, Recording, ShapeSpace, UpAxis};

/// Joints of SMPL: the body's 22 and one of each hand.
const SMPL_JOINTS: usize = 24;

/// Reads an AMASS file.
///
/// # Errors
/// [`Error::Io`], and those of [`from_archive`].
pub fn read(path: impl AsRef<Path>, options: &ReadOptions) -> Result<Recording, Error> {
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
    path: impl AsRef<Path>,
    options: &ReadOptions,
) -> Result<Recording, Error> {
    let path = path.as_ref();
    Reader {
        path,
        archive,
        options,
        notes: Vec::new(),
    }
    .read()
}

/// The 22 joints of every frame as axis-angle vectors, and how many joints the file has.
struct Poses {
    /// `[frames][22]`.
    axis_angles: Vec<DVec3>,
    joints: usize,
}

struct Reader<'a> {
    path: &'a Path,
    archive: &'a mut Archive,
    options: &'a ReadOptions,
    notes: Vec<String>,
}

impl Reader<'_> {
    fn read(mut self) -> Result<Recording, Error> {
        let frame_rate = self.frame_rate()?;
        let poses = self.poses()?;
        let translations = self.translations(poses.axis_angles.len() / Joint::COUNT)?;
        let space = self.space(poses.joints)?;
        let shape = self.shape(space)?;
        let rest_pelvis = self.rest_pelvis(space);

        let up = self.options.up_axis.unwrap_or(UpAxis::Z);
        let pelvis = rest_pelvis.as_dvec3();
        let root_translation = translations
            .into_iter()
            .map(|trans| (turn::to_ours(up, trans + pelvis) - pelvis).as_vec3())
            .collect();
        let rotations = poses
            .axis_angles
            .into_iter()
            .enumerate()
            .map(|(index, axis_angle)| {
                let local = DQuat::from_scaled_axis(axis_angle);
                let is_root = index % Joint::COUNT == Joint::Pelvis.index();
                let turned = if is_root {
                    turn::ours_from_file(up) * local
                } else {
                    local
                };
                turned.as_quat()
            })
            .collect::<Vec<Quat>>();
        if self.archive.contains("dmpls") {
            self.notes
                .push("Soft-tissue coefficients (`dmpls`) were left out.".into());
        }
        let motion = Motion::new(frame_rate, Some(shape), root_translation, rotations)
            .map_err(|error| self.format("the rotations", "finite numbers", &error.to_string()))?;
        Ok(Recording {
            motion,
            name: stem(self.path),
            rest_pelvis,
            source: None,
            licence: None,
            notes: self.notes,
        })
    }

    fn frame_rate(&mut self) -> Result<FrameRate, Error> {
        if let Some(given) = self.options.frame_rate {
            return Ok(given);
        }
        for key in ["mocap_framerate", "mocap_frame_rate"] {
            if self.archive.contains(key) {
                let value = self.array(key)?.number();
                let value = value.map_err(|error| self.broken(error))?;
                return FrameRate::new(value).map_err(|_| {
                    let place = format!("`{key}`");
                    self.format(&place, "a positive number", &value.to_string())
                });
            }
        }
        Err(self.format(
            "the frame rate",
            "`mocap_framerate` or `mocap_frame_rate`, or a frame rate given as an option",
            "neither",
        ))
    }

    fn poses(&mut self) -> Result<Poses, Error> {
        if self.archive.contains("root_orient") && self.archive.contains("pose_body") {
            let root = self.matrix("root_orient", &[3])?;
            let body = self.matrix("pose_body", &[63])?;
            if root.rows() != body.rows() {
                let expected = format!("{} frames as in `root_orient`", root.rows());
                let found = format!("{} frames", body.rows());
                return Err(self.format("`pose_body`", &expected, &found));
            }
            let frames = root
                .values
                .chunks_exact(3)
                .zip(body.values.chunks_exact(63));
            let axis_angles = frames.flat_map(|(root, body)| vectors(root).chain(vectors(body)));
            if self.archive.contains("pose_hand") {
                self.note_left_out("hands, jaw and eyes");
            }
            let axis_angles = axis_angles.collect();
            return Ok(Poses {
                axis_angles,
                joints: SMPLX_JOINTS,
            });
        }
        let joint_counts = [Joint::COUNT, SMPL_JOINTS, SMPLH_JOINTS, SMPLX_JOINTS];
        let poses = self.matrix("poses", &joint_counts.map(|joints| joints * 3))?;
        match poses.columns / 3 {
            SMPLX_JOINTS => self.note_left_out("hands, jaw and eyes"),
            SMPLH_JOINTS | SMPL_JOINTS => self.note_left_out("hands"),
            _ => {}
        }
        let rows = poses.values.chunks_exact(poses.columns);
        Ok(Poses {
            axis_angles: rows
                .flat_map(|row| vectors(row).take(Joint::COUNT))
                .collect(),
            joints: poses.columns / 3,
        })
    }

    fn note_left_out(&mut self, what: &str) {
        self.notes.push(format!(
            "Rotations of {what} were left out: the body has {} joints.",
            Joint::COUNT
        ));
    }

    fn translations(&mut self, frames: usize) -> Result<Vec<DVec3>, Error> {
        let trans = self.matrix("trans", &[3])?;
        if trans.rows() != frames {
            let expected = format!("{frames} frames as in the poses");
            let found = format!("{} frames", trans.rows());
            return Err(self.format("`trans`", &expected, &found));
        }
        Ok(vectors(&trans.values).collect())
    }

    fn space(&mut self, joints: usize) -> Result<ShapeSpace, Error> {
        let named = match self.optional_text("surface_model_type")? {
            Some(model) => model.to_lowercase().contains("smplx"),
            None => joints == SMPLX_JOINTS,
        };
        Ok(if named {
            ShapeSpace::SmplX
        } else {
            ShapeSpace::Smpl
        })
    }

    fn shape(&mut self, space: ShapeSpace) -> Result<MotionShape, Error> {
        let gender = self.optional_text("gender")?;
        let mut betas = Vec::new();
        if self.archive.contains("betas") {
            let array = self.array("betas")?;
            betas = array.to_f32().map_err(|error| self.broken(error))?;
            if let [rows, columns] = *array.shape()
                && rows > 1
            {
                self.notes
                    .push(format!("Of {rows} rows of `betas`, the first was taken."));
                betas.truncate(columns);
            }
            if let Some(bad) = betas.iter().position(|beta| !beta.is_finite()) {
                let place = format!("`betas`, number {bad}");
                return Err(self.format(&place, "a finite number", &betas[bad].to_string()));
            }
        }
        Ok(MotionShape {
            space,
            gender,
            betas,
        })
    }

    fn rest_pelvis(&mut self, space: ShapeSpace) -> Vec3 {
        self.options.rest_pelvis.unwrap_or_else(|| {
            let mean = match space {
                ShapeSpace::SmplX => SMPLX_REST_PELVIS,
                _ => SMPL_REST_PELVIS,
            };
            self.notes.push(format!(
                "The rest pelvis of the recorded body was not given: a mean body's {mean} m was taken, \
                 which may move the whole motion by some centimetres."
            ));
            mean
        })
    }

    /// A text that files may lack, or that may be pickled, as some of AMASS's genders are.
    fn optional_text(&mut self, key: &str) -> Result<Option<String>, Error> {
        if !self.archive.contains(key) {
            return Ok(None);
        }
        let text = self.archive.array(key).and_then(|array| array.text());
        match text {
            Ok(text) => {
                // Python 2 left the mark of its byte strings in some files: b'female'.
                let inner = text
                    .strip_prefix("b'")
                    .and_then(|rest| rest.strip_suffix('\''));
                Ok(Some(inner.unwrap_or(&text).to_owned()))
            }
            Err(error @ (ArrayError::ElementType { .. } | ArrayError::Content { .. })) => {
                self.notes.push(format!("`{key}` was left out. {error}"));
                Ok(None)
            }
            Err(error) => Err(self.broken(error)),
        }
    }

    /// `[frames][columns]` finite numbers; a third dimension is flattened into the second.
    fn matrix(&mut self, key: &str, columns_known: &[usize]) -> Result<Matrix, Error> {
        let array = self.array(key)?;
        let shape = array.shape();
        let columns = match shape {
            [_, columns] => *columns,
            // The array is in memory, so the product of its shape cannot overflow.
            [_, joints, components] => joints * components,
            _ => 0,
        };
        if !columns_known.contains(&columns) {
            let expected = format!("[frames][{columns_known:?}]");
            return Err(self.format(&format!("`{key}`"), &expected, &format!("{shape:?}")));
        }
        if shape[0] == 0 {
            return Err(self.format(&format!("`{key}`"), "at least one frame", "none"));
        }
        if shape[0] > self.options.limits.frames {
            return Err(Error::Limit {
                path: self.path.into(),
                what: "the number of frames",
                found: shape[0] as u64,
                limit: self.options.limits.frames as u64,
            });
        }
        let values = array.to_f64().map_err(|error| self.broken(error))?;
        if let Some(bad) = values.iter().position(|value| !value.is_finite()) {
            let place = format!("`{key}`, frame {}, column {}", bad / columns, bad % columns);
            return Err(self.format(&place, "a finite number", &values[bad].to_string()));
        }
        Ok(Matrix { values, columns })
    }

    fn array(&mut self, key: &str) -> Result<Array, Error> {
        self.archive.array(key).map_err(|error| self.broken(error))
    }

    fn broken(&self, source: ArrayError) -> Error {
        Error::Array {
            path: self.path.into(),
            source,
        }
    }

    fn format(&self, place: &str, expected: &str, found: &str) -> Error {
        Error::Format {
            path: self.path.into(),
            place: place.into(),
            expected: expected.into(),
            found: found.into(),
        }
    }
}

struct Matrix {
    values: Vec<f64>,
    columns: usize,
}

impl Matrix {
    fn rows(&self) -> usize {
        self.values.len() / self.columns
    }
}

fn vectors(values: &[f64]) -> impl Iterator<Item = DVec3> {
    let (triples, _) = values.as_chunks::<3>();
    triples.iter().map(|&triple| DVec3::from_array(triple))
}

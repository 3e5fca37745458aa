//! A motion by SMPL's parameters as files hold it, and the way to ours.

use glam::{DMat3, DQuat, DVec3, Vec3};
use physique_body::Joint;

use crate::amass::{SMPL_REST_PELVIS, SMPLX_REST_PELVIS};
use crate::fields::{Fields, Matrix};
use crate::read::stem;
use crate::world::World;
use crate::{Error, FrameRate, Motion, MotionShape, Recording, ShapeSpace};

/// Joints of SMPL-X: the body's 22, jaw, two eyes and 15 of each hand.
pub(crate) const SMPLX_JOINTS: usize = 55;
/// Joints of SMPL-H: the body's 22 and 15 of each hand.
pub(crate) const SMPLH_JOINTS: usize = 52;
/// Joints of SMPL: the body's 22 and one of each hand.
pub(crate) const SMPL_JOINTS: usize = 24;

/// What a file says about where the body is.
pub(crate) enum Path {
    /// SMPL's `trans`: the pelvis stands at rest pelvis + translation.
    Translation(Vec<DVec3>),
    /// Where the pelvis itself stands.
    Pelvis(Vec<DVec3>),
}

/// A motion in the axes of its file.
pub(crate) struct SmplMotion {
    pub(crate) frame_rate: FrameRate,
    pub(crate) world: World,
    pub(crate) shape: MotionShape,
    /// `[frames][22]`, local.
    pub(crate) rotations: Vec<DQuat>,
    pub(crate) path: Path,
    pub(crate) notes: Vec<String>,
}

impl SmplMotion {
    /// Turns the world upright; see [`crate::amass`] for what that does to translations.
    ///
    /// # Errors
    /// [`Error::Format`] when there are not as many rotations as places.
    pub(crate) fn into_recording(mut self, fields: &Fields<'_>) -> Result<Recording, Error> {
        let to_ours = |vector: DVec3| self.world.to_ours(vector);
        let rest_pelvis = match &self.path {
            Path::Pelvis(_) => Vec3::ZERO,
            Path::Translation(_) => fields.options.rest_pelvis.unwrap_or_else(|| {
                let mean = mean_pelvis(self.shape.space);
                self.notes.push(format!(
                    "The rest pelvis of the recorded body was not given: a mean body's {mean} m was taken, \
                     which may move the whole motion by some centimetres."
                ));
                mean
            }),
        };
        let root_translation = match &self.path {
            Path::Pelvis(places) => places.iter().map(|&at| to_ours(at).as_vec3()).collect(),
            Path::Translation(steps) => {
                let pelvis = rest_pelvis.as_dvec3();
                let steps = steps.iter();
                steps
                    .map(|&trans| (to_ours(trans + pelvis) - pelvis).as_vec3())
                    .collect()
            }
        };
        let upright = self.world.ours_from_file();
        for root in self.rotations.iter_mut().step_by(Joint::COUNT) {
            *root = upright * *root;
        }
        let rotations = self.rotations.iter().map(|turn| turn.as_quat()).collect();
        let motion = Motion::new(
            self.frame_rate,
            Some(self.shape),
            root_translation,
            rotations,
        );
        let motion = motion.map_err(|problem| fields.inside("the motion", problem))?;
        Ok(Recording {
            motion,
            name: stem(fields.path),
            rest_pelvis,
            source: None,
            licence: None,
            notes: self.notes,
        })
    }
}

/// Rest pelvis of the mean body of a family.
pub(crate) const fn mean_pelvis(space: ShapeSpace) -> Vec3 {
    match space {
        ShapeSpace::SmplX => SMPLX_REST_PELVIS,
        _ => SMPL_REST_PELVIS,
    }
}

/// Family of the betas that a file of so many joints has.
pub(crate) const fn space_of(joints: usize) -> ShapeSpace {
    match joints {
        SMPLX_JOINTS => ShapeSpace::SmplX,
        _ => ShapeSpace::Smpl,
    }
}

/// Local rotations of joints over time.
pub(crate) struct Rotations {
    /// `[frames][joints]`.
    pub(crate) values: Vec<DQuat>,
    /// Joints a frame.
    pub(crate) joints: usize,
}

impl Rotations {
    /// Reads axis-angle vectors `[frames][3 joints]` or `[frames][joints][3]`, or matrices
    /// `[frames][joints][3][3]`, for any of these numbers of joints.
    ///
    /// # Errors
    /// As [`Fields::matrix`]; [`Error::Format`] for matrices that do not turn.
    pub(crate) fn read(
        fields: &mut Fields<'_>,
        key: &str,
        joints: &[usize],
    ) -> Result<Self, Error> {
        let vectors = joints.iter().map(|joints| 3 * joints);
        let columns: Vec<usize> = vectors
            .chain(joints.iter().map(|joints| 9 * joints))
            .collect();
        let shape = fields.array(key)?.shape().to_vec();
        let matrix = fields.matrix(key, &columns)?;
        // 3 x 3 joints of axis-angle vectors are as many numbers as one matrix: the shape tells.
        let are_matrices = shape.ends_with(&[3, 3]) || !joints.contains(&(matrix.columns / 3));
        if are_matrices {
            Self::of_matrices(fields, key, &matrix)
        } else {
            Ok(Self {
                joints: matrix.columns / 3,
                values: vectors_of(&matrix.values)
                    .map(DQuat::from_scaled_axis)
                    .collect(),
            })
        }
    }

    fn of_matrices(fields: &Fields<'_>, key: &str, matrix: &Matrix) -> Result<Self, Error> {
        let joints = matrix.columns / 9;
        let turns = matrix.values.as_chunks::<9>().0.iter().enumerate();
        let values = turns.map(|(index, rows)| {
            let turn = DMat3::from_cols_array(rows).transpose();
            quaternion(turn).ok_or_else(|| {
                let name = Joint::ALL
                    .get(index % joints)
                    .map_or("a joint", |joint| joint.name());
                let found = format!(
                    "determinant {:.3} at frame {}, {name}",
                    turn.determinant(),
                    index / joints
                );
                fields.format(key, "rotation matrices", &found)
            })
        });
        Ok(Self {
            values: values.collect::<Result<_, _>>()?,
            joints,
        })
    }

    pub(crate) fn frames(&self) -> usize {
        self.values.len() / self.joints
    }

    /// The first joints of every frame.
    pub(crate) fn first(self, joints: usize) -> Vec<DQuat> {
        if joints == self.joints {
            return self.values;
        }
        let frames = self.values.chunks_exact(self.joints);
        frames
            .flat_map(|frame| frame[..joints.min(self.joints)].iter().copied())
            .collect()
    }
}

/// A rotation from a matrix, unless that is far from one.
pub(crate) fn quaternion(matrix: DMat3) -> Option<DQuat> {
    let is_turn = (matrix.determinant() - 1.0).abs() < 0.1
        && (matrix.transpose() * matrix).abs_diff_eq(DMat3::IDENTITY, 0.1);
    is_turn.then(|| DQuat::from_mat3(&matrix).normalize())
}

/// Shape coefficients, where a file has any.
///
/// # Errors
/// As [`Fields::array`]; [`Error::Format`] for numbers that are not finite.
pub(crate) fn read_shape(
    fields: &mut Fields<'_>,
    space: ShapeSpace,
    notes: &mut Vec<String>,
) -> Result<MotionShape, Error> {
    let (gender, note) = fields.optional_text("gender")?;
    notes.extend(note);
    let mut betas = Vec::new();
    if fields.contains("betas") {
        let (values, shape) = fields.numbers("betas")?;
        betas = values;
        if let [rows, columns] = *shape
            && rows > 1
        {
            notes.push(format!("Of {rows} rows of `betas`, the first was taken."));
            betas.truncate(columns);
        }
        if let Some(bad) = betas.iter().position(|beta| !beta.is_finite()) {
            let place = format!("`betas`, number {bad}");
            return Err(fields.format_at(&place, "a finite number", &betas[bad].to_string()));
        }
    }
    Ok(MotionShape {
        space,
        gender,
        betas,
    })
}

/// Numbers as vectors, three by three.
pub(crate) fn vectors_of(values: &[f64]) -> impl Iterator<Item = DVec3> {
    let (triples, _) = values.as_chunks::<3>();
    triples.iter().map(|&triple| DVec3::from_array(triple))
}

/// The note that some joints of a file have no place in the body.
pub(crate) fn left_out(what: &str) -> String {
    format!(
        "Rotations of {what} were left out: the body has {} joints.",
        Joint::COUNT
    )
}

//! The compact body file: a body model as a deflated `.npz` of half a megabyte.
//!
//! | array | type | shape | meaning |
//! |---|---|---|---|
//! | `format` | u4 | 1 | version, 1 |
//! | `template_quantised` | i2 | V, 3 | position in units of 0.05 mm |
//! | `shape_directions` | f2 | B, V, 3 | metres a unit of each beta |
//! | `regressor_joint`, `_vertex`, `_weight` | u1, u2, f4 | N | joint regressor by joint, vertex |
//! | `blend_joint`, `blend_weight` | u1, u2 | V, 4 | blend weights in units of 1/65,535 |
//! | `triangles` | u2 | F, 3 | counter-clockwise seen from outside |
//! | `parents` | i1 | 22 | -1 for the root |
//! | `mirror_vertex` | u2 | V | mirror image of each vertex |
//! | `betas_male`, `betas_female` | f4 | B | mean bodies |
//! | `attribute_map` | f4 | B, 5 | see [`AttributeMap::betas_from_attributes`] |

use glam::Vec3;
use physique_files::npz::{Archive, Array, ArrayLimits};

use crate::model::BodyArrays;
use crate::{AttributeMap, BlendWeights, BodyModel, Error, Joint, JointRegressor};

const VERSION: u32 = 1;
/// Metres a unit of `template_quantised`.
const TEMPLATE_UNIT: f32 = 5e-5;
/// No compact body is larger once unpacked.
const LARGEST_BYTES: u64 = 64 << 20;

/// Reads a compact body from the bytes of its file; `name` is used in reports and errors.
///
/// # Errors
/// [`Error::Content`] for a broken archive, [`Error::Format`] with the array, what was expected
/// and what was found; [`Error::Model`] for arrays that do not fit together.
pub fn read(name: &str, bytes: &[u8]) -> Result<BodyModel, Error> {
    let limits = ArrayLimits {
        bytes: LARGEST_BYTES,
        ..ArrayLimits::default()
    };
    let archive = Archive::open(bytes.to_vec(), limits).map_err(|error| Error::Content {
        file: name.into(),
        problem: Box::new(error.into()),
    })?;
    from_archive(name, archive)
}

/// Reads a compact body from its opened archive.
pub(crate) fn from_archive(name: &str, archive: Archive) -> Result<BodyModel, Error> {
    let mut file = File { name, archive };
    let version = file.integers::<u32>("format", &[Some(1)])?.0;
    if version != [VERSION] {
        return Err(file.error("format", VERSION.to_string(), format!("{version:?}")));
    }
    let (template, shape) = file.integers::<i16>("template_quantised", &[None, Some(3)])?;
    let vertices = shape[0];
    let (directions, shape) = file.numbers("shape_directions", &[None, Some(vertices), Some(3)])?;
    let betas = shape[0];
    let parents = file.integers::<i8>("parents", &[Some(Joint::COUNT)])?.0;
    let (regressor_joints, shape) = file.integers::<u8>("regressor_joint", &[None])?;
    let entries = [Some(shape[0])];
    let regressor_vertices = file.integers::<u16>("regressor_vertex", &entries)?.0;
    let regressor_weights = file.numbers("regressor_weight", &entries)?.0;
    let (blend_joints, shape) = file.integers::<u8>("blend_joint", &[Some(vertices), None])?;
    let influences = shape[1];
    let blend_shape = [Some(vertices), Some(influences)];
    let blend_weights = file.integers::<u16>("blend_weight", &blend_shape)?.0;
    let triangles = file.integers::<u16>("triangles", &[None, Some(3)])?.0;
    let mirror = file.integers::<u16>("mirror_vertex", &[Some(vertices)])?.0;
    let mean_male = file.numbers("betas_male", &[Some(betas)])?.0;
    let mean_female = file.numbers("betas_female", &[Some(betas)])?.0;
    let map = file.numbers("attribute_map", &[Some(betas), Some(5)])?.0;
    if vertices == 0 || influences == 0 {
        let found = format!("{vertices} vertices, {influences} influences");
        return Err(file.error("blend_joint", "at least one of each".into(), found));
    }

    let vectors = |flat: &[f32]| -> Vec<Vec3> {
        let chunks = flat.as_chunks::<3>().0.iter();
        chunks.map(|&v| Vec3::from_array(v)).collect()
    };
    let regressor_row = |joint: usize| {
        let entries = regressor_vertices.iter().zip(&regressor_weights);
        let of_joint = regressor_joints.iter().zip(entries);
        of_joint
            .filter(move |&(&of, _)| usize::from(of) == joint)
            .map(|(_, (&vertex, &weight))| (u32::from(vertex), weight))
    };
    let arrays = BodyArrays {
        name: name.into(),
        template: template
            .as_chunks::<3>()
            .0
            .iter()
            .map(|v| Vec3::from_array(v.map(|unit| f32::from(unit) * TEMPLATE_UNIT)))
            .collect(),
        shape_directions: directions.chunks(vertices * 3).map(vectors).collect(),
        pose_directions: Vec::new(),
        joint_regressor: JointRegressor::from_rows((0..parents.len()).map(regressor_row))?,
        blend_weights: BlendWeights::from_rows(
            blend_joints
                .chunks(influences)
                .zip(blend_weights.chunks(influences))
                .map(|(joints, weights)| {
                    let weights = weights.iter().map(|&unit| f32::from(unit) / 65535.0);
                    joints.iter().copied().zip(weights).collect::<Vec<_>>()
                }),
        )?,
        triangles: triangles
            .as_chunks::<3>()
            .0
            .iter()
            .map(|triangle| triangle.map(u32::from))
            .collect(),
        parents: parents
            .iter()
            .map(|&parent| usize::try_from(parent).ok())
            .collect(),
        mirror_vertices: mirror.into_iter().map(u32::from).collect(),
        attributes: Some(AttributeMap {
            mean_male,
            mean_female,
            betas_from_attributes: map.as_chunks::<5>().0.to_vec(),
        }),
    };
    BodyModel::new(arrays)
}

struct File<'a> {
    name: &'a str,
    archive: Archive,
}

impl File<'_> {
    fn error(&self, array: &str, expected: String, found: String) -> Error {
        Error::Format {
            file: self.name.into(),
            place: format!("array `{array}`"),
            expected,
            found,
        }
    }

    fn content(&self, problem: physique_files::Error) -> Error {
        Error::Content {
            file: self.name.into(),
            problem: Box::new(problem),
        }
    }

    /// Numbers in C order and their shape; `None` in `shape` stands for any length.
    fn numbers(
        &mut self,
        array: &str,
        shape: &[Option<usize>],
    ) -> Result<(Vec<f32>, Vec<usize>), Error> {
        let array = self.array(array, shape)?;
        let values = array.to_f32().map_err(|error| self.content(error.into()))?;
        Ok((values, array.shape().to_vec()))
    }

    /// Integers in C order, each within its type, and their shape.
    fn integers<T: TryFrom<i64>>(
        &mut self,
        name: &str,
        shape: &[Option<usize>],
    ) -> Result<(Vec<T>, Vec<usize>), Error> {
        let array = self.array(name, shape)?;
        let values = array.to_i64().map_err(|error| self.content(error.into()))?;
        let values: Result<Vec<T>, _> = values.into_iter().map(T::try_from).collect();
        match values {
            Ok(values) => Ok((values, array.shape().to_vec())),
            Err(_) => {
                let expected = format!("values of {}", std::any::type_name::<T>());
                Err(self.error(name, expected, "one beyond".into()))
            }
        }
    }

    fn array(&mut self, name: &str, shape: &[Option<usize>]) -> Result<Array, Error> {
        let array = self.archive.array(name);
        let array = array.map_err(|error| self.content(error.into()))?;
        let found = array.shape();
        let fits = found.len() == shape.len()
            && found
                .iter()
                .zip(shape)
                .all(|(&found, wanted)| wanted.is_none_or(|wanted| found == wanted));
        if fits {
            return Ok(array);
        }
        let expected = format!("an array of shape {shape:?}");
        Err(self.error(name, expected, format!("shape {found:?}")))
    }
}

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

use std::io::{Cursor, Read};

use glam::Vec3;
use half::f16;
use npyz::{Deserialize, NpyFile};
use zip::ZipArchive;

use crate::model::BodyArrays;
use crate::{AttributeMap, BlendWeights, BodyModel, Error, Joint, JointRegressor};

const VERSION: u32 = 1;
/// Metres a unit of `template_quantised`.
const TEMPLATE_UNIT: f32 = 5e-5;
/// No compact body is larger once unpacked; checked before anything is allocated.
const LARGEST_ARRAY_BYTES: u64 = 64 << 20;

/// Reads a compact body from the bytes of its file; `name` is used in reports and errors.
///
/// # Errors
/// [`Error::Format`] with the array, what was expected and what was found; [`Error::Model`] for
/// arrays that do not fit together.
pub fn read(name: &str, bytes: &[u8]) -> Result<BodyModel, Error> {
    let mut file = Archive::open(name, bytes)?;
    let version = file.array::<u32>("format", &[Some(1)])?.0;
    if version != [VERSION] {
        return Err(file.error("format", VERSION.to_string(), format!("{version:?}")));
    }
    let (template, shape) = file.array::<i16>("template_quantised", &[None, Some(3)])?;
    let vertices = shape[0];
    let (directions, shape) =
        file.array::<f16>("shape_directions", &[None, Some(vertices), Some(3)])?;
    let betas = shape[0];
    let parents = file.array::<i8>("parents", &[Some(Joint::COUNT)])?.0;
    let (regressor_joints, shape) = file.array::<u8>("regressor_joint", &[None])?;
    let entries = [Some(shape[0])];
    let regressor_vertices = file.array::<u16>("regressor_vertex", &entries)?.0;
    let regressor_weights = file.array::<f32>("regressor_weight", &entries)?.0;
    let (blend_joints, shape) = file.array::<u8>("blend_joint", &[Some(vertices), None])?;
    let influences = shape[1];
    let blend_shape = [Some(vertices), Some(influences)];
    let blend_weights = file.array::<u16>("blend_weight", &blend_shape)?.0;
    let triangles = file.array::<u16>("triangles", &[None, Some(3)])?.0;
    let mirror = file.array::<u16>("mirror_vertex", &[Some(vertices)])?.0;
    let mean_male = file.array::<f32>("betas_male", &[Some(betas)])?.0;
    let mean_female = file.array::<f32>("betas_female", &[Some(betas)])?.0;
    let map = file
        .array::<f32>("attribute_map", &[Some(betas), Some(5)])?
        .0;
    if vertices == 0 || influences == 0 {
        let found = format!("{vertices} vertices, {influences} influences");
        return Err(file.error("blend_joint", "at least one of each".into(), found));
    }

    let vectors = |flat: &[f16]| -> Vec<Vec3> {
        let chunks = flat.as_chunks::<3>().0.iter();
        chunks
            .map(|v| Vec3::from_array(v.map(f16::to_f32)))
            .collect()
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

struct Archive<'a> {
    file: &'a str,
    zip: ZipArchive<Cursor<&'a [u8]>>,
}

impl<'a> Archive<'a> {
    fn open(file: &'a str, bytes: &'a [u8]) -> Result<Self, Error> {
        match ZipArchive::new(Cursor::new(bytes)) {
            Ok(zip) => Ok(Self { file, zip }),
            Err(problem) => Err(Error::Format {
                file: file.into(),
                place: "start".into(),
                expected: "a .npz archive".into(),
                found: problem.to_string(),
            }),
        }
    }

    fn error(&self, array: &str, expected: String, found: String) -> Error {
        Error::Format {
            file: self.file.into(),
            place: format!("array `{array}`"),
            expected,
            found,
        }
    }

    /// The array's values in C order and its shape; `None` in `shape` stands for any length.
    fn array<T: Deserialize>(
        &mut self,
        array: &str,
        shape: &[Option<usize>],
    ) -> Result<(Vec<T>, Vec<usize>), Error> {
        let bytes = self.unpack(array)?;
        let expected = || format!("an array of shape {shape:?}");
        let header = NpyFile::new(&bytes[..])
            .map_err(|problem| self.error(array, expected(), problem.to_string()))?;
        let found: Vec<usize> = header.shape().iter().map(|&n| n as usize).collect();
        let fits = found.len() == shape.len()
            && found.iter().zip(shape).all(|(n, wanted)| wanted.is_none_or(|wanted| *n == wanted))
            // The values follow the header, so their number cannot exceed the bytes there are.
            && found
                .iter()
                .try_fold(1_usize, |product, &n| product.checked_mul(n))
                .is_some_and(|values| values <= bytes.len());
        if !fits || header.order() != npyz::Order::C {
            return Err(self.error(array, expected(), format!("shape {found:?}")));
        }
        match header.into_vec() {
            Ok(values) => Ok((values, found)),
            Err(problem) => Err(self.error(array, expected(), problem.to_string())),
        }
    }

    fn unpack(&mut self, array: &str) -> Result<Vec<u8>, Error> {
        // The stated size may lie, so the stream is cut off as well.
        let mut bytes = Vec::new();
        let outcome = match self.zip.by_name(&format!("{array}.npy")) {
            Ok(entry) => entry
                .take(LARGEST_ARRAY_BYTES + 1)
                .read_to_end(&mut bytes)
                .map_err(|problem| problem.to_string()),
            Err(problem) => Err(problem.to_string()),
        };
        match outcome {
            Ok(_) if bytes.len() as u64 <= LARGEST_ARRAY_BYTES => Ok(bytes),
            Ok(_) => {
                let expected = format!("at most {LARGEST_ARRAY_BYTES} bytes");
                Err(self.error(array, expected, "more".into()))
            }
            Err(found) => Err(self.error(array, "an intact entry of that name".into(), found)),
        }
    }
}

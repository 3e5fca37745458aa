//! Reading proxies of our own layout.

use std::collections::BTreeMap;
use std::path::Path;

use half::f16;
use physique_body::Joint;
use physique_files::read_file;
use safetensors::{Dtype, SafeTensorError, SafeTensors, tensor::TensorView};

use super::{BLEND_WEIGHTS, CHOSEN, FORMAT, JOINTS, ProxyLimits, SPHERES, STATISTICS};
use crate::regressor::{NetworkLayout, Parameter};
use crate::sphere_proxy::BlendRow;
use crate::{
    Error, JointRegressor, PairChoice, PairStatistics, Pairs, SphereProxy, SphereRegressor,
};

/// Reads a proxy that [`super::write_proxy`] wrote.
///
/// # Errors
/// [`Error::File`]; [`Error::ProxyFile`] with the array that is missing or does not fit, before
/// memory is taken for it.
pub fn read_proxy(path: &Path, limits: &ProxyLimits) -> Result<SphereProxy, Error> {
    let bytes = read_file(path, limits.bytes)?;
    parse_proxy(&path.display().to_string(), &bytes, limits)
}

/// Reads the bytes of a proxy file; `file` names it in errors.
///
/// # Errors
/// As [`read_proxy`].
pub fn parse_proxy(file: &str, bytes: &[u8], limits: &ProxyLimits) -> Result<SphereProxy, Error> {
    parse(&Reader { file, limits }, bytes).map_err(|problem| problem.in_proxy_file(file))
}

fn parse(reader: &Reader<'_>, bytes: &[u8]) -> Result<SphereProxy, Error> {
    let (file, limits) = (reader.file, reader.limits);
    let sound = |error: SafeTensorError| {
        let found = match error {
            // The array that the crate names is a different one every time.
            SafeTensorError::InvalidOffset(_) => "arrays that overlap or leave gaps".to_owned(),
            other => other.to_string(),
        };
        reader.refuse("the whole file", "a .safetensors file", found)
    };
    reader.check_header(bytes)?;
    let (_, header) = SafeTensors::read_metadata(bytes).map_err(sound)?;
    let tensors = SafeTensors::deserialize(bytes).map_err(sound)?;
    let told = header.metadata().as_ref().and_then(|all| all.get("proxy"));
    let mut lines = told.map_or("", String::as_str).lines();
    let format = lines.next().unwrap_or("");
    if format != FORMAT {
        let found = match format {
            "" => "no format".to_owned(),
            other => format!("`{}`", other.escape_debug()),
        };
        return Err(reader.refuse("its header", FORMAT, found));
    }
    let notes: BTreeMap<String, String> = lines
        .filter_map(|line| line.split_once(": "))
        .map(|(name, text)| (name.to_owned(), text.to_owned()))
        .collect();

    let array = |name: &str| {
        let tensor = tensors.tensor(name);
        tensor.map_err(|_| reader.refuse(name, "an array of that name", "none".into()))
    };
    // The first layer tells betas and width, the last one the spheres.
    let [width, betas] = reader.shape(SPHERES, &array(&format!("{SPHERES}net1.0.weight_v"))?)?;
    let [outputs] = reader.shape(SPHERES, &array(&format!("{SPHERES}net2.8.bias"))?)?;
    let spheres = outputs / 4;
    if outputs % 4 != 0 || spheres > limits.spheres {
        let expected = format!("4 values a sphere, at most {} spheres", limits.spheres);
        return Err(reader.refuse("spheres.net2.8.bias", &expected, outputs.to_string()));
    }
    let [joint_width, joint_betas] =
        reader.shape(JOINTS, &array(&format!("{JOINTS}linear_stack.0.weight"))?)?;
    let sphere_layout = SphereRegressor::layout(betas, width, spheres)?;
    let joint_layout = JointRegressor::layout(joint_betas, joint_width)?;
    let count = sphere_layout.parameter_count() + joint_layout.parameter_count();
    if count > limits.parameters {
        let expected = format!("at most {} parameters", limits.parameters);
        return Err(reader.refuse("the regressors", &expected, count.to_string()));
    }
    let parameters = |layout: &NetworkLayout, prefix: &str| {
        let name = |parameter: &Parameter| format!("{prefix}{}", parameter.name);
        // Two small arrays may promise a large network: all of it must be there first.
        for parameter in layout.parameters() {
            let name = name(parameter);
            reader.check_shape(&name, &array(&name)?, &parameter.shape)?;
        }
        let mut parameters = Vec::with_capacity(layout.parameter_count());
        for parameter in layout.parameters() {
            let name = name(parameter);
            parameters.extend(reader.floats(&name, &array(&name)?, &parameter.shape)?);
        }
        Ok::<_, Error>(parameters)
    };
    let sphere_parameters = parameters(&sphere_layout, SPHERES)?;
    let joint_parameters = parameters(&joint_layout, JOINTS)?;

    let shape = [spheres, Joint::COUNT];
    let weights = reader.floats(BLEND_WEIGHTS, &array(BLEND_WEIGHTS)?, &shape)?;
    let pairs = if let Ok(chosen) = tensors.tensor(CHOSEN) {
        let [_, 2] = reader.shape(CHOSEN, &chosen)? else {
            let found = format!("shape {:?}", chosen.shape());
            return Err(reader.refuse(CHOSEN, "shape [pairs, 2]", found));
        };
        let numbers = reader.integers(CHOSEN, &chosen)?;
        let numbers = numbers.as_chunks::<2>().0.iter();
        let pairs = numbers.map(|&[i, j]| (i as usize, j as usize));
        PairChoice::Chosen(Pairs::new(spheres, pairs)?)
    } else {
        let poses = notes.get("poses").and_then(|text| text.parse().ok());
        let poses = poses
            .ok_or_else(|| reader.refuse("its header", "the number of poses", "none".into()))?;
        let counts = reader.integers(STATISTICS, &array(STATISTICS)?)?;
        PairChoice::Statistics(PairStatistics::from_counts(spheres, poses, counts)?)
    };
    SphereProxy::new(
        SphereRegressor::new(sphere_layout, sphere_parameters)?,
        JointRegressor::new(joint_layout, joint_parameters)?,
        blend_rows(file, &weights)?,
        pairs,
        notes
            .into_iter()
            .filter(|(name, _)| name != "poses")
            .collect(),
    )
}

/// Rows of 22 weights as entries, heaviest first.
pub(super) fn blend_rows(file: &str, weights: &[f32]) -> Result<Vec<BlendRow>, Error> {
    let rows = weights.as_chunks::<{ Joint::COUNT }>().0.iter().enumerate();
    rows.map(|(sphere, row)| {
        let mut used: Vec<(u8, f32)> = (0_u8..)
            .zip(row.iter().copied())
            .filter(|&(_, weight)| weight != 0.0)
            .collect();
        let sum: f32 = row.iter().sum();
        // Not a number is not near 1, either.
        let sums_to_one = (sum - 1.0).abs() < 1e-3;
        if used.len() > 4 || !sums_to_one {
            return Err(Error::ProxyFile {
                file: file.to_owned(),
                place: format!("the blend weights of sphere {sphere}"),
                expected: "at most four, of sum 1".into(),
                found: format!("{} of sum {sum}", used.len()),
            });
        }
        used.sort_by(|a, b| b.1.total_cmp(&a.1));
        let mut entries = [(0, 0.0); 4];
        entries[..used.len()].copy_from_slice(&used);
        Ok(entries)
    })
    .collect()
}

struct Reader<'a> {
    file: &'a str,
    limits: &'a ProxyLimits,
}

impl Reader<'_> {
    fn refuse(&self, place: &str, expected: &str, found: String) -> Error {
        Error::ProxyFile {
            file: self.file.to_owned(),
            place: place.to_owned(),
            expected: expected.to_owned(),
            found,
        }
    }

    fn shape<const D: usize>(
        &self,
        place: &str,
        tensor: &TensorView<'_>,
    ) -> Result<[usize; D], Error> {
        let shape = tensor.shape();
        <[usize; D]>::try_from(shape).map_err(|_| {
            let expected = format!("arrays of {D} dimensions at its ends");
            self.refuse(place, &expected, format!("shape {shape:?}"))
        })
    }

    /// Refuses headers far longer than those of proxies, which take several times their size
    /// when they are parsed.
    fn check_header(&self, bytes: &[u8]) -> Result<(), Error> {
        const LONGEST: u64 = 1 << 20;
        let length = bytes
            .first_chunk()
            .map_or(0, |&all| u64::from_le_bytes(all));
        if length <= LONGEST {
            return Ok(());
        }
        let expected = format!("at most {LONGEST} bytes of a .safetensors file's");
        Err(self.refuse("its header", &expected, length.to_string()))
    }

    fn check_shape(
        &self,
        name: &str,
        tensor: &TensorView<'_>,
        shape: &[usize],
    ) -> Result<(), Error> {
        if tensor.shape() == shape {
            return Ok(());
        }
        let found = format!("{:?}", tensor.shape());
        Err(self.refuse(name, &format!("shape {shape:?}"), found))
    }

    fn floats(
        &self,
        name: &str,
        tensor: &TensorView<'_>,
        shape: &[usize],
    ) -> Result<Vec<f32>, Error> {
        self.check_shape(name, tensor, shape)?;
        let bytes = tensor.data();
        match tensor.dtype() {
            Dtype::F32 => Ok(words(bytes).map(f32::from_le_bytes).collect()),
            Dtype::F16 => {
                let halves = bytes.as_chunks::<2>().0.iter();
                Ok(halves
                    .map(|&half| f16::from_le_bytes(half).to_f32())
                    .collect())
            }
            Dtype::I8 => {
                let values = bytes.iter().map(|&byte| i8::from_le_bytes([byte]));
                Ok(values.map(f32::from).collect())
            }
            other => Err(self.refuse(name, "F32, F16 or I8", format!("{other:?}"))),
        }
    }

    fn integers(&self, name: &str, tensor: &TensorView<'_>) -> Result<Vec<u32>, Error> {
        let most = self.limits.spheres.saturating_mul(self.limits.spheres);
        let count = tensor.data().len() / 4;
        if tensor.dtype() != Dtype::U32 || count > most {
            let found = format!("{count} of {:?}", tensor.dtype());
            return Err(self.refuse(name, &format!("at most {most} of U32"), found));
        }
        Ok(words(tensor.data()).map(u32::from_le_bytes).collect())
    }
}

fn words(bytes: &[u8]) -> impl Iterator<Item = [u8; 4]> + '_ {
    bytes.as_chunks::<4>().0.iter().copied()
}

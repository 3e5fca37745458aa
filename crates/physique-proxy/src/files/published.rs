//! Reading proxies as published: PyTorch regressors and NumPy arrays in one folder.

use std::collections::BTreeMap;
use std::path::Path;

use physique_body::Joint;
use physique_files::npz::{Array, ArrayLimits};
use physique_files::pickle::PickleLimits;
use physique_files::{named_arrays, read_file};

use super::ProxyLimits;
use super::read::blend_rows;
use crate::regressor::NetworkLayout;
use crate::sphere_proxy::BlendRow;
use crate::{Error, JointRegressor, PairChoice, Pairs, SphereProxy, SphereRegressor};

const SPHERES: &str = "SR/sphere_regressor.pth";
const JOINTS: &str = "JR/joint_regressor.pth";
const BLEND_WEIGHTS: &str = "boneweights.npy";
/// Pairs that are left out: of one joint or intersecting in 90 % of the poses; of one joint only.
const EXCLUDED: [&str; 2] = ["coll_mat_1jd90.npy", "coll_mat_1j.npy"];

/// Reads a folder in the published layout: `SR/sphere_regressor.pth`, `JR/joint_regressor.pth`,
/// `boneweights.npy`, and `coll_mat_1jd90.npy` or else `coll_mat_1j.npy`. Read as data: no code in
/// the files can run.
///
/// The published program goes on with all pairs where the last is missing; here that is an error.
///
/// # Errors
/// [`Error::File`]; [`Error::ProxyContent`] for a broken file; [`Error::ProxyFile`] with the array
/// that is missing or does not fit.
pub fn read_published(folder: &Path, limits: &ProxyLimits) -> Result<SphereProxy, Error> {
    // Each file is let go before the next one is read.
    read_parts(folder, limits)
        .map_err(|problem| problem.in_proxy_file(&folder.display().to_string()))
}

fn read_parts(folder: &Path, limits: &ProxyLimits) -> Result<SphereProxy, Error> {
    let spheres = sphere_regressor(&folder.join(SPHERES), limits)?;
    let joints = joint_regressor(&folder.join(JOINTS), limits)?;
    let count = spheres.sphere_count();
    let blend_weights = blend_weights(&folder.join(BLEND_WEIGHTS), count, limits)?;
    let [all, of_one_joint] = EXCLUDED.map(|name| folder.join(name));
    let path = if all.exists() { all } else { of_one_joint };
    let pairs = PairChoice::Chosen(pairs_but(&path, count, limits)?);
    let notes = BTreeMap::from([("source".to_owned(), folder.display().to_string())]);
    SphereProxy::new(spheres, joints, blend_weights, pairs, notes)
}

fn sphere_regressor(path: &Path, limits: &ProxyLimits) -> Result<SphereRegressor, Error> {
    let arrays = Arrays::read(path, limits)?;
    let [width, betas] = arrays.shape("net1.0.weight_v")?;
    let [outputs] = arrays.shape("net2.8.bias")?;
    let count = outputs / 4;
    if outputs % 4 != 0 || count > limits.spheres {
        let expected = format!("4 values a sphere, at most {} spheres", limits.spheres);
        return Err(arrays.refuse("net2.8.bias", expected, outputs.to_string()));
    }
    let layout = SphereRegressor::layout(betas, width, count);
    let layout = layout.map_err(|problem| problem.in_proxy_file(&arrays.file))?;
    let parameters = arrays.parameters(&layout, limits)?;
    SphereRegressor::new(layout, parameters).map_err(|problem| problem.in_proxy_file(&arrays.file))
}

fn joint_regressor(path: &Path, limits: &ProxyLimits) -> Result<JointRegressor, Error> {
    let arrays = Arrays::read(path, limits)?;
    let [width, betas] = arrays.shape("linear_stack.0.weight")?;
    let layout = JointRegressor::layout(betas, width);
    let layout = layout.map_err(|problem| problem.in_proxy_file(&arrays.file))?;
    let parameters = arrays.parameters(&layout, limits)?;
    JointRegressor::new(layout, parameters).map_err(|problem| problem.in_proxy_file(&arrays.file))
}

fn blend_weights(path: &Path, count: usize, limits: &ProxyLimits) -> Result<Vec<BlendRow>, Error> {
    let arrays = Arrays::read(path, limits)?;
    blend_rows(
        &arrays.file,
        &arrays.floats("array", &[count, Joint::COUNT])?,
    )
}

/// All pairs of spheres but those that a matrix marks.
fn pairs_but(path: &Path, count: usize, limits: &ProxyLimits) -> Result<Pairs, Error> {
    let arrays = Arrays::read(path, limits)?;
    let excluded = arrays.floats("array", &[count, count])?;
    if let Some(bad) = excluded.iter().position(|mark| !mark.is_finite()) {
        let place = format!("row {}, column {}", bad / count, bad % count);
        let found = excluded[bad].to_string();
        return Err(arrays.refuse(&place, "a finite number".into(), found));
    }
    let kept = |i: usize, j: usize| excluded[i * count + j] == 0.0;
    Ok(Pairs::all(count)?.filtered(kept))
}

/// The arrays of one file.
struct Arrays {
    file: String,
    arrays: Vec<Array>,
}

impl Arrays {
    fn read(path: &Path, limits: &ProxyLimits) -> Result<Self, Error> {
        let file = path.display().to_string();
        let bytes = read_file(path, limits.bytes)?;
        let array_limits = ArrayLimits {
            bytes: limits.bytes,
            ..ArrayLimits::default()
        };
        let pickle_limits = PickleLimits {
            bytes: limits.bytes,
            ..PickleLimits::default()
        };
        match named_arrays(bytes, &array_limits, &pickle_limits) {
            Ok(arrays) => Ok(Self { file, arrays }),
            Err(problem) => Err(Error::ProxyContent {
                file,
                problem: Box::new(problem),
            }),
        }
    }

    fn refuse(&self, place: &str, expected: String, found: String) -> Error {
        Error::ProxyFile {
            file: self.file.clone(),
            place: place.to_owned(),
            expected,
            found,
        }
    }

    fn array(&self, name: &str) -> Result<&Array, Error> {
        let found = self.arrays.iter().find(|array| array.key() == name);
        found.ok_or_else(|| self.refuse(name, "an array of that name".into(), "none".into()))
    }

    fn shape<const D: usize>(&self, name: &str) -> Result<[usize; D], Error> {
        let shape = self.array(name)?.shape();
        <[usize; D]>::try_from(shape)
            .map_err(|_| self.refuse(name, format!("{D} dimensions"), format!("{shape:?}")))
    }

    fn floats(&self, name: &str, shape: &[usize]) -> Result<Vec<f32>, Error> {
        let array = self.array(name)?;
        if array.shape() != shape {
            let found = format!("{:?}", array.shape());
            return Err(self.refuse(name, format!("shape {shape:?}"), found));
        }
        array.to_f32().map_err(|problem| Error::ProxyContent {
            file: self.file.clone(),
            problem: Box::new(problem.into()),
        })
    }

    fn parameters(&self, layout: &NetworkLayout, limits: &ProxyLimits) -> Result<Vec<f32>, Error> {
        if layout.parameter_count() > limits.parameters {
            let expected = format!("at most {} parameters", limits.parameters);
            let found = layout.parameter_count().to_string();
            return Err(self.refuse("the whole file", expected, found));
        }
        // Two small arrays may promise a large network: memory grows with what is there.
        let mut parameters = Vec::new();
        for parameter in layout.parameters() {
            parameters.extend(self.floats(&parameter.name, &parameter.shape)?);
        }
        Ok(parameters)
    }
}

//! Fitting a proxy to a body: shapes, samples, training, blend weights.

mod adam;
mod blend_weights;
mod blocks;
mod checkpoint;
mod initial;
mod options;
mod samples;
pub(crate) mod shapes;
mod sphere_losses;
mod train_joints;
mod train_spheres;

use std::collections::BTreeMap;
use std::path::Path;
use std::sync::Arc;
use std::sync::atomic::{AtomicUsize, Ordering};

use physique_body::{BodyModel, Joint};
use physique_geometry::Triangles;
use rayon::prelude::*;

pub(crate) use blend_weights::vertex_rows;
pub use blend_weights::{BlendOptions, NeighbourWeights};
pub use options::FitOptions;
pub use sphere_losses::{SphereLossWeights, SphereLosses};

use crate::random::Random;
use crate::{Error, JointRegressor, PairChoice, PairStatistics, SphereProxy, SphereRegressor};
use blocks::SampleFile;
use samples::BodySamples;
use shapes::{NormalisedBody, Purpose};
use train_joints::{BodyJoints, train_joints};
use train_spheres::{SphereBodySamples, train_spheres};

/// Parts of a fit, in their order.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Stage {
    /// Bodies get their points.
    Samples,
    /// Passes of the joint regressor.
    Joints,
    /// Passes of the sphere regressor.
    Spheres,
}

/// Watches a fit. All calls come from the thread that fits, but those of [`Stage::Samples`].
pub trait FitObserver: Sync {
    /// Some units of a stage are done; `loss` is the stage's mean loss of the last, 0 for samples.
    fn epoch(&self, stage: Stage, done: usize, loss: f64);

    /// The losses of one pass, one by one.
    fn sphere_losses(&self, _epoch: usize, _losses: &SphereLosses) {}

    /// Asked after each pass: whether to write a checkpoint now.
    fn wants_checkpoint(&self) -> bool {
        false
    }
}

/// Fits a whole proxy to a body model: [`fit_regressors`], then blend weights. No poses are counted
/// yet: see [`SphereProxy::with_statistics`].
///
/// # Errors
/// As [`fit_regressors`].
pub fn fit_proxy(
    model: &Arc<BodyModel>,
    options: &FitOptions,
    blend: &BlendOptions,
    folder: &Path,
    observer: &dyn FitObserver,
) -> Result<SphereProxy, Error> {
    let FittedRegressors { spheres, joints } = fit_regressors(model, options, folder, observer)?;
    let rows = blend_weights::blend_weights(model, &spheres, options, blend)?;
    let statistics = PairStatistics::new(options.spheres)?;
    let recipe = serde_json::to_string(options).unwrap_or_default();
    let notes = BTreeMap::from([
        ("body".to_owned(), model.name().to_owned()),
        ("recipe".to_owned(), recipe),
    ]);
    let pairs = PairChoice::Statistics(statistics);
    SphereProxy::new(spheres, joints, rows, pairs, notes)
}

/// Both regressors of a body.
#[derive(Clone, Debug)]
pub struct FittedRegressors {
    /// Betas to spheres.
    pub spheres: SphereRegressor,
    /// Betas to joints.
    pub joints: JointRegressor,
}

/// Fits both regressors to a body model.
///
/// Samples and checkpoints lie in `folder`, which is made; called again with the same folder,
/// model and options, the fit goes on where it was stopped and ends in the same result, bit for
/// bit, for any number of threads.
///
/// Cost of the default recipe: 40 minutes of processor time (six for the samples, one for the joints, 31 for
/// the spheres at 54 ms a step) and 5 GB of disk; `cargo run --release --example fit_speed` measures.
///
/// # Errors
/// [`Error::FitOptions`]; [`Error::Checkpoint`] if the folder holds another fit;
/// [`Error::Geometry`] unless the body's surface is closed; [`Error::Samples`]; errors of files.
pub fn fit_regressors(
    model: &Arc<BodyModel>,
    options: &FitOptions,
    folder: &Path,
    observer: &dyn FitObserver,
) -> Result<FittedRegressors, Error> {
    options.check()?;
    std::fs::create_dir_all(folder).map_err(|problem| physique_files::FileError::Io {
        path: folder.into(),
        problem,
    })?;
    let recipe = format!("{options:?} {}", fingerprint(model));
    let joints = train_joints(
        &body_joints(model, options)?,
        options,
        &recipe,
        &folder.join("joints.checkpoint"),
        observer,
    )?;
    let spheres = train_spheres(
        &body_samples(model, options, folder, observer)?,
        options,
        &recipe,
        &folder.join("spheres.checkpoint"),
        observer,
    )?;
    Ok(FittedRegressors { spheres, joints })
}

/// Normalised rest joints of random shapes.
fn body_joints(model: &Arc<BodyModel>, options: &FitOptions) -> Result<Vec<BodyJoints>, Error> {
    (0..options.joint_bodies)
        .into_par_iter()
        .map(|index| {
            let range = options.beta_range;
            let betas = shapes::betas(Purpose::Joints, index, model, range, options.seed);
            let shape = NormalisedBody::new(model, &betas)?;
            let joints = &shape.body.rest_joints()[..Joint::COUNT];
            let joints = joints
                .iter()
                .flat_map(|&joint| shape.ball.ball_from_world(joint).to_array());
            Ok(BodyJoints {
                betas,
                joints: joints.collect(),
            })
        })
        .collect()
}

/// Samples of random shapes; those on disk are kept.
fn body_samples(
    model: &Arc<BodyModel>,
    options: &FitOptions,
    folder: &Path,
    observer: &dyn FitObserver,
) -> Result<Vec<SphereBodySamples>, Error> {
    const SAMPLES: u64 = 120;
    let triangles = Triangles::new(model.vertex_count(), model.triangles())?;
    // What the samples depend on names them, so that fits of other sizes can share them.
    let key = format!(
        "{:x}-{}-{}-{}-{}",
        fingerprint(model),
        options.beta_range,
        options.ball_points,
        options.surface_points,
        options.seed
    );
    let done = AtomicUsize::new(0);
    (0..options.sphere_bodies)
        .into_par_iter()
        .map(|index| {
            let range = options.beta_range;
            let betas = shapes::betas(Purpose::Spheres, index, model, range, options.seed);
            let path = folder.join(format!("samples-{key}-{index:05}.bin"));
            let samples = match SampleFile::open(&path) {
                Some(samples) => samples,
                None => {
                    let shape = NormalisedBody::new(model, &betas)?;
                    let mut random = Random::new(&[options.seed, SAMPLES, index as u64]);
                    let samples = BodySamples::draw(&shape, &triangles, options, &mut random)?;
                    SampleFile::write(&path, &samples)?
                }
            };
            observer.epoch(
                Stage::Samples,
                done.fetch_add(1, Ordering::Relaxed) + 1,
                0.0,
            );
            Ok(SphereBodySamples { betas, samples })
        })
        .collect()
}

/// Tells body models apart (FNV-1a over shapes and triangles).
fn fingerprint(model: &BodyModel) -> u64 {
    let directions = model
        .shape_directions()
        .iter()
        .take(shapes::BETAS)
        .flatten();
    let numbers = model.template().iter().chain(directions);
    let numbers = numbers
        .flat_map(|vector| vector.to_array())
        .map(f32::to_bits);
    let corners = model.triangles().iter().flatten().copied();
    numbers
        .chain(corners)
        .flat_map(u32::to_le_bytes)
        .fold(0xCBF2_9CE4_8422_2325, |hash, byte| {
            (hash ^ u64::from(byte)).wrapping_mul(0x0100_0000_01B3)
        })
}

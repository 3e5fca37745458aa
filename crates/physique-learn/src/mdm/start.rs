//! Training that starts from a trained network.

use std::ffi::OsStr;
use std::path::{Path, PathBuf};

use burn::tensor::Device;
use physique_motion::features::FeatureStatistics;
use serde::{Deserialize, Serialize};
use sha2::{Digest, Sha256};

use super::folder::NETWORK;
use super::{Mdm, MdmConfig, MdmFolder, MdmPlan, PUBLISHED_NAMES, parameters_of, read_published};
use crate::Error;
use crate::checkpoint::CheckpointLimits;
use crate::text::KnownCaptions;
use crate::trainer::read_network;

/// Settings of a network that may change from one run to the next.
const FREE: [&str; 1] = ["dropout"];

/// Where a run's first weights are from.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Origin {
    /// The folder or file, as it was named.
    pub path: String,
    /// SHA-256 of the file of weights, in hexadecimal.
    pub sha256: String,
}

/// A trained network that a new run starts from: fine-tuning.
#[derive(Debug)]
pub struct StartingNetwork {
    /// Where it is from.
    pub origin: Origin,
    /// The network; the running average, where training kept one.
    pub network: Mdm,
    /// Steps of diffusion that it was trained with.
    pub diffusion_steps: usize,
    /// Factor of the schedule's signal-to-noise ratio.
    pub signal: f64,
    /// Name of the text encoder, where it is known; empty for networks without captions.
    pub text_encoder: Option<String>,
    /// What its motions are normalised by, where it is known.
    pub statistics: Option<FeatureStatistics>,
    /// What it was told, where it is known.
    pub captions: Option<KnownCaptions>,
}

impl StartingNetwork {
    /// Reads a folder of [`MdmFolder::write`], a published checkpoint (`.pt`, with `args.json`
    /// beside it), or a state of one of our runs (`state-….safetensors`, with `plan.json` beside it).
    ///
    /// # Errors
    /// As [`MdmFolder::read`] and [`read_published`].
    pub fn read(path: &Path, limits: &CheckpointLimits, device: &Device) -> Result<Self, Error> {
        if path.is_dir() {
            return Self::folder(path, limits, device);
        }
        match path.extension().and_then(OsStr::to_str) {
            Some("safetensors") => Self::state(path, device),
            _ => Self::published(path, limits, device),
        }
    }

    fn folder(path: &Path, limits: &CheckpointLimits, device: &Device) -> Result<Self, Error> {
        let origin = Origin::of(path, &path.join(NETWORK), limits.bytes)?;
        let folder = MdmFolder::read(path, limits, device)?;
        Ok(Self {
            origin,
            network: folder.network,
            diffusion_steps: folder.description.diffusion_steps,
            signal: folder.description.signal,
            text_encoder: Some(folder.description.text_encoder),
            statistics: Some(folder.statistics),
            captions: folder.captions,
        })
    }

    fn published(path: &Path, limits: &CheckpointLimits, device: &Device) -> Result<Self, Error> {
        let origin = Origin::of(path, path, limits.bytes)?;
        let (network, arguments) = read_published(path, limits, device)?;
        Ok(Self {
            origin,
            network,
            diffusion_steps: arguments.diffusion_steps,
            signal: 1.0,
            text_encoder: Some(arguments.text_encoder().to_owned()),
            statistics: None,
            captions: None,
        })
    }

    fn state(path: &Path, device: &Device) -> Result<Self, Error> {
        let beside = path.with_file_name("plan.json");
        let plan = physique_files::read_file(&beside, 1 << 20)?;
        let plan: MdmPlan = serde_json::from_slice(&plan).map_err(|problem| Error::Checkpoint {
            file: beside,
            place: format!("line {}", problem.line()),
            expected: "the plan of the run".into(),
            found: problem.to_string(),
        })?;
        let parameters = read_network(path)?;
        plan.network.check()?;
        plan.network.check_size(parameters.count())?;
        let network = Mdm::new(&plan.network, 0, device)?;
        Ok(Self {
            origin: Origin::of(path, path, u64::MAX)?,
            network: parameters.load(network, "MDM", &[])?,
            diffusion_steps: plan.training.diffusion_steps,
            signal: plan.training.signal,
            text_encoder: None,
            statistics: None,
            captions: None,
        })
    }

    /// The network on another device, for a run of this shape.
    ///
    /// # Errors
    /// Those of [`StartingNetwork::check`].
    pub fn network(&self, config: &MdmConfig, device: &Device) -> Result<Mdm, Error> {
        self.check(config)?;
        let parameters = parameters_of(&self.network, &self.origin.path)?;
        parameters.load(Mdm::new(config, 0, device)?, "MDM", PUBLISHED_NAMES)
    }

    /// Whether a network of this shape can start so.
    ///
    /// # Errors
    /// [`Error::Checkpoint`] with the first setting of the shape that is another; dropout may be.
    pub fn check(&self, config: &MdmConfig) -> Result<(), Error> {
        let settings = |config: &MdmConfig| {
            let value = serde_json::to_value(config).map_err(|problem| self.refuse("", problem))?;
            let settings = value.as_object().cloned();
            Ok::<_, Error>(settings.unwrap_or_default())
        };
        let (ours, theirs) = (settings(config)?, settings(self.network.config())?);
        let other = ours.iter().find(|(name, setting)| {
            !FREE.contains(&name.as_str()) && theirs.get(*name) != Some(setting)
        });
        let Some((name, setting)) = other else {
            return Ok(());
        };
        let found = theirs.get(name).cloned().unwrap_or_default();
        Err(Error::Checkpoint {
            file: PathBuf::from(&self.origin.path),
            place: format!("the network's {name}"),
            expected: format!("{setting}, as in the plan of the run"),
            found: found.to_string(),
        })
    }

    fn refuse(&self, place: &str, found: impl ToString) -> Error {
        Error::Checkpoint {
            file: PathBuf::from(&self.origin.path),
            place: place.to_owned(),
            expected: "the shape of a network".into(),
            found: found.to_string(),
        }
    }
}

impl Origin {
    /// Of a folder or file whose weights are in the file `weights`.
    fn of(path: &Path, weights: &Path, limit: u64) -> Result<Self, Error> {
        let bytes = physique_files::read_file(weights, limit)?;
        let digest = Sha256::digest(&bytes);
        Ok(Self {
            path: path.display().to_string(),
            sha256: digest.iter().map(|byte| format!("{byte:02x}")).collect(),
        })
    }
}

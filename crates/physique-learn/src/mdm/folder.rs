//! Our own files of a network: a folder with all that is needed to use it.

use std::collections::BTreeMap;
use std::path::Path;

use burn::tensor::Device;
use physique_motion::Limits;
use physique_motion::features::FeatureStatistics;
use serde::{Deserialize, Serialize};

use super::{ConditionKind, Mdm, MdmConfig, PUBLISHED_NAMES, parameters_of, read_published};
use crate::Error;
use crate::checkpoint::{CheckpointLimits, Precision, parse_safetensors, write_safetensors};
use crate::folders::{self, CONFIG, DEVIATION, MEAN};
use crate::text::KnownCaptions;

const FORMAT: &str = "physique-mdm 1";
pub(super) const NETWORK: &str = "model.safetensors";
const CAPTIONS: &str = "captions.safetensors";
/// The note of networks that guidance means nothing to.
const UNGUIDED: &str = "unguided";
/// The longest window of the published data sets.
const PUBLISHED_FRAMES: usize = 196;

/// A network with what it takes to use it.
#[derive(Clone, Debug)]
pub struct MdmFolder {
    /// The network.
    pub network: Mdm,
    /// What its motions are normalised by.
    pub statistics: FeatureStatistics,
    /// What it was told in training; `None` where that is not known, or nothing.
    pub captions: Option<KnownCaptions>,
    /// What else there is to know.
    pub description: MdmDescription,
}

/// What there is to know of a network besides its shape and numbers.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct MdmDescription {
    /// Frames a second of its motions.
    pub frame_rate: f64,
    /// Frames of the longest motion that it was trained with, if that is known.
    pub longest_frames: Option<usize>,
    /// Steps of diffusion that it was trained with.
    pub diffusion_steps: usize,
    /// Factor of the schedule's signal-to-noise ratio, see
    /// [`Schedule::with_signal`](crate::diffusion::Schedule::with_signal).
    pub signal: f64,
    /// Name of the text encoder; empty for networks without captions.
    pub text_encoder: String,
    /// Data, licence and the like, by name.
    pub notes: BTreeMap<String, String>,
}

/// The content of `config.json`.
#[derive(Debug, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
struct Config {
    format: String,
    network: MdmConfig,
    description: MdmDescription,
}

impl MdmFolder {
    /// Writes `model.safetensors` under the published names, `config.json`, `mean.npy`, `std.npy`
    /// and, where captions are known, `captions.safetensors` into a folder, which is made. Each file
    /// is written whole or not at all, the configuration last: a folder that has one is whole.
    ///
    /// # Errors
    /// [`Error::File`].
    pub fn write(&self, folder: &Path, precision: Precision) -> Result<(), Error> {
        folders::make(folder)?;
        let parameters = parameters_of(&self.network, "the network")?;
        let words = BTreeMap::from([("format".to_owned(), FORMAT.to_owned())]);
        write_safetensors(&folder.join(NETWORK), &parameters, words, precision)?;
        if let Some(captions) = &self.captions {
            captions.write(&folder.join(CAPTIONS))?;
        }
        folders::write_statistics(folder, &self.statistics)?;
        let config = Config {
            format: FORMAT.into(),
            network: self.network.config().clone(),
            description: self.description.clone(),
        };
        folders::write_config(folder, &config)
    }

    /// Reads what [`MdmFolder::write`] wrote.
    ///
    /// # Errors
    /// [`Error::File`] for a file that is missing; [`Error::Checkpoint`] for one that is broken;
    /// [`Error::Parameters`] and [`Error::ParameterShape`] for numbers of another network;
    /// [`Error::Motion`] for statistics that are none; [`Error::Input`] for those of other features.
    pub fn read(folder: &Path, limits: &CheckpointLimits, device: &Device) -> Result<Self, Error> {
        let file = |name: &str| match folder.join(name) {
            path if name == CAPTIONS && !path.exists() => Ok(None),
            path => Ok(Some(physique_files::read_file(&path, limits.bytes)?)),
        };
        Self::parse(folder, file, limits, device)
    }

    /// A published checkpoint, with `args.json` beside it, and the statistics of its data set
    /// (`Mean.npy`, `Std.npy`), which the file does not hold.
    ///
    /// # Errors
    /// As [`read_published`]; [`Error::Input`] for statistics of other features.
    pub fn published(
        path: &Path,
        statistics: FeatureStatistics,
        limits: &CheckpointLimits,
        device: &Device,
    ) -> Result<Self, Error> {
        let (network, arguments) = read_published(path, limits, device)?;
        let config = network.config();
        check_statistics(&statistics, config)?;
        let notes = (arguments.cond_mask_prob == 0.0).then(|| {
            (
                UNGUIDED.to_owned(),
                "trained with its condition only".to_owned(),
            )
        });
        let text_encoder = match config.condition {
            ConditionKind::Sentence { .. } | ConditionKind::Tokens { .. } => {
                arguments.text_encoder().to_owned()
            }
            _ => String::new(),
        };
        Ok(Self {
            description: MdmDescription {
                frame_rate: statistics.skeleton().frames_per_second(),
                longest_frames: config.planner.is_none().then_some(PUBLISHED_FRAMES),
                diffusion_steps: arguments.diffusion_steps,
                signal: 1.0,
                text_encoder,
                notes: notes.into_iter().collect(),
            },
            network,
            statistics,
            captions: None,
        })
    }

    /// Whether there is nothing to guide by: the network never learnt without its condition.
    pub(super) fn is_unguided(&self) -> bool {
        self.description.notes.contains_key(UNGUIDED)
    }

    /// As [`MdmFolder::read`], of files that `file` gives by name; the folder only names them in
    /// errors.
    ///
    /// # Errors
    /// As [`MdmFolder::read`], and those of `file`.
    pub fn parse(
        folder: &Path,
        file: impl Fn(&str) -> Result<Option<Vec<u8>>, Error>,
        limits: &CheckpointLimits,
        device: &Device,
    ) -> Result<Self, Error> {
        let path = folder.join(CONFIG);
        let refuse = |place: String, found: String| Error::Checkpoint {
            file: path.clone(),
            place,
            expected: format!("the configuration of a network, `{FORMAT}`"),
            found,
        };
        let needed = |name: &str| match file(name)? {
            Some(bytes) => Ok((folder.join(name), bytes)),
            None => Err(refuse(format!("`{name}` beside it"), "no such file".into())),
        };
        let (_, text) = needed(CONFIG)?;
        let config: Config = serde_json::from_slice(&text)
            .map_err(|problem| refuse(format!("line {}", problem.line()), problem.to_string()))?;
        if config.format != FORMAT {
            return Err(refuse("`format`".into(), format!("{:?}", config.format)));
        }
        let (path, bytes) = needed(NETWORK)?;
        let (parameters, _) = parse_safetensors(&bytes, &path, limits)?;
        config.network.check()?;
        config.network.check_size(parameters.count())?;
        let network = Mdm::new(&config.network, 0, device)?;
        let network = parameters.load(network, "MDM", PUBLISHED_NAMES)?;
        let (mean, deviation) = (needed(MEAN)?, needed(DEVIATION)?);
        let statistics = FeatureStatistics::parse(
            (&mean.0, mean.1),
            (&deviation.0, deviation.1),
            &Limits::default(),
        )?;
        check_statistics(&statistics, &config.network)?;
        let captions = match file(CAPTIONS)? {
            Some(bytes) => Some(KnownCaptions::parse(
                &bytes,
                &folder.join(CAPTIONS),
                limits,
            )?),
            None => None,
        };
        Ok(Self {
            network,
            statistics,
            captions,
            description: config.description,
        })
    }
}

/// Whether statistics are of the columns that the network has.
fn check_statistics(statistics: &FeatureStatistics, config: &MdmConfig) -> Result<(), Error> {
    let found = statistics.mean().len();
    if found == config.columns {
        return Ok(());
    }
    let expected = format!("{} columns, as the network has", config.columns);
    Err(Error::input("Statistics", expected, found))
}

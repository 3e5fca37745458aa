//! An evaluator with all that is needed to use it, and its files.

use std::collections::BTreeMap;
use std::path::Path;

use burn::tensor::Device;
use physique_data::Caption;
use physique_motion::Limits;
use physique_motion::features::FeatureStatistics;
use physique_text::{MiniLm, TextEncoder as _};
use serde::{Deserialize, Serialize};

use super::{SentenceConfig, SentenceNetworks};
use crate::Error;
use crate::checkpoint::{CheckpointLimits, Precision, read_safetensors, write_safetensors};
use crate::evaluation::motion_side::points;
use crate::evaluation::{CaptionReading, PairEvaluator, Points};
use crate::folders::{self, CONFIG, DEVIATION, MEAN};
use crate::layers::Dropout;
use crate::tensors::tensor;
use crate::text::{CaptionCentre, PromptEncoder};

const FORMAT: &str = "physique-evaluator 1";
const NETWORKS: &str = "model.safetensors";

/// Networks, what motions are normalised by, and what reads captions.
#[derive(Debug)]
pub struct SentenceEvaluator {
    networks: SentenceNetworks,
    statistics: FeatureStatistics,
    prompts: PromptEncoder,
    notes: BTreeMap<String, String>,
}

/// The content of `config.json`.
#[derive(Debug, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
struct Config {
    format: String,
    networks: SentenceConfig,
    text_encoder: String,
    captions: Centre,
    notes: BTreeMap<String, String>,
}

/// What is done to encoded captions.
#[derive(Debug, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
struct Centre {
    factor: f32,
    mean: Vec<f32>,
}

impl SentenceEvaluator {
    /// Puts an evaluator together; `notes` say what it was trained on, and the like.
    ///
    /// # Errors
    /// [`Error::Input`] when networks, statistics and captions are of different widths, or captions
    /// have no centre.
    pub fn new(
        networks: SentenceNetworks,
        statistics: FeatureStatistics,
        prompts: PromptEncoder,
        notes: BTreeMap<String, String>,
    ) -> Result<Self, Error> {
        let SentenceConfig { columns, text, .. } = *networks.config();
        for (what, expected, found) in [
            ("Statistics", columns, statistics.mean().len()),
            ("Encoded captions", text, prompts.encoder().width()),
        ] {
            if found != expected {
                let expected = format!("{expected} numbers, as the networks read");
                return Err(Error::input(what, expected, found));
            }
        }
        if prompts.centre().is_none() {
            return Err(Error::input("Encoded captions", "a centre", "none"));
        }
        Ok(Self {
            networks,
            statistics,
            prompts,
            notes,
        })
    }

    /// What it was trained on, and the like.
    pub const fn notes(&self) -> &BTreeMap<String, String> {
        &self.notes
    }

    /// Writes `model.safetensors`, `mean.npy`, `std.npy` and `config.json` into a folder, which is
    /// made. Each file is written whole or not at all, the configuration last: a folder that has one
    /// is whole.
    ///
    /// # Errors
    /// [`Error::File`].
    pub fn write(&self, folder: &Path) -> Result<(), Error> {
        folders::make(folder)?;
        let words = BTreeMap::from([("format".to_owned(), FORMAT.to_owned())]);
        let parameters = self.networks.parameters()?;
        write_safetensors(
            &folder.join(NETWORKS),
            &parameters,
            words,
            Precision::Single,
        )?;
        folders::write_statistics(folder, &self.statistics)?;
        let centre = self.prompts.centre();
        let config = Config {
            format: FORMAT.into(),
            networks: self.networks.config().clone(),
            text_encoder: self.prompts.encoder().name().into(),
            captions: Centre {
                factor: centre.map_or(1.0, CaptionCentre::factor),
                mean: centre.map_or_else(Vec::new, |centre| centre.mean().to_vec()),
            },
            notes: self.notes.clone(),
        };
        folders::write_config(folder, &config)
    }

    /// Reads what [`SentenceEvaluator::write`] wrote.
    ///
    /// # Errors
    /// [`Error::File`] for a file that is missing; [`Error::Checkpoint`] for one that is broken, or
    /// for a text encoder that is not embedded; [`Error::Parameters`] and [`Error::ParameterShape`]
    /// for numbers of other networks; [`Error::Motion`] and [`Error::Input`] for statistics of other
    /// features.
    pub fn read(folder: &Path, limits: &CheckpointLimits, device: &Device) -> Result<Self, Error> {
        let path = folder.join(CONFIG);
        let text = physique_files::read_file(&path, 1 << 20)?;
        let refuse = |place: String, expected: &str, found: String| Error::Checkpoint {
            file: path.clone(),
            place,
            expected: expected.to_owned(),
            found,
        };
        let config: Config = serde_json::from_slice(&text).map_err(|problem| {
            let expected = format!("the configuration of an evaluator, `{FORMAT}`");
            refuse(
                format!("line {}", problem.line()),
                &expected,
                problem.to_string(),
            )
        })?;
        if config.format != FORMAT {
            let found = format!("{:?}", config.format);
            return Err(refuse("`format`".into(), FORMAT, found));
        }
        let encoder = MiniLm::embedded()?;
        if config.text_encoder != encoder.name() {
            let found = format!("{:?}", config.text_encoder);
            return Err(refuse("`text_encoder`".into(), encoder.name(), found));
        }
        let (parameters, _) = read_safetensors(&folder.join(NETWORKS), limits)?;
        let widest = config.networks.columns.max(config.networks.text);
        if widest > WIDEST_INPUT {
            let expected = format!("at most {WIDEST_INPUT} numbers");
            let place = "`columns` and `text`".to_owned();
            return Err(refuse(place, &expected, widest.to_string()));
        }
        let networks = SentenceNetworks::new(&config.networks, 0, device)?;
        let statistics = [MEAN, DEVIATION].map(|name| folder.join(name));
        let statistics =
            FeatureStatistics::read(&statistics[0], &statistics[1], &Limits::default())?;
        let centre = CaptionCentre::new(config.captions.mean, config.captions.factor)?;
        let prompts = PromptEncoder::new(Box::new(encoder), Some(centre))?;
        let networks = networks.with_parameters(parameters)?;
        Self::new(networks, statistics, prompts, config.notes)
    }
}

/// Widest input that a file may ask for.
const WIDEST_INPUT: usize = 1 << 13;

impl PairEvaluator for SentenceEvaluator {
    fn about(&self) -> String {
        let notes = self
            .notes
            .iter()
            .map(|(name, note)| format!("{name} {note}"));
        let notes = notes.collect::<Vec<_>>().join(", ");
        format!("Physique's own, which reads sentences ({notes})")
    }

    fn statistics(&self) -> &FeatureStatistics {
        &self.statistics
    }

    fn embed_motions(
        &self,
        motions: &[f32],
        frames: usize,
        lengths: &[usize],
    ) -> Result<Points, Error> {
        let dropout = Dropout::none();
        points(
            self.networks
                .embed_motions(motions, frames, lengths, &dropout)?,
        )
    }

    fn embed_captions(
        &self,
        captions: &[&Caption],
        reading: CaptionReading,
    ) -> Result<Points, Error> {
        if reading != CaptionReading::Whole {
            let expected = "a published evaluator, which reads word by word";
            return Err(Error::setting("caption_length_bug", expected, "this one"));
        }
        let texts: Vec<&str> = captions
            .iter()
            .map(|caption| caption.text.as_str())
            .collect();
        let captions = self.prompts.encode(&texts)?;
        let shape = [captions.batch, captions.width];
        let captions = tensor(captions.values, shape, &self.networks.device());
        points(self.networks.embed_captions(captions))
    }
}

//! What a network was told in training, to know what it knows.

use std::collections::BTreeMap;
use std::path::Path;

use physique_text::{CaptionIndex, TextEncoder};

use super::{CaptionCentre, PromptEncoder};
use crate::Error;
use crate::checkpoint::{CheckpointLimits, Precision, parse_safetensors, write_safetensors};
use crate::parameters::{ParameterArray, Parameters};

const DIRECTIONS: &str = "directions";
const MEAN: &str = "mean";
const CENTRE: &str = "centre";
const FACTOR: &str = "centre_factor";
const TEXTS: &str = "captions";
const USUAL: &str = "usual_distance";

/// Training captions, kept beside a network: what its vectors are centred by, and what prompts are
/// compared with.
#[derive(Clone, Debug)]
pub struct KnownCaptions {
    texts: Vec<String>,
    index: CaptionIndex,
    usual_distance: f32,
    centre: Option<CaptionCentre>,
}

/// The training caption that is nearest to a prompt.
#[derive(Clone, Debug, PartialEq)]
pub struct NearestCaption {
    /// The caption.
    pub text: String,
    /// 0: the same; 1: nothing in common.
    pub distance: f32,
    /// Whether other wordings of what the network knows are seldom as far.
    pub unusual: bool,
}

impl KnownCaptions {
    /// Keeps training captions. `other_wordings` say the same in words that training has not used:
    /// how far they are tells from where on a prompt is about something else; without them the limit
    /// is a distance of 0.5.
    ///
    /// Cost: encoding all of them.
    ///
    /// # Errors
    /// [`Error::Text`] without captions.
    pub fn new(
        prompts: &PromptEncoder,
        training: &[&str],
        other_wordings: &[&str],
    ) -> Result<Self, Error> {
        let index = CaptionIndex::new(prompts.encoder(), training)?;
        let usual = index.usual_distance(prompts.encoder(), other_wordings);
        Ok(Self {
            texts: training.iter().map(|&text| text.to_owned()).collect(),
            usual_distance: usual.unwrap_or(0.5),
            centre: prompts.centre().cloned(),
            index,
        })
    }

    /// The captions.
    pub fn texts(&self) -> &[String] {
        &self.texts
    }

    /// The distance that other wordings seldom exceed.
    pub const fn usual_distance(&self) -> f32 {
        self.usual_distance
    }

    /// What sentence vectors are centred by.
    pub const fn centre(&self) -> Option<&CaptionCentre> {
        self.centre.as_ref()
    }

    /// The nearest training caption to a prompt.
    pub fn nearest(&self, encoder: &dyn TextEncoder, prompt: &str) -> Option<NearestCaption> {
        let found = self.index.nearest(encoder, &[prompt]).pop()?;
        Some(NearestCaption {
            text: self.texts.get(found.caption)?.clone(),
            distance: found.distance,
            unusual: found.distance > self.usual_distance,
        })
    }

    /// Writes them, whole or not at all, in 16 bits a number.
    ///
    /// # Errors
    /// [`Error::File`].
    pub fn write(&self, path: &Path) -> Result<(), Error> {
        let width = self.index.mean().len();
        let mut arrays = BTreeMap::new();
        let mut add = |name: &str, shape: Vec<usize>, values: &[f32]| {
            let values = values.to_vec();
            arrays.insert(name.to_owned(), ParameterArray { shape, values });
        };
        let directions = self.index.directions();
        add(DIRECTIONS, vec![self.texts.len(), width], directions);
        add(MEAN, vec![width], self.index.mean());
        if let Some(centre) = &self.centre {
            add(CENTRE, vec![width], centre.mean());
        }
        let mut words = BTreeMap::from([
            (USUAL.to_owned(), self.usual_distance.to_string()),
            (TEXTS.to_owned(), self.texts.join("\n")),
        ]);
        if let Some(centre) = &self.centre {
            words.insert(FACTOR.to_owned(), centre.factor().to_string());
        }
        let parameters = Parameters {
            source: String::new(),
            arrays,
        };
        write_safetensors(path, &parameters, words, Precision::Half)
    }

    /// Takes the bytes of what [`Self::write`] wrote; the path only names them in errors.
    ///
    /// # Errors
    /// [`Error::Checkpoint`].
    pub fn parse(bytes: &[u8], path: &Path, limits: &CheckpointLimits) -> Result<Self, Error> {
        let (mut parameters, words) = parse_safetensors(bytes, path, limits)?;
        let refuse = |place: &str, expected: &str, found: String| Error::Checkpoint {
            file: path.into(),
            place: format!("`{place}`"),
            expected: expected.into(),
            found,
        };
        let word = |name: &str| {
            let word = words.get(name).map(String::as_str);
            word.ok_or_else(|| refuse(name, "a word in the header", "none".into()))
        };
        let number = |name: &str| {
            let word = word(name)?;
            let number: Option<f32> = word.parse().ok().filter(|number: &f32| number.is_finite());
            number.ok_or_else(|| refuse(name, "a finite number", word.escape_debug().to_string()))
        };
        let texts: Vec<String> = word(TEXTS)?.split('\n').map(str::to_owned).collect();
        let mut array = |name: &str| {
            let array = parameters.arrays.remove(name);
            let array = array.ok_or_else(|| refuse(name, "an array", "none".into()))?;
            let finite = array.values.iter().all(|value| value.is_finite());
            match finite {
                true => Ok(array),
                false => Err(refuse(name, "finite numbers", "others".into())),
            }
        };
        let mean = array(MEAN)?.values;
        let directions = array(DIRECTIONS)?;
        if directions.shape != [texts.len(), mean.len()] {
            let expected = format!("shape [{}, {}]", texts.len(), mean.len());
            return Err(refuse(
                DIRECTIONS,
                &expected,
                format!("{:?}", directions.shape),
            ));
        }
        let centre = match words.contains_key(FACTOR) {
            true => Some(CaptionCentre::new(array(CENTRE)?.values, number(FACTOR)?)?),
            false => None,
        };
        Ok(Self {
            usual_distance: number(USUAL)?,
            index: CaptionIndex::from_parts(mean, directions.values)?,
            texts,
            centre,
        })
    }
}

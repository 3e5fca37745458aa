//! Captions word by word, as published evaluators read them.

mod part_of_speech;

use std::collections::HashMap;
use std::path::{Path, PathBuf};

use physique_data::Caption;
use physique_files::npz::{Array, ArrayLimits};
use physique_files::pickle::{Pickle, PickleLimits, View};

use self::part_of_speech::PartOfSpeech;
use super::networks::WORD;
use super::{CaptionReading, CaptionWords};
use crate::Error;

/// Words of a caption that are read.
const LONGEST: usize = 20;
/// With those that mark start and end.
const PADDED: usize = LONGEST + 2;

/// Vectors of words: the `glove` folder of HumanML3D's users, `our_vab_data.npy`, `our_vab_words.pkl`
/// and `our_vab_idx.pkl`, read as data.
#[derive(Clone, Debug)]
pub struct WordVectors {
    /// `[words][300]`.
    vectors: Vec<f32>,
    rows: HashMap<String, usize>,
    start: usize,
    end: usize,
    unknown: usize,
}

/// What files of word vectors may ask for.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct WordLimits {
    /// Bytes of each file.
    pub bytes: u64,
    /// Words.
    pub words: usize,
}

impl Default for WordLimits {
    /// 1 GiB, a million words: GloVe as a whole.
    fn default() -> Self {
        Self {
            bytes: 1 << 30,
            words: 1 << 20,
        }
    }
}

impl WordVectors {
    /// Reads the three files of a folder.
    ///
    /// # Errors
    /// [`Error::File`] for a file that is missing or too large; [`Error::Content`] for one that is
    /// broken or holds more than data; [`Error::Words`] where they do not fit each other, or the
    /// words `sos`, `eos` and `unk` are missing.
    pub fn read(folder: &Path, limits: &WordLimits) -> Result<Self, Error> {
        let [data, words, indices] =
            ["data.npy", "words.pkl", "idx.pkl"].map(|name| folder.join(format!("our_vab_{name}")));
        let (vectors, count) = vectors(&data, limits)?;
        let rows = rows(&indices, count, limits)?;
        let pickle = pickle(&words, limits)?;
        let refuse = |expected: &str, found: String| refuse(&words, expected, found);
        let Some(known) = pickle.root().list() else {
            return Err(refuse("a list of words", pickle.root().kind().into()));
        };
        let mut of_words = HashMap::with_capacity(known.len());
        for word in known.iter() {
            let word = word
                .text()
                .ok_or_else(|| refuse("words", word.kind().into()))?;
            let row = rows.get(word).copied();
            let row = row.ok_or_else(|| {
                let found = format!("{:?}, which has none", shown(word));
                refuse("words that have a number in our_vab_idx.pkl", found)
            })?;
            of_words.insert(word.to_owned(), row);
        }
        let mark = |word: &str| {
            let row = of_words.get(word).copied();
            row.ok_or_else(|| refuse("the words sos, eos and unk", format!("no {word}")))
        };
        Ok(Self {
            vectors,
            start: mark("sos")?,
            end: mark("eos")?,
            unknown: mark("unk")?,
            rows: of_words,
        })
    }

    /// Captions as the text encoder reads them: at most 20 words between marks of start and end,
    /// padded with unknown words.
    ///
    /// # Errors
    /// [`Error::Input`] for captions without `lemma/POS` words.
    pub fn vectorise(
        &self,
        captions: &[&Caption],
        reading: CaptionReading,
    ) -> Result<CaptionWords, Error> {
        let mut words = CaptionWords {
            words: PADDED,
            vectors: Vec::with_capacity(captions.len() * PADDED * WORD),
            parts_of_speech: Vec::with_capacity(captions.len() * PADDED),
            lengths: Vec::with_capacity(captions.len()),
        };
        let other = PartOfSpeech::OTHER;
        for caption in captions {
            let mut read = vec![(self.start, other)];
            let tokens = caption.tokens.as_deref().ok_or_else(|| {
                let found = format!("only {:?}", caption.text);
                Error::input("Caption", "its words as `lemma/POS`", found)
            })?;
            for token in tokens.split_whitespace().take(LONGEST) {
                let Some((word, tag)) = token.rsplit_once('/') else {
                    let found = format!("{:?}", shown(token));
                    return Err(Error::input("Word of a caption", "`lemma/POS`", found));
                };
                read.push(match self.rows.get(word) {
                    Some(&row) => (row, PartOfSpeech::of(word, tag)),
                    None => (self.unknown, other),
                });
            }
            read.push((self.end, other));
            words.lengths.push(match reading {
                CaptionReading::Whole => read.len(),
                CaptionReading::WithPadding => PADDED,
            });
            read.resize(PADDED, (self.unknown, other));
            for (row, part) in read {
                words
                    .vectors
                    .extend_from_slice(&self.vectors[row * WORD..][..WORD]);
                words.parts_of_speech.push(part.column());
            }
        }
        Ok(words)
    }
}

/// `[words][300]`, and how many words.
fn vectors(path: &Path, limits: &WordLimits) -> Result<(Vec<f32>, usize), Error> {
    let bytes = physique_files::read_file(path, limits.bytes)?;
    let array_limits = ArrayLimits {
        bytes: limits.bytes,
        ..ArrayLimits::default()
    };
    let array = Array::from_npy("our_vab_data", bytes, &array_limits);
    let array = array.map_err(|problem| content(path, problem))?;
    let &[count, WORD] = array.shape() else {
        let found = format!("shape {:?}", array.shape());
        return Err(refuse(path, "a vector of 300 numbers a word", found));
    };
    if count > limits.words {
        let expected = format!("at most {} words", limits.words);
        return Err(refuse(path, &expected, count.to_string()));
    }
    let vectors = array.to_f32().map_err(|problem| content(path, problem))?;
    if let Some(at) = vectors.iter().position(|number| !number.is_finite()) {
        let found = format!("{} in row {}", vectors[at], at / WORD);
        return Err(refuse(path, "finite numbers", found));
    }
    Ok((vectors, count))
}

/// Row of each word, below `count`.
fn rows(path: &Path, count: usize, limits: &WordLimits) -> Result<HashMap<String, usize>, Error> {
    let pickle = pickle(path, limits)?;
    let View::Dict(_) = pickle.root().view() else {
        let found = pickle.root().kind().into();
        return Err(refuse(path, "a dictionary of words", found));
    };
    let mut rows = HashMap::new();
    for (word, row) in pickle.root().entries() {
        let Some(word) = word.text() else {
            return Err(refuse(path, "words", word.kind().into()));
        };
        let place = row.number().filter(|row| row.fract() == 0.0 && *row >= 0.0);
        let place = place.map(|row| row as usize).filter(|row| *row < count);
        let Some(place) = place else {
            let found = format!("{row:?} for {:?}", shown(word));
            return Err(refuse(path, &format!("rows below {count}"), found));
        };
        rows.insert(word.to_owned(), place);
    }
    Ok(rows)
}

fn pickle(path: &Path, limits: &WordLimits) -> Result<Pickle, Error> {
    let bytes = physique_files::read_file(path, limits.bytes)?;
    let limits = PickleLimits {
        bytes: limits.bytes,
        // A word, its number, and the containers.
        values: limits.words.saturating_mul(2).saturating_add(16),
        ..PickleLimits::default()
    };
    Pickle::read(bytes, &limits).map_err(|problem| content(path, problem))
}

fn content(path: &Path, problem: impl Into<physique_files::Error>) -> Error {
    Error::Content {
        file: path.into(),
        problem: Box::new(problem.into()),
    }
}

fn refuse(path: &Path, expected: &str, found: String) -> Error {
    Error::Words {
        file: PathBuf::from(path),
        expected: expected.to_owned(),
        found,
    }
}

/// The beginning of a word from a stranger.
fn shown(word: &str) -> String {
    word.chars().take(40).collect()
}

//! BERT's word pieces (Wu et al., 2016), for models of lower-case words.

use std::path::Path;

use physique_files::read_file;
use unicode_normalization::UnicodeNormalization as _;

use super::letters::{is_accent, is_control, is_punctuation, is_word_sign};
use super::vocabulary::{Numbers, json, numbers, text, wrong};
use crate::{Error, TextLimits};

/// Letters of a word that are looked at; a longer one is unknown.
const LONGEST_WORD: usize = 100;

/// Lower-case words without accents, cut into the longest pieces that the vocabulary knows.
///
/// Equal to Hugging Face's tokenizer of `bert-base-uncased` and its kin.
#[derive(Clone, Debug)]
pub struct WordPieces {
    numbers: Numbers,
    start: u32,
    end: u32,
    unknown: u32,
    /// One more than the greatest number.
    count: usize,
}

impl WordPieces {
    /// Reads `vocab.txt`, or else `tokenizer.json`, of a folder.
    ///
    /// # Errors
    /// [`Error::Missing`], [`Error::File`], and [`Error::Format`] for a vocabulary without `[CLS]`,
    /// `[SEP]` and `[UNK]`.
    pub fn read(folder: &Path, limits: &TextLimits) -> Result<Self, Error> {
        let list = folder.join("vocab.txt");
        if list.exists() {
            return Self::from_list(&read_file(&list, limits.text_bytes)?, &list);
        }
        let file = folder.join("tokenizer.json");
        if !file.exists() {
            return Err(Error::Missing {
                folder: folder.into(),
                expected: "vocab.txt or tokenizer.json",
            });
        }
        let value = json(&read_file(&file, limits.text_bytes)?, &file)?;
        Self::new(numbers(&value["model"]["vocab"], &file)?, &file)
    }

    /// Understands a list with one piece a line, counted from 0; `path` names it in errors.
    ///
    /// # Errors
    /// [`Error::Format`].
    pub fn from_list(bytes: &[u8], path: &Path) -> Result<Self, Error> {
        let pieces = text(bytes, path)?.lines().zip(0..);
        Self::new(
            pieces
                .map(|(piece, number)| (piece.to_owned(), number))
                .collect(),
            path,
        )
    }

    fn new(numbers: Numbers, path: &Path) -> Result<Self, Error> {
        let special = |piece: &str| {
            let number = numbers.get(piece).copied();
            number.ok_or_else(|| wrong(path, "vocabulary".into(), piece, "none".into()))
        };
        Ok(Self {
            start: special("[CLS]")?,
            end: special("[SEP]")?,
            unknown: special("[UNK]")?,
            count: numbers.values().max().map_or(0, |&most| most as usize + 1),
            numbers,
        })
    }

    /// One more than the greatest number of a piece.
    pub(crate) const fn vocabulary(&self) -> usize {
        self.count
    }

    /// Numbers of a caption's pieces between `[CLS]` and `[SEP]`, at most `longest` with these.
    pub fn encode(&self, caption: &str, longest: usize) -> Vec<u32> {
        let mut found = vec![self.start];
        for word in words(caption) {
            self.pieces(&word, &mut found);
            // What comes later is cut off anyway.
            if found.len() >= longest {
                break;
            }
        }
        found.truncate(longest.saturating_sub(1).max(1));
        found.push(self.end);
        found
    }

    /// Adds a word's pieces, each the longest that fits; those after the first begin with `##`.
    fn pieces(&self, word: &str, found: &mut Vec<u32>) {
        let before = found.len();
        if word.chars().count() > LONGEST_WORD {
            found.push(self.unknown);
            return;
        }
        let mut rest = word;
        while !rest.is_empty() {
            let prefix = if rest.len() == word.len() { "" } else { "##" };
            let ends = rest
                .char_indices()
                .rev()
                .map(|(at, letter)| at + letter.len_utf8());
            let piece = ends.into_iter().find_map(|end| {
                let number = self.numbers.get(&format!("{prefix}{}", &rest[..end]));
                number.map(|&number| (number, end))
            });
            let Some((number, end)) = piece else {
                found.truncate(before);
                found.push(self.unknown);
                return;
            };
            found.push(number);
            rest = &rest[end..];
        }
    }
}

/// Lower-case words and signs.
fn words(caption: &str) -> Vec<String> {
    let mut spaced = String::with_capacity(caption.len());
    for letter in caption.chars() {
        match letter {
            '\0' | '\u{fffd}' => {}
            letter if is_control(letter) => {}
            letter if letter.is_whitespace() => spaced.push(' '),
            letter if is_word_sign(letter) => spaced.extend([' ', letter, ' ']),
            letter => spaced.push(letter),
        }
    }
    let plain = spaced.nfd().filter(|&letter| !is_accent(letter));
    let mut words = Vec::new();
    let mut word = String::new();
    for letter in plain.flat_map(char::to_lowercase) {
        if letter.is_whitespace() || is_punctuation(letter) {
            if !word.is_empty() {
                words.push(std::mem::take(&mut word));
            }
            if !letter.is_whitespace() {
                words.push(letter.into());
            }
        } else {
            word.push(letter);
        }
    }
    if !word.is_empty() {
        words.push(word);
    }
    words
}

//! CLIP's pairs of bytes (Sennrich et al., 2016; Radford et al., 2021).

use std::collections::HashMap;
use std::path::Path;

use physique_files::{read_file, unpacked};

use super::letters::{is_letter, is_number};
use super::vocabulary::{Numbers, json, numbers, text, wrong};
use crate::{Error, TextLimits};

const START: &str = "<|startoftext|>";
const END: &str = "<|endoftext|>";
/// What the last piece of a word ends with.
const WORD_END: &str = "</w>";
/// Merges that CLIP takes of its list, whose first line is a heading.
const CLIP_MERGES: usize = 49_152 - 256 - 2;
/// English endings that are pieces by themselves.
const ENDINGS: [&str; 7] = ["'s", "'t", "'re", "'ve", "'m", "'ll", "'d"];

/// Lower-case words as bytes, of which pairs are put together in the order of a list.
///
/// Equal to OpenAI's tokenizer but for its repair of broken encodings (`ftfy`) and of HTML, neither of
/// which changes a sound caption.
#[derive(Clone, Debug)]
pub struct BytePairs {
    numbers: Numbers,
    /// Place of a pair in the list of merges.
    ranks: HashMap<(String, String), usize>,
    start: u32,
    end: u32,
}

impl BytePairs {
    /// Reads `vocab.json` with `merges.txt`, or `tokenizer.json`, of a folder, or OpenAI's
    /// `bpe_simple_vocab_16e6.txt`, packed (`.gz`) or not, in a folder or named outright.
    ///
    /// # Errors
    /// [`Error::Missing`], [`Error::File`], and [`Error::Format`] for files that are no such
    /// vocabulary.
    pub fn read(path: &Path, limits: &TextLimits) -> Result<Self, Error> {
        let read = |path: &Path| read_file(path, limits.text_bytes);
        if path.is_file() {
            return Self::from_openai(read(path)?, path, limits);
        }
        let (pieces, merges) = (path.join("vocab.json"), path.join("merges.txt"));
        if pieces.exists() && merges.exists() {
            let numbers = numbers(&json(&read(&pieces)?, &pieces)?, &pieces)?;
            let bytes = read(&merges)?;
            let lines = text(&bytes, &merges)?.lines();
            let lines = lines.filter(|line| !line.starts_with("#version") && !line.is_empty());
            return Self::new(numbers, ranks(lines, &merges)?, &pieces);
        }
        for name in ["bpe_simple_vocab_16e6.txt.gz", "bpe_simple_vocab_16e6.txt"] {
            let file = path.join(name);
            if file.exists() {
                return Self::from_openai(read(&file)?, &file, limits);
            }
        }
        let file = path.join("tokenizer.json");
        if file.exists() {
            return Self::from_tokenizer(&read(&file)?, &file);
        }
        Err(Error::Missing {
            folder: path.into(),
            expected: "vocab.json with merges.txt, tokenizer.json or bpe_simple_vocab_16e6.txt.gz",
        })
    }

    /// Hugging Face's single file.
    fn from_tokenizer(bytes: &[u8], path: &Path) -> Result<Self, Error> {
        let value = json(bytes, path)?;
        let model = &value["model"];
        let merges = model["merges"].as_array().map_or(&[][..], Vec::as_slice);
        // A merge is `"a b"`, or `["a", "b"]` in newer files.
        let lines = merges.iter().map(|merge| match merge.as_array() {
            Some(pair) => {
                let parts = pair.iter().map(|part| part.as_str().unwrap_or_default());
                parts.collect::<Vec<_>>().join(" ")
            }
            None => merge.as_str().unwrap_or_default().to_owned(),
        });
        let lines: Vec<String> = lines.collect();
        let ranks = ranks(lines.iter().map(String::as_str), path)?;
        Self::new(numbers(&model["vocab"], path)?, ranks, path)
    }

    /// OpenAI's list: a heading, then merges; numbers follow from their order.
    fn from_openai(bytes: Vec<u8>, path: &Path, limits: &TextLimits) -> Result<Self, Error> {
        let bytes = unpacked(bytes, limits.text_bytes).map_err(|problem| Error::Data {
            path: path.into(),
            problem,
        })?;
        let lines = text(&bytes, path)?.lines().skip(1).take(CLIP_MERGES);
        let lines: Vec<&str> = lines.collect();
        let letters = byte_letters();
        let bytes = letters.iter().map(|&(_, letter)| letter.to_string());
        let bytes: Vec<String> = bytes.collect();
        let ends = bytes.iter().map(|byte| format!("{byte}{WORD_END}"));
        let merged = lines.iter().map(|line| line.replace(' ', ""));
        let special = [START, END].map(str::to_owned);
        let pieces = bytes
            .iter()
            .cloned()
            .chain(ends)
            .chain(merged)
            .chain(special);
        let numbers = pieces.zip(0..).collect();
        Self::new(numbers, ranks(lines.into_iter(), path)?, path)
    }

    fn new(
        numbers: Numbers,
        ranks: HashMap<(String, String), usize>,
        path: &Path,
    ) -> Result<Self, Error> {
        let special = |piece: &str| {
            let number = numbers.get(piece).copied();
            number.ok_or_else(|| wrong(path, "vocabulary".into(), piece, "none".into()))
        };
        Ok(Self {
            start: special(START)?,
            end: special(END)?,
            numbers,
            ranks,
        })
    }

    /// One more than the greatest number of a piece.
    pub(crate) fn vocabulary(&self) -> usize {
        self.numbers
            .values()
            .max()
            .map_or(0, |&most| most as usize + 1)
    }

    /// Numbers of a caption's pieces between start and end, at most `longest` with these; what is too
    /// long is cut before the end.
    pub fn encode(&self, caption: &str, longest: usize) -> Vec<u32> {
        let letters = byte_letters();
        let letter_of = |byte: u8| {
            let found = letters.iter().find(|&&(of, _)| of == byte);
            found.map_or('?', |&(_, letter)| letter)
        };
        let lower = caption.to_lowercase();
        let mut found = vec![self.start];
        for word in words(&lower) {
            if found.len() >= longest {
                break;
            }
            let bytes: Vec<String> = word
                .bytes()
                .map(|byte| letter_of(byte).to_string())
                .collect();
            for piece in self.merged(bytes) {
                // Every single byte is a piece of a whole vocabulary; of a broken one nothing is.
                found.extend(self.numbers.get(&piece).copied());
            }
        }
        found.truncate(longest.saturating_sub(1).max(1));
        found.push(self.end);
        found
    }

    /// Puts pairs together, those first in the list before others.
    fn merged(&self, mut pieces: Vec<String>) -> Vec<String> {
        if let Some(last) = pieces.last_mut() {
            last.push_str(WORD_END);
        }
        loop {
            let pairs = pieces.windows(2).filter_map(|pair| {
                let key = (pair[0].clone(), pair[1].clone());
                self.ranks.get(&key).map(|&rank| (rank, key))
            });
            let Some((_, (first, second))) = pairs.min_by_key(|&(rank, _)| rank) else {
                return pieces;
            };
            let mut next = Vec::with_capacity(pieces.len());
            let mut rest = pieces.into_iter().peekable();
            while let Some(piece) = rest.next() {
                match rest.next_if(|after| piece == first && *after == second) {
                    Some(after) => next.push(piece + &after),
                    None => next.push(piece),
                }
            }
            pieces = next;
        }
    }
}

/// Places of pairs in a list of lines such as `i n`.
fn ranks<'a>(
    lines: impl Iterator<Item = &'a str>,
    path: &Path,
) -> Result<HashMap<(String, String), usize>, Error> {
    let pair = |(rank, line): (usize, &str)| {
        let (first, second) = line.split_once(' ').ok_or_else(|| {
            let place = format!("merge {rank}");
            wrong(path, place, "two pieces", format!("{line:?}"))
        })?;
        Ok(((first.to_owned(), second.to_owned()), rank))
    };
    lines.enumerate().map(pair).collect()
}

/// A printable letter for every byte, in the order of CLIP's vocabulary: those that print stand for
/// themselves, the others are letters from 256 on.
fn byte_letters() -> Vec<(u8, char)> {
    let prints = |byte: u8| matches!(byte, b'!'..=b'~' | 0xa1..=0xac | 0xae..=0xff);
    let (shown, hidden): (Vec<u8>, Vec<u8>) = (0..=255).partition(|&byte| prints(byte));
    let shown = shown.into_iter().map(|byte| (byte, char::from(byte)));
    let others = hidden.into_iter().zip('\u{100}'..);
    shown.chain(others).collect()
}

/// Words, single digits, runs of signs, and English endings.
fn words(text: &str) -> Vec<&str> {
    let mut words = Vec::new();
    let mut rest = text;
    while let Some(first) = rest.chars().next() {
        let special = [START, END].into_iter().chain(ENDINGS);
        let special = special
            .into_iter()
            .find(|special| rest.starts_with(special));
        let run = |is_part: &dyn Fn(char) -> bool| {
            rest.find(|letter| !is_part(letter)).unwrap_or(rest.len())
        };
        let length = if let Some(special) = special {
            special.len()
        } else if first.is_whitespace() {
            rest = &rest[first.len_utf8()..];
            continue;
        } else if is_letter(first) {
            run(&is_letter)
        } else if is_number(first) {
            first.len_utf8()
        } else {
            run(&|letter| !letter.is_whitespace() && !is_letter(letter) && !is_number(letter))
        };
        let (word, after) = rest.split_at(length);
        words.push(word);
        rest = after;
    }
    words
}

#[cfg(test)]
mod tests {
    use super::{byte_letters, words};

    #[test]
    fn words_are_those_of_clips_pattern() {
        let found = words("he's 2m tall, don't!! \u{1f600}ok");
        assert_eq!(
            found,
            [
                "he",
                "'s",
                "2",
                "m",
                "tall",
                ",",
                "don",
                "'t",
                "!!",
                "\u{1f600}",
                "ok"
            ]
        );
    }

    #[test]
    fn every_byte_has_a_letter_of_its_own() {
        let mut letters: Vec<char> = byte_letters().iter().map(|&(_, letter)| letter).collect();
        assert_eq!(letters[0], '!');
        assert_eq!(letters[188], '\u{100}', "byte 0");
        letters.sort_unstable();
        letters.dedup();
        assert_eq!(letters.len(), 256);
    }
}

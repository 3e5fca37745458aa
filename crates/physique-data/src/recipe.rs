//! From a folder's file names to labels, and from labels to sentences.
//!
//! ```toml
//! name = "my-motions"
//! licence = "CC-BY-4.0"
//! attribution = "Me"
//! mirror = true                        # every clip also left for right
//!
//! [windows]                            # seconds that a network sees at once
//! shortest = 2.0
//! longest = 9.8
//!
//! [split]                              # by clip; shares are taken of each content by itself
//! validation = 0.05
//! test = 0.1
//! within = "content"
//!
//! [[source]]                           # `*` and `**` match anything, braces make a label
//! files = "**/{content}_{style}_{take}.bvh"
//!
//! [words.content.walk-left]            # lists of words may have any name
//! mirrored = "walk-right"
//! does = ["walks to the left", "goes left"]
//! held_out.does = ["heads left"]       # never in a training caption
//!
//! [words.style.sad]
//! manner = ["sadly"]
//! kind = ["sad", "unhappy"]
//!
//! [[caption]]
//! text = "a person {content.does}"
//!
//! [[caption]]                          # `{a LIST}` puts "a" or "an" before
//! text = "{a style.kind} person {content.does} {style.manner}"
//! weight = 2.0
//! ```
//!
//! A caption applies to a clip if its label has all lists that the caption asks for. `{content}`
//! alone is the label itself, hyphens and underscores as blanks.

pub mod embedded;
mod pattern;
mod table;
mod template;
mod words;

use std::collections::{BTreeMap, BTreeSet};
use std::path::Path;

use physique_files::read_file;
use serde::Deserialize;

pub use crate::split::SplitRule;
pub use table::Table;
pub use words::Words;

use crate::{DataLimits, Error};
pub(crate) use pattern::Pattern;
pub(crate) use table::{LoadedTable, plain};
pub(crate) use template::{Sentences, Template};

/// Labels of a clip by name.
pub type Labels = BTreeMap<String, String>;

/// How a folder becomes a data set; see the [module](self).
#[derive(Clone, Debug, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Recipe {
    /// The data set's name.
    pub name: String,
    /// Licence of the recordings.
    pub licence: String,
    /// Whom to name.
    pub attribution: String,
    /// Frames a second of the data set; the published ones have 20.
    #[serde(default = "twenty")]
    pub frame_rate: f64,
    /// Whether every clip is there left for right, too.
    #[serde(default)]
    pub mirror: bool,
    /// Labels that tell a recording: where several files agree in all of them, the first one in the
    /// order of the sources is kept. Numbers compare as numbers.
    #[serde(default)]
    pub unique_by: Vec<String>,
    /// Length of windows.
    #[serde(default)]
    pub windows: WindowRule,
    /// Which clips are not trained on.
    #[serde(default)]
    pub split: SplitRule,
    /// What is refused though it can be read.
    #[serde(default)]
    pub refuse: RefuseRule,
    /// Where clips are. A file belongs to the first source that names it.
    #[serde(rename = "source")]
    pub sources: Vec<FileRule>,
    /// Clips that are not wanted.
    #[serde(default, rename = "leave_out")]
    pub leave_out: Vec<LeaveOutRule>,
    /// Words by label and value.
    #[serde(default)]
    pub words: BTreeMap<String, BTreeMap<String, Words>>,
    /// Sentences.
    #[serde(default, rename = "caption")]
    pub captions: Vec<CaptionRule>,
}

const fn twenty() -> f64 {
    20.0
}

/// Length of windows.
#[derive(Clone, Copy, Debug, PartialEq, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct WindowRule {
    /// Seconds; clips below it are left out.
    pub shortest: f64,
    /// Seconds; longer clips are seen in windows.
    pub longest: f64,
}

impl Default for WindowRule {
    fn default() -> Self {
        Self {
            shortest: 2.0,
            longest: 9.8,
        }
    }
}

/// What is refused though it can be read.
#[derive(Clone, Copy, Debug, PartialEq, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct RefuseRule {
    /// Metres a second: a joint that is faster from one frame of the data set to the next has
    /// jumped. A pitcher's hand reaches 40.
    pub joint_speed: f64,
}

impl Default for RefuseRule {
    fn default() -> Self {
        Self { joint_speed: 40.0 }
    }
}

/// Files that are clips.
#[derive(Clone, Debug, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct FileRule {
    /// Pattern below the folder: `*`, `**` and `{label}`.
    pub files: String,
    /// Labels that all these clips have.
    #[serde(default)]
    pub labels: Labels,
    /// Frames a second, where the files do not say or are wrong.
    #[serde(default)]
    pub frame_rate: Option<f64>,
    /// Labels that a table knows.
    #[serde(default)]
    pub table: Option<Table>,
}

/// Clips that are not wanted: all labels match.
#[derive(Clone, Debug, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct LeaveOutRule {
    /// Values by label; a list means any of them.
    pub labels: BTreeMap<String, OneOrMany>,
    /// Why: a sentence for the report.
    pub reason: String,
}

impl LeaveOutRule {
    pub(crate) fn matches(&self, labels: &Labels) -> bool {
        self.labels.iter().all(|(label, wanted)| {
            let value = labels.get(label);
            value.is_some_and(|value| wanted.contains(value))
        })
    }
}

/// A value or a list of values.
#[derive(Clone, Debug, PartialEq, Eq, Deserialize)]
#[serde(untagged)]
pub enum OneOrMany {
    /// This one.
    One(String),
    /// Any of these.
    Many(Vec<String>),
}

impl OneOrMany {
    fn contains(&self, value: &str) -> bool {
        match self {
            Self::One(one) => one == value,
            Self::Many(many) => many.iter().any(|one| one == value),
        }
    }
}

/// A sentence with gaps.
#[derive(Clone, Debug, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct CaptionRule {
    /// The sentence; gaps are `{label}`, `{label.list}` and `{a label.list}`.
    pub text: String,
    /// How often it is drawn, relative to the others, however many words fill it.
    #[serde(default = "one")]
    pub weight: f32,
}

const fn one() -> f32 {
    1.0
}

impl Recipe {
    /// Reads a recipe's file.
    ///
    /// # Errors
    /// [`Error::File`]; [`Error::Recipe`] with line and expectation.
    pub fn read(path: &Path, limits: &DataLimits) -> Result<Self, Error> {
        let name = path.display().to_string();
        let bytes = read_file(path, limits.text_bytes)?;
        let text = String::from_utf8(bytes).map_err(|problem| Error::Recipe {
            recipe: name.clone(),
            problem: format!("expected UTF-8, found {problem}"),
        })?;
        Self::parse(&text, &name)
    }

    /// Understands the text of a recipe; `name` is told in errors.
    ///
    /// # Errors
    /// [`Error::Recipe`] with line or key, expectation and finding.
    pub fn parse(text: &str, name: &str) -> Result<Self, Error> {
        let fail = |problem: String| Error::Recipe {
            recipe: name.to_owned(),
            problem,
        };
        let recipe: Self = toml::from_str(text).map_err(|problem| fail(problem.to_string()))?;
        recipe.check().map_err(fail)?;
        Ok(recipe)
    }

    fn check(&self) -> Result<(), String> {
        let expect = |holds: bool, key: &str, expected: &str, found: String| match holds {
            true => Ok(()),
            false => Err(format!("{key}: expected {expected}, found {found}")),
        };
        let found = self.frame_rate;
        let is_rate = found.is_finite() && (1.0..=1000.0).contains(&found);
        expect(is_rate, "frame_rate", "1 to 1000", found.to_string())?;
        let WindowRule { shortest, longest } = self.windows;
        let are_windows = shortest > 0.0 && longest >= shortest && longest <= 3600.0;
        let expected = "0 < shortest <= longest <= 3600 seconds";
        expect(
            are_windows,
            "windows",
            expected,
            format!("{shortest} and {longest}"),
        )?;
        let SplitRule {
            validation, test, ..
        } = self.split;
        let are_shares = validation >= 0.0 && test >= 0.0 && validation + test < 1.0;
        let expected = "shares that leave something to train on";
        expect(
            are_shares,
            "split",
            expected,
            format!("{validation} and {test}"),
        )?;
        let found = self.refuse.joint_speed;
        expect(
            found > 0.0,
            "refuse.joint_speed",
            "a speed above 0",
            found.to_string(),
        )?;
        expect(
            !self.sources.is_empty(),
            "source",
            "one or more",
            "none".into(),
        )?;
        for source in &self.sources {
            Pattern::parse(&source.files).map_err(|problem| format!("source.files: {problem}"))?;
            if let Some(table) = &source.table {
                Pattern::parse(&table.file)
                    .map_err(|problem| format!("source.table.file: {problem}"))?;
            }
            if let Some(rate) = source.frame_rate {
                let is_rate = rate.is_finite() && rate > 0.0;
                expect(
                    is_rate,
                    "source.frame_rate",
                    "a number above 0",
                    rate.to_string(),
                )?;
            }
        }
        for caption in &self.captions {
            Template::parse(&caption.text).map_err(|problem| format!("caption.text: {problem}"))?;
            let is_weight = caption.weight.is_finite() && caption.weight > 0.0;
            expect(
                is_weight,
                "caption.weight",
                "a number above 0",
                caption.weight.to_string(),
            )?;
        }
        self.check_words()
    }

    /// Words that no caption asks for, and captions that ask for what no word list has, are slips of
    /// the pen.
    fn check_words(&self) -> Result<(), String> {
        for (label, values) in &self.words {
            for (value, words) in values {
                if let Some(mirrored) = &words.mirrored
                    && !values.contains_key(mirrored)
                {
                    return Err(format!(
                        "words.{label}.{value}.mirrored: expected a value of {label} that has words, found {mirrored:?}"
                    ));
                }
            }
        }
        for caption in &self.captions {
            let template = Template::parse(&caption.text)?;
            for (label, list) in template.lists() {
                let values = self.words.get(label).map(BTreeMap::values);
                let knows = values.is_some_and(|mut values| values.any(|words| words.has(list)));
                if !knows {
                    return Err(format!(
                        "caption {:?}: expected a list {list:?} in words.{label}, found none",
                        caption.text
                    ));
                }
            }
        }
        Ok(())
    }

    /// Labels that captions are made of, and that of the split.
    pub(crate) fn told_labels(&self) -> BTreeSet<String> {
        let templates = self
            .captions
            .iter()
            .flat_map(|rule| Template::parse(&rule.text));
        let mut labels: BTreeSet<String> = templates
            .flat_map(|template| template.labels().map(str::to_owned).collect::<Vec<_>>())
            .collect();
        labels.extend(self.split.within.clone());
        labels
    }

    /// Labels of the mirror image.
    pub(crate) fn mirrored(&self, labels: &Labels) -> Labels {
        let mut mirrored = labels.clone();
        for (label, value) in &mut mirrored {
            let words = self.words.get(label).and_then(|values| values.get(value));
            if let Some(twin) = words.and_then(|words| words.mirrored.as_ref()) {
                value.clone_from(twin);
            }
        }
        mirrored
    }

    /// All sentences of a clip with these labels.
    ///
    /// # Errors
    /// How many there would be, where they are more than `limit`.
    pub(crate) fn sentences(&self, labels: &Labels, limit: usize) -> Result<Sentences, String> {
        let mut sentences = Sentences::default();
        for rule in &self.captions {
            let template = Template::parse(&rule.text)?;
            template.fill(labels, &self.words, rule.weight, limit, &mut sentences)?;
        }
        Ok(sentences)
    }
}

#[cfg(test)]
mod tests {
    use super::Recipe;

    fn problem(text: &str) -> String {
        let head = "name = 'a'\nlicence = 'b'\nattribution = 'c'\n";
        Recipe::parse(&format!("{head}{text}"), "mine")
            .map_or_else(|problem| problem.to_string(), |_| "accepted".to_owned())
    }

    #[test]
    fn slips_of_the_pen_are_told_with_their_place() {
        for (text, told) in [
            ("source = []", "expected one or more"),
            ("[[source]]\nfiles = '{a'", "source.files: "),
            ("[[source]]\nfiles = '*'\nfile = 1", "unknown field `file`"),
            (
                "[[source]]\nfiles = '*'\n[windows]\nshortest = 3\nlongest = 2",
                "windows: expected 0 < shortest",
            ),
            (
                "[[source]]\nfiles = '*'\n[split]\ntest = 1.0",
                "split: expected shares",
            ),
            (
                "[[source]]\nfiles = '*'\n[[caption]]\ntext = 'a {x.y}'",
                "expected a list \"y\" in words.x",
            ),
            (
                "[[source]]\nfiles = '*'\n[words.x.left]\nmirrored = 'right'",
                "words.x.left.mirrored",
            ),
        ] {
            let found = problem(text);
            assert!(found.contains(told), "{text}: {found}");
            assert!(found.starts_with("mine: "), "{found}");
        }
        assert_eq!(problem("[[source]]\nfiles = '*.bvh'"), "accepted");
    }
}

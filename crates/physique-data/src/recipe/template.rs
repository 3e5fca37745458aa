//! Sentences with gaps.

use std::collections::{BTreeMap, HashMap};

use super::{Labels, Words, pattern::is_name};
use crate::Wording;

/// A sentence such as `{a style.kind} person {content.does}`.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(crate) struct Template(Vec<Piece>);

#[derive(Clone, Debug, PartialEq, Eq)]
enum Piece {
    Text(String),
    Gap {
        label: String,
        /// The value itself where there is none.
        list: Option<String>,
        /// "a" or "an" goes before.
        article: bool,
    },
}

/// The sentences of one clip, each once.
#[derive(Clone, Debug, Default, PartialEq)]
pub(crate) struct Sentences {
    /// With the weight of each.
    pub(crate) training: Vec<(String, f32)>,
    pub(crate) held_out: Vec<String>,
    seen: HashMap<String, usize>,
}

impl Template {
    pub(crate) fn parse(text: &str) -> Result<Self, String> {
        let mut pieces = Vec::new();
        let mut rest = text;
        while let Some((before, after)) = rest.split_once('{') {
            let (gap, after) = after
                .split_once('}')
                .ok_or_else(|| format!("expected a closing brace in {text:?}"))?;
            pieces.push(Piece::Text(before.to_owned()));
            let (article, gap) = match gap.strip_prefix("a ") {
                Some(gap) => (true, gap.trim()),
                None => (false, gap),
            };
            let (label, list) = match gap.split_once('.') {
                Some((label, list)) => (label, Some(list)),
                None => (gap, None),
            };
            if !is_name(label) || !list.is_none_or(is_name) {
                return Err(format!(
                    "expected {{label}}, {{label.list}} or {{a label.list}} in {text:?}, found {gap:?}"
                ));
            }
            pieces.push(Piece::Gap {
                label: label.to_owned(),
                list: list.map(str::to_owned),
                article,
            });
            rest = after;
        }
        if rest.contains('}') {
            return Err(format!("expected an opening brace before }} in {text:?}"));
        }
        pieces.push(Piece::Text(rest.to_owned()));
        Ok(Self(pieces))
    }

    /// Labels that the sentence asks for.
    pub(super) fn labels(&self) -> impl Iterator<Item = &str> {
        self.0.iter().filter_map(|piece| match piece {
            Piece::Gap { label, .. } => Some(label.as_str()),
            Piece::Text(_) => None,
        })
    }

    /// Labels and lists that the sentence asks for.
    pub(super) fn lists(&self) -> impl Iterator<Item = (&str, &str)> {
        self.0.iter().filter_map(|piece| match piece {
            Piece::Gap {
                label,
                list: Some(list),
                ..
            } => Some((label.as_str(), list.as_str())),
            _ => None,
        })
    }

    /// Adds every sentence that this template makes for these labels; none where a label or a list
    /// is missing. Training sentences share the weight; a sentence with a held-out word is held out.
    pub(crate) fn fill(
        &self,
        labels: &Labels,
        words: &BTreeMap<String, BTreeMap<String, Words>>,
        weight: f32,
        limit: usize,
        sentences: &mut Sentences,
    ) -> Result<(), String> {
        let mut filled = vec![(String::new(), Wording::Training)];
        for piece in &self.0 {
            let choices = match piece {
                Piece::Text(text) => vec![(text.clone(), Wording::Training)],
                Piece::Gap {
                    label,
                    list,
                    article,
                } => choices(labels, words, label, list.as_deref(), *article),
            };
            if filled.len().saturating_mul(choices.len()) > limit {
                let found = filled.len() * choices.len();
                return Err(format!("more than {limit} captions of one clip: {found}"));
            }
            filled = filled
                .iter()
                .flat_map(|(start, held)| {
                    choices.iter().map(move |(end, also_held)| {
                        (format!("{start}{end}"), either(*held, *also_held))
                    })
                })
                .collect();
        }
        let is_training = |(_, wording): &&(String, Wording)| *wording == Wording::Training;
        let share = weight / filled.iter().filter(is_training).count().max(1) as f32;
        for (text, wording) in filled {
            let text = text.split_whitespace().collect::<Vec<_>>().join(" ");
            sentences.add(text, wording, share);
        }
        Ok(())
    }
}

const fn either(a: Wording, b: Wording) -> Wording {
    match (a, b) {
        (Wording::Training, Wording::Training) => Wording::Training,
        _ => Wording::HeldOut,
    }
}

/// What may stand in a gap.
fn choices(
    labels: &Labels,
    words: &BTreeMap<String, BTreeMap<String, Words>>,
    label: &str,
    list: Option<&str>,
    article: bool,
) -> Vec<(String, Wording)> {
    let Some(value) = labels.get(label) else {
        return Vec::new();
    };
    let with_article = |word: &str| match article {
        true => format!("{} {word}", article_of(word)),
        false => word.to_owned(),
    };
    let Some(list) = list else {
        let itself = value.replace(['-', '_'], " ");
        return vec![(with_article(&itself), Wording::Training)];
    };
    let Some(of_value) = words.get(label).and_then(|values| values.get(value)) else {
        return Vec::new();
    };
    let each = |lists: &BTreeMap<String, Vec<String>>, wording| {
        let found = lists.get(list).into_iter().flatten();
        found
            .map(|word| (with_article(word), wording))
            .collect::<Vec<_>>()
    };
    let mut choices = each(&of_value.training, Wording::Training);
    choices.extend(each(&of_value.held_out, Wording::HeldOut));
    choices
}

/// By the first letter: right for words that sound as they are written.
fn article_of(word: &str) -> &'static str {
    match word
        .chars()
        .next()
        .map(|letter| letter.to_ascii_lowercase())
    {
        Some('a' | 'e' | 'i' | 'o' | 'u') => "an",
        _ => "a",
    }
}

impl Sentences {
    /// A sentence that two templates make is drawn as often as both say, and is a training sentence
    /// if it is one by either.
    fn add(&mut self, text: String, wording: Wording, weight: f32) {
        match wording {
            Wording::Training => match self.seen.get(&text) {
                Some(&index) => self.training[index].1 += weight,
                None => {
                    self.seen.insert(text.clone(), self.training.len());
                    self.held_out.retain(|held_out| *held_out != text);
                    self.training.push((text, weight));
                }
            },
            Wording::HeldOut => {
                if !self.seen.contains_key(&text) && !self.held_out.contains(&text) {
                    self.held_out.push(text);
                }
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use crate::Recipe;

    const RECIPE: &str = r#"
name = "a"
licence = "b"
attribution = "c"
[[source]]
files = "*"
[words.content.walk]
does = ["walks", "is walking"]
held_out.does = ["strolls"]
[words.style.angry]
kind = ["angry"]
manner = ["angrily"]
held_out.manner = ["in anger"]
[[caption]]
text = "a person {content.does}"
[[caption]]
text = "{a style.kind} person {content.does} {style.manner}"
weight = 4.0
"#;

    fn sentences(labels: &[(&str, &str)]) -> (Vec<(String, f32)>, Vec<String>) {
        let recipe = Recipe::parse(RECIPE, "test").unwrap();
        let labels = labels.iter().map(|&(a, b)| (a.to_owned(), b.to_owned()));
        let found = recipe.sentences(&labels.collect(), 100).unwrap();
        (found.training, found.held_out)
    }

    #[test]
    fn held_out_words_make_held_out_sentences() {
        let (training, held_out) = sentences(&[("content", "walk"), ("style", "angry")]);
        let texts: Vec<&str> = training.iter().map(|(text, _)| text.as_str()).collect();
        let expected = [
            "a person walks",
            "a person is walking",
            "an angry person walks angrily",
            "an angry person is walking angrily",
        ];
        assert_eq!(texts, expected);
        let weights: Vec<f32> = training.iter().map(|&(_, weight)| weight).collect();
        assert_eq!(weights, [0.5, 0.5, 2.0, 2.0]);
        let expected = [
            "a person strolls",
            "an angry person walks in anger",
            "an angry person is walking in anger",
            "an angry person strolls angrily",
            "an angry person strolls in anger",
        ];
        assert_eq!(held_out, expected);
    }

    #[test]
    fn a_template_needs_all_its_words() {
        let (training, held_out) = sentences(&[("content", "walk"), ("style", "normal")]);
        assert_eq!((training.len(), held_out.len()), (2, 1));
        let (training, held_out) = sentences(&[("content", "kick")]);
        assert_eq!((training.len(), held_out.len()), (0, 0));
    }

    #[test]
    fn too_many_sentences_are_refused() {
        let recipe = Recipe::parse(RECIPE, "test").unwrap();
        let labels = [("content", "walk"), ("style", "angry")];
        let labels = labels.map(|(a, b)| (a.to_owned(), b.to_owned()));
        let problem = recipe.sentences(&labels.into(), 5).unwrap_err();
        assert_eq!(problem, "more than 5 captions of one clip: 6");
    }
}

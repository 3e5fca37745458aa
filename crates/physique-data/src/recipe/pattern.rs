//! Patterns of file names that make labels.

use super::Labels;

/// A pattern such as `set-*/**/{content}_{style}.bvh`, matched against paths below a folder with `/`
/// between names. `*` stands for any letters of one name, `**` for any letters, `{label}` for one or
/// more letters of one name, as few as possible.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(crate) struct Pattern(Vec<Part>);

#[derive(Clone, Debug, PartialEq, Eq)]
enum Part {
    Letter(char),
    /// Anything within a name.
    Any,
    /// Anything.
    AnyDepth,
    Label(String),
}

impl Pattern {
    pub(crate) fn parse(text: &str) -> Result<Self, String> {
        let mut parts = Vec::new();
        let mut rest = text;
        while let Some(letter) = rest.chars().next() {
            rest = &rest[letter.len_utf8()..];
            parts.push(match letter {
                '*' if rest.starts_with('*') => {
                    rest = &rest[1..];
                    // `**/` is also no folder at all.
                    rest = rest.strip_prefix('/').unwrap_or(rest);
                    Part::AnyDepth
                }
                '*' => Part::Any,
                '{' => {
                    let (label, after) = rest
                        .split_once('}')
                        .ok_or_else(|| format!("expected a closing brace in {text:?}"))?;
                    if !is_name(label) {
                        return Err(format!(
                            "expected letters, digits and underscores in braces, found {label:?}"
                        ));
                    }
                    rest = after;
                    Part::Label(label.to_owned())
                }
                '}' => return Err(format!("expected an opening brace before }} in {text:?}")),
                letter => Part::Letter(letter),
            });
        }
        if parts.is_empty() {
            return Err("expected a pattern, found nothing".to_owned());
        }
        Ok(Self(parts))
    }

    /// Labels of a path, or `None` where it does not match. A label that stands twice must be the
    /// same both times.
    pub(crate) fn labels(&self, path: &str) -> Option<Labels> {
        let letters: Vec<char> = path.chars().collect();
        let mut search = Search {
            parts: &self.0,
            letters: &letters,
            failed: vec![false; (self.0.len() + 1) * (letters.len() + 1)],
            spans: Vec::new(),
        };
        if !search.matches(0, 0) {
            return None;
        }
        let mut labels = Labels::new();
        for (label, from, to) in search.spans {
            let value: String = letters[from..to].iter().collect();
            if *labels
                .entry(label.to_owned())
                .or_insert_with(|| value.clone())
                != value
            {
                return None;
            }
        }
        Some(labels)
    }
}

/// Whether this can name a label or a list.
pub(super) fn is_name(text: &str) -> bool {
    let is_part = |letter: char| letter.is_ascii_alphanumeric() || letter == '_' || letter == '-';
    !text.is_empty() && text.chars().all(is_part)
}

/// Backtracking that remembers where it failed, so that no path takes more than parts x letters
/// squared.
struct Search<'a> {
    parts: &'a [Part],
    letters: &'a [char],
    failed: Vec<bool>,
    /// Labels with the letters they took, from the last to the first.
    spans: Vec<(&'a str, usize, usize)>,
}

impl Search<'_> {
    fn matches(&mut self, part: usize, at: usize) -> bool {
        let place = part * (self.letters.len() + 1) + at;
        if self.failed[place] {
            return false;
        }
        let found = match self.parts.get(part) {
            None => at == self.letters.len(),
            Some(Part::Letter(letter)) => {
                self.letters.get(at) == Some(letter) && self.matches(part + 1, at + 1)
            }
            Some(wild) => {
                let least = usize::from(matches!(wild, Part::Label(_)));
                let reach = match wild {
                    Part::AnyDepth => self.letters.len() - at,
                    _ => {
                        let rest = self.letters[at..].iter();
                        rest.take_while(|&&letter| letter != '/').count()
                    }
                };
                let end = (at + least..=at + reach).find(|&end| self.matches(part + 1, end));
                if let (Some(end), Part::Label(label)) = (end, wild) {
                    self.spans.push((label, at, end));
                }
                end.is_some()
            }
        };
        self.failed[place] = !found;
        found
    }
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::Pattern;

    fn labels(pattern: &str, path: &str) -> Option<Vec<(String, String)>> {
        let labels = Pattern::parse(pattern).unwrap().labels(path)?;
        Some(labels.into_iter().collect())
    }

    fn pairs(of: &[(&str, &str)]) -> Option<Vec<(String, String)>> {
        let owned = of.iter().map(|&(a, b)| (a.to_owned(), b.to_owned()));
        Some(owned.collect())
    }

    #[test]
    fn names_become_labels() {
        let pattern = "data/*/dataset-{set}_{content}_{style}_{take}.bvh";
        let path = "data/two/dataset-2_raise-up-both-hands_not-confident_001.bvh";
        let expected = [
            ("content", "raise-up-both-hands"),
            ("set", "2"),
            ("style", "not-confident"),
            ("take", "001"),
        ];
        assert_eq!(labels(pattern, path), pairs(&expected));
        assert_eq!(labels(pattern, "data/two/more/dataset-2_a_b_1.bvh"), None);
        assert_eq!(labels("**/{a}.bvh", "x.bvh"), pairs(&[("a", "x")]));
        assert_eq!(labels("**/{a}.bvh", "p/q/x.bvh"), pairs(&[("a", "x")]));
        assert_eq!(
            labels("{a}_{b}", "1_2_3"),
            pairs(&[("a", "1"), ("b", "2_3")])
        );
        assert_eq!(labels("{a}/{a}.bvh", "x/x.bvh"), pairs(&[("a", "x")]));
        assert_eq!(labels("{a}/{a}.bvh", "x/y.bvh"), None);
    }

    #[test]
    fn broken_patterns_are_told() {
        for pattern in ["", "{a", "a}", "{}", "{a b}"] {
            assert!(Pattern::parse(pattern).is_err(), "{pattern}");
        }
    }

    #[test]
    fn a_pattern_that_invites_backtracking_ends() {
        let pattern = Pattern::parse(&"*a".repeat(60)).unwrap();
        assert_eq!(pattern.labels(&"a".repeat(59)), None);
        assert!(pattern.labels(&"a".repeat(200)).is_some());
    }

    proptest! {
        #[test]
        fn what_is_put_together_comes_apart(a in "[a-z-]{1,9}", b in "[a-z-]{1,9}", c in "[a-z_]{1,9}") {
            let found = labels("x/{a}_{b}_{c}.bvh", &format!("x/{a}_{b}_{c}.bvh"));
            prop_assert_eq!(found, pairs(&[("a", &a), ("b", &b), ("c", &c)]));
        }
    }
}

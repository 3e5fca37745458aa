//! Captions that tell two things at once.

/// A caption of what legs do, and one of what trunk and arms do meanwhile.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct BodyPartTexts {
    /// Of legs and path.
    pub legs: String,
    /// Of trunk, head and arms.
    pub upper_body: String,
}

impl BodyPartTexts {
    /// Splits an English caption such as "a tired person walks and waves with the left hand" in two, each
    /// with the whole subject: "a tired person walks", "a tired person waves with the left hand".
    ///
    /// `None` unless the caption is made of two clauses (around "and" or "while") with a person as
    /// their subject, one of which is about getting about and the other about hands or arms: "walks and
    /// turns left" is one thing, "raises both hands and waves" is another.
    pub fn of(caption: &str) -> Option<Self> {
        let words: Vec<&str> = caption.split_whitespace().collect();
        let is = |word: &str, list: &[&str]| list.contains(&bare(word).as_str());
        let mut connectors = (0..words.len()).filter(|&at| is(words[at], &CONNECTORS));
        let (Some(connector), None) = (connectors.next(), connectors.next()) else {
            return None;
        };
        let subject = 1 + words[..connector]
            .iter()
            .position(|word| is(word, &PERSONS))?;
        let (subject, first) = words[..connector].split_at(subject);
        let mut second = &words[connector + 1..];
        while second.first().is_some_and(|word| is(word, &PRONOUNS)) {
            second = &second[1..];
        }
        let (legs, arms) = match (Part::of(first)?, Part::of(second)?) {
            (Part::Legs, Part::Arms) => (first, second),
            (Part::Arms, Part::Legs) => (second, first),
            _ => return None,
        };
        let caption = |clause: &[&str]| {
            // "walks while waving" has its auxiliary left out.
            let is_bare = clause.first().is_some_and(|verb| verb.ends_with("ing"));
            let auxiliary: &[&str] = if is_bare { &["is"] } else { &[] };
            let caption = [subject, auxiliary, clause].concat().join(" ");
            caption.trim_end_matches([',', '.', ';']).to_owned()
        };
        Some(Self {
            legs: caption(legs),
            upper_body: caption(arms),
        })
    }
}

#[derive(Clone, Copy, PartialEq, Eq)]
enum Part {
    Legs,
    Arms,
}

impl Part {
    /// What a clause is about, where it is about one.
    fn of(clause: &[&str]) -> Option<Self> {
        let words: Vec<String> = clause.iter().map(|word| bare(word)).collect();
        let about = |stems: &[&str]| {
            words
                .iter()
                .any(|word| stems.iter().any(|stem| is_form(word, stem)))
        };
        match (about(&LEGS), about(&ARMS)) {
            (true, false) => Some(Self::Legs),
            (false, true) => Some(Self::Arms),
            _ => None,
        }
    }
}

/// A word without case and punctuation.
fn bare(word: &str) -> String {
    word.trim_matches(|letter: char| !letter.is_alphanumeric())
        .to_lowercase()
}

/// Whether a word is a stem with one of the endings of verbs and nouns: "walks", "jogging", "waving".
fn is_form(word: &str, stem: &str) -> bool {
    let endings = ["", "s", "es", "ed", "ing"];
    let last = stem.chars().last().map(String::from).unwrap_or_default();
    word.strip_prefix(stem).is_some_and(|ending| {
        let undoubled = ending.strip_prefix(&last).unwrap_or(ending);
        endings.contains(&ending) || endings.contains(&undoubled)
    }) || stem
        .strip_suffix('e')
        .is_some_and(|stem| word.strip_prefix(stem).is_some_and(|e| e == "ing"))
}

const CONNECTORS: [&str; 2] = ["and", "while"];

const PERSONS: [&str; 16] = [
    "person",
    "man",
    "woman",
    "someone",
    "somebody",
    "human",
    "figure",
    "character",
    "boy",
    "girl",
    "child",
    "actor",
    "dancer",
    "he",
    "she",
    "they",
];

const PRONOUNS: [&str; 4] = ["he", "she", "they", "then"];

const LEGS: [&str; 16] = [
    "walk", "run", "jog", "march", "stroll", "stride", "sprint", "dash", "step", "turn", "tiptoe",
    "limp", "sneak", "skip", "wander", "pace",
];

const ARMS: [&str; 8] = [
    "hand", "arm", "wave", "clap", "punch", "greet", "gesture", "salute",
];

#[cfg(test)]
mod tests {
    use super::BodyPartTexts;

    #[test]
    fn two_things_at_once_are_told_apart() {
        for (caption, legs, upper_body) in [
            (
                "a tired person walks and waves with the left hand",
                "a tired person walks",
                "a tired person waves with the left hand",
            ),
            (
                "A woman waves both hands while jogging forward.",
                "A woman is jogging forward",
                "A woman waves both hands",
            ),
            (
                "someone is walking, and raises the right arm",
                "someone is walking",
                "someone raises the right arm",
            ),
            (
                "a person turns left while they lift both hands",
                "a person turns left",
                "a person lift both hands",
            ),
            (
                "the man runs while waving",
                "the man runs",
                "the man is waving",
            ),
        ] {
            let found =
                BodyPartTexts::of(caption).unwrap_or_else(|| panic!("{caption}: one thing"));
            assert_eq!(
                (found.legs.as_str(), found.upper_body.as_str()),
                (legs, upper_body)
            );
        }
    }

    #[test]
    fn one_thing_stays_one() {
        for caption in [
            "",
            "and",
            "a person walks",
            "a person waves with the left hand",
            "a person walks and turns left",
            "a person raises both hands and waves",
            "walks and waves",
            "a person sits down and waves",
            "a person walks and",
            "a person and a dog walk while waving hands",
            "a person walks on their hands and waves",
            "a person runs and waves and stops",
            "a person is charming and waves",
        ] {
            assert_eq!(BodyPartTexts::of(caption), None, "{caption}");
        }
    }
}

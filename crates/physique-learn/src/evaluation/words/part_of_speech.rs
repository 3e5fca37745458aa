//! Parts of speech, and words that are one by themselves.

/// Tags with a column of their own.
const TAGS: [&str; 9] = [
    "VERB", "NOUN", "DET", "ADP", "NUM", "AUX", "PRON", "ADJ", "ADV",
];

/// Words that are told apart from their part of speech, in the columns after the tags; of several
/// lists the first counts.
const LISTS: [&[&str]; 5] = [
    // Places.
    &[
        "left",
        "right",
        "clockwise",
        "counterclockwise",
        "anticlockwise",
        "forward",
        "back",
        "backward",
        "up",
        "down",
        "straight",
        "curve",
    ],
    // Parts of the body.
    &[
        "arm", "chin", "foot", "feet", "face", "hand", "mouth", "leg", "waist", "eye", "knee",
        "shoulder", "thigh",
    ],
    // Objects.
    &[
        "stair",
        "dumbbell",
        "chair",
        "window",
        "floor",
        "car",
        "ball",
        "handrail",
        "baseball",
        "basketball",
    ],
    // Actions.
    &[
        "walk", "run", "swing", "pick", "bring", "kick", "put", "squat", "throw", "hop", "dance",
        "jump", "turn", "stumble", "stop", "sit", "lift", "lower", "raise", "wash", "stand",
        "kneel", "stroll", "rub", "bend", "balance", "flap", "jog", "shuffle", "lean", "rotate",
        "spin", "spread", "climb",
    ],
    // Descriptions.
    &[
        "slowly",
        "carefully",
        "fast",
        "careful",
        "slow",
        "quickly",
        "happy",
        "angry",
        "sad",
        "happily",
        "angrily",
        "sadly",
    ],
];

/// A column of the one-hot vector beside a word.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct PartOfSpeech(u8);

impl PartOfSpeech {
    /// Marks, unknown words, and all other tags.
    pub(super) const OTHER: Self = Self((TAGS.len() + LISTS.len()) as u8);

    /// Of a known word with this tag.
    pub(super) fn of(word: &str, tag: &str) -> Self {
        let list = LISTS.iter().position(|list| list.contains(&word));
        let column = list.map(|list| TAGS.len() + list);
        let column = column.or_else(|| TAGS.iter().position(|known| *known == tag));
        column.map_or(Self::OTHER, |column| Self(column as u8))
    }

    pub(super) const fn column(self) -> u8 {
        self.0
    }
}

#[cfg(test)]
mod tests {
    use super::PartOfSpeech;

    #[test]
    fn lists_come_before_tags() {
        let column = |word, tag| PartOfSpeech::of(word, tag).column();
        assert_eq!(column("person", "NOUN"), 1);
        assert_eq!(column("a", "DET"), 2);
        assert_eq!(column("then", "ADV"), 8);
        assert_eq!(column("left", "ADJ"), 9);
        assert_eq!(column("hand", "NOUN"), 10);
        assert_eq!(column("ball", "NOUN"), 11);
        assert_eq!(column("walk", "VERB"), 12);
        assert_eq!(column("sadly", "ADV"), 13);
        assert_eq!(column("and", "CCONJ"), 14);
        assert_eq!(PartOfSpeech::OTHER.column(), 14);
    }
}

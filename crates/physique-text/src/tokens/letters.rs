//! Kinds of letters, as tokenizers tell them apart.

use unicode_properties::{GeneralCategory, GeneralCategoryGroup, UnicodeGeneralCategory as _};

/// Letters that BERT drops: control, format, private use and unassigned ones.
pub(super) fn is_control(letter: char) -> bool {
    !matches!(letter, '\t' | '\n' | '\r')
        && letter.general_category_group() == GeneralCategoryGroup::Other
}

/// ASCII signs, and what Unicode calls punctuation.
pub(super) fn is_punctuation(letter: char) -> bool {
    letter.is_ascii_punctuation()
        || letter.general_category_group() == GeneralCategoryGroup::Punctuation
}

/// Marks that stand over or under a letter.
pub(super) fn is_accent(letter: char) -> bool {
    letter.general_category() == GeneralCategory::NonspacingMark
}

/// Signs that are words of their own in BERT: Chinese ones.
pub(super) const fn is_word_sign(letter: char) -> bool {
    matches!(letter as u32,
        0x4E00..=0x9FFF | 0x3400..=0x4DBF | 0x20000..=0x2A6DF | 0x2A700..=0x2B73F
        | 0x2B740..=0x2B81F | 0x2B920..=0x2CEAF | 0xF900..=0xFAFF | 0x2F800..=0x2FA1F)
}

/// Unicode's letters.
pub(super) fn is_letter(letter: char) -> bool {
    letter.general_category_group() == GeneralCategoryGroup::Letter
}

/// Unicode's numbers.
pub(super) fn is_number(letter: char) -> bool {
    letter.general_category_group() == GeneralCategoryGroup::Number
}

//! Left and right in labels.

/// The label with left and right exchanged; `None` where it speaks of neither.
pub(super) fn other_side(label: &str) -> Option<String> {
    let words = label.split('-').map(|word| match word {
        "left" => "right",
        "right" => "left",
        word => word,
    });
    let other = words.collect::<Vec<_>>().join("-");
    (other != label).then_some(other)
}

#[cfg(test)]
mod tests {
    use super::other_side;

    #[test]
    fn sides_are_words() {
        let other = |label: &str| other_side(label);
        assert_eq!(other("wave-left-hand").as_deref(), Some("wave-right-hand"));
        assert_eq!(other("turn-right").as_deref(), Some("turn-left"));
        assert_eq!(other("walk"), None);
        assert_eq!(other("bright"), None);
    }
}

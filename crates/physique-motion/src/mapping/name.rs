//! Joint names without the habits of exporters.

/// Prefixes that rigs put before every name, normalised.
const RIG_PREFIXES: [&str; 8] = [
    "mixamorig",
    "ccbase",
    "bip001",
    "bip01",
    "character1",
    "armature",
    "joint",
    "def",
];

/// A name in lower case without namespace (`rig:Hips`, `Armature|Hips`), blanks, punctuation and
/// a rig's prefix.
pub(super) fn normalised(name: &str) -> String {
    let plain = name.rsplit([':', '|']).next().unwrap_or(name);
    let mut letters: String = plain
        .chars()
        .filter(|letter| letter.is_alphanumeric())
        .flat_map(char::to_lowercase)
        .collect();
    for prefix in RIG_PREFIXES {
        if let Some(rest) = letters.strip_prefix(prefix)
            && !rest.is_empty()
        {
            letters = rest.to_owned();
            break;
        }
    }
    letters
}

#[cfg(test)]
mod tests {
    use super::normalised;

    #[test]
    fn exporters_habits_do_not_matter() {
        for name in [
            "LeftUpLeg",
            "mixamorig:LeftUpLeg",
            "mixamorig_LeftUpLeg",
            "Armature|mixamorig:leftUpLeg",
            "left up-leg",
        ] {
            assert_eq!(normalised(name), "leftupleg");
        }
        assert_eq!(normalised("joint_Root"), "root");
        assert_eq!(normalised("Joint"), "joint");
    }
}

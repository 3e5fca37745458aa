//! Joint names without the habits of exporters.

use crate::Skeleton;

/// The joints of a skeleton by name: letter case, blanks, underscores, namespaces and the
/// prefixes of common rigs do not matter.
pub(super) struct NamedJoints<'a> {
    skeleton: &'a Skeleton,
    normalised: Vec<String>,
}

impl<'a> NamedJoints<'a> {
    pub(super) fn new(skeleton: &'a Skeleton) -> Self {
        let joints = skeleton.joints().iter();
        Self {
            skeleton,
            normalised: joints.map(|joint| normalised(&joint.name)).collect(),
        }
    }

    /// The first joint of that name. Exact spelling goes first: a file may tell "hand" from
    /// "Hand".
    pub(super) fn find(&self, name: &str) -> Option<usize> {
        let wanted = normalised(name);
        self.skeleton
            .find(name)
            .or_else(|| self.normalised.iter().position(|found| *found == wanted))
    }
}

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
fn normalised(name: &str) -> String {
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

//! Which clips are trained on, and which are not.

use std::collections::BTreeMap;

use serde::{Deserialize, Serialize};

use crate::random::hash;

/// A part of a data set. Clips belong to one as a whole, together with their mirror images: windows
/// of one recording are never on two sides.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Split {
    /// Seen by the network.
    Train,
    /// Seen by those who choose its settings.
    Validation,
    /// Seen by nobody before the figures are printed.
    Test,
}

impl Split {
    /// All splits.
    pub const ALL: [Self; 3] = [Self::Train, Self::Validation, Self::Test];

    /// Its name in files and tables.
    pub const fn name(self) -> &'static str {
        match self {
            Self::Train => "train",
            Self::Validation => "validation",
            Self::Test => "test",
        }
    }
}

/// How a recipe splits its clips.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct SplitRule {
    /// Share of the clips that go to validation.
    pub validation: f64,
    /// Share of the clips that go to testing.
    pub test: f64,
    /// A label: shares are taken of each of its values by itself, rounded down, so that what is rare
    /// stays in training.
    pub within: Option<String>,
    /// Another seed is another split.
    pub seed: u64,
}

impl Default for SplitRule {
    fn default() -> Self {
        Self {
            validation: 0.05,
            test: 0.10,
            within: None,
            seed: 10,
        }
    }
}

impl SplitRule {
    /// The split of each of `(name, group)`, in their order. It depends on the names alone, not on
    /// their order.
    pub(crate) fn assign(&self, clips: &[(&str, &str)]) -> Vec<Split> {
        let mut groups: BTreeMap<&str, Vec<(u64, &str, usize)>> = BTreeMap::new();
        for (index, &(name, group)) in clips.iter().enumerate() {
            let key = (hash(self.seed, name), name, index);
            groups.entry(group).or_default().push(key);
        }
        let mut splits = vec![Split::Train; clips.len()];
        for members in groups.values_mut() {
            members.sort_unstable();
            let share = |share: f64| (members.len() as f64 * share) as usize;
            let (validation, test) = (share(self.validation), share(self.test));
            for (place, &(_, _, index)) in members.iter().enumerate() {
                splits[index] = match place {
                    place if place < test => Split::Test,
                    place if place < test + validation => Split::Validation,
                    _ => Split::Train,
                };
            }
        }
        splits
    }
}

#[cfg(test)]
mod tests {
    use super::{Split, SplitRule};

    #[test]
    fn what_is_rare_stays_in_training_and_order_does_not_matter() {
        let names: Vec<String> = (0..100).map(|index| format!("walk_{index}")).collect();
        let mut clips: Vec<(&str, &str)> = names.iter().map(|n| (n.as_str(), "walk")).collect();
        clips.push(("kick_0", "kick"));
        let rule = SplitRule {
            validation: 0.05,
            test: 0.1,
            ..SplitRule::default()
        };
        let splits = rule.assign(&clips);
        let count = |split| splits.iter().filter(|&&found| found == split).count();
        assert_eq!(count(Split::Test), 10);
        assert_eq!(count(Split::Validation), 5);
        assert_eq!(splits.last(), Some(&Split::Train));

        clips.reverse();
        let mut reversed = rule.assign(&clips);
        reversed.reverse();
        assert_eq!(reversed, splits);
    }
}

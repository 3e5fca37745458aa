//! How far a judge can be trusted.

use serde::Serialize;

/// Real clips that a judge does not know, and how many of them it is right about.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
pub struct JudgeAccuracy {
    /// Clips that it is right about.
    pub right: usize,
    /// Clips, one or more.
    pub clips: usize,
}

impl JudgeAccuracy {
    /// Share that a judge must be right about, and of how many clips at least, to be trusted.
    pub const TRUSTED: (f64, usize) = (0.95, 20);

    /// The share of the clips that it is right about.
    pub fn share(self) -> f64 {
        self.right as f64 / self.clips as f64
    }

    /// Whether what the judge says means anything: see [`Self::TRUSTED`].
    pub fn is_trusted(self) -> bool {
        let (share, clips) = Self::TRUSTED;
        self.share() >= share && self.clips >= clips
    }
}

impl std::fmt::Display for JudgeAccuracy {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        let Self { right, clips } = self;
        let percent = 100.0 * self.share();
        write!(
            f,
            "{right} of {clips} real validation clips ({percent:.1} %)"
        )
    }
}

#[cfg(test)]
mod tests {
    use super::JudgeAccuracy;

    #[test]
    fn few_clips_and_many_mistakes_are_not_to_be_trusted() {
        let trusted = |right, clips| JudgeAccuracy { right, clips }.is_trusted();
        assert!(trusted(19, 20) && trusted(284, 284));
        assert!(!trusted(18, 20) && !trusted(19, 19) && !trusted(0, 2));
        let told = JudgeAccuracy {
            right: 282,
            clips: 284,
        }
        .to_string();
        assert_eq!(told, "282 of 284 real validation clips (99.3 %)");
    }
}

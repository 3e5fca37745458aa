//! Exit codes, so that scripts need not read text.

use std::process::ExitCode;

/// How a run ended. (clap itself exits with 2 for unusable arguments.)
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Exit {
    /// Everything asked for was done: 0.
    Done,
    /// Something could not be read, scored or written: 1.
    Failed,
    /// All was scored, and `--fail-on` is met: 3.
    ConditionMet,
    /// All was done, but a motion stays as it was: every repair would have made something else
    /// worse: 4.
    HeldBack,
}

impl From<Exit> for ExitCode {
    fn from(exit: Exit) -> Self {
        Self::from(match exit {
            Exit::Done => 0,
            Exit::Failed => 1,
            Exit::ConditionMet => 3,
            Exit::HeldBack => 4,
        })
    }
}

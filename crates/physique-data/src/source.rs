//! Where motions come from.

mod draft;
mod files;
mod published;
mod recorded;

use std::collections::BTreeSet;
use std::path::Path;

use physique::motion::features::FeatureStatistics;

pub(crate) use draft::{Draft, DraftClip, Outcome, Plan, Sayings, SplitBy};
pub use published::PublishedSet;

use crate::index::SkeletonName;
use crate::{DataLimits, Error, LeftOut, Recipe, Storage};

/// A kind of data set.
#[derive(Clone, Debug, PartialEq)]
pub enum Source {
    /// Any folder of motions, by a recipe.
    Recipe(Box<Recipe>),
    /// A folder of HumanML3D or KIT-ML as its users have it.
    Published(PublishedSet),
}

/// What a source says of the whole data set.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct About {
    pub(crate) name: String,
    pub(crate) licence: String,
    pub(crate) attribution: String,
    pub(crate) storage: Storage,
    pub(crate) skeleton: SkeletonName,
    pub(crate) frame_rate: f64,
    /// Rows of the shortest and longest window.
    pub(crate) windows: (usize, usize),
    /// Labels that tell contents, not numbers of takes: the report counts by them.
    pub(crate) told: BTreeSet<String>,
}

/// Motions to look at, one after the other or at once.
pub(crate) struct Work<'a> {
    pub(crate) about: About,
    pub(crate) plan: Plan,
    /// Looks at one job of the plan.
    #[allow(clippy::type_complexity)] // One function.
    pub(crate) look: Box<dyn Fn(usize) -> Vec<Outcome> + Sync + 'a>,
    /// Mean and deviation, where the folder has them.
    pub(crate) statistics: Option<FeatureStatistics>,
}

impl Source {
    /// Looks through the folder without opening motions.
    pub(crate) fn work<'a>(
        &'a self,
        folder: &'a Path,
        limits: &'a DataLimits,
    ) -> Result<Work<'a>, Error> {
        match self {
            Self::Recipe(recipe) => recorded::work(recipe, folder, limits),
            Self::Published(set) => published::work(*set, folder, limits),
        }
    }
}

/// A reason as an outcome.
pub(crate) fn left_out(name: &str, reason: crate::Reason, message: impl ToString) -> Outcome {
    Outcome::LeftOut(LeftOut {
        name: name.to_owned(),
        reason,
        message: message.to_string(),
    })
}

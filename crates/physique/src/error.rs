//! What can go wrong above the single floors.

/// Why a motion could not be loaded or scored.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum Error {
    /// A body that does not work.
    #[error(transparent)]
    Body(#[from] physique_body::Error),
    /// A file or motion that does not work.
    #[error(transparent)]
    Motion(#[from] physique_motion::Error),
    /// A surface that cannot be measured.
    #[error(transparent)]
    Geometry(#[from] physique_geometry::Error),
    /// A body or motion whose physics cannot be measured; boxed, because it wraps the floors below.
    #[error(transparent)]
    Physics(Box<physique_physics::Error>),
    /// A sphere proxy that does not work.
    #[error(transparent)]
    Proxy(#[from] physique_proxy::Error),
    /// A repair of no strength.
    #[error("The strength of a repair must be a positive number; found {found}.")]
    Strength {
        /// The strength as given.
        found: f64,
    },
    /// A motion without frames has no score.
    #[error("The motion has no frames: there is nothing to score.")]
    NoFrames,
    /// Options that ask for no measure.
    #[error("There is nothing to measure: name at least one protocol and one group of measures.")]
    NothingToMeasure,
    /// A name that is no protocol's.
    #[error(
        "Protocol `{found}`: expected {}.",
        crate::Protocol::ALL.map(crate::Protocol::name).join(", ")
    )]
    Protocol {
        /// The name given.
        found: String,
    },
    /// An unreadable `--fail-on` condition.
    #[error(
        "Condition `{condition}`: expected MEASURE OP NUMBER such as \
         `self_intersection_mean_cm3>20`, found {found}."
    )]
    Condition {
        /// The condition as given.
        condition: String,
        /// What is wrong with it.
        found: String,
    },
}

impl From<physique_physics::Error> for Error {
    fn from(error: physique_physics::Error) -> Self {
        Self::Physics(Box::new(error))
    }
}

//! What can go wrong before a motion can be measured.

/// Why a body or motion cannot be measured.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum Error {
    /// A body whose surface is not closed has no inside.
    #[error(transparent)]
    Geometry(#[from] physique_geometry::Error),
    /// A body or pose that does not work.
    #[error(transparent)]
    Body(#[from] physique_body::Error),
    /// A motion that does not work; boxed, because it is the largest.
    #[error(transparent)]
    Motion(Box<physique_motion::Error>),
    /// An option outside its range.
    #[error("Physics option `{option}`: expected {expected}, found {found}.")]
    Option {
        /// The option's name.
        option: &'static str,
        /// What is possible.
        expected: &'static str,
        /// What was given.
        found: f64,
    },
    /// A body without volume, or without feet.
    #[error("Body {body}: expected {expected}, found {found}.")]
    Shape {
        /// The body model's name.
        body: String,
        /// What a body needs.
        expected: &'static str,
        /// What this one has.
        found: String,
    },
    /// A name that is no protocol's.
    #[error(
        "Protocol `{found}`: expected humos-released, humos-corrected, physdiff, gmd, \
         reindiffuse, kimodo, edge-pfc, mann, humor or ipman."
    )]
    Protocol {
        /// The name given.
        found: String,
    },
    /// Slices of a motion whose lengths disagree.
    #[error("Motion slices: {what} must hold {expected} elements, found {found}.")]
    Length {
        /// Which slice.
        what: &'static str,
        /// Elements needed.
        expected: usize,
        /// Elements given.
        found: usize,
    },
    /// A motion without frames has no measures.
    #[error("The motion has no frames: there is nothing to measure.")]
    NoFrames,
}

impl From<physique_motion::Error> for Error {
    fn from(error: physique_motion::Error) -> Self {
        Self::Motion(Box::new(error))
    }
}

//! What can go wrong with sphere bodies and their losses.

/// Why a sphere body, a list of pairs or a loss does not work.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum Error {
    /// Arrays of a sphere body that do not fit each other, or hold impossible numbers.
    #[error("Sphere body: expected {expected}, found {found}.")]
    SphereBody {
        /// What a sphere body needs.
        expected: &'static str,
        /// What this one has.
        found: String,
    },
    /// A pair that cannot be.
    #[error("Pair ({first}, {second}): expected two different spheres of {spheres}.")]
    Pair {
        /// Index of one sphere.
        first: usize,
        /// Index of the other.
        second: usize,
        /// Number of spheres.
        spheres: usize,
    },
    /// A list of pairs of another body.
    #[error("Pairs: expected pairs of {expected} spheres as the body has, found pairs of {found}.")]
    PairCount {
        /// Spheres of the body.
        expected: usize,
        /// Spheres that the pairs were chosen among.
        found: usize,
    },
    /// Slices whose lengths disagree.
    #[error("{what}: expected {expected} elements, found {found}.")]
    Length {
        /// Which slice.
        what: &'static str,
        /// Elements needed.
        expected: usize,
        /// Elements given.
        found: usize,
    },
    /// A tolerance that is no number.
    #[error("Tolerance: expected a finite depth, found {found}.")]
    Tolerance {
        /// What was given.
        found: f32,
    },
    /// Vector instructions that the processor lacks.
    #[error("Backend {backend}: this processor does not have it.")]
    Backend {
        /// What was asked for.
        backend: crate::Backend,
    },
    /// A rotation that is no number.
    #[error("Frame {frame}: expected a finite rotation of {joint}, found NaN or infinity.")]
    NotFinite {
        /// Index of the frame.
        frame: usize,
        /// The joint.
        joint: physique_body::Joint,
    },
    /// Rotations whose products leave the range of numbers.
    #[error("Frame {frame}: the posed spheres are too far away to be numbers.")]
    Overflow {
        /// Index of the frame.
        frame: usize,
    },
    /// A height field that is none.
    #[error("Height field: expected {expected}, found {found}.")]
    HeightField {
        /// What a height field needs.
        expected: &'static str,
        /// What this one has.
        found: String,
    },
    /// Features or positions that do not work; boxed, because it is the largest.
    #[error(transparent)]
    Motion(Box<physique_motion::Error>),
}

impl From<physique_motion::Error> for Error {
    fn from(error: physique_motion::Error) -> Self {
        Self::Motion(Box::new(error))
    }
}

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
    /// A rotation or position that is no number.
    #[error("Frame {frame}: expected finite numbers for {joint}, found NaN or infinity.")]
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
    /// Features whose counts do not fit each other.
    #[error("Features: expected {expected}, found {found}.")]
    Batch {
        /// What fits.
        expected: String,
        /// What was given.
        found: String,
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
    /// A network's parameters that do not fit, or cannot be.
    #[error("Regressor, {array}: expected {expected}, found {found}.")]
    Regressor {
        /// Which parameters.
        array: String,
        /// What fits.
        expected: String,
        /// What was given.
        found: String,
    },
    /// More betas than a regressor reads, or betas that are not finite.
    #[error("Shape: expected at most {available} finite betas, found {found}.")]
    Betas {
        /// Betas that the regressor reads.
        available: usize,
        /// The betas given.
        found: String,
    },
    /// A recipe that cannot be followed.
    #[error("Fit, {what}: expected {expected}, found {found}.")]
    FitOptions {
        /// Which option.
        what: &'static str,
        /// What is possible.
        expected: String,
        /// What was asked for.
        found: String,
    },
    /// A body around which samples cannot be drawn.
    #[error(
        "Samples: expected {wanted} points near the surface on each side, found {inside} inside and {outside} outside."
    )]
    Samples {
        /// Points wanted on each side.
        wanted: usize,
        /// Points found inside.
        inside: usize,
        /// Points found outside.
        outside: usize,
    },
    /// A checkpoint of another fit, or a broken one.
    #[error(
        "Checkpoint {path}: expected the state of this fit, found {found}; choose another work folder to start anew."
    )]
    Checkpoint {
        /// The file.
        path: std::path::PathBuf,
        /// What it holds.
        found: String,
    },
    /// The body's mesh or shape does not allow it.
    #[error(transparent)]
    Body(#[from] physique_body::Error),
    /// The body's surface does not allow it.
    #[error(transparent)]
    Geometry(#[from] physique_geometry::Error),
    /// A file could not be read or written.
    #[error(transparent)]
    File(#[from] physique_files::FileError),
    /// Counts of intersecting pairs that cannot be.
    #[error("Pair statistics: expected counts of at most {poses} poses, found {count}.")]
    PairCounts {
        /// Poses counted.
        poses: u64,
        /// A count.
        count: u32,
    },
    /// A proxy file that is not what its format demands.
    #[error("Proxy file {file}, {place}: expected {expected}, found {found}.")]
    ProxyFile {
        /// The file.
        file: String,
        /// The array.
        place: String,
        /// What the format demands.
        expected: String,
        /// What the file holds.
        found: String,
    },
    /// A proxy file that is broken, or holds more than data.
    #[error("Proxy file {file}: {problem}")]
    ProxyContent {
        /// The file.
        file: String,
        /// What is wrong with it.
        problem: Box<physique_files::Error>,
    },
    /// A proxy file whose parts are sound, but make no proxy.
    #[error("Proxy file {file}: {problem}")]
    ProxyParts {
        /// The file.
        file: String,
        /// What does not fit.
        problem: Box<Error>,
    },
    /// A size that is not embedded.
    #[error("Embedded proxies: expected 128, 192 or 256 spheres, found {found}.")]
    NoOpenProxy {
        /// Spheres asked for.
        found: usize,
    },
}

impl From<physique_motion::Error> for Error {
    fn from(error: physique_motion::Error) -> Self {
        Self::Motion(Box::new(error))
    }
}

impl Error {
    /// The error with the file that it comes from, unless it names one already.
    pub(crate) fn in_proxy_file(self, file: &str) -> Self {
        match self {
            Self::File(_)
            | Self::ProxyFile { .. }
            | Self::ProxyContent { .. }
            | Self::ProxyParts { .. } => self,
            problem => Self::ProxyParts {
                file: file.to_owned(),
                problem: Box::new(problem),
            },
        }
    }
}

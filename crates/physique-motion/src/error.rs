//! What can go wrong with a motion or its file.

use std::path::PathBuf;

use physique_files::FileError;

/// Why a motion could not be read, made, mapped or written.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum Error {
    /// The operating system refused.
    #[error("{path}: {problem}")]
    Io {
        /// The file.
        path: PathBuf,
        /// What the system said.
        problem: std::io::Error,
    },
    /// A filter that the frame rate does not allow.
    #[error(
        "The cutoff must be above 0 and below {highest} Hz, 0.4 of the frame rate, found {found}."
    )]
    Cutoff {
        /// The cutoff, in Hz.
        found: f64,
        /// What it must be below.
        highest: f64,
    },
    /// A frame rate that no motion has.
    #[error("The frame rate must be from 0.001 to 1,000,000 frames a second, found {found}.")]
    FrameRate {
        /// The value found.
        found: f64,
    },
    /// Arrays of a motion disagree in length.
    #[error(
        "A motion of {frames} frames and {joints} joints needs {expected} rotations, found {found}."
    )]
    RotationCount {
        /// Frames of the root translation.
        frames: usize,
        /// Joints a frame.
        joints: usize,
        /// frames x joints.
        expected: usize,
        /// Rotations given.
        found: usize,
    },
    /// A value that is not a finite number, or a rotation of no length.
    #[error("Frame {frame}, joint {joint}: {what} is not a finite number or not a rotation.")]
    NotFinite {
        /// Frame, from 0.
        frame: usize,
        /// Joint's name.
        joint: String,
        /// What was looked at.
        what: &'static str,
    },
    /// A skeleton that is not a tree of finite bones.
    #[error("Joint {index} ({joint}): expected {expected}.")]
    Skeleton {
        /// Joint's name.
        joint: String,
        /// Joint's index.
        index: usize,
        /// What a skeleton demands.
        expected: &'static str,
    },
    /// Arrays of a clip disagree in length.
    #[error(
        "A clip of {joints} joints, {moved} of them distinct joints that move, needs [frames][{joints}] rotations and [frames][{moved}] translations, found {rotations} and {translations}."
    )]
    ClipArrays {
        /// Joints of the skeleton.
        joints: usize,
        /// Rotations given.
        rotations: usize,
        /// Joints said to move within their parent.
        moved: usize,
        /// Translations given.
        translations: usize,
    },
    /// The content of a file is not what its format demands.
    #[error("{path}, {place}: expected {expected}, found {}.", without_stop(found))]
    Format {
        /// The file.
        path: PathBuf,
        /// Line, frame, key or byte.
        place: String,
        /// What the format demands.
        expected: String,
        /// What the file says.
        found: String,
    },
    /// A part of a file that is none.
    #[error("{path}, {place}: {problem}")]
    Inside {
        /// The file.
        path: PathBuf,
        /// Key, motion or line.
        place: String,
        /// What is wrong there.
        problem: Box<Error>,
    },
    /// A file that asks for more than [`crate::Limits`] allow.
    #[error(
        "{path}: {what} is {found}, above the limit of {limit}; raise the limit if the file is right."
    )]
    Limit {
        /// The file.
        path: PathBuf,
        /// What is too large.
        what: &'static str,
        /// Asked for.
        found: u64,
        /// Allowed.
        limit: u64,
    },
    /// A motion that a format cannot hold.
    #[error("The motion cannot be written as {format}: {reason}.")]
    Unwritable {
        /// Name of the format.
        format: &'static str,
        /// Why it cannot.
        reason: String,
    },
    /// A file of no known format.
    #[error(
        "{path} looks like {looks_like}; motions are read from BVH, ASF/AMC, glTF, AMASS (.npz), Physique's own .motion.npz, HumanML3D's and KIT's arrays (.npy), MDM's results.npy and DeepMimic's JSON."
    )]
    UnknownFormat {
        /// The file.
        path: PathBuf,
        /// What its content looks like.
        looks_like: String,
    },
    /// A file of several motions where one is expected.
    #[error(
        "{path} holds {found} motions where one is expected; name one by its number, such as {path}#0."
    )]
    ManyMotions {
        /// The file.
        path: PathBuf,
        /// Motions in it.
        found: usize,
    },
    /// A motion that a file of several does not hold.
    #[error("{path} holds {found} motions, but none called {name}; they are counted from #0.")]
    NoSuchMotion {
        /// The file.
        path: PathBuf,
        /// What was asked for.
        name: String,
        /// Motions in it.
        found: usize,
    },
    /// A pickle or PyTorch file that is broken, or that holds more than data.
    #[error("{path}: {problem}")]
    Data {
        /// The file.
        path: PathBuf,
        /// What is wrong with it.
        problem: physique_files::Error,
    },
    /// An array of a file is broken or missing.
    #[error("{path}: {problem}")]
    Array {
        /// The file.
        path: PathBuf,
        /// What is wrong with it.
        problem: crate::npz::ArrayError,
    },
    /// A skeleton in which no body was found.
    #[error("No human body was found in the skeleton: {problem}.")]
    NotHuman {
        /// What is missing or wrong.
        problem: String,
    },
    /// A clip without frames.
    #[error("The clip holds no frames.")]
    NoFrames,
    /// Joint positions that are not whole frames.
    #[error("Expected positions of {joints} joints for every frame, found {found} positions.")]
    PositionCount {
        /// Joints a frame.
        joints: usize,
        /// Positions given.
        found: usize,
    },
    /// Features that are not whole rows.
    #[error("Expected rows of {columns} features, found {found} numbers.")]
    FeatureCount {
        /// Columns of a row.
        columns: usize,
        /// Numbers given.
        found: usize,
    },
    /// A feature that is NaN or infinite.
    #[error("Frame {frame}, column {column} ({what}): expected a finite number.")]
    FeatureNotFinite {
        /// Frame, from 0.
        frame: usize,
        /// Column, from 0.
        column: usize,
        /// What the column holds, and of which joint.
        what: String,
    },
    /// A body that faces nowhere.
    #[error("Frame {frame}: hips and shoulders do not tell where the body faces.")]
    NoHeading {
        /// Frame, from 0.
        frame: usize,
    },
    /// A bone without a direction.
    #[error("Frame {frame}: expected a bone from {parent} to {joint}, found both in one place.")]
    NoBone {
        /// Frame, from 0.
        frame: usize,
        /// Upper joint's name.
        parent: &'static str,
        /// Lower joint's name.
        joint: &'static str,
    },
    /// Six numbers that are no rotation.
    #[error(
        "Frame {frame}, joint {joint}: expected six numbers of a rotation, found parallel or zero vectors."
    )]
    NoRotation {
        /// Frame, from 0.
        frame: usize,
        /// Joint's name.
        joint: &'static str,
    },
    /// Statistics that cannot normalise.
    #[error(
        "Column {column} of the {array}: expected a finite number, above 0 for a deviation, found {found}."
    )]
    Statistics {
        /// Mean or standard deviation.
        array: &'static str,
        /// Column, from 0.
        column: usize,
        /// The number.
        found: f32,
    },
}

impl From<FileError> for Error {
    fn from(error: FileError) -> Self {
        match error {
            FileError::TooLarge { path, found, limit } => Self::Limit {
                path,
                what: "the size in bytes",
                found,
                limit,
            },
            FileError::Io { path, problem } => Self::Io { path, problem },
        }
    }
}

/// A sentence of others without its full stop.
fn without_stop(found: &str) -> &str {
    found.strip_suffix('.').unwrap_or(found)
}

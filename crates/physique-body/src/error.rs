//! What can go wrong with a body or its file.

use crate::Joint;

/// Why a body could not be read, shaped or posed.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum Error {
    /// A body file that is not what its format demands.
    #[error("Body file {file}, {place}: expected {expected}, found {found}.")]
    Format {
        /// The file's name.
        file: String,
        /// The array or entry.
        place: String,
        /// What the format demands.
        expected: String,
        /// What the file holds.
        found: String,
    },
    /// The bytes of a body file cannot be read.
    #[error(transparent)]
    File(#[from] physique_files::FileError),
    /// A body file is broken, or holds more than data.
    #[error("Body file {file}: {problem}")]
    Content {
        /// The file's name.
        file: String,
        /// What is wrong with it.
        problem: Box<physique_files::Error>,
    },
    /// Arrays that do not fit together.
    #[error("Body model: {what} must be {expected}, found {found}.")]
    Model {
        /// The array.
        what: &'static str,
        /// What fits the others.
        expected: String,
        /// What was given.
        found: String,
    },
    /// More betas than the model has shape directions, or betas that are not finite.
    #[error("Shape: expected at most {available} finite betas, found {found}.")]
    Betas {
        /// Shape directions of the model.
        available: usize,
        /// The betas given.
        found: String,
    },
    /// A pose for another number of joints.
    #[error(
        "Pose: expected {} to {joints} rotations, found {found}.",
        Joint::COUNT
    )]
    RotationCount {
        /// Joints of the model.
        joints: usize,
        /// Rotations given.
        found: usize,
    },
    /// A person whom the model cannot represent.
    #[error("Body attributes: {what} must be {expected}, found {found}.")]
    Attributes {
        /// Which attribute.
        what: &'static str,
        /// What the model can do.
        expected: String,
        /// What was asked for.
        found: String,
    },
}

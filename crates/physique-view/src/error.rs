//! What can go wrong when a picture is drawn or written.

use std::path::PathBuf;

/// An error of this crate: each says where, what was expected and what was found.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum ViewError {
    /// A body or its surface cannot be posed or measured.
    #[error("the body cannot be drawn: {problem}")]
    Measure {
        /// What the floor below said.
        problem: String,
    },
    /// A triangle names a vertex that the mesh does not have.
    #[error(
        "triangle {triangle} names vertex {index}, but the mesh has {vertices} vertices (0 to {last})",
        last = vertices.saturating_sub(1)
    )]
    IndexOutOfRange {
        /// The triangle, counted from zero.
        triangle: usize,
        /// The vertex that it names.
        index: u32,
        /// How many vertices the mesh has.
        vertices: usize,
    },
    /// A coordinate is NaN, infinite or beyond [`MAX_COORDINATE`](crate::MAX_COORDINATE).
    #[error(
        "{what} {index} lies at ({x}, {y}, {z}); expected finite metres within {limit} of the origin",
        limit = crate::MAX_COORDINATE
    )]
    BadPosition {
        /// What the point belongs to, such as "vertex".
        what: &'static str,
        /// Which one, counted from zero.
        index: usize,
        /// Its coordinates as found.
        x: f32,
        /// See `x`.
        y: f32,
        /// See `x`.
        z: f32,
    },
    /// Two lists that go together differ in length.
    #[error("{what}: expected {expected} entries, found {found}")]
    LengthMismatch {
        /// Which list, and what it goes with.
        what: &'static str,
        /// The length that was expected.
        expected: usize,
        /// The length that was found.
        found: usize,
    },
    /// A picture without pixels, or with more than [`MAX_PIXELS`](crate::MAX_PIXELS).
    #[error(
        "a picture of {width} x {height} pixels cannot be drawn; expected 1 to {limit} pixels in all",
        limit = crate::MAX_PIXELS
    )]
    BadSize {
        /// Width in pixels.
        width: u64,
        /// Height in pixels.
        height: u64,
    },
    /// A camera that looks nowhere: not finite, eye on target, up along the line of sight, or no field of view.
    #[error("the camera cannot see: {reason}")]
    BadCamera {
        /// Which of its numbers is at fault, and what was expected.
        reason: &'static str,
    },
    /// More triangles than one picture can tell apart.
    #[error("a scene of {found} triangles is too large; expected fewer than {limit}", limit = u32::MAX)]
    TooManyTriangles {
        /// How many there would be.
        found: usize,
    },
    /// A sheet or strip has nothing to show.
    #[error("there is nothing to draw: {what}")]
    Empty {
        /// What is missing.
        what: &'static str,
    },
    /// The picture could not be compressed.
    #[error("the picture could not be encoded as PNG: {0}")]
    Encode(#[from] png::EncodingError),
    /// The file could not be written.
    #[error("{} could not be written: {source}", path.display())]
    Write {
        /// The file.
        path: PathBuf,
        /// What the operating system said.
        source: std::io::Error,
    },
}

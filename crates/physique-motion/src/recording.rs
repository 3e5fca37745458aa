//! A motion of the body together with what its file says about it.

use glam::Vec3;

use crate::Motion;

/// A motion of the body as a file holds it.
#[derive(Clone, Debug, PartialEq)]
pub struct Recording {
    /// The motion itself.
    pub motion: Motion,
    /// What to call it; readers fill in the file's name where the file is silent.
    pub name: String,
    /// Where the pelvis of the body that it was recorded for stands in its rest pose, in metres.
    ///
    /// [`Motion::root_translation`] counts from here, so a body with another rest pelvis must add
    /// the difference to stand at the same place.
    pub rest_pelvis: Vec3,
    /// Where it comes from, as its file says.
    pub source: Option<String>,
    /// Under which licence, as its file says.
    pub licence: Option<String>,
    /// What the reader left out, guessed or changed: full sentences.
    pub notes: Vec<String>,
}

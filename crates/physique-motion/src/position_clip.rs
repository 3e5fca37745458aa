//! A motion known by its joints' positions, together with what its file says about it.

use crate::features::JointPositions;

/// Joint positions over time as a file holds them: HumanML3D's 22 joints or KIT's 21.
///
/// [`crate::inverse_kinematics::solve`] finds the body's rotations.
#[derive(Clone, Debug, PartialEq)]
pub struct PositionClip {
    /// The positions, Y up, in the file's unit of length; frame rate and skeleton with them.
    pub positions: JointPositions,
    /// What the reader recovered, guessed or left out: full sentences.
    pub notes: Vec<String>,
}

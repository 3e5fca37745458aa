//! From what networks generate to motions of a body.

use anyhow::Result;
use physique::body::Body;
use physique::load::{LoadOptions, Loaded, load_positions};
use physique::motion::PositionClip;
use physique::motion::features::{MotionFeatures, recover_from_positions};

/// Features as a motion of the body, by inverse kinematics of their joints' positions.
pub(crate) fn on_body(features: &MotionFeatures, body: &Body) -> Result<Loaded> {
    let clip = PositionClip {
        positions: recover_from_positions(features)?,
        notes: Vec::new(),
    };
    Ok(load_positions(&clip, body, &LoadOptions::default())?)
}

//! Where the floor is taken to be.

use physique_motion::Motion;
use physique_physics::{GroundChoice, Physics, PhysicsOptions};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use crate::Error;

/// How far HUMOS sinks its clips, in metres.
const HUMOS_SINK_M: f64 = 0.02;

/// Where the floor is: found once for a clip, over all its frames, for every protocol.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum Floor {
    /// At height 0 of the motion: what is sunk or floats as a whole shows.
    #[default]
    Zero,
    /// At the lowest skin of the clip: nothing can sink, and a single low frame lifts all others.
    Lowest,
    /// Where slow soles stand: robust against single frames.
    Estimated,
    /// 2 cm above the lowest skin of the clip: how HUMOS prepares its data.
    HumosSink,
}

impl Floor {
    /// Height of the floor in the motion's world, in metres; 0 for a motion without frames.
    ///
    /// # Errors
    /// [`Error::Body`] when the motion does not fit the body.
    pub fn height(self, physics: &Physics, motion: &Motion) -> Result<f64, Error> {
        Ok(match self {
            Self::Zero => 0.0,
            Self::Lowest => lowest_skin(physics, motion)?,
            Self::HumosSink => lowest_skin(physics, motion)? + HUMOS_SINK_M,
            Self::Estimated => {
                let options = PhysicsOptions {
                    ground: GroundChoice::Estimated,
                    ..PhysicsOptions::default()
                };
                physics.ground_height(motion, &options)
            }
        })
    }
}

/// Height of the lowest vertex of all frames.
fn lowest_skin(physics: &Physics, motion: &Motion) -> Result<f64, Error> {
    let body = physics.body();
    let mut posed = body.posed();
    let mut lowest = f32::MAX;
    for frame in 0..motion.frame_count() {
        body.pose(&motion.pose(frame), &mut posed)?;
        lowest = posed.vertices().iter().map(|v| v.y).fold(lowest, f32::min);
    }
    Ok(match motion.frame_count() {
        0 => 0.0,
        _ => f64::from(lowest),
    })
}

/// The motion lowered by a height, so that its floor lies at 0.
pub(crate) fn lowered(motion: &Motion, height: f64) -> Result<Motion, Error> {
    let down = glam::Vec3::Y * height as f32;
    let roots = motion.root_translation().iter().map(|root| *root - down);
    Ok(Motion::new(
        motion.frame_rate(),
        motion.shape().cloned(),
        roots.collect(),
        motion.rotations().to_vec(),
    )?)
}

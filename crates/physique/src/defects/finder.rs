//! All defects of a motion on a body.

use physique_body::Body;
use physique_motion::Motion;
use physique_physics::{GroundChoice, Physics, PhysicsOptions};

use super::track::JointTrack;
use super::{Defect, DefectKind, DefectLimits, flight, ground, jump, still};
use crate::Error;
use crate::self_intersection::SelfIntersection;

/// Finds what is wrong with motions of one body.
///
/// ```
/// use physique::body::{Body, Sex, open_body};
/// use physique::defects::{DefectFinder, DefectLimits};
/// use physique::motion::embedded;
///
/// let body = Body::mean(open_body()?, Sex::Neutral)?;
/// let finder = DefectFinder::new(&body, DefectLimits::default())?;
/// let walk = embedded::clip("walk").expect("it is embedded").load()?;
/// assert_eq!(finder.find(&walk.motion)?, []);
/// # Ok::<(), physique::Error>(())
/// ```
#[derive(Clone, Debug)]
pub struct DefectFinder {
    physics: Physics,
    limits: DefectLimits,
}

impl DefectFinder {
    /// Prepares a body: a tenth of a second, once.
    ///
    /// # Errors
    /// [`Error::Physics`] for a body without inside or feet.
    pub fn new(body: &Body, limits: DefectLimits) -> Result<Self, Error> {
        Ok(Self {
            physics: Physics::new(body)?,
            limits,
        })
    }

    /// The thresholds.
    pub const fn limits(&self) -> &DefectLimits {
        &self.limits
    }

    /// What is wrong with a motion, self-intersection left out; empty for a good one. The ground
    /// is at height 0.
    ///
    /// Costs about 0.15 ms a frame on one core.
    ///
    /// # Errors
    /// None for a motion of this body with frames; one without is a defect, not an error.
    pub fn find(&self, motion: &Motion) -> Result<Vec<Defect>, Error> {
        if motion.frame_count() == 0 {
            return Ok(vec![Defect::of_error(&Error::NoFrames)]);
        }
        let limits = &self.limits;
        let mut defects = Vec::new();
        defects.extend(too_short(motion, limits));
        let track = JointTrack::new(motion, self.physics.body())?;
        defects.extend(jump::find(&track, limits));
        defects.extend(still::find(&track, limits));
        let stated = motion.frame_rate().per_second();
        if let Some(defect) = unusual_frame_rate(stated, limits) {
            // What is said of speeds at such a rate means nothing.
            defects.push(defect);
            return Ok(defects);
        }
        let options = PhysicsOptions::default();
        let estimated = PhysicsOptions {
            ground: GroundChoice::Estimated,
            ..options
        };
        let standing = self.physics.ground_height(motion, &estimated);
        let measures = self.physics.measure(motion, &options)?;
        defects.extend(flight::find(&measures.frames, standing, stated, limits));
        defects.extend(ground::find(&measures.ground, standing, limits));
        Ok(defects)
    }

    /// Whether a body passes through itself too much.
    pub fn of_self_intersection(&self, found: &SelfIntersection) -> Option<Defect> {
        let limit = self.limits.self_intersection_cm3;
        let worst = found.pairs.iter().find(|pair| !pair.crease)?;
        (found.mean_cm3 > limit).then(|| {
            let message = format!(
                "Parts of the body share {:.0} cm3 on average and {:.0} cm3 at {:.2} s; most of it \
                 is {} and {}.",
                found.mean_cm3, found.worst_cm3, found.worst_s, worst.parts[0], worst.parts[1],
            );
            Defect::measured(
                DefectKind::SelfIntersection,
                message,
                Some(found.worst_s),
                found.mean_cm3,
                limit,
            )
        })
    }
}

fn too_short(motion: &Motion, limits: &DefectLimits) -> Option<Defect> {
    let seconds = motion.seconds();
    (seconds < limits.least_s).then(|| {
        let frames = motion.frame_count();
        let message = format!("The clip lasts {seconds:.2} s ({frames} frames).");
        Defect::measured(DefectKind::TooShort, message, None, seconds, limits.least_s)
    })
}

fn unusual_frame_rate(stated: f64, limits: &DefectLimits) -> Option<Defect> {
    let [least, greatest] = limits.frame_rates_fps;
    let limit = if stated < least { least } else { greatest };
    (!(least..=greatest).contains(&stated)).then(|| {
        let message = format!(
            "The stated frame rate is {stated:.2} a second; motion comes at {least:.0} to \
             {greatest:.0}."
        );
        Defect::measured(DefectKind::FrameRate, message, None, stated, limit)
    })
}

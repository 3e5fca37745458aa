//! Which clips of a collection are bad, and why: what `physique scan` says.

use physique_body::Body;
use physique_motion::{FrameRate, Motion};
use physique_physics::protocol::resampled;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use crate::defects::{Defect, DefectFinder, DefectKind, DefectLimits};
use crate::{Error, Group, Protocol, ScoreOptions, Scorer};

/// Name and version of the JSON that [`ScanReport`] becomes.
pub const SCHEMA: &str = "physique.scan/1";

/// Frames a second at which self-intersection is looked at: enough for its mean.
const SAMPLES_A_SECOND: f64 = 5.0;

/// What a scan of many clips found.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct ScanReport {
    /// Name and version of this format: `physique.scan/1`.
    pub schema: String,
    /// Version of Physique that looked.
    pub physique_version: String,
    /// One entry a clip, in the order asked for; good ones have no defects.
    pub clips: Vec<ClipReport>,
}

impl ScanReport {
    /// What was found of clips.
    pub fn new(clips: Vec<ClipReport>) -> Self {
        Self {
            schema: SCHEMA.to_owned(),
            physique_version: env!("CARGO_PKG_VERSION").to_owned(),
            clips,
        }
    }
}

/// What is wrong with one clip.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct ClipReport {
    /// The file.
    pub file: String,
    /// The file's name, with `#` and a number or key where it holds several motions.
    pub name: String,
    /// Number of frames; null where the clip cannot be read.
    pub frames: Option<usize>,
    /// Frames a second; null where the clip cannot be read.
    pub frame_rate_fps: Option<f64>,
    /// What is wrong; empty for a good clip.
    pub defects: Vec<Defect>,
}

/// Looks at clips on one body: [`DefectFinder`], and self-intersection at five frames a second.
#[derive(Clone, Debug)]
pub struct Scanner {
    finder: DefectFinder,
    /// Where self-intersection is wanted.
    scorer: Option<Scorer>,
    kinds: Vec<DefectKind>,
}

impl Scanner {
    /// Prepares a body to look for these kinds of defects.
    ///
    /// # Errors
    /// [`Error::Geometry`] or [`Error::Physics`] for a body whose surface is not closed.
    pub fn new(body: &Body, limits: DefectLimits, kinds: &[DefectKind]) -> Result<Self, Error> {
        let options = ScoreOptions {
            protocols: vec![Protocol::Native],
            groups: vec![Group::SelfIntersection],
            ..ScoreOptions::default()
        };
        let scorer = kinds.contains(&DefectKind::SelfIntersection);
        let scorer = scorer.then(|| Scorer::new(body.clone(), options));
        Ok(Self {
            finder: DefectFinder::new(body, limits)?,
            scorer: scorer.transpose()?,
            kinds: kinds.to_vec(),
        })
    }

    /// The defects of a motion, of the kinds asked for.
    ///
    /// # Errors
    /// As [`DefectFinder::find`].
    pub fn scan(&self, motion: &Motion) -> Result<Vec<Defect>, Error> {
        let mut defects = self.finder.find(motion)?;
        if let Some(scorer) = &self.scorer
            && motion.frame_count() > 0
        {
            let sampled = match motion.frame_rate().per_second() > SAMPLES_A_SECOND {
                true => resampled(motion, FrameRate::new(SAMPLES_A_SECOND)?)?,
                false => motion.clone(),
            };
            let found = scorer.score(&sampled)?.self_intersection;
            defects.extend(found.and_then(|found| self.finder.of_self_intersection(&found)));
        }
        Ok(self.of_kinds(defects))
    }

    /// The defects of the kinds asked for.
    pub fn of_kinds(&self, defects: impl IntoIterator<Item = Defect>) -> Vec<Defect> {
        let wanted = defects.into_iter();
        wanted
            .filter(|defect| self.kinds.contains(&defect.kind))
            .collect()
    }
}

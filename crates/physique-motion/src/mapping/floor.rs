//! The floor of a recording, from the feet that stand on it.

use glam::Quat;

use super::{
    body_rest::BodyRest,
    foot_tracks::{FootTracks, lower_of},
    slope::SlopingFloor,
    soles::Soles,
};

/// What feet tell of the floor.
#[derive(Clone, Debug)]
pub(super) struct Floor {
    /// Heights of standing feet after the floor is turned level.
    pub(super) soles: Soles,
    /// How the floor slopes, if it does.
    pub(super) slope: Option<SlopingFloor>,
    /// Heights over the floor at which the lower foot stands, sorted, in metres.
    stands: Vec<f32>,
    frames: usize,
}

impl Floor {
    /// The floor under the feet; `level`: look for a slope and turn it level.
    pub(super) fn under(feet: FootTracks, body: &BodyRest, level: bool) -> Self {
        /// Feet must come so much nearer to a floor that is turned level.
        const NEARER: f32 = 0.6;
        let as_recorded = Self::flat(&feet, body);
        let slope = level.then(|| SlopingFloor::find(&feet)).flatten();
        let Some(slope) = slope else {
            return as_recorded;
        };
        let turned = Self::flat(&feet.turned(slope.level_from_source), body);
        // Planes fit a dancer who stands on the toes at one end, too.
        if turned.usual_stand() > NEARER * as_recorded.usual_stand() {
            return as_recorded;
        }
        Self {
            slope: Some(slope),
            ..turned
        }
    }

    fn flat(feet: &FootTracks, body: &BodyRest) -> Self {
        let soles = Soles::measure(feet, body);
        let stands = (0..feet.frame_count()).filter_map(|frame| {
            let height = |side: usize| {
                let foot = &feet.sides[side];
                soles.over_floor(foot.ankles[frame], foot.balls.get(frame).copied())
            };
            let side = lower_of(height);
            feet.stands(side, frame).then(|| height(side))
        });
        let mut stands: Vec<f32> = stands.collect();
        stands.sort_by(f32::total_cmp);
        Self {
            soles,
            slope: None,
            stands,
            frames: feet.frame_count(),
        }
    }

    /// Turns the source's world before anything else.
    pub(super) fn level_from_source(&self) -> Quat {
        self.slope
            .map_or(Quat::IDENTITY, |slope| slope.level_from_source)
    }

    /// Half of all stands are lower.
    fn usual_stand(&self) -> f32 {
        let middle = self.stands.get(self.stands.len() / 2);
        middle.copied().unwrap_or(0.0)
    }

    /// How far over the floor the lower foot stands at times, in metres, where that is a step or
    /// a ladder rather than noise; `None` on even ground.
    fn highest_stand(&self) -> Option<f32> {
        /// A foot may stand so high on any even ground: sole, noise and soft shoes.
        const EVEN: f32 = 0.08;
        /// Of all frames, those on higher ground.
        const LEAST_SHARE: f32 = 0.05;
        let high = self.stands.len() - self.stands.partition_point(|&height| height < EVEN);
        if (high as f32) < LEAST_SHARE * self.frames as f32 {
            return None;
        }
        // The very highest may be a foot that hangs still for a moment.
        let last = self.stands.len().checked_sub(1)?;
        self.stands.get(last * 98 / 100).copied()
    }

    /// What a reader of the result should know.
    pub(super) fn notes(&self) -> Vec<String> {
        let mut notes = Vec::new();
        if let Some(slope) = self.slope {
            let degrees = slope.degrees;
            notes.push(format!(
                "the floor of the recording slopes by {degrees:.1} degrees, so it was turned level"
            ));
        }
        if let Some(height) = self.highest_stand() {
            notes.push(format!(
                "the ground is uneven: feet stand up to {height:.2} m above the lowest place"
            ));
        }
        notes
    }
}

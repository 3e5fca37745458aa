//! The promise of a repair: nothing that `score` measures gets worse beyond a stated tolerance.

use std::borrow::Cow;
use std::fmt;

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use crate::MotionScore;
use crate::measures::measures;

/// How much a measure may grow.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Tolerance {
    /// Name of the measure, as in [`crate::measures`].
    pub measure: &'static str,
    /// Part of the value before.
    pub relative: f64,
    /// And this much more, in the measure's unit.
    pub absolute: f64,
    /// Whether a greater value is better.
    pub greater_is_better: bool,
}

/// What is promised. Measures of flight and the whole body's pace are not better or worse.
#[rustfmt::skip]
pub const PROMISE: [Tolerance; 12] = [
    Tolerance::less("self_intersection_mean_cm3", 0.02, 0.5),
    Tolerance::less("self_intersection_worst_cm3", 0.02, 5.0),
    Tolerance::less("ground_penetration_mean_cm", 0.02, 0.05),
    Tolerance::less("ground_penetration_worst_cm", 0.05, 0.3),
    Tolerance::less("ground_floating_mean_cm", 0.02, 0.05),
    Tolerance::less("ground_unsupported_percent", 0.02, 1.0),
    Tolerance::less("feet_slide_mean_cm_s", 0.03, 0.2),
    Tolerance::less("feet_slide_frames_percent", 0.03, 2.0),
    Tolerance::greater("balance_stable_percent", 0.0, 3.0),
    Tolerance::less("balance_outside_mean_cm", 0.05, 0.3),
    Tolerance::less("smoothness_jerk_mean_m_s3", 0.05, 1.0),
    Tolerance::less("smoothness_jitter_mean_mm", 0.05, 0.1),
];

impl Tolerance {
    const fn less(measure: &'static str, relative: f64, absolute: f64) -> Self {
        Self {
            measure,
            relative,
            absolute,
            greater_is_better: false,
        }
    }

    const fn greater(measure: &'static str, relative: f64, absolute: f64) -> Self {
        Self {
            greater_is_better: true,
            ..Self::less(measure, relative, absolute)
        }
    }

    /// How much worse than this the measure may get.
    pub fn allowed(&self, before: f64) -> f64 {
        self.relative * before.abs() + self.absolute
    }

    fn is_broken(&self, before: f64, after: f64) -> bool {
        let sign = if self.greater_is_better { -1.0 } else { 1.0 };
        let worse = sign * (after - before);
        worse.is_nan() || worse > self.allowed(before)
    }
}

/// A measure that a repair would have made worse.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct Worse {
    /// Name of the measure.
    pub measure: Cow<'static, str>,
    /// In the source.
    pub before: f64,
    /// In the repaired motion.
    pub after: f64,
}

impl Worse {
    /// By how many tolerances the promise is broken, beyond the one that is allowed.
    pub(super) fn violation(&self) -> f64 {
        let promise = PROMISE
            .iter()
            .find(|promise| promise.measure == self.measure);
        let allowed = promise.map_or(0.0, |promise| promise.allowed(self.before));
        let violation = (self.after - self.before).abs() / allowed - 1.0;
        if violation.is_finite() {
            violation
        } else {
            10.0
        }
    }
}

impl fmt::Display for Worse {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self {
            measure,
            before,
            after,
        } = self;
        write!(formatter, "{measure} from {before:.2} to {after:.2}")
    }
}

/// All measures that are worse beyond their tolerance; a measure that is lost is worse.
pub(super) fn broken(before: &MotionScore, after: &MotionScore) -> Vec<Worse> {
    let (before, after) = (measures(before), measures(after));
    let value = |measures: &[(Cow<'static, str>, f64)], name| {
        let found = measures.iter().find(|(measure, _)| *measure == name);
        found.map(|(_, value)| *value)
    };
    PROMISE
        .iter()
        .filter_map(|tolerance| {
            let before = value(&before, tolerance.measure)?;
            let after = value(&after, tolerance.measure).unwrap_or(f64::NAN);
            tolerance.is_broken(before, after).then_some(Worse {
                measure: tolerance.measure.into(),
                before,
                after,
            })
        })
        .collect()
}

//! A row of the paper's table.

use serde::Serialize;

use super::RepetitionMeasures;
use crate::evaluation::Interval;

/// Means over repetitions, each with its 95 % interval.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct EvaluationRow {
    /// Whose motions.
    pub name: String,
    /// What else there is to know of them.
    pub about: String,
    /// Motions a repetition.
    pub motions: usize,
    /// Real motions that they are compared with, a repetition.
    pub real_motions: usize,
    /// Pairs of motions whose distances are diversity.
    pub diversity_pairs: usize,
    /// Top 1, 2 and 3 of 32.
    pub r_precision: [Interval; 3],
    /// Mean distance of motions from their captions.
    pub multimodal_distance: Interval,
    /// Fréchet distance from the real motions.
    pub fid: Interval,
    /// Mean distance of motions from each other.
    pub diversity: Interval,
    /// Mean distance of motions of one caption from each other.
    pub multimodality: Option<Interval>,
    /// Mean over motions, in the published metric's "cm3".
    pub self_intersection_cm3: Option<Interval>,
    /// Where the row is not what the paper's would be.
    pub remarks: Vec<String>,
}

impl EvaluationRow {
    /// Summarises repetitions; NaN for none.
    pub fn of(name: &str, about: &str, measures: &[RepetitionMeasures]) -> Self {
        let interval = |of: fn(&RepetitionMeasures) -> f64| {
            Interval::of(&measures.iter().map(of).collect::<Vec<_>>())
        };
        let where_measured = |of: fn(&RepetitionMeasures) -> Option<f64>| {
            let values: Vec<f64> = measures.iter().filter_map(of).collect();
            (!values.is_empty()).then(|| Interval::of(&values))
        };
        let least = |of: fn(&RepetitionMeasures) -> usize| {
            measures.iter().map(of).min().unwrap_or_default()
        };
        Self {
            name: name.to_owned(),
            about: about.to_owned(),
            motions: least(|measures| measures.motions),
            real_motions: least(|measures| measures.real_motions),
            diversity_pairs: least(|measures| measures.diversity_pairs),
            r_precision: [
                interval(|measures| measures.r_precision[0]),
                interval(|measures| measures.r_precision[1]),
                interval(|measures| measures.r_precision[2]),
            ],
            multimodal_distance: interval(|measures| measures.multimodal_distance),
            fid: interval(|measures| measures.fid),
            diversity: interval(|measures| measures.diversity),
            multimodality: where_measured(|measures| measures.multimodality),
            self_intersection_cm3: where_measured(|measures| measures.self_intersection_cm3),
            remarks: Vec::new(),
        }
    }
}

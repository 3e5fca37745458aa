//! How far the body's joints end up from the source's.

use physique_body::Joint;

/// Distances between source and result over a motion, in centimetres.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Distances {
    /// Mean.
    pub mean_cm: f32,
    /// 95 of 100 are smaller.
    pub percentile_95_cm: f32,
    /// Largest.
    pub max_cm: f32,
}

impl Distances {
    /// From distances in metres, which are sorted in place; zero for none.
    pub(crate) fn of(metres: &mut [f32]) -> Self {
        metres.sort_by(f32::total_cmp);
        let Some(&max) = metres.last() else {
            return Self::default();
        };
        let sum: f64 = metres.iter().copied().map(f64::from).sum();
        Self {
            mean_cm: (100.0 * sum / metres.len() as f64) as f32,
            percentile_95_cm: 100.0 * metres[(metres.len() - 1) * 95 / 100],
            max_cm: 100.0 * max,
        }
    }
}

/// Distances between the joints of the source, scaled by the length of the legs, and the body's.
///
/// Joints of two skeletons are never at the same place of the body, and arms, trunk and head keep
/// the body's own proportions: some centimetres remain in any good mapping. Ankles say how well
/// the feet keep their places.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct FitError {
    /// All joints of the list together.
    pub all: Distances,
    /// By joint of the body, where one joint is the source.
    pub by_joint: Vec<(Joint, Distances)>,
}

/// Gathers distances frame by frame.
#[derive(Clone, Debug, Default)]
pub(crate) struct FitErrorGatherer {
    by_joint: [Vec<f32>; Joint::COUNT],
}

impl FitErrorGatherer {
    pub(crate) fn add(&mut self, joint: Joint, metres: f32) {
        self.by_joint[joint.index()].push(metres);
    }

    pub(crate) fn finish(mut self) -> FitError {
        let mut all: Vec<f32> = self.by_joint.iter().flatten().copied().collect();
        let by_joint = Joint::ALL
            .into_iter()
            .filter_map(|joint| {
                let distances = &mut self.by_joint[joint.index()];
                (!distances.is_empty()).then(|| (joint, Distances::of(distances)))
            })
            .collect();
        FitError {
            all: Distances::of(&mut all),
            by_joint,
        }
    }
}

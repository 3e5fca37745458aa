//! How far the body's joints and bones end up from the source's.

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
        let [mean, percentile_95, max] = spread(metres).map(|metres| 100.0 * metres);
        Self {
            mean_cm: mean,
            percentile_95_cm: percentile_95,
            max_cm: max,
        }
    }
}

/// Angles between directions of the source and the result over a motion, in degrees.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Angles {
    /// Mean.
    pub mean_degrees: f32,
    /// 95 of 100 are smaller.
    pub percentile_95_degrees: f32,
    /// Largest.
    pub max_degrees: f32,
}

impl Angles {
    /// From angles in degrees, which are sorted in place; zero for none.
    fn of(degrees: &mut [f32]) -> Self {
        let [mean_degrees, percentile_95_degrees, max_degrees] = spread(degrees);
        Self {
            mean_degrees,
            percentile_95_degrees,
            max_degrees,
        }
    }
}

/// Mean, 95th percentile and maximum of values, which are sorted in place; zeros for none.
fn spread(values: &mut [f32]) -> [f32; 3] {
    values.sort_by(f32::total_cmp);
    let Some(&max) = values.last() else {
        return [0.0; 3];
    };
    let sum: f64 = values.iter().copied().map(f64::from).sum();
    let mean = (sum / values.len() as f64) as f32;
    [mean, values[(values.len() - 1) * 95 / 100], max]
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
    /// By upper joint of each bone of the limbs: upper arms and forearms, thighs and shins.
    /// Arms keep their directions to rounding; legs differ by what keeps feet in place. Empty
    /// where rotations were solved from positions.
    pub by_limb: Vec<(Joint, Angles)>,
}

/// Gathers distances frame by frame.
#[derive(Clone, Debug, Default)]
pub(crate) struct FitErrorGatherer {
    by_joint: [Vec<f32>; Joint::COUNT],
    by_limb: [Vec<f32>; Joint::COUNT],
}

impl FitErrorGatherer {
    pub(crate) fn add(&mut self, joint: Joint, metres: f32) {
        self.by_joint[joint.index()].push(metres);
    }

    /// `upper`: the joint from which the bone goes.
    pub(crate) fn add_bone(&mut self, upper: Joint, degrees: f32) {
        self.by_limb[upper.index()].push(degrees);
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
        let by_limb = Joint::ALL
            .into_iter()
            .filter_map(|joint| {
                let angles = &mut self.by_limb[joint.index()];
                (!angles.is_empty()).then(|| (joint, Angles::of(angles)))
            })
            .collect();
        FitError {
            all: Distances::of(&mut all),
            by_joint,
            by_limb,
        }
    }
}

//! A motion as a few hundred numbers.

use physique_motion::features::MotionFeatures;

/// Statistics over a motion's frames: where joints are, seen from the root and its heading, and how
/// fast they and the root move. The length of the motion is not among them.
#[derive(Clone, Debug, PartialEq)]
pub struct MotionDescription(Vec<f32>);

/// Numbers about the root, after those about joints.
const ROOT: usize = 10;

impl MotionDescription {
    /// Describes features, not normalised.
    pub fn of(features: &MotionFeatures) -> Self {
        let (layout, rate) = (features.layout(), features.frame_rate().per_second() as f32);
        let column = |column: usize| Series::of(features.rows().map(|row| row[column]));
        let mut numbers = Vec::with_capacity(5 * layout.positions.len() + ROOT);
        for position in layout.positions.clone().map(column) {
            // Movement tells more than place: it counts twice.
            numbers.extend([
                position.mean,
                2.0 * position.deviation,
                position.most,
                position.least,
            ]);
        }
        for joint in layout.velocities.clone().step_by(3) {
            let speeds = features.rows().map(|row| {
                let velocity = &row[joint..joint + 3];
                velocity.iter().map(|v| v * v).sum::<f32>().sqrt()
            });
            // Half of metres a second are about as far apart as metres of place.
            numbers.push(0.5 * rate * Series::of(speeds).mean);
        }
        // The feature is half the turn to the next frame.
        let turn = |row: &[f32]| 2.0 * row[layout.root_turn];
        let turns = Series::of(features.rows().map(turn));
        let turned = Series::of(features.rows().map(|row| turn(row).abs()));
        let whole = turns.mean * features.frame_count() as f32;
        numbers.extend([whole, 0.5 * rate * turns.mean, 0.5 * rate * turned.mean]);
        for axis in layout.root_velocity.clone().map(column) {
            numbers.extend([rate * axis.mean, 2.0 * rate * axis.deviation]);
        }
        let height = column(layout.root_height);
        numbers.extend([height.mean, 3.0 * height.deviation, height.least]);
        Self(numbers)
    }

    /// The numbers; as many for each motion of a skeleton.
    pub fn numbers(&self) -> &[f32] {
        &self.0
    }
}

/// A number over time.
struct Series {
    mean: f32,
    deviation: f32,
    least: f32,
    most: f32,
}

impl Series {
    fn of(values: impl Iterator<Item = f32> + Clone) -> Self {
        let count = values.clone().count().max(1) as f32;
        let mean = values.clone().sum::<f32>() / count;
        let squares = values.clone().map(|value| (value - mean) * (value - mean));
        Self {
            mean,
            deviation: (squares.sum::<f32>() / count).sqrt(),
            least: values.clone().fold(f32::INFINITY, f32::min),
            most: values.fold(f32::NEG_INFINITY, f32::max),
        }
    }
}

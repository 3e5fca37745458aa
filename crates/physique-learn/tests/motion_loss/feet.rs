//! Losses of feet: against equations in 64 bits, and what they must be of bodies that stand, float,
//! sink and slide.

use physique_learn::motion_loss::{GroundLoss, LossAndGradient, MotionLoss, SlidingLoss};
use physique_learn::random::Random;
use physique_motion::features::{
    FeatureLayout, FeatureSkeleton, FeatureStatistics, JointPositions, MotionFeatures, extract,
};
use physique_motion::mapping::BodyRest;
use physique_motion::{FrameRate, embedded};

const SKELETON: FeatureSkeleton = FeatureSkeleton::HumanMl3d;
const COLUMNS: usize = 263;
/// Ankle and toes of the left foot, then of the right one.
const FEET: [usize; 4] = [7, 10, 8, 11];

fn rest() -> BodyRest {
    let body = physique::body::open_body().expect("embedded");
    BodyRest::from(&physique::body::Body::new(body, &[]).expect("mean shape"))
}

/// Statistics that change numbers: unlike for every column.
fn statistics() -> FeatureStatistics {
    let columns = || (0..COLUMNS).map(|column| column as f32);
    let mean = columns().map(|column| 0.01 * (column * 0.7).sin());
    let deviation = columns().map(|column| 0.5 + 0.3 * (column * 1.3).cos());
    FeatureStatistics::new(SKELETON, mean.collect(), deviation.collect()).expect("possible")
}

fn ground() -> GroundLoss {
    GroundLoss::new(statistics())
}

fn sliding() -> SlidingLoss {
    SlidingLoss::new(statistics())
}

fn of(loss: &dyn MotionLoss, rows: &[f32]) -> LossAndGradient {
    let mut normalised = rows.to_vec();
    statistics().normalise(&mut normalised);
    let frames = rows.len() / COLUMNS;
    let found = loss.evaluate(&normalised, frames, &[frames]);
    found.expect("numbers")
}

fn value(loss: &dyn MotionLoss, rows: &[f32]) -> f64 {
    f64::from(of(loss, rows).losses[0])
}

/// Rows of an embedded clip.
fn clip(name: &str) -> Vec<f32> {
    let motion = embedded::clip(name).expect(name).load().expect(name).motion;
    let positions = JointPositions::from_motion(&motion, &rest()).expect("finite");
    extract(&positions).expect("frames").values().to_vec()
}

/// Rows of the embedded body that stands in its rest pose.
fn standing(frames: usize) -> Vec<f32> {
    let rest = rest();
    let joints: Vec<_> = rest.joints.to_vec();
    let rate = FrameRate::new(20.0).expect("above 0");
    let positions = joints.repeat(frames + 1);
    let positions = JointPositions::new(rate, SKELETON, positions).expect("finite");
    let features: MotionFeatures = extract(&positions).expect("frames");
    features.values().to_vec()
}

/// All joints higher.
fn lifted(rows: &[f32], by: f32) -> Vec<f32> {
    let layout = FeatureLayout::of(SKELETON);
    let mut rows = rows.to_vec();
    for row in rows.chunks_exact_mut(COLUMNS) {
        row[layout.root_height] += by;
        let positions = &mut row[layout.positions.clone()];
        positions
            .iter_mut()
            .skip(1)
            .step_by(3)
            .for_each(|y| *y += by);
    }
    rows
}

/// The equations, in 64 bits, with contacts from `contacts` as constants: ground and sliding.
fn reference(rows: &[f64], contacts: &[f64]) -> [f64; 2] {
    let layout = FeatureLayout::of(SKELETON);
    let frames: Vec<&[f64]> = rows.chunks_exact(COLUMNS).collect();
    let (mut half_turn, mut place) = (0.0_f64, [0.0; 2]);
    let turned = |half_turn: f64, [x, z]: [f64; 2]| {
        let (sine, cosine) = (-2.0 * half_turn).sin_cos();
        [x * cosine + z * sine, z * cosine - x * sine]
    };
    let mut feet = Vec::new();
    for (frame, row) in frames.iter().enumerate() {
        if frame > 0 {
            let last = frames[frame - 1];
            half_turn += last[layout.root_turn];
            let velocity = &last[layout.root_velocity.clone()];
            let step = turned(half_turn, [velocity[0], velocity[1]]);
            place = [place[0] + step[0], place[1] + step[1]];
        }
        feet.push(FEET.map(|joint| {
            let at = layout.positions.start + 3 * (joint - 1);
            let [x, z] = turned(half_turn, [row[at], row[at + 2]]);
            [x + place[0], row[at + 1], z + place[1]]
        }));
    }
    let count = frames.len() as f64;
    let (mut ground, mut sliding) = (0.0, 0.0);
    let standing = [GroundLoss::ANKLE, 0.0, GroundLoss::ANKLE, 0.0];
    for (frame, now) in feet.iter().enumerate() {
        let contact = |foot: usize| {
            let contact = contacts[frame * COLUMNS + layout.contacts.start + foot];
            contact.clamp(0.0, 1.0)
        };
        let height = |foot: usize| now[foot][1] - standing[foot];
        for side in [0, 2] {
            let lower = side + usize::from(height(side) >= height(side + 1));
            let excess = (height(lower) - GroundLoss::REST).max(0.0);
            ground += contact(lower) * excess * excess;
        }
        for foot in 0..4 {
            ground += (-height(foot)).max(0.0).powi(2);
            if let Some(next) = feet.get(frame + 1) {
                let step = [0, 2].map(|axis| (next[foot][axis] - now[foot][axis]) * 20.0);
                let square = step[0] * step[0] + step[1] * step[1];
                let soft = SlidingLoss::SOFTNESS;
                sliding += contact(foot) * ((square + soft * soft).sqrt() - soft);
            }
        }
    }
    [1e4 * ground / count, sliding / count]
}

/// Central differences of the equations against the losses' own gradients, by every column.
#[test]
fn values_and_gradients_are_those_of_the_equations() {
    let mut random = Random::new(&[4]);
    let walk = clip("walk");
    // A turning, stumbling walk, partly in the ground and partly above it.
    let mut rows = walk[10 * COLUMNS..18 * COLUMNS].to_vec();
    for row in rows.chunks_exact_mut(COLUMNS) {
        for number in &mut row[..67] {
            *number += 0.06 * (random.unit() as f32 - 0.5);
        }
        for contact in &mut row[COLUMNS - 4..] {
            *contact = 1.4 * random.unit() as f32 - 0.2;
        }
    }
    let statistics = statistics();
    let mut normalised = rows;
    statistics.normalise(&mut normalised);
    let raw = |normalised: &[f64]| -> Vec<f64> {
        let scales = statistics.mean().iter().zip(statistics.deviation()).cycle();
        let numbers = normalised.iter().zip(scales);
        numbers
            .map(|(x, (&mean, &deviation))| x * f64::from(deviation) + f64::from(mean))
            .collect()
    };
    let start: Vec<f64> = normalised.iter().map(|&number| f64::from(number)).collect();
    let contacts = raw(&start);
    let frames = normalised.len() / COLUMNS;
    let losses: [&dyn MotionLoss; 2] = [&ground(), &sliding()];
    for (index, loss) in losses.into_iter().enumerate() {
        let found = loss
            .evaluate(&normalised, frames, &[frames])
            .expect("numbers");
        let expected = reference(&raw(&start), &contacts)[index];
        assert!(expected > 0.1, "nothing to see: {expected}");
        let error = (f64::from(found.losses[0]) - expected).abs() / expected;
        assert!(error < 1e-5, "{loss:?}: {expected}, {error}");
        let most = found
            .gradient
            .iter()
            .fold(0.0_f32, |most, by| most.max(by.abs()));
        let mut moved = start.clone();
        for column in 0..start.len() {
            let step = 1e-6;
            let mut at = |by: f64| {
                moved[column] = start[column] + by;
                reference(&raw(&moved), &contacts)[index]
            };
            let expected = (at(step) - at(-step)) / (2.0 * step);
            moved[column] = start[column];
            let error = (f64::from(found.gradient[column]) - expected).abs();
            assert!(
                error < 1e-4 * f64::from(most),
                "{column}: {expected}, {error}"
            );
        }
    }
}

#[test]
fn a_body_that_stands_loses_nothing() {
    let rows = standing(6);
    for loss in [&ground() as &dyn MotionLoss, &sliding()] {
        let found = of(loss, &rows);
        assert!(found.losses[0] < 1e-9, "{loss:?}: {:?}", found.losses);
        let most = found
            .gradient
            .iter()
            .fold(0.0_f32, |most, by| most.max(by.abs()));
        assert!(most < 1e-3, "{loss:?}: {most}");
    }
}

/// A real walk, heels first, costs as much as floating by 4 mm too much.
#[test]
fn a_real_walk_loses_little() {
    let rows = clip("walk");
    let real = value(&ground(), &rows);
    assert!(real < 0.4, "{real} cm2");
    let higher = value(&ground(), &lifted(&rows, 0.06));
    assert!(higher > real + 10.0, "{real}, {higher} cm2");
}

/// Heights of ankle and toes of both feet of the body at rest.
fn standing_feet() -> [f64; 4] {
    let rows = standing(1);
    FEET.map(|joint| f64::from(rows[FeatureLayout::of(SKELETON).positions.start + 3 * joint - 2]))
}

#[test]
fn floating_and_sinking_cost_their_square() {
    let rows = standing(6);
    let at = |height: f64| value(&ground(), &lifted(&rows, height as f32));
    let [left_ankle, left_toes, right_ankle, right_toes] = standing_feet();
    assert!(left_ankle.min(right_ankle) > GroundLoss::ANKLE);
    let square = |excess: f64| 1e4 * excess.max(0.0).powi(2);
    // Both feet rest, on their toes.
    for height in [0.02, 0.05, 0.10, 0.20] {
        let toes = [left_toes, right_toes];
        let expected: f64 = toes
            .map(|y| square(y + height - GroundLoss::REST))
            .iter()
            .sum();
        let error = (at(height) - expected).abs();
        assert!(error < 1e-2, "{height}: {expected}, {error}");
    }
    for depth in [0.005, 0.03, 0.08] {
        let ankles = [left_ankle, right_ankle].map(|y| y - GroundLoss::ANKLE);
        let joints = [ankles[0], ankles[1], left_toes, right_toes];
        let expected: f64 = joints.map(|y| square(depth - y)).iter().sum();
        let error = (at(-depth) - expected).abs();
        assert!(error < 1e-2, "{depth}: {expected}, {error}");
    }
    // The toes of a foot that stands on its heel are free.
    let mut heel = rows.clone();
    for row in heel.chunks_exact_mut(COLUMNS) {
        for toes in [FEET[1], FEET[3]] {
            row[FeatureLayout::of(SKELETON).positions.start + 3 * toes - 2] += 0.08;
        }
    }
    assert!(value(&ground(), &heel) < 1e-9);
    // A body in the air does not slide.
    assert!(value(&sliding(), &lifted(&rows, 0.3)) < 1e-9);
}

#[test]
fn sliding_costs_its_speed_where_feet_rest() {
    let frames = 6;
    let layout = FeatureLayout::of(SKELETON);
    let slides = |speed: f64, turn: f32, contact: f32| {
        let mut rows = standing(frames);
        for row in rows.chunks_exact_mut(COLUMNS) {
            row[layout.root_velocity.start] = (speed / 20.0) as f32;
            row[layout.contacts.clone()].fill(contact);
        }
        // The first step turns the body.
        rows[layout.root_turn] += turn;
        value(&sliding(), &rows)
    };
    let soft = SlidingLoss::SOFTNESS;
    // Feet do not leave the last frame.
    let share = (frames - 1) as f64 / frames as f64;
    for speed in [0.0, 0.05, 0.4, 2.0] {
        let expected = 4.0 * share * ((speed * speed + soft * soft).sqrt() - soft);
        let error = (slides(speed, 0.0, 1.0) - expected).abs();
        assert!(error < 1e-4, "{speed}: {error}");
        let half = slides(speed, 0.0, 0.5);
        assert!((half - 0.5 * expected).abs() < 1e-4, "{speed}: {half}");
        assert!(slides(speed, 0.0, 0.0) < 1e-9);
    }
    // Feet circle the root as it turns; to which side is the same.
    let turns = [0.2, -0.2].map(|turn| slides(0.0, turn, 1.0));
    assert!(turns[0] > 0.1, "{turns:?}");
    assert!((turns[0] - turns[1]).abs() < 0.05 * turns[0], "{turns:?}");
    // The ground is as it was.
    let mut rows = standing(frames);
    for row in rows.chunks_exact_mut(COLUMNS) {
        row[layout.root_velocity.clone()].fill(0.1);
        row[layout.root_turn] = 0.2;
    }
    assert!(value(&ground(), &rows) < 1e-9);
}

/// What lies behind a motion's end is padding.
#[test]
fn padding_does_not_count() {
    let rows = lifted(&clip("walk")[..8 * COLUMNS], 0.07);
    let mut normalised = rows.clone();
    statistics().normalise(&mut normalised);
    for loss in [&ground() as &dyn MotionLoss, &sliding()] {
        let alone = loss.evaluate(&normalised[..5 * COLUMNS], 5, &[5]);
        let padded = loss.evaluate(&normalised, 8, &[5]).expect("numbers");
        let alone = alone.expect("numbers");
        assert_eq!(alone.losses, padded.losses);
        assert_eq!(alone.gradient, padded.gradient[..5 * COLUMNS]);
        assert!(padded.gradient[5 * COLUMNS..].iter().all(|&by| by == 0.0));
    }
    assert!(ground().evaluate(&normalised, 8, &[9]).is_err());
    assert!(ground().evaluate(&normalised[1..], 8, &[8]).is_err());
}

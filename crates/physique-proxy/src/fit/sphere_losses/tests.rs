//! The fused losses against the published numbers and a slow reference.

use physique_files::npz::{Archive, ArrayLimits};
use proptest::prelude::*;

use super::{LossWorkspace, SamplePoints, SphereLossWeights, SphereLosses};

/// Equations 2, 4 and 5 word by word, in f64.
fn reference(points: &SamplePoints, outputs: &[f64], tolerance: f64) -> SphereLosses {
    let spheres: Vec<[f64; 4]> = outputs
        .as_chunks::<4>()
        .0
        .iter()
        .map(|&[log_radius, x, y, z]| [x, y, z, log_radius.exp()])
        .collect();
    let place = |i: usize| [points.x[i], points.y[i], points.z[i]].map(f64::from);
    let length = |a: [f64; 3], b: &[f64]| {
        let squares = a.iter().zip(b).map(|(a, b)| (a - b) * (a - b));
        squares.sum::<f64>().sqrt()
    };
    let count = points.len() as f64;
    let mut losses = SphereLosses::default();
    for i in 0..points.len() {
        let gaps = spheres.iter().map(|s| length(place(i), &s[..3]) - s[3]);
        let predicted = gaps.fold(f64::INFINITY, f64::min);
        let target = f64::from(points.distance[i]);
        losses.signed_distance += match target < 0.0 {
            true => predicted.max(0.0),
            false => (target - predicted).abs(),
        } / count;
    }
    for s in &spheres {
        let inside = (0..points.len()).filter(|&i| points.distance[i] < 0.0);
        let nearest = inside
            .map(|i| length(place(i), &s[..3]) - s[3])
            .fold(1.0, f64::min);
        losses.emptiness += (nearest - tolerance).max(0.0) / spheres.len() as f64;
    }
    for (j, s) in spheres.iter().enumerate() {
        for t in &spheres[..j] {
            let depth = s[3] + t[3] - length([s[0], s[1], s[2]], &t[..3]);
            losses.overlap += depth.max(0.0) / (spheres.len() * spheres.len()) as f64;
        }
    }
    losses
}

#[track_caller]
fn assert_near(found: f64, expected: f64, tolerance: f64) {
    assert!(
        (found - expected).abs() <= tolerance,
        "{found} instead of {expected}"
    );
}

#[test]
fn published_losses() {
    let bytes = include_bytes!("../../../tests/fixtures/sphere_small.npz").to_vec();
    let mut archive = Archive::open(bytes, ArrayLimits::default()).expect("a sound archive");
    let mut array = |key: &str| archive.array(key).expect(key).to_f64().expect(key);
    let (spheres, radii) = (array("sphere_out"), array("radii"));
    let (places, targets) = (array("pts"), array("gt"));
    let (bodies, count) = (3, 12);
    let mut mean = SphereLosses::default();
    for body in 0..bodies {
        let mut workspace = LossWorkspace::default();
        let points = &mut workspace.points;
        for point in body * 50..(body + 1) * 50 {
            points.x.push(places[3 * point] as f32);
            points.y.push(places[3 * point + 1] as f32);
            points.z.push(places[3 * point + 2] as f32);
            points.distance.push(targets[point] as f32);
        }
        points.stretches.push(50);
        let outputs: Vec<f32> = (body * count..(body + 1) * count)
            .flat_map(|s| {
                [
                    radii[s].ln(),
                    spheres[4 * s + 1],
                    spheres[4 * s + 2],
                    spheres[4 * s + 3],
                ]
            })
            .map(|value| value as f32)
            .collect();
        let mut gradient = vec![0.0; outputs.len()];
        let losses = workspace.evaluate(&outputs, &SphereLossWeights::default(), &mut gradient);
        mean.signed_distance += losses.signed_distance / bodies as f64;
        mean.emptiness += losses.emptiness / bodies as f64;
        mean.overlap += losses.overlap / bodies as f64;
    }
    let mut value = |key: &str| archive.array(key).expect(key).to_f64().expect(key)[0];
    assert_near(mean.signed_distance, value("loss_sdf"), 1e-6);
    assert_near(mean.emptiness, value("loss_empty"), 1e-6);
    assert_near(mean.overlap, value("loss_is"), 1e-6);
}

/// Points around some spheres; `seed` says where.
fn scene(points: usize, spheres: usize, seed: u64) -> (SamplePoints, Vec<f32>) {
    let mut random = crate::random::Random::new(&[seed]);
    let mut samples = SamplePoints::default();
    for _ in 0..points {
        samples.x.push(random.within(1.0));
        samples.y.push(random.within(1.0));
        samples.z.push(random.within(0.3));
        samples.distance.push(random.within(0.3) + 0.1);
    }
    // Two stretches, neither a whole number of clusters.
    samples.stretches = vec![points / 3, points];
    let outputs = (0..spheres)
        .flat_map(|_| {
            [
                -2.5 + random.within(1.0),
                random.within(1.2),
                random.within(1.2),
                random.within(0.4),
            ]
        })
        .collect();
    (samples, outputs)
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(24))]

    #[test]
    fn equals_the_reference(points in 1usize..400, spheres in 1usize..70, seed in any::<u64>()) {
        let (samples, outputs) = scene(points, spheres, seed);
        let exact: Vec<f64> = outputs.iter().map(|&value| value.into()).collect();
        let weights = SphereLossWeights::default();
        let mut workspace = LossWorkspace { points: samples.clone(), ..Default::default() };
        let mut gradient = vec![f32::NAN; outputs.len()];
        let found = workspace.evaluate(&outputs, &weights, &mut gradient);
        let tolerance = f64::from(weights.tolerance);
        let expected = reference(&samples, &exact, tolerance);
        assert_near(found.signed_distance, expected.signed_distance, 2e-6);
        assert_near(found.emptiness, expected.emptiness, 2e-6);
        assert_near(found.overlap, expected.overlap, 2e-6);

        // Differences over a step that crosses a kink are no slopes: the two one-sided ones tell.
        let total = |outputs: &[f64]| reference(&samples, outputs, tolerance).total(&weights);
        let here = total(&exact);
        for index in (0..outputs.len()).step_by(outputs.len().div_ceil(24)) {
            let step = 1e-6;
            let mut moved = exact.clone();
            moved[index] += step;
            let above = (total(&moved) - here) / step;
            moved[index] -= 2.0 * step;
            let below = (here - total(&moved)) / step;
            if (above - below).abs() < 1e-4 {
                assert_near(gradient[index].into(), 0.5 * (above + below), 1e-4);
            }
        }
    }
}

#[test]
fn without_points_inside_spheres_are_as_far_as_published() {
    let mut workspace = LossWorkspace::default();
    let outputs = [0.1_f32.ln(), 0.0, 0.0, 0.0];
    let mut gradient = [f32::NAN; 4];
    let weights = SphereLossWeights::default();
    let losses = workspace.evaluate(&outputs, &weights, &mut gradient);
    assert_near(losses.emptiness, 0.95, 1e-6);
    assert_eq!(gradient, [0.0; 4]);
    workspace.points.x.push(0.3);
    workspace.points.y.push(0.0);
    workspace.points.z.push(0.0);
    workspace.points.distance.push(0.2);
    workspace.points.stretches.push(1);
    let losses = workspace.evaluate(&outputs, &weights, &mut gradient);
    assert_near(losses.emptiness, 0.95, 1e-6);
    // Right where it should be: 0.3 - 0.1 from the sphere.
    assert_near(losses.signed_distance, 0.0, 1e-6);
}

#[test]
fn a_point_in_the_middle_of_a_sphere_pulls_nowhere() {
    let points = SamplePoints {
        x: vec![0.0],
        y: vec![0.0],
        z: vec![0.0],
        distance: vec![0.5],
        stretches: vec![1],
    };
    let mut workspace = LossWorkspace {
        points,
        ..LossWorkspace::default()
    };
    let mut gradient = [f32::NAN; 8];
    let outputs = [-1.0, 0.0, 0.0, 0.0, -1.0, 0.0, 0.0, 0.0];
    workspace.evaluate(&outputs, &SphereLossWeights::default(), &mut gradient);
    assert!(gradient.iter().all(|slope| slope.is_finite()));
}

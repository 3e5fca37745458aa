//! Where training starts.

use glam::Vec3;

use super::sphere_losses::SamplePoints;
use crate::random::Random;
use crate::regressor::NetworkLayout;

/// Rounds of moving centres to the middle of their points.
const ROUNDS: usize = 15;
/// Least radius of a first sphere.
const LEAST_RADIUS: f32 = 0.01;

/// Parameters as PyTorch draws them for `Linear` layers: uniform within one over the root of the
/// inputs, gains as long as the rows.
pub(crate) fn parameters(layout: &NetworkLayout, random: &mut Random) -> Vec<f32> {
    let mut parameters = vec![0.0; layout.parameter_count()];
    for layer in layout.layers() {
        let extent = (layer.inputs as f32).sqrt().recip();
        for range in [layer.weight.clone(), layer.bias.clone()] {
            parameters[range].fill_with(|| random.within(extent));
        }
        if let Some(gains) = &layer.gain {
            for row in 0..layer.outputs {
                let start = layer.weight.start + row * layer.inputs;
                let row_values = &parameters[start..start + layer.inputs];
                let square: f32 = row_values.iter().map(|value| value * value).sum();
                parameters[gains.start + row] = square.sqrt();
            }
        }
    }
    parameters
}

/// First spheres for the last layer's bias, `[log r, x, y, z]` each: clusters of the points inside
/// one body, as large as fits at their middles.
///
/// The paper starts from what the layers give by chance, all spheres in one place; started inside
/// the body and spread out, none is left without work.
pub(crate) fn spheres(points: &SamplePoints, count: usize, random: &mut Random) -> Vec<f32> {
    let inside: Vec<(Vec3, f32)> = (0..points.len())
        .filter(|&i| points.distance[i] < 0.0)
        .map(|i| {
            let place = Vec3::new(points.x[i], points.y[i], points.z[i]);
            (place, -points.distance[i])
        })
        .collect();
    let mut centres = spread(&inside, count, random);
    let mut deepest = vec![LEAST_RADIUS; centres.len()];
    for _ in 0..ROUNDS {
        let mut sums = vec![(Vec3::ZERO, 0.0_f32); centres.len()];
        deepest.fill(LEAST_RADIUS);
        for &(place, depth) in &inside {
            let nearest = nearest(&centres, place);
            sums[nearest].0 += place;
            sums[nearest].1 += 1.0;
            deepest[nearest] = deepest[nearest].max(depth);
        }
        for (centre, (sum, points)) in centres.iter_mut().zip(sums) {
            if points > 0.0 {
                *centre = sum / points;
            }
        }
    }
    centres
        .iter()
        .zip(deepest)
        .flat_map(|(centre, radius)| [radius.ln(), centre.x, centre.y, centre.z])
        .collect()
}

/// Points far from each other: each is the farthest from those before it.
fn spread(points: &[(Vec3, f32)], count: usize, random: &mut Random) -> Vec<Vec3> {
    if points.is_empty() {
        return vec![Vec3::ZERO; count];
    }
    let mut centres = vec![points[random.below(points.len())].0];
    let mut squares = vec![f32::INFINITY; points.len()];
    while centres.len() < count {
        let last = centres[centres.len() - 1];
        let mut farthest = (0, f32::NEG_INFINITY);
        for (index, (square, point)) in squares.iter_mut().zip(points).enumerate() {
            *square = square.min(point.0.distance_squared(last));
            if *square > farthest.1 {
                farthest = (index, *square);
            }
        }
        centres.push(points[farthest.0].0);
    }
    centres
}

fn nearest(centres: &[Vec3], place: Vec3) -> usize {
    let mut best = (0, f32::INFINITY);
    for (index, centre) in centres.iter().enumerate() {
        let square = centre.distance_squared(place);
        if square < best.1 {
            best = (index, square);
        }
    }
    best.0
}

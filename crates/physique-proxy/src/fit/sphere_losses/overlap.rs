//! The overlap of spheres among themselves.

use multiversion::multiversion;

use super::spheres::{LANES, Spheres};

/// Sum of overlap depths over pairs, divided by the squared number of spheres; slopes are added to.
pub(super) fn add(spheres: &Spheres, weight: f32, slopes: &mut [[f32; 4]]) -> f64 {
    let square = (spheres.len() * spheres.len()).max(1) as f64;
    let slope = weight / square as f32;
    let sum: f64 = (0..spheres.len())
        .map(|first| f64::from(overlaps(spheres, first, slope, slopes)))
        .sum();
    sum / square
}

/// Sum of overlap depths of one sphere with all later ones.
#[multiversion(targets = "simd")]
fn overlaps(spheres: &Spheres, first: usize, slope: f32, slopes: &mut [[f32; 4]]) -> f32 {
    let [x, y, z, r] = spheres.get(first);
    let mut sum = 0.0;
    for group in first / LANES..spheres.x.len() {
        let mut depths = [0.0_f32; LANES];
        let mut lengths = [0.0_f32; LANES];
        for lane in 0..LANES {
            let (dx, dy, dz) = (
                spheres.x[group][lane] - x,
                spheres.y[group][lane] - y,
                spheres.z[group][lane] - z,
            );
            lengths[lane] = (dx * dx + dy * dy + dz * dz).sqrt();
            depths[lane] = r + spheres.r[group][lane] - lengths[lane];
        }
        for lane in 0..LANES {
            let second = group * LANES + lane;
            if depths[lane] > 0.0 && second > first {
                sum += depths[lane];
                let along = slope / lengths[lane].max(1e-12);
                let [dx, dy, dz] = [
                    (spheres.x[group][lane] - x) * along,
                    (spheres.y[group][lane] - y) * along,
                    (spheres.z[group][lane] - z) * along,
                ];
                // Moving apart lessens the overlap; growing deepens it.
                let near = &mut slopes[first];
                near[0] += dx;
                near[1] += dy;
                near[2] += dz;
                near[3] += slope;
                let far = &mut slopes[second];
                far[0] -= dx;
                far[1] -= dy;
                far[2] -= dz;
                far[3] += slope;
            }
        }
    }
    sum
}

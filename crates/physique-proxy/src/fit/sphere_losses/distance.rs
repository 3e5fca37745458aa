//! The signed-distance loss: how well the union of spheres stands in for the body.

use multiversion::multiversion;

use super::clusters::Cluster;
use super::spheres::{LANES, Spheres};
use super::{LossWorkspace, SamplePoints};

impl LossWorkspace {
    pub(super) fn signed_distance(&mut self, weight: f32) -> f64 {
        let slope = weight / self.points.len().max(1) as f32;
        let mut sum = 0.0;
        for cluster in &self.clusters.list {
            gaps(&self.spheres, cluster.centre, &mut self.gaps);
            select(
                &self.spheres,
                &self.gaps,
                2.0 * cluster.radius,
                &mut self.candidates,
                &mut self.numbers,
            );
            sum += f64::from(cluster_loss(
                &self.points,
                cluster,
                &self.candidates,
                &self.numbers,
                slope,
                &mut self.slopes,
            ));
        }
        sum / self.points.len().max(1) as f64
    }
}

/// Signed distance of a place to every sphere, padding included.
#[multiversion(targets = "simd")]
pub(super) fn gaps(spheres: &Spheres, [px, py, pz]: [f32; 3], gaps: &mut Vec<f32>) {
    gaps.resize(spheres.x.len() * LANES, 0.0);
    let groups = spheres.x.iter().zip(&spheres.y).zip(&spheres.z);
    for ((((x, y), z), r), gaps) in groups.zip(&spheres.r).zip(gaps.as_chunks_mut::<LANES>().0) {
        for lane in 0..LANES {
            let (dx, dy, dz) = (px - x[lane], py - y[lane], pz - z[lane]);
            gaps[lane] = (dx * dx + dy * dy + dz * dz).sqrt() - r[lane];
        }
    }
}

/// Spheres at most `reach` farther than the nearest one, in order.
fn select(
    spheres: &Spheres,
    gaps: &[f32],
    reach: f32,
    candidates: &mut Vec<[f32; 4]>,
    numbers: &mut Vec<u32>,
) {
    let nearest = least(gaps);
    let bound = nearest + reach;
    candidates.clear();
    numbers.clear();
    for (group, gaps) in gaps.as_chunks::<LANES>().0.iter().enumerate() {
        let mut within = 0_u32;
        for (lane, &gap) in gaps.iter().enumerate() {
            within |= u32::from(gap <= bound) << lane;
        }
        while within != 0 {
            let index = group * LANES + within.trailing_zeros() as usize;
            within &= within - 1;
            candidates.push(spheres.get(index));
            numbers.push(index as u32);
        }
    }
}

#[multiversion(targets = "simd")]
pub(super) fn least(values: &[f32]) -> f32 {
    let (groups, rest) = values.as_chunks::<LANES>();
    let mut lanes = [f32::INFINITY; LANES];
    for group in groups {
        for lane in 0..LANES {
            let value = group[lane];
            lanes[lane] = if value < lanes[lane] {
                value
            } else {
                lanes[lane]
            };
        }
    }
    lanes
        .iter()
        .chain(rest)
        .copied()
        .fold(f32::INFINITY, f32::min)
}

/// Signed distance to, and number of, the candidate nearest to each point; the first of equals.
///
/// A function of its own, whose arrays stay in registers.
#[multiversion(targets = "simd")]
fn nearest_candidates(
    px: &[f32; LANES],
    py: &[f32; LANES],
    pz: &[f32; LANES],
    candidates: &[[f32; 4]],
) -> ([f32; LANES], [u32; LANES]) {
    let (px, py, pz) = (*px, *py, *pz);
    let mut nearest = [f32::INFINITY; LANES];
    let mut winner = [0_u32; LANES];
    for (number, &[x, y, z, r]) in (0_u32..).zip(candidates) {
        let mut gaps = [0.0_f32; LANES];
        for lane in 0..LANES {
            let (dx, dy, dz) = (px[lane] - x, py[lane] - y, pz[lane] - z);
            gaps[lane] = (dx * dx + dy * dy + dz * dz).sqrt() - r;
        }
        for lane in 0..LANES {
            let nearer = gaps[lane] < nearest[lane];
            winner[lane] = if nearer { number } else { winner[lane] };
            nearest[lane] = if nearer { gaps[lane] } else { nearest[lane] };
        }
    }
    (nearest, winner)
}

/// Sum of the loss over a cluster; slopes are added to.
fn cluster_loss(
    points: &SamplePoints,
    cluster: &Cluster,
    candidates: &[[f32; 4]],
    numbers: &[u32],
    slope: f32,
    slopes: &mut [[f32; 4]],
) -> f32 {
    let mut sums = [0.0_f32; LANES];
    let mut start = cluster.start;
    while start < cluster.end {
        let count = LANES.min(cluster.end - start);
        // Lanes without a point hold the centre, and signs below leave them out.
        let [mut px, mut py, mut pz] = cluster.centre.map(|c| [c; LANES]);
        let mut target = [-1.0_f32; LANES];
        let range = start..start + count;
        px[..count].copy_from_slice(&points.x[range.clone()]);
        py[..count].copy_from_slice(&points.y[range.clone()]);
        pz[..count].copy_from_slice(&points.z[range.clone()]);
        target[..count].copy_from_slice(&points.distance[range]);

        let (nearest, winner) = nearest_candidates(&px, &py, &pz, candidates);

        let mut signs = [0.0_f32; LANES];
        for lane in 0..LANES {
            let (gap, target) = (nearest[lane], target[lane]);
            let (loss, sign) = if target < 0.0 {
                (gap.max(0.0), if gap > 0.0 { 1.0 } else { 0.0 })
            } else {
                let excess = gap - target;
                (excess.abs(), if excess > 0.0 { 1.0 } else { -1.0 })
            };
            let real = lane < count;
            sums[lane] += if real { loss } else { 0.0 };
            signs[lane] = if real { sign } else { 0.0 };
        }
        for lane in 0..count {
            let sign = signs[lane];
            if sign != 0.0 {
                let winner = winner[lane] as usize;
                let [x, y, z, r] = candidates[winner];
                // The gap plus the radius is the length; a point at the centre pulls nowhere.
                let along = -sign * slope / (nearest[lane] + r).max(1e-12);
                let sums = &mut slopes[numbers[winner] as usize];
                sums[0] += along * (px[lane] - x);
                sums[1] += along * (py[lane] - y);
                sums[2] += along * (pz[lane] - z);
                sums[3] -= sign * slope;
            }
        }
        start += count;
    }
    sums.iter().sum()
}

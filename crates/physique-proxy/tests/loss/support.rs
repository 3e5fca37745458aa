//! Bodies and poses for the tests.

use glam::{Quat, Vec3};
use physique_body::Joint;
use physique_proxy::{PoseMatrices, SphereBody, pose_matrices};

/// Deterministic numbers in [-1, 1): SplitMix64.
pub(crate) struct Random(pub u64);

impl Random {
    pub(crate) fn next(&mut self) -> f32 {
        self.0 = self.0.wrapping_add(0x9E37_79B9_7F4A_7C15);
        let mut z = self.0;
        z = (z ^ (z >> 30)).wrapping_mul(0xBF58_476D_1CE4_E5B9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94D0_49BB_1331_11EB);
        z ^= z >> 31;
        (z >> 40) as f32 / (1 << 23) as f32 - 1.0
    }

    pub(crate) fn vector(&mut self) -> Vec3 {
        Vec3::new(self.next(), self.next(), self.next())
    }

    pub(crate) fn below(&mut self, end: usize) -> usize {
        ((self.next() + 1.0) / 2.0 * end as f32) as usize
    }

    /// Local rotations of up to `most` radians about random axes.
    pub(crate) fn pose(&mut self, most: f32) -> PoseMatrices {
        pose_matrices(&[(); Joint::COUNT].map(|()| {
            let axis = self.vector().try_normalize().unwrap_or(Vec3::Y);
            Quat::from_axis_angle(axis, most * self.next())
        }))
    }

    /// A body of spheres strewn about a skeleton, each following up to four joints.
    pub(crate) fn body(&mut self, spheres: usize) -> SphereBody {
        let rest_joints = [(); Joint::COUNT].map(|()| 0.7 * self.vector());
        let rows: Vec<_> = (0..spheres).map(|_| self.blend_weights()).collect();
        let centres = rows.iter().map(|row| {
            let joint = rest_joints[usize::from(row[0].0)];
            joint + 0.2 * self.vector()
        });
        SphereBody {
            rest_joints,
            centres: centres.collect(),
            radii: (0..spheres).map(|_| 0.08 + 0.06 * self.next()).collect(),
            blend_weights: rows,
        }
    }

    fn blend_weights(&mut self) -> [(u8, f32); 4] {
        let influences = 1 + self.below(4);
        let mut row = [(0, 0.0); 4];
        let mut sum = 0.0;
        for entry in &mut row[..influences] {
            *entry = (self.below(Joint::COUNT) as u8, 1.05 + self.next());
            sum += entry.1;
        }
        row.map(|(joint, weight)| (joint, weight / sum))
    }
}

//! How often spheres touch in real motion.

use glam::Vec3;

use crate::{Error, Pairs, PoseMatrices, SphereBody};

/// In how many poses of real motion each two spheres of a proxy intersect.
///
/// Neighbours on a body intersect in nearly every pose; a loss that punishes them pulls at poses
/// that are right. The paper leaves out pairs that intersect in 90 % of all poses or more.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct PairStatistics {
    spheres: usize,
    poses: u64,
    /// By [`place`].
    intersecting: Vec<u32>,
}

/// Where a pair `i < j` is counted: pairs with the lowest second sphere come first.
fn place(i: usize, j: usize) -> usize {
    j * j.saturating_sub(1) / 2 + i
}

impl PairStatistics {
    /// No poses yet.
    ///
    /// # Errors
    /// [`Error::SphereBody`] for more than 4,096 spheres.
    pub fn new(spheres: usize) -> Result<Self, Error> {
        Self::from_counts(spheres, 0, vec![0; place(0, spheres.min(4_097))])
    }

    /// Counts that were stored: for every second sphere in order, those with all before it.
    ///
    /// # Errors
    /// [`Error::SphereBody`] for more than 4,096 spheres; [`Error::Length`] unless there is one
    /// count a pair; [`Error::PairCounts`] for a count above the number of poses.
    pub fn from_counts(spheres: usize, poses: u64, intersecting: Vec<u32>) -> Result<Self, Error> {
        if spheres > 4_096 {
            return Err(Error::SphereBody {
                expected: "at most 4,096 spheres",
                found: spheres.to_string(),
            });
        }
        if intersecting.len() != place(0, spheres) {
            return Err(Error::Length {
                what: "counts of intersecting pairs",
                expected: place(0, spheres),
                found: intersecting.len(),
            });
        }
        if let Some(&count) = intersecting.iter().find(|&&count| u64::from(count) > poses) {
            return Err(Error::PairCounts { poses, count });
        }
        Ok(Self {
            spheres,
            poses,
            intersecting,
        })
    }

    /// Counts all poses of a motion of a body with these spheres.
    ///
    /// # Errors
    /// [`Error::PairCount`] for a body of another number of spheres; [`SphereBody::check`]'s.
    pub fn add(&mut self, body: &SphereBody, poses: &[PoseMatrices]) -> Result<(), Error> {
        body.check()?;
        if body.sphere_count() != self.spheres {
            return Err(Error::PairCount {
                expected: self.spheres,
                found: body.sphere_count(),
            });
        }
        let mut centres = Vec::new();
        for pose in poses {
            body.pose(pose, &mut centres);
            let mut counts = self.intersecting.as_mut_slice();
            for (j, (&centre, &radius)) in centres.iter().zip(&body.radii).enumerate() {
                let (row, rest) = counts.split_at_mut(j);
                count_touching(row, centre, radius, &centres, &body.radii);
                counts = rest;
            }
            self.poses += 1;
        }
        Ok(())
    }

    /// Adds what another task counted.
    ///
    /// # Errors
    /// [`Error::PairCount`] for statistics of another number of spheres.
    pub fn merge(&mut self, other: &Self) -> Result<(), Error> {
        if other.spheres != self.spheres {
            return Err(Error::PairCount {
                expected: self.spheres,
                found: other.spheres,
            });
        }
        self.poses += other.poses;
        for (count, more) in self.intersecting.iter_mut().zip(&other.intersecting) {
            *count = count.saturating_add(*more);
        }
        Ok(())
    }

    /// Number of spheres.
    pub fn sphere_count(&self) -> usize {
        self.spheres
    }

    /// Poses counted.
    pub fn poses(&self) -> u64 {
        self.poses
    }

    /// Counts as [`PairStatistics::from_counts`] takes them.
    pub fn counts(&self) -> &[u32] {
        &self.intersecting
    }

    /// Share of the poses in which two spheres intersect, 0 to 1; 0 where no pose was counted.
    ///
    /// # Panics
    /// Unless `i < j` and both are spheres.
    pub fn intersecting(&self, i: usize, j: usize) -> f64 {
        assert!(i < j && j < self.spheres, "a pair of two spheres");
        match self.poses {
            0 => 0.0,
            poses => f64::from(self.intersecting[place(i, j)]) / poses as f64,
        }
    }

    /// All pairs that intersect in a smaller share of the poses than `most`.
    ///
    /// # Errors
    /// None in practice: there are at most 4,096 spheres.
    pub fn pairs_below(&self, most: f64) -> Result<Pairs, Error> {
        let all = Pairs::all(self.spheres)?;
        Ok(all.filtered(|i, j| self.poses == 0 || self.intersecting(i, j) < most))
    }
}

/// Adds 1 where a sphere touches one of those before it.
fn count_touching(counts: &mut [u32], centre: Vec3, radius: f32, centres: &[Vec3], radii: &[f32]) {
    for ((count, other), other_radius) in counts.iter_mut().zip(centres).zip(radii) {
        let reach = radius + other_radius;
        *count += u32::from(centre.distance_squared(*other) < reach * reach);
    }
}

#[cfg(test)]
mod tests {
    use glam::Vec3;
    use physique_body::Joint;

    use super::PairStatistics;
    use crate::{Error, Pairs, SphereBody, pose_matrices};

    /// Two spheres on the left hand and one on the head.
    fn body() -> SphereBody {
        let mut rest_joints = [Vec3::ZERO; Joint::COUNT];
        rest_joints[Joint::LeftWrist.index()] = Vec3::X;
        let follow = |joint: Joint| [(joint.index() as u8, 1.0), (0, 0.0), (0, 0.0), (0, 0.0)];
        SphereBody {
            rest_joints,
            centres: vec![Vec3::X * 1.5, Vec3::X * 1.25, Vec3::Y * 0.5],
            radii: vec![0.2, 0.2, 0.3],
            blend_weights: vec![
                follow(Joint::LeftWrist),
                follow(Joint::LeftWrist),
                follow(Joint::Head),
            ],
        }
    }

    #[test]
    fn counts_poses_in_which_spheres_touch() {
        let turned = |angle: f32| {
            let mut pose = [glam::Quat::IDENTITY; Joint::COUNT];
            pose[Joint::LeftShoulder.index()] = glam::Quat::from_rotation_z(angle);
            pose_matrices(&pose)
        };
        let quarter = std::f32::consts::FRAC_PI_2;
        let mut statistics = PairStatistics::new(3).expect("few");
        statistics
            .add(&body(), &[turned(0.0), turned(quarter), turned(0.1)])
            .expect("fits");
        // The neighbours always; the arm turned up about the origin brings none to the head at
        // 0.5, since 1.25 - 0.5 is more than both radii.
        assert_eq!(statistics.counts(), [3, 0, 0]);
        assert_eq!(statistics.intersecting(0, 1), 1.0);
        let pairs = statistics.pairs_below(0.9).expect("few");
        assert_eq!(pairs, Pairs::new(3, [(0, 2), (1, 2)]).expect("in range"));

        let mut other = PairStatistics::from_counts(3, 7, vec![0, 7, 2]).expect("possible");
        other.merge(&statistics).expect("as many spheres");
        assert_eq!((other.poses(), other.counts()), (10, &[3, 7, 2][..]));
        assert_eq!(other.pairs_below(0.5).expect("few").len(), 2);
    }

    #[test]
    fn impossible_counts_are_refused() {
        let wrong = PairStatistics::from_counts(3, 2, vec![1, 2, 3]);
        assert!(matches!(
            wrong,
            Err(Error::PairCounts { poses: 2, count: 3 })
        ));
        assert!(matches!(
            PairStatistics::from_counts(3, 2, vec![1]),
            Err(Error::Length { expected: 3, .. })
        ));
        assert!(PairStatistics::new(1 << 40).is_err());
        let mut two = PairStatistics::new(2).expect("few");
        assert!(two.merge(&PairStatistics::new(3).expect("few")).is_err());
        assert!(two.add(&body(), &[]).is_err());
    }
}

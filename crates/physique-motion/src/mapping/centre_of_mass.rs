//! The centre of mass of a figure, by its joints.

use glam::Vec3;
use physique_body::Joint;

/// Share of the trunk in the body's mass: de Leva, "Adjustments to Zatsiorsky-Seluyanov's segment
/// inertia parameters", J. Biomechanics 29(9), 1996, means of women and men.
const TRUNK: f32 = 0.430;

/// Shares of the other segments of that table, each divided between its two ends so that its
/// centre stays.
const SHARES: [(Joint, f32); 13] = [
    (Joint::Head, 0.068),
    (Joint::LeftShoulder, 0.011),
    (Joint::RightShoulder, 0.011),
    (Joint::LeftElbow, 0.024),
    (Joint::RightElbow, 0.024),
    (Joint::LeftWrist, 0.012),
    (Joint::RightWrist, 0.012),
    (Joint::LeftHip, 0.089),
    (Joint::RightHip, 0.089),
    (Joint::LeftKnee, 0.082),
    (Joint::RightKnee, 0.082),
    (Joint::LeftAnkle, 0.033),
    (Joint::RightAnkle, 0.033),
];

/// Part of the centre's way that the pelvis goes when it moves and the ankles stay: all of hips,
/// trunk, arms and head, half of the knees.
const MOVED_BY_PELVIS: f32 = 0.85;

/// Where the mass of a figure is.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Figure {
    /// `[22]` joints, where the figure has them.
    pub(super) joints: [Option<Vec3>; Joint::COUNT],
    /// Centre of the trunk: see [`trunk_centre`].
    pub(super) trunk: Vec3,
}

/// Centre of a trunk that is equally heavy along its spine: points from the middle of the hips
/// over pelvis and spine to the middle of the shoulders.
pub(super) fn trunk_centre(spine: impl Iterator<Item = Vec3>) -> Vec3 {
    let (mut moment, mut length, mut below) = (Vec3::ZERO, 0.0, None);
    for point in spine {
        let from: Vec3 = below.replace(point).unwrap_or(point);
        let piece = from.distance(point);
        moment += from.midpoint(point) * piece;
        length += piece;
    }
    if length > 0.0 {
        moment / length
    } else {
        below.unwrap_or_default()
    }
}

/// From the centre of mass of one figure to that of another, over the joints that both have.
pub(super) fn between(from: &Figure, to: &Figure) -> Vec3 {
    let (mut moment, mut mass) = ((to.trunk - from.trunk) * TRUNK, TRUNK);
    for (joint, share) in SHARES {
        if let (Some(from), Some(to)) = (from.joints[joint.index()], to.joints[joint.index()]) {
            moment += (to - from) * share;
            mass += share;
        }
    }
    moment / mass
}

/// How far a pelvis ought to move over standing feet to take a centre of mass this far, no further
/// than `longest`, and without a sudden stop there.
pub(super) fn pelvis_way(centre_way: Vec3, longest: f32) -> Vec3 {
    let way = centre_way.with_y(0.0) / MOVED_BY_PELVIS;
    way / (1.0 + (way.length() / longest).powi(2)).sqrt()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn shares_make_a_whole_body() {
        let whole: f32 = TRUNK + SHARES.iter().map(|(_, share)| share).sum::<f32>();
        assert!((whole - 1.0).abs() < 1e-3, "{whole}");
    }

    #[test]
    fn a_moved_figure_has_a_moved_centre() {
        let figure = |way: Vec3| Figure {
            joints: Joint::ALL.map(|joint| Some(Vec3::splat(joint.index() as f32) + way)),
            trunk: Vec3::Y + way,
        };
        let way = Vec3::new(0.1, -0.2, 0.3);
        let mut moved = figure(way);
        moved.joints[Joint::Head.index()] = None;
        assert!(between(&figure(Vec3::ZERO), &moved).distance(way) < 1e-6);
    }

    #[test]
    fn a_bent_trunk_has_its_centre_beside_the_line_between_its_ends() {
        let bent = [Vec3::ZERO, Vec3::new(0.1, 0.2, 0.0), Vec3::Y * 0.4];
        let centre = trunk_centre(bent.into_iter());
        assert!(
            centre.distance(Vec3::new(0.05, 0.2, 0.0)) < 1e-6,
            "{centre}"
        );
        assert_eq!(trunk_centre([Vec3::Y].into_iter()), Vec3::Y);
    }

    #[test]
    fn the_pelvis_goes_on_the_level_and_not_far() {
        let way = pelvis_way(Vec3::new(0.017, 0.5, 0.0), 0.1);
        assert!(way.y == 0.0 && (way.x - 0.02).abs() < 1e-3);
        assert!(pelvis_way(Vec3::X * 9.0, 0.1).length() < 0.1);
    }
}

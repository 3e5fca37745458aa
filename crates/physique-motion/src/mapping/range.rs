//! Joints that turn farther than any human's.

use glam::Quat;
use physique_body::Joint;

/// Farthest turns from the T-pose against the parent, in degrees: textbook ranges of motion with
/// some 30 degrees for loose rigs. Hips and shoulders turn too freely to be judged so.
const FARTHEST: [(Joint, f32); 15] = [
    (Joint::Spine1, 80.0),
    (Joint::Spine2, 80.0),
    (Joint::Spine3, 80.0),
    (Joint::Neck, 90.0),
    (Joint::Head, 100.0),
    (Joint::LeftCollar, 70.0),
    (Joint::RightCollar, 70.0),
    (Joint::LeftElbow, 170.0),
    (Joint::RightElbow, 170.0),
    // 90 of pronation, most of which forearms of rigs leave to the hand, and 70 of flexion.
    (Joint::LeftWrist, 120.0),
    (Joint::RightWrist, 120.0),
    (Joint::LeftKnee, 170.0),
    (Joint::RightKnee, 170.0),
    (Joint::LeftAnkle, 90.0),
    (Joint::RightAnkle, 90.0),
];

/// Counts frames in which joints turn too far.
#[derive(Clone, Debug, Default)]
pub(super) struct RangeCheck {
    frames: usize,
    /// By entry of the table: frames beyond, and the farthest turn in degrees.
    beyond: [(usize, f32); FARTHEST.len()],
}

impl RangeCheck {
    /// Looks at the world orientations of a frame's joints.
    pub(super) fn add(&mut self, world_from_joint: &[Quat; Joint::COUNT]) {
        self.frames += 1;
        for ((joint, farthest), (frames, most)) in FARTHEST.into_iter().zip(&mut self.beyond) {
            let Some(parent) = joint.parent() else {
                continue;
            };
            let [parent, own] = [parent, joint].map(|joint| world_from_joint[joint.index()]);
            let turn = parent.angle_between(own).to_degrees();
            if turn > farthest {
                *frames += 1;
                *most = most.max(turn);
            }
        }
    }

    /// A sentence for each joint that is beyond its range for a twentieth of the frames.
    pub(super) fn notes(&self) -> Vec<String> {
        let joints = FARTHEST.into_iter().zip(self.beyond);
        let beyond = joints.filter(|(_, (frames, _))| *frames > 0 && 20 * frames >= self.frames);
        beyond
            .map(|((joint, farthest), (frames, most))| {
                let share = 100 * frames / self.frames;
                format!(
                    "{joint} turns by up to {most:.0} degrees, and by more than the {farthest:.0} \
                     of a human in {share} % of the frames: the recording is wrong there, or the \
                     axes of its joints are"
                )
            })
            .collect()
    }
}

#[cfg(test)]
mod tests {
    use super::{Joint, Quat, RangeCheck};

    fn notes(degrees: f32, frames: usize) -> Vec<String> {
        let mut check = RangeCheck::default();
        for frame in 0..100 {
            let mut world = [Quat::IDENTITY; Joint::COUNT];
            if frame < frames {
                world[Joint::LeftWrist.index()] = Quat::from_rotation_x(degrees.to_radians());
            }
            check.add(&world);
        }
        check.notes()
    }

    #[test]
    fn a_wrist_turned_through_is_named_and_a_supple_one_is_not() {
        let found = notes(154.0, 30);
        assert_eq!(found.len(), 1);
        for word in ["left_wrist", "154", "120", "30 %"] {
            assert!(found[0].contains(word), "{found:?}");
        }
        assert!(notes(110.0, 100).is_empty());
        assert!(notes(154.0, 4).is_empty());
        assert!(RangeCheck::default().notes().is_empty());
    }
}

//! The unknowns of a repair: by how much every joint turns and the root moves, frame by frame.

use glam::{DMat3, DQuat, DVec3};
use physique_body::Joint;
use physique_motion::Motion;
use rayon::prelude::*;

use super::figure::{Figure, Pose};
use crate::Error;

/// Frames that one thread takes at once.
pub(super) const FRAMES_A_TASK: usize = 16;
/// Numbers a frame: a rotation vector a joint, in its parent's axes, then the root's displacement.
pub(super) const UNKNOWNS: usize = 3 * (Joint::COUNT + 1);

/// The motion that is changed.
pub(super) struct Source {
    motion: Motion,
    rotations: Vec<DQuat>,
    root: Vec<DVec3>,
}

impl Source {
    pub(super) fn new(motion: &Motion) -> Self {
        let rotations = motion.rotations().iter();
        Self {
            rotations: rotations.map(|q| q.as_dquat().normalize()).collect(),
            root: motion
                .root_translation()
                .iter()
                .map(|v| v.as_dvec3())
                .collect(),
            motion: motion.clone(),
        }
    }

    pub(super) fn motion(&self) -> &Motion {
        &self.motion
    }

    pub(super) fn frame_count(&self) -> usize {
        self.root.len()
    }

    /// Number of unknowns.
    pub(super) fn unknowns(&self) -> usize {
        self.frame_count() * UNKNOWNS
    }

    /// The changed motion, posed.
    pub(super) fn poses(&self, figure: &Figure, change: &[f64]) -> Vec<Pose> {
        let frames = (0..self.frame_count()).into_par_iter();
        let pose = |frame| {
            let rotations =
                std::array::from_fn(|joint| DMat3::from_quat(self.rotation(change, frame, joint)));
            let root = self.root[frame] + vector(change, frame, Joint::COUNT);
            figure.pose(rotations, root)
        };
        frames.with_min_len(FRAMES_A_TASK).map(pose).collect()
    }

    /// The changed motion; joints and roots that did not change keep every bit.
    pub(super) fn motion_of(&self, change: &[f64]) -> Result<Motion, Error> {
        let mut rotations = self.motion.rotations().to_vec();
        let mut root = self.motion.root_translation().to_vec();
        for (frame, translation) in root.iter_mut().enumerate() {
            for joint in 0..Joint::COUNT {
                if vector(change, frame, joint) != DVec3::ZERO {
                    rotations[frame * Joint::COUNT + joint] =
                        self.rotation(change, frame, joint).as_quat();
                }
            }
            *translation += vector(change, frame, Joint::COUNT).as_vec3();
        }
        let shape = self.motion.shape().cloned();
        Ok(Motion::new(
            self.motion.frame_rate(),
            shape,
            root,
            rotations,
        )?)
    }

    fn rotation(&self, change: &[f64], frame: usize, joint: usize) -> DQuat {
        let turn = DQuat::from_scaled_axis(vector(change, frame, joint));
        turn * self.rotations[frame * Joint::COUNT + joint]
    }
}

/// From derivatives by small turns `R -> exp(w) R` of the changed rotations of a frame, and by the
/// root's displacement, to derivatives by the unknowns of the frame; adds them.
///
/// A step `d` of the rotation vector `w` turns by `J(w) d` more, with the left Jacobian `J` of
/// the rotations.
pub(super) fn add_turns(
    change: &[f64],
    turns: &[DVec3; Joint::COUNT],
    root: DVec3,
    gradient: &mut [f64],
) {
    for (joint, &turn) in turns.iter().enumerate() {
        let w = vector(change, 0, joint);
        let square = w.length_squared();
        let angle = square.sqrt();
        let (a, b) = if angle < 1e-4 {
            (0.5 - square / 24.0, 1.0 / 6.0 - square / 120.0)
        } else {
            let sine = angle.sin();
            (
                (1.0 - angle.cos()) / square,
                (angle - sine) / (square * angle),
            )
        };
        let across = w.cross(turn);
        let by_vector = turn - across * a + w.cross(across) * b;
        add(gradient, joint, by_vector);
    }
    add(gradient, Joint::COUNT, root);
}

fn vector(change: &[f64], frame: usize, place: usize) -> DVec3 {
    DVec3::from_slice(&change[frame * UNKNOWNS + 3 * place..])
}

fn add(gradient: &mut [f64], place: usize, step: DVec3) {
    let slots = &mut gradient[3 * place..][..3];
    for (slot, step) in slots.iter_mut().zip(step.to_array()) {
        *slot += step;
    }
}

//! The unknowns of a repair: by how much every joint turns and the root moves, frame by frame.

use glam::{DMat3, DQuat, DVec3, Mat3};
use physique_body::Joint;
use physique_motion::Motion;
use physique_proxy::PoseMatrices;

use crate::Error;

/// Numbers a frame: a rotation vector a joint, in its parent's axes, then the root's displacement.
pub(super) const UNKNOWNS: usize = 3 * (Joint::COUNT + 1);

/// The motion that is changed.
pub(super) struct Source {
    motion: Motion,
    rotations: Vec<DQuat>,
    root: Vec<DVec3>,
}

/// A changed motion, in the forms that the losses take.
pub(super) struct Changed {
    /// `[frames][22]` local rotations, flat.
    pub(super) rotations: Vec<DMat3>,
    /// `[frames]` root translations.
    pub(super) root: Vec<DVec3>,
    /// `[frames]` the rotations again, for the spheres.
    pub(super) poses: Vec<PoseMatrices>,
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

    pub(super) fn changed(&self, change: &[f64]) -> Changed {
        let mut changed = Changed {
            rotations: Vec::with_capacity(self.rotations.len()),
            root: Vec::with_capacity(self.root.len()),
            poses: Vec::with_capacity(self.root.len()),
        };
        for (frame, &root) in self.root.iter().enumerate() {
            let mut pose: PoseMatrices = Default::default();
            for (joint, matrix) in pose.iter_mut().enumerate() {
                let rotation = DMat3::from_quat(self.rotation(change, frame, joint));
                let single = Mat3::from_cols_array(&rotation.to_cols_array().map(|x| x as f32));
                *matrix = single.transpose().to_cols_array();
                changed.rotations.push(rotation);
            }
            changed.poses.push(pose);
            changed
                .root
                .push(root + vector(change, frame, Joint::COUNT));
        }
        changed
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

/// From derivatives by small turns `R -> exp(w) R` of the changed rotations, `[frames][22]`, to
/// derivatives by the unknowns; adds them.
///
/// A step `d` of the rotation vector `w` turns by `J(w) d` more, with the left Jacobian `J` of
/// the rotations.
pub(super) fn add_turns(change: &[f64], turns: &[DVec3], gradient: &mut [f64]) {
    for (place, &turn) in turns.iter().enumerate() {
        let (frame, joint) = (place / Joint::COUNT, place % Joint::COUNT);
        let w = vector(change, frame, joint);
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
        add(gradient, frame, joint, by_vector);
    }
}

/// Adds derivatives by the root's displacement, `[frames]`.
pub(super) fn add_root(root: &[DVec3], gradient: &mut [f64]) {
    for (frame, &root) in root.iter().enumerate() {
        add(gradient, frame, Joint::COUNT, root);
    }
}

fn vector(change: &[f64], frame: usize, place: usize) -> DVec3 {
    DVec3::from_slice(&change[frame * UNKNOWNS + 3 * place..])
}

fn add(gradient: &mut [f64], frame: usize, place: usize, step: DVec3) {
    let slots = &mut gradient[frame * UNKNOWNS + 3 * place..][..3];
    for (slot, step) in slots.iter_mut().zip(step.to_array()) {
        *slot += step;
    }
}

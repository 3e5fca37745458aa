//! Which joints of a body file are kept.

use crate::{BlendWeights, Error, Joint};

/// Which joints of a body file are kept.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub enum JointSet {
    /// All that the file has: 22, 24, 52 or 55.
    #[default]
    File,
    /// The 22 body joints. Vertices of fingers, jaw and eyes move with the wrists and the head, as
    /// if those joints were at rest: exact for motions without hands and face, and faster.
    Body22,
}

impl JointSet {
    /// How many of a file's joints are kept.
    pub(super) fn kept(self, file_joints: usize) -> usize {
        match self {
            Self::File => file_joints,
            Self::Body22 => file_joints.min(Joint::COUNT),
        }
    }

    /// Blend weights from a dense `[V, J]`, those of joints that are not kept added to the
    /// nearest kept joint above.
    pub(super) fn blend_weights(
        self,
        dense: &[f32],
        parents: &[Option<usize>],
    ) -> Result<BlendWeights, Error> {
        let kept = self.kept(parents.len());
        // Parents come before children, so that a chain ends.
        let mut target: Vec<usize> = Vec::with_capacity(parents.len());
        for (joint, parent) in parents.iter().enumerate() {
            target.push(match parent {
                Some(parent) if joint >= kept => target[*parent],
                _ => joint,
            });
        }
        let rows = dense.chunks_exact(parents.len()).map(|row| {
            let mut folded = vec![0.0; kept];
            for (&weight, &joint) in row.iter().zip(&target) {
                folded[joint] += weight;
            }
            // At most 256 joints, checked when the file was read.
            let indexed = folded.into_iter().enumerate();
            indexed.map(|(joint, weight)| (joint as u8, weight))
        });
        BlendWeights::from_rows(rows)
    }
}

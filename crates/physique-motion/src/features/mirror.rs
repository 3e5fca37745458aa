//! Left for right.

use glam::Vec3;

use super::{FeatureSkeleton, JointPositions, MotionFeatures};

/// Components of a rotation's first two columns that change sign: M R M with M = diag(-1, 1, 1).
const MIRRORED_COLUMNS: [f32; 6] = [1.0, -1.0, -1.0, -1.0, 1.0, 1.0];

impl JointPositions {
    /// The mirror image in the plane x = 0, left joints exchanged with right ones: how HumanML3D
    /// doubles its data ("M" clips). Twice is the identity, bit for bit.
    #[must_use]
    pub fn mirrored(&self) -> Self {
        let twins = self.skeleton().definition().mirrored;
        let mut mirrored = self.clone();
        for (image, joints) in mirrored.frames_mut().zip(self.frames()) {
            for (image, &twin) in image.iter_mut().zip(twins) {
                *image = joints[twin] * Vec3::new(-1.0, 1.0, 1.0);
            }
        }
        mirrored
    }
}

impl MotionFeatures {
    /// Features of the mirror image, without going through positions. Twice is the identity.
    ///
    /// Equal to the features of [`JointPositions::mirrored`] but for the data set's skeleton, whose
    /// left and right bones differ by some millimetres.
    #[must_use]
    pub fn mirrored(&self) -> Self {
        let layout = self.layout();
        let mut mirrored = self.clone();
        for (image, row) in mirrored.rows_mut().zip(self.rows()) {
            image[layout.root_turn] *= -1.0;
            image[layout.root_velocity.start] *= -1.0;
            let signs = [-1.0, 1.0, 1.0];
            exchange(
                self.skeleton(),
                1,
                &mut image[layout.positions.clone()],
                &row[layout.positions.clone()],
                signs,
            );
            exchange(
                self.skeleton(),
                1,
                &mut image[layout.rotations.clone()],
                &row[layout.rotations.clone()],
                MIRRORED_COLUMNS,
            );
            exchange(
                self.skeleton(),
                0,
                &mut image[layout.velocities.clone()],
                &row[layout.velocities.clone()],
                signs,
            );
            image[layout.contacts.clone()].rotate_left(2);
        }
        mirrored
    }
}

/// Copies a block of `SIZE` numbers for each joint from `first` on, left for right.
fn exchange<const SIZE: usize>(
    skeleton: FeatureSkeleton,
    first: usize,
    image: &mut [f32],
    block: &[f32],
    signs: [f32; SIZE],
) {
    let twins = &skeleton.definition().mirrored[first..];
    let joints = block.as_chunks::<SIZE>().0;
    for (image, &twin) in image.as_chunks_mut::<SIZE>().0.iter_mut().zip(twins) {
        for ((image, value), sign) in image.iter_mut().zip(joints[twin - first]).zip(signs) {
            *image = value * sign;
        }
    }
}

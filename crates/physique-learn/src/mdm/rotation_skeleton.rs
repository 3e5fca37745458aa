//! Where joints are, of motions that are rotations.

use burn::tensor::Tensor;
use glam::Vec3;
use physique::body::{Body, Joint};

use crate::Error;
use crate::tensors::tensor;

/// Parents of SMPL's 24 joints.
const SMPL_PARENTS: [usize; 24] = [
    0, 0, 0, 0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 9, 9, 12, 13, 14, 16, 17, 18, 19, 20, 21,
];
/// From wrists to SMPL's joints of the hands, further along the forearm, in metres.
const HAND: f32 = 0.08;

/// The bones that turn rotations into positions, for motions as MDM's models of actions have them
/// (`rot6d`): a frame is `[joints + 1][6]` numbers, flat. Six of a joint are the first two rows of its
/// rotation from its parent's frame; the last row begins with the root's path, x, y, z in metres.
#[derive(Clone, Debug, PartialEq)]
pub struct RotationSkeleton {
    parents: Vec<usize>,
    /// From the parent at rest, in metres.
    offsets: Vec<Vec3>,
}

impl RotationSkeleton {
    /// Joints at rest with the number of each one's parent, which comes before it; the first joint is
    /// its own parent.
    ///
    /// # Errors
    /// [`Error::Input`] for parents that do not come before, counts that disagree, fewer than 12 joints
    /// (the last four of SMPL's first twelve are ankles and feet), or numbers that are not finite.
    pub fn new(parents: Vec<usize>, rest: &[Vec3]) -> Result<Self, Error> {
        const FEWEST: usize = 12;
        if parents.len() != rest.len() || rest.len() < FEWEST {
            let expected = format!("{FEWEST} or more, and a parent each");
            let found = format!("{} and {} parents", rest.len(), parents.len());
            return Err(Error::input("Joints", expected, found));
        }
        let before = |(joint, &parent): (usize, &usize)| parent < joint.max(1);
        if let Some(joint) = parents.iter().enumerate().position(|pair| !before(pair)) {
            let found = format!("{} of joint {joint}", parents[joint]);
            return Err(Error::input("Parents", "each before its joint", found));
        }
        if let Some(joint) = rest.iter().position(|at| !at.is_finite()) {
            let found = format!("{} of joint {joint}", rest[joint]);
            return Err(Error::input("Joints", "finite positions", found));
        }
        let offsets = parents
            .iter()
            .zip(rest)
            .map(|(&parent, &at)| at - rest[parent]);
        Ok(Self {
            offsets: offsets.collect(),
            parents,
        })
    }

    /// SMPL's 24 joints where that body has them at rest.
    ///
    /// # Errors
    /// [`Error::Input`] for numbers that are not finite.
    pub fn smpl(rest: &[Vec3; 24]) -> Result<Self, Error> {
        Self::new(SMPL_PARENTS.to_vec(), rest)
    }

    /// SMPL's 24 joints of a body that has the first 22 of them; hands are 8 cm from the wrists.
    ///
    /// # Errors
    /// As [`RotationSkeleton::smpl`].
    pub fn of_body(body: &Body) -> Result<Self, Error> {
        let hand = |wrist: Joint, elbow: Joint| {
            let (wrist, elbow) = (body.rest_joint(wrist), body.rest_joint(elbow));
            wrist + HAND * (wrist - elbow).normalize_or_zero()
        };
        let mut rest = [Vec3::ZERO; 24];
        for (at, joint) in rest.iter_mut().zip(Joint::ALL) {
            *at = body.rest_joint(joint);
        }
        rest[22] = hand(Joint::LeftWrist, Joint::LeftElbow);
        rest[23] = hand(Joint::RightWrist, Joint::RightElbow);
        Self::smpl(&rest)
    }

    /// Joints, without the row of the root's path.
    pub fn joints(&self) -> usize {
        self.parents.len()
    }

    /// Numbers a frame: 150 for SMPL.
    pub fn columns(&self) -> usize {
        6 * (self.joints() + 1)
    }

    /// Positions of joints, `[batch][frames][joints][3]`, of motions `[batch][frames][columns]`: the
    /// root at its path from the first frame on. Differentiable.
    pub fn positions(&self, motions: Tensor<3>) -> Tensor<4> {
        let [batch, frames, _] = motions.dims();
        let (count, joints) = (batch * frames, self.joints());
        let device = motions.device();
        let rows = motions.reshape([count, joints + 1, 6]);
        let local = matrices(rows.clone().narrow(1, 0, joints));
        let local = |joint: usize| local.clone().narrow(1, joint, 1).squeeze_dim::<3>(1);
        let path = rows.narrow(1, joints, 1).narrow(2, 0, 3);
        let path = path.reshape([batch, frames, 3]);
        let path = path.clone() - path.narrow(1, 0, 1);

        let mut positions = vec![Tensor::<2>::zeros([count, 3], &device)];
        let mut world_from = vec![local(0)];
        for joint in 1..joints {
            let parent = self.parents[joint];
            let offset = self.offsets[joint].to_array().to_vec();
            let offset: Tensor<3> = tensor(offset, [1, 1, 3], &device);
            let bone = (world_from[parent].clone() * offset).sum_dim(2);
            positions.push(positions[parent].clone() + bone.squeeze_dim::<2>(2));
            world_from.push(world_from[parent].clone().matmul(local(joint)));
        }
        let positions = Tensor::stack::<3>(positions, 1).reshape([batch, frames, joints, 3]);
        positions + path.unsqueeze_dim::<4>(2)
    }
}

/// Rotations `[count][joints][3][3]` by their first two rows, `[count][joints][6]`: the first keeps its
/// direction, the second is bent to a right angle.
fn matrices(rows: Tensor<3>) -> Tensor<4> {
    let first = unit(rows.clone().narrow(2, 0, 3));
    let second = rows.narrow(2, 3, 3);
    let along = (first.clone() * second.clone()).sum_dim(2);
    let second = unit(second - first.clone() * along);
    let third = cross(&first, &second);
    Tensor::stack(vec![first, second, third], 2)
}

/// Rows of length 1, but for rows of zeros.
fn unit(rows: Tensor<3>) -> Tensor<3> {
    let square = rows.clone().square().sum_dim(2);
    rows / (square + 1e-12).sqrt()
}

fn cross(a: &Tensor<3>, b: &Tensor<3>) -> Tensor<3> {
    let of = |rows: &Tensor<3>, axis: usize| rows.clone().narrow(2, axis % 3, 1);
    let component =
        |axis: usize| of(a, axis + 1) * of(b, axis + 2) - of(a, axis + 2) * of(b, axis + 1);
    Tensor::cat(vec![component(0), component(1), component(2)], 2)
}

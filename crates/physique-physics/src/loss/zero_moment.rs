//! The zero moment point of a window's middle frame, and its gradient.

use glam::{DMat4, DVec2, DVec3, DVec4};

use super::Window;
use crate::balance::{Centroid, GRAVITY};
use crate::{MassMoments, TimeFilter};

/// A zero moment point with what its gradient needs.
pub(super) struct ZeroMoment<'a> {
    filter: &'a TimeFilter,
    ground: f64,
    centroid: Centroid,
    /// Second time derivatives of the joint transforms.
    accelerations: Vec<DMat4>,
    /// The point, `(x, z)`.
    pub(super) point: DVec2,
}

impl<'a> ZeroMoment<'a> {
    /// `None` where the ground carries hardly anything.
    pub(super) fn new(window: &Window<'_>, filter: &'a TimeFilter, ground: f64) -> Option<Self> {
        let moments = &window.shaped.moments;
        let poses = window.transforms(0);
        let mut accelerations = vec![DMat4::ZERO; poses.len()];
        for (offset, tap) in taps(filter) {
            let transforms = window.transforms(offset);
            for (sum, transform) in accelerations.iter_mut().zip(transforms) {
                *sum += *transform * tap;
            }
        }
        let centroid = Centroid {
            mass: moments.mass(),
            centre: moments.mean(poses),
            acceleration: moments.mean(&accelerations),
            angular_momentum_rate: moments.moment_about_centre(poses, &accelerations),
            ..Centroid::default()
        };
        Some(Self {
            point: centroid.zero_moment_point(ground)?,
            filter,
            ground,
            centroid,
            accelerations,
        })
    }

    /// Adds the gradient of a loss to the point to the window.
    pub(super) fn backward(&self, window: &mut Window<'_>, point: DVec2) {
        let moments = &window.shaped.moments;
        let (centre, acceleration, turn) = self.to_centroid(point);
        let poses = window.transforms(0).to_vec();
        let mut to_poses = vec![DMat4::ZERO; poses.len()];
        let mut to_accelerations = to_poses.clone();
        let Some((_, rest)) = window.gradients(0) else {
            return;
        };
        let (first, second) = (&mut rest.first, &mut rest.second);
        let mut mean_backward = |gradient: DVec3, of: &[DMat4], to: &mut [DMat4]| {
            let gradient = (gradient / moments.mass()).extend(0.0);
            for (joint, &moment) in moments.first.iter().enumerate() {
                to[joint] += outer(gradient, moment);
                first[joint] += of[joint].transpose() * gradient;
            }
        };
        mean_backward(centre, &poses, &mut to_poses);
        mean_backward(acceleration, &self.accelerations, &mut to_accelerations);
        self.turn_backward(
            moments,
            turn,
            &poses,
            (&mut to_poses, &mut to_accelerations),
            second,
        );

        add(window, 0, &to_poses, 1.0);
        for (offset, tap) in taps(self.filter) {
            add(window, offset, &to_accelerations, tap);
        }
    }

    /// Derivatives to centre, acceleration, and angular momentum rate about the origin.
    fn to_centroid(&self, point: DVec2) -> (DVec3, DVec3, DVec3) {
        let Centroid {
            mass,
            centre,
            acceleration,
            angular_momentum_rate: rate,
            ..
        } = self.centroid;
        let support = GRAVITY + acceleration.y;
        let height = centre.y - self.ground;
        let along = DVec3::new(point.x, 0.0, point.y);
        let turn = DVec3::new(-point.y, 0.0, point.x) / (mass * support);
        // The offsets shrink with the support.
        let to_support =
            (height * along.dot(acceleration) / support) / support - turn.dot(rate) / support;
        let to_centre = along - DVec3::Y * along.dot(acceleration) / support;
        let to_acceleration = along * (-height / support) + DVec3::Y * to_support;
        // rate = rate about the origin - mass centre x acceleration
        (
            to_centre - mass * acceleration.cross(turn),
            to_acceleration - mass * turn.cross(centre),
            turn,
        )
    }

    /// Through `sum_jl T_j M_jl A_l^T` and its antisymmetric part.
    fn turn_backward(
        &self,
        moments: &MassMoments,
        turn: DVec3,
        poses: &[DMat4],
        (to_poses, to_accelerations): (&mut [DMat4], &mut [DMat4]),
        second: &mut [DMat4],
    ) {
        let skew = DMat4::from_cols(
            DVec4::new(0.0, -turn.z, turn.y, 0.0),
            DVec4::new(turn.z, 0.0, -turn.x, 0.0),
            DVec4::new(-turn.y, turn.x, 0.0, 0.0),
            DVec4::ZERO,
        );
        for (&(j, l, moment), to_moment) in moments.second.iter().zip(second) {
            let turned = skew * self.accelerations[l];
            to_poses[j] += turned * moment.transpose();
            to_accelerations[l] += skew.transpose() * poses[j] * moment;
            *to_moment += poses[j].transpose() * turned;
        }
    }
}

/// Offsets and taps of the second derivative.
fn taps(filter: &TimeFilter) -> impl Iterator<Item = (isize, f64)> + '_ {
    let reach = filter.reach() as isize;
    (-reach..=reach).zip(filter.taps(2).iter().copied())
}

fn outer(column: DVec4, row: DVec4) -> DMat4 {
    DMat4::from_cols(
        column * row.x,
        column * row.y,
        column * row.z,
        column * row.w,
    )
}

fn add(window: &mut Window<'_>, offset: isize, gradient: &[DMat4], scale: f64) {
    if let Some((transforms, _)) = window.gradients(offset) {
        for (sum, term) in transforms.iter_mut().zip(gradient) {
            *sum += *term * scale;
        }
    }
}

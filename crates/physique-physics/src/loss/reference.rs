//! The losses by the book: the whole motion posed point by point, no windows, no moments, no
//! gradients. Slow; the tests compare the fast losses with these.

use glam::{DVec2, DVec3};

use super::balance::{LEAST_CONTACT, signed_distance, softplus};
use super::pressure::LEAST_PRESSURE;
use super::{
    Floating, LossBody, MotionSlices, Penetration, PressureBalance, Sliding, SupportedBalance,
};
use crate::balance::{Centroid, on_ground};
use crate::soles::SOLE_POINTS;
use crate::{MassPoints, TimeFilter};

/// Every point of a motion.
pub struct PosedMotion {
    /// `[frames][skin points]`.
    skin: Vec<Vec<DVec3>>,
    /// `[frames][mass points]`.
    mass: Vec<Vec<DVec3>>,
    masses: Vec<f64>,
    areas: Vec<f64>,
    frames_per_second: f64,
}

impl PosedMotion {
    /// Poses all points of all frames. Rotations and root must fit together.
    pub fn new(body: &LossBody, motion: &MotionSlices<'_>) -> Self {
        let shaped = body.shaped(motion.betas);
        let joints = motion.rotations.len() / motion.root.len().max(1);
        let mass_points: MassPoints = shaped.mass_points();
        let mut posed = Self {
            skin: Vec::new(),
            mass: Vec::new(),
            masses: mass_points.masses().to_vec(),
            areas: body.skin.iter().map(|point| point.area).collect(),
            frames_per_second: motion.frame_rate.per_second(),
        };
        let mut transforms = Vec::new();
        for (rotations, &root) in motion.rotations.chunks(joints.max(1)).zip(motion.root) {
            shaped
                .rig
                .pose(rotations.iter().copied(), root, &mut transforms);
            let skin = body.skin.iter().zip(&shaped.skin).map(|(point, &rest)| {
                let blend = point.weights.iter();
                blend
                    .map(|&(j, w)| transforms[j].transform_point3(rest) * w)
                    .sum()
            });
            posed.skin.push(skin.collect());
            posed.mass.push(mass_points.posed(&transforms));
        }
        posed
    }

    fn frames(&self) -> usize {
        self.skin.len()
    }

    /// Mean over the frames that a filter of this reach covers.
    fn mean(&self, reach: usize, term: impl Fn(usize) -> f64) -> f64 {
        let terms = self.frames().saturating_sub(2 * reach);
        let sum: f64 = (reach..reach + terms).map(term).sum();
        if terms == 0 { 0.0 } else { sum / terms as f64 }
    }

    fn zero_moment_point(&self, filter: &TimeFilter, frame: usize, ground: f64) -> Option<DVec2> {
        let points = &self.mass[frame];
        let acceleration = |point: usize| -> DVec3 {
            let taps = filter.taps(2).iter().enumerate();
            taps.map(|(k, &tap)| self.mass[frame + k - filter.reach()][point] * tap)
                .sum()
        };
        let accelerations: Vec<_> = (0..points.len()).map(acceleration).collect();
        let mass: f64 = self.masses.iter().sum();
        let mean = |vectors: &[DVec3]| {
            let weighted = vectors.iter().zip(&self.masses).map(|(v, m)| *v * *m);
            weighted.sum::<DVec3>() / mass
        };
        let centre = mean(points);
        let turns = points.iter().zip(&accelerations).zip(&self.masses);
        let centroid = Centroid {
            mass,
            centre,
            acceleration: mean(&accelerations),
            angular_momentum_rate: turns.map(|((p, a), m)| (*p - centre).cross(*a) * *m).sum(),
            ..Centroid::default()
        };
        centroid.zero_moment_point(ground)
    }
}

/// [`Penetration`].
pub fn penetration(motion: &PosedMotion, loss: &Penetration) -> f64 {
    motion.mean(0, |frame| {
        let depths = motion.skin[frame]
            .iter()
            .map(|p| (loss.ground - p.y).max(0.0));
        depths.map(|d| 1e4 * d * d).sum::<f64>() / motion.skin[frame].len() as f64
    })
}

/// [`Floating`].
pub fn floating(motion: &PosedMotion, loss: &Floating<'_>) -> f64 {
    motion.mean(0, |frame| {
        let weighted = motion.skin[frame].iter().map(|p| {
            let height = p.y - loss.ground;
            let weight = (-loss.sharpness * height).exp();
            (height * weight, weight)
        });
        let (sum, total) = weighted.fold((0.0, 0.0), |(s, t), (a, b)| (s + a, t + b));
        let excess = (sum / total - loss.tolerance).max(0.0);
        1e4 * loss.grounded.get(frame).copied().unwrap_or(1.0) * excess * excess
    })
}

/// [`Sliding`].
pub fn sliding(motion: &PosedMotion, loss: &Sliding<'_>) -> f64 {
    motion.mean(1, |frame| {
        let weights = loss.contacts.chunks(SOLE_POINTS).nth(frame).unwrap_or(&[]);
        let speeds = weights.iter().enumerate().map(|(point, weight)| {
            let step = motion.skin[frame + 1][point] - motion.skin[frame - 1][point];
            let speed = on_ground(step).length() * motion.frames_per_second / 2.0;
            weight * (speed.hypot(loss.softness) - loss.softness)
        });
        speeds.sum()
    })
}

/// [`SupportedBalance`].
pub fn supported_balance(motion: &PosedMotion, loss: &SupportedBalance<'_>) -> f64 {
    motion.mean(loss.filter.reach(), |frame| {
        let weights = loss.contacts.chunks(SOLE_POINTS).nth(frame).unwrap_or(&[]);
        let point = motion.zero_moment_point(&loss.filter, frame, loss.ground);
        let soles: Vec<_> = motion.skin[frame][..SOLE_POINTS]
            .iter()
            .map(|p| on_ground(*p))
            .collect();
        match point {
            Some(point) if weights.iter().sum::<f64>() >= LEAST_CONTACT => {
                signed_distance(point, &soles, weights).map_or(0.0, |(distance, _)| {
                    loss.softness * softplus((distance + loss.margin) / loss.softness).0
                })
            }
            _ => 0.0,
        }
    })
}

/// [`PressureBalance`].
pub fn pressure_balance(motion: &PosedMotion, loss: &PressureBalance) -> f64 {
    motion.mean(loss.filter.reach(), |frame| {
        let skin = &motion.skin[frame];
        let pressures: Vec<_> = skin
            .iter()
            .map(|p| loss.pressure.pressure(p.y - loss.ground))
            .collect();
        let point = motion.zero_moment_point(&loss.filter, frame, loss.ground);
        match point {
            Some(point) if pressures.iter().any(|&p| p >= LEAST_PRESSURE) => {
                let (mut centre, mut total) = (DVec2::ZERO, 0.0);
                for ((p, pressure), area) in skin.iter().zip(pressures).zip(&motion.areas) {
                    centre += on_ground(*p) * pressure * *area;
                    total += pressure * area;
                }
                let r2 = point.distance_squared(centre / total);
                loss.rho.powi(2) * r2 / (loss.rho.powi(2) + r2)
            }
            _ => 0.0,
        }
    })
}

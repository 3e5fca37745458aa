//! A guess of the objective's curvature, solved exactly.
//!
//! Feet that stand tie pelvis and legs to each other and to their neighbours in time far more tightly
//! than the stiffness does: without knowing that, a descent creeps. For legs, trunk and root the
//! curvature of stiffness, feet and balance at the source is one banded matrix; all other joints
//! have their stiffness alone.

use glam::DVec3;
use physique_body::Joint;
use physique_physics::soles::SOLE_POINTS;

use super::balance::Balance;
use super::banded::Banded;
use super::change::UNKNOWNS;
use super::feet::Feet;
use super::figure::{Figure, Pose};
use super::objective::Weights;
use super::stiffness::Stiffness;
use super::wrench::Wrenches;

/// Places of a change that are tied: joints, then the root's displacement.
const TIED: [usize; 13] = [
    Joint::Pelvis as usize,
    Joint::LeftHip as usize,
    Joint::RightHip as usize,
    Joint::Spine1 as usize,
    Joint::LeftKnee as usize,
    Joint::RightKnee as usize,
    Joint::Spine2 as usize,
    Joint::LeftAnkle as usize,
    Joint::RightAnkle as usize,
    Joint::Spine3 as usize,
    Joint::LeftFoot as usize,
    Joint::RightFoot as usize,
    Joint::COUNT,
];
/// Numbers a frame.
const SIZE: usize = 3 * TIED.len();
/// Derivatives of one number by those.
type Row = [f64; SIZE];

/// See the module.
pub(super) struct Preconditioner {
    tied: Banded,
}

impl Preconditioner {
    pub(super) fn new(
        figure: &Figure,
        source: &[Pose],
        stiffness: &Stiffness,
        (feet, balance): (&Feet, &Balance),
        weights: Weights,
    ) -> Self {
        let mut tied = Banded::new(source.len() * SIZE, 3 * SIZE - 1);
        for (number, unknown) in unknowns().enumerate() {
            for frame in 0..source.len() {
                for (step, value) in stiffness.curvature(unknown, frame).enumerate() {
                    tied.add((frame + step) * SIZE + number, frame * SIZE + number, value);
                }
            }
        }
        let rows: Vec<_> = source.iter().map(|pose| Rows::of(figure, pose)).collect();
        for frame in 0..source.len() {
            add_feet(&mut tied, &rows, feet, weights.feet, frame);
            add_balance(&mut tied, &rows, balance, weights.balance, frame);
        }
        tied.factorise();
        Self { tied }
    }

    /// Solves for the change whose gradient this is, in place.
    pub(super) fn solve(&self, stiffness: &Stiffness, gradient: &mut [f64]) {
        let frames = gradient.len() / UNKNOWNS;
        let mut tied = Vec::with_capacity(frames * SIZE);
        for frame in gradient.chunks_exact(UNKNOWNS) {
            tied.extend(unknowns().map(|unknown| frame[unknown]));
        }
        rayon::join(|| self.tied.solve(&mut tied), || stiffness.solve(gradient));
        for (frame, tied) in gradient
            .chunks_exact_mut(UNKNOWNS)
            .zip(tied.chunks_exact(SIZE))
        {
            for (unknown, value) in unknowns().zip(tied) {
                frame[unknown] = *value;
            }
        }
    }
}

/// Numbers of the tied unknowns of a frame.
fn unknowns() -> impl Iterator<Item = usize> {
    TIED.into_iter().flat_map(|place| 3 * place..3 * place + 3)
}

/// Derivatives of a frame's sole points and centre of mass.
struct Rows {
    soles: [[Row; 3]; SOLE_POINTS],
    centre: [Row; 2],
}

impl Rows {
    fn of(figure: &Figure, pose: &Pose) -> Self {
        let mut wrenches = Wrenches::default();
        let mut row = |push: &dyn Fn(&mut Wrenches)| {
            wrenches.clear(&figure.rig);
            push(&mut wrenches);
            let mut turns = [DVec3::ZERO; Joint::COUNT];
            let root = wrenches.carry(&figure.rig, &pose.world_from_rest, &mut turns);
            let vectors = TIED.map(|place| turns.get(place).copied().unwrap_or(root));
            let mut row = [0.0; SIZE];
            for (slots, vector) in row.chunks_exact_mut(3).zip(vectors) {
                slots.copy_from_slice(&vector.to_array());
            }
            row
        };
        let world = &pose.world_from_rest;
        Self {
            soles: std::array::from_fn(|sole| {
                DVec3::AXES.map(|axis| {
                    row(&|wrenches| wrenches.push_skin(&figure.skin[sole], world, axis))
                })
            }),
            centre: [DVec3::X, DVec3::Z]
                .map(|axis| row(&|wrenches| wrenches.push_centre(&figure.moments, world, axis))),
        }
    }
}

fn add_feet(matrix: &mut Banded, rows: &[Rows], feet: &Feet, weight: f64, frame: usize) {
    for point in 0..SOLE_POINTS {
        let step = feet.step_weight(frame, point) * weight;
        let place = feet.place_weight(frame, point);
        for axis in 0..3 {
            let row = &rows[frame].soles[point][axis];
            add_square(matrix, &[(frame, row, 1.0)], place);
            if let Some(next) = rows.get(frame + 1) {
                let next = &next.soles[point][axis];
                let terms = [(frame, row, -1.0), (frame + 1, next, 1.0)];
                add_square(matrix, &terms, step[axis]);
            }
        }
    }
}

fn add_balance(matrix: &mut Banded, rows: &[Rows], balance: &Balance, weight: f64, frame: usize) {
    let Some(curvature) = balance.curvature(frame) else {
        return;
    };
    let [before, own, after] = balance.taps();
    for (axis, sole_axis) in [(0, 0), (1, 2)] {
        // The point moves with the soles.
        let mut row = rows[frame].centre[axis].map(|slope| slope * own);
        for (sole, share) in rows[frame].soles.iter().zip(balance.shares(frame)) {
            for (slope, of_sole) in row.iter_mut().zip(&sole[sole_axis]) {
                *slope -= share * of_sole;
            }
        }
        let terms = [
            (frame - 1, &rows[frame - 1].centre[axis], before),
            (frame, &row, 1.0),
            (frame + 1, &rows[frame + 1].centre[axis], after),
        ];
        add_square(matrix, &terms, weight * curvature);
    }
}

/// Adds `weight` times the square of a sum of rows, each of a frame and with a factor.
fn add_square(matrix: &mut Banded, terms: &[(usize, &Row, f64)], weight: f64) {
    if weight < 1e-3 {
        return;
    }
    for &(late, late_row, late_factor) in terms {
        for &(early, early_row, early_factor) in terms.iter().filter(|(frame, ..)| *frame <= late) {
            let factor = weight * late_factor * early_factor;
            for (i, a) in late_row.iter().enumerate().filter(|(_, a)| **a != 0.0) {
                let last = if early == late { i + 1 } else { SIZE };
                let columns = early_row[..last].iter().enumerate();
                for (j, b) in columns.filter(|(_, b)| **b != 0.0) {
                    matrix.add(late * SIZE + i, early * SIZE + j, factor * a * b);
                }
            }
        }
    }
}

//! Everything that a repair weighs, as one number with its gradient.

use glam::{DMat3, DVec3};
use physique_motion::FrameRate;
use physique_physics::loss::{
    Floating, FrameLoss, LossBody, MotionGradient, MotionSlices, Penetration, Sliding, evaluate,
};
use physique_proxy::{PoseMatrices, SelfIntersection};

use super::change::{Changed, Source, add_root, add_turns};
use super::descent::Cost;
use super::stiffness::Stiffness;
use super::touch::Touches;

/// Squared centimetres in a squared metre: the unit of all costs.
const CM2: f64 = 1e4;
/// A skin point 1 cm in the ground costs as much as so many pairs of spheres 1 cm deep. The losses
/// are means over some hundred points of skin, of which only some can touch the ground.
const PENETRATION: f64 = 2000.0;
/// Floating by 1 cm beyond the tolerance.
const FLOATING: f64 = 20.0;
/// A sole point that slides by 1 m/s.
const SLIDING: f64 = 300.0;
/// A gap that opens by 1 cm where hands touched.
const TOUCH: f64 = 1.0;
/// Slower sliding is hardly worth a change, in m/s.
const SLIDE_SOFTNESS: f64 = 0.02;

/// What is weighed, in units of the stiffness.
pub(super) struct Objective<'a> {
    pub(super) source: &'a Source,
    pub(super) stiffness: &'a Stiffness,
    pub(super) body: &'a LossBody,
    pub(super) spheres: &'a SelfIntersection,
    pub(super) touches: &'a Touches,
    /// `[frames]` weights of the self-intersection; none where it is left alone.
    pub(super) self_weights: Option<Vec<f32>>,
    /// `[frames]` 1 where the source is on the ground; none where the ground is left alone.
    pub(super) grounded: Option<Vec<f64>>,
    /// `[frames][12]` weights of sole points that stand; none where feet are left alone.
    pub(super) contacts: Option<Vec<f64>>,
    /// Multiplies the self-intersection and what keeps touches.
    pub(super) self_strength: f64,
    /// Multiplies the losses of ground and feet.
    pub(super) strength: f64,
}

impl Cost for Objective<'_> {
    fn evaluate(&self, at: &[f64], gradient: &mut [f64]) -> f64 {
        gradient.fill(0.0);
        let changed = self.source.changed(at);
        let mut cost = self.stiffness.cost(at, gradient);
        let (spheres, ground) = rayon::join(|| self.spheres(&changed), || self.ground(&changed));
        for part in [spheres, ground] {
            cost += part.cost;
            add_turns(at, &part.turns, gradient);
            add_root(&part.root, gradient);
        }
        if cost.is_finite() { cost } else { f64::MAX }
    }

    fn precondition(&self, gradient: &mut [f64]) {
        self.stiffness.solve(gradient);
    }
}

/// A cost and its derivatives by small turns of the joints and steps of the root.
#[derive(Default)]
struct Part {
    cost: f64,
    turns: Vec<DVec3>,
    root: Vec<DVec3>,
}

impl Objective<'_> {
    fn spheres(&self, changed: &Changed) -> Part {
        let Some(weights) = &self.self_weights else {
            return Part::default();
        };
        let weights: Vec<_> = weights
            .iter()
            .map(|w| w * (CM2 * self.self_strength) as f32)
            .collect();
        let frames = changed.poses.len();
        let mut losses = vec![0.0; frames];
        let mut by_poses: Vec<PoseMatrices> = vec![Default::default(); frames];
        let (poses, by) = (&changed.poses, &mut by_poses);
        if self
            .spheres
            .gradient(poses, &weights, &mut losses, by)
            .is_err()
        {
            // Rotations that are no numbers: a step that the search takes back.
            return Part {
                cost: f64::INFINITY,
                ..Part::default()
            };
        }
        let terms = losses.iter().zip(&weights);
        let mut cost: f64 = terms.map(|(loss, weight)| f64::from(loss * weight)).sum();
        let matrices = by_poses.iter().flatten();
        let mut turns: Vec<_> = matrices
            .zip(&changed.rotations)
            .map(|(by_matrix, rotation)| {
                let by_matrix = DMat3::from_cols_array(&by_matrix.map(f64::from)).transpose();
                turn(by_matrix * rotation.transpose())
            })
            .collect();
        let touch = CM2 * TOUCH * self.self_strength;
        cost += touch * self.touches.cost(changed, touch, &mut turns);
        Part {
            cost,
            turns,
            root: Vec::new(),
        }
    }

    fn ground(&self, changed: &Changed) -> Part {
        let rate = self.source.motion().frame_rate();
        let mut part = Part::default();
        if let Some(grounded) = &self.grounded {
            let floating = Floating {
                grounded,
                ..Floating::default()
            };
            self.add(
                changed,
                rate,
                &Penetration::default(),
                PENETRATION,
                &mut part,
            );
            self.add(changed, rate, &floating, FLOATING, &mut part);
        }
        if let Some(contacts) = &self.contacts {
            let sliding = Sliding {
                contacts,
                softness: SLIDE_SOFTNESS,
            };
            self.add(changed, rate, &sliding, SLIDING, &mut part);
        }
        part
    }

    /// Adds a loss, as a sum over frames.
    fn add(
        &self,
        changed: &Changed,
        frame_rate: FrameRate,
        loss: &dyn FrameLoss,
        weight: f64,
        part: &mut Part,
    ) {
        let motion = MotionSlices {
            frame_rate,
            rotations: &changed.rotations,
            root: &changed.root,
            betas: &[],
        };
        let weight = weight * self.strength * changed.root.len() as f64;
        let mut gradient = MotionGradient::default();
        let Ok(cost) = evaluate(self.body, &motion, loss, Some(&mut gradient)) else {
            part.cost = f64::INFINITY;
            return;
        };
        part.cost += weight * cost;
        part.turns.resize(changed.rotations.len(), DVec3::ZERO);
        part.root.resize(changed.root.len(), DVec3::ZERO);
        let turns = gradient.rotation_vectors(&changed.rotations);
        for (sum, turn) in part.turns.iter_mut().zip(turns) {
            *sum += turn * weight;
        }
        for (sum, root) in part.root.iter_mut().zip(gradient.root) {
            *sum += root * weight;
        }
    }
}

/// The derivative by small turns, from `G R^T`.
fn turn(product: DMat3) -> DVec3 {
    DVec3::new(
        product.y_axis.z - product.z_axis.y,
        product.z_axis.x - product.x_axis.z,
        product.x_axis.y - product.y_axis.x,
    )
}

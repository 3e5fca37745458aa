//! What a tile leaves for its next stage.

use physique_body::Joint;

use super::MOST_NUMBERS;
use super::swings::SwingWork;
use crate::lanes::{Answers, Simd};
use crate::plan::{Plan, QUAD};

/// Rotation, row by row, and position.
pub(crate) type Transform<L> = [L; 12];

/// Lowest corner and highest.
pub(crate) type Bounds<L> = [[L; 3]; 2];

/// Scratch of one thread, some 200 kB whatever the number of frames.
pub(crate) struct Workspace<L> {
    /// Local rotations; on the way back, the loss's derivatives by them.
    pub(crate) local: [[L; 9]; Joint::COUNT],
    pub(crate) world_from_joint: [Transform<L>; Joint::COUNT],
    pub(crate) by_world: [Transform<L>; Joint::COUNT],
    /// Centre, and half its squared length; padded, so that every quad can be read as four.
    pub(crate) spheres: Vec<[L; 4]>,
    pub(crate) by_spheres: Vec<[L; 3]>,
    pub(crate) by_reaches: Vec<L>,
    pub(crate) quad_bounds: Vec<Bounds<L>>,
    pub(crate) group_bounds: Vec<Bounds<L>>,
    /// Survivors of the broad phase.
    pub(crate) group_pairs: Vec<u32>,
    pub(crate) quad_pairs: Vec<u32>,
    pub(crate) touching: Vec<(u32, Answers)>,
    /// Positions, where they are given; on the way back, the loss's derivatives by them.
    pub(crate) joints: [[L; 3]; Joint::COUNT],
    pub(crate) swings: SwingWork<L>,
    /// For a last tile that is not full.
    pub(crate) frames: Vec<f32>,
    pub(crate) by_frames: Vec<f32>,
}

impl<L: Copy> Workspace<L> {
    pub(crate) fn new<S: Simd<Lanes = L>>(simd: S, plan: &Plan) -> Self {
        let zero = simd.splat(0.0);
        Self {
            local: [[zero; 9]; Joint::COUNT],
            world_from_joint: [[zero; 12]; Joint::COUNT],
            by_world: [[zero; 12]; Joint::COUNT],
            spheres: vec![[zero; 4]; plan.sphere_count() + QUAD - 1],
            // Padded likewise: what is no number may seem to touch anything.
            by_spheres: vec![[zero; 3]; plan.sphere_count() + QUAD - 1],
            by_reaches: vec![zero; plan.sphere_count() + QUAD - 1],
            quad_bounds: vec![[[zero; 3]; 2]; plan.quads.len()],
            group_bounds: vec![[[zero; 3]; 2]; plan.groups.len()],
            // One more each: a survivor is written before it is counted.
            group_pairs: vec![0; plan.group_pairs.len() + 1],
            quad_pairs: vec![0; plan.quad_pairs.len() + 1],
            touching: vec![(0, Answers::default()); plan.quad_pairs.len() + 1],
            joints: [[zero; 3]; Joint::COUNT],
            swings: SwingWork::new(zero),
            frames: vec![0.0; S::COUNT * MOST_NUMBERS],
            by_frames: vec![0.0; S::COUNT * MOST_NUMBERS],
        }
    }
}

//! Tiles over threads: the fused kernel applied to any number of frames.

use std::sync::Mutex;
use std::sync::atomic::{AtomicUsize, Ordering};

use rayon::prelude::*;

use crate::kernel::{Tile, TileGradient, Workspace};
use crate::lanes::{Dispatch, Simd};
use crate::plan::Plan;
use crate::{Penalty, PoseMatrices};

/// What to evaluate; slices are as long as `poses`.
pub(crate) struct Request<'a> {
    pub(crate) poses: &'a [PoseMatrices],
    pub(crate) losses: &'a mut [f32],
    pub(crate) gradient: Option<TileGradient<'a>>,
}

/// A loss on a chosen backend.
pub(crate) trait Engine: Send + Sync {
    /// Returns the first frame whose loss is not finite.
    fn evaluate(&self, request: Request<'_>) -> Option<usize>;
}

/// Builds the engine for whichever backend is dispatched to.
pub(crate) struct Build {
    pub(crate) plan: Plan,
    pub(crate) penalty: Penalty,
}

impl Dispatch for Build {
    type Output = Box<dyn Engine>;

    fn with<S: Simd>(self, simd: S) -> Self::Output {
        Box::new(Fused {
            simd,
            plan: self.plan,
            penalty: self.penalty,
            idle: Mutex::default(),
        })
    }
}

struct Fused<S: Simd> {
    simd: S,
    plan: Plan,
    penalty: Penalty,
    /// Workspaces between two uses: as many as threads ever worked at once.
    idle: Mutex<Vec<Box<Workspace<S::Lanes>>>>,
}

/// Fewest tiles worth handing to another thread.
const TILES: usize = 4;

impl<S: Simd> Engine for Fused<S> {
    fn evaluate(&self, request: Request<'_>) -> Option<usize> {
        let first = AtomicUsize::new(usize::MAX);
        let record = |tile: usize, losses: &[f32]| {
            let frame = losses.iter().position(|loss| !loss.is_finite());
            first.fetch_min(tile * S::COUNT + frame.unwrap_or(0), Ordering::Relaxed);
        };
        let tiles = request.poses.par_chunks(S::COUNT);
        let tiles = tiles
            .zip(request.losses.par_chunks_mut(S::COUNT))
            .enumerate();
        match request.gradient {
            None => tiles.with_min_len(TILES).for_each_init(
                || Borrowed::new(self),
                |workspace, (number, (poses, losses))| {
                    if !self.tile(workspace.get(), poses, losses, None) {
                        record(number, losses);
                    }
                },
            ),
            Some(TileGradient { weights, by_poses }) => tiles
                .zip(weights.par_chunks(S::COUNT))
                .zip(by_poses.par_chunks_mut(S::COUNT))
                .with_min_len(TILES)
                .for_each_init(
                    || Borrowed::new(self),
                    |workspace, (((number, (poses, losses)), weights), by_poses)| {
                        let gradient = TileGradient { weights, by_poses };
                        if !self.tile(workspace.get(), poses, losses, Some(gradient)) {
                            record(number, losses);
                        }
                    },
                ),
        }
        let first = first.into_inner();
        (first != usize::MAX).then_some(first)
    }
}

impl<S: Simd> Fused<S> {
    /// Whether all is finite.
    fn tile(
        &self,
        workspace: &mut Workspace<S::Lanes>,
        poses: &[PoseMatrices],
        losses: &mut [f32],
        gradient: Option<TileGradient<'_>>,
    ) -> bool {
        if poses.len() < S::COUNT {
            return self.part_of_tile(workspace, poses, losses, gradient);
        }
        self.simd.run(Tile {
            plan: &self.plan,
            workspace,
            penalty: self.penalty,
            poses,
            losses,
            gradient,
        })
    }

    /// Fills the tile up with its last frame.
    fn part_of_tile(
        &self,
        workspace: &mut Workspace<S::Lanes>,
        poses: &[PoseMatrices],
        losses: &mut [f32],
        gradient: Option<TileGradient<'_>>,
    ) -> bool {
        let frames = poses.len();
        let Some(last) = poses.last() else {
            return true;
        };
        let mut full = std::mem::take(&mut workspace.poses);
        let mut by_full = std::mem::take(&mut workspace.by_poses);
        full[..frames].copy_from_slice(poses);
        full[frames..].fill(*last);
        let mut full_losses = [0.0; crate::lanes::MOST_LANES];
        let mut full_weights = [0.0; crate::lanes::MOST_LANES];
        let finite = if let Some(gradient) = gradient {
            full_weights[..frames].copy_from_slice(gradient.weights);
            let full_gradient = TileGradient {
                weights: &full_weights,
                by_poses: &mut by_full,
            };
            let finite = self.tile(workspace, &full, &mut full_losses, Some(full_gradient));
            gradient.by_poses.copy_from_slice(&by_full[..frames]);
            finite
        } else {
            self.tile(workspace, &full, &mut full_losses, None)
        };
        losses.copy_from_slice(&full_losses[..frames]);
        workspace.poses = full;
        workspace.by_poses = by_full;
        finite
    }
}

/// A workspace that goes back when it is no longer needed.
struct Borrowed<'a, S: Simd> {
    engine: &'a Fused<S>,
    workspace: Option<Box<Workspace<S::Lanes>>>,
}

impl<'a, S: Simd> Borrowed<'a, S> {
    fn new(engine: &'a Fused<S>) -> Self {
        let idle = engine.idle.lock().ok().and_then(|mut idle| idle.pop());
        Self {
            engine,
            workspace: idle,
        }
    }

    fn get(&mut self) -> &mut Workspace<S::Lanes> {
        self.workspace
            .get_or_insert_with(|| Box::new(Workspace::new(self.engine.simd, &self.engine.plan)))
    }
}

impl<S: Simd> Drop for Borrowed<'_, S> {
    fn drop(&mut self) {
        if let (Ok(mut idle), Some(workspace)) = (self.engine.idle.lock(), self.workspace.take()) {
            idle.push(workspace);
        }
    }
}

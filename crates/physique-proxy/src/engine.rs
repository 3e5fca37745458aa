//! Tiles over threads: the fused kernel applied to any number of frames.

use std::sync::Mutex;

use crate::Penalty;
use crate::kernel::{Input, Joints, Rotations, ShapeSums, Swings, Tile, TileGradient, Workspace};
use crate::lanes::{Dispatch, MOST_LANES, Simd};
use crate::plan::Plan;

/// What frames are given by, not yet known when the program is compiled.
#[derive(Clone, Copy)]
pub(crate) enum Given<'a> {
    /// See [`Rotations`].
    Rotations,
    /// See [`Joints`].
    Joints(&'a Swings),
}

impl Given<'_> {
    /// Numbers of a frame.
    const fn numbers(self) -> usize {
        match self {
            Self::Rotations => Rotations::NUMBERS,
            Self::Joints(_) => Joints::NUMBERS,
        }
    }
}

/// What to evaluate: a frame for each of `losses`.
pub(crate) struct Request<'a> {
    pub(crate) given: Given<'a>,
    /// `[frames]` rows of [`Given::numbers`].
    pub(crate) frames: &'a [f32],
    pub(crate) losses: &'a mut [f32],
    pub(crate) gradient: Option<TileGradient<'a>>,
}

impl<'a> Request<'a> {
    fn split_at(self, frames: usize) -> (Self, Self) {
        let given = self.given;
        let numbers = frames * given.numbers();
        let rows = self.frames.split_at(numbers);
        let losses = self.losses.split_at_mut(frames);
        let gradients = self.gradient.map(|TileGradient { weights, by_frames }| {
            let weights = weights.split_at(frames);
            let by_frames = by_frames.split_at_mut(numbers);
            let gradient = |weights, by_frames| TileGradient { weights, by_frames };
            (
                gradient(weights.0, by_frames.0),
                gradient(weights.1, by_frames.1),
            )
        });
        let (early, late): (Option<TileGradient<'a>>, _) = gradients.unzip();
        let part = |frames, losses, gradient| Self {
            given,
            frames,
            losses,
            gradient,
        };
        (part(rows.0, losses.0, early), part(rows.1, losses.1, late))
    }
}

/// What comes of a request, beside what it writes.
pub(crate) struct Outcome {
    /// The first frame whose loss is not finite.
    pub(crate) not_finite: Option<usize>,
    /// Derivatives by the shape, where wanted.
    pub(crate) shape: Option<ShapeSums>,
}

/// A loss on a chosen backend.
pub(crate) trait Engine: Send + Sync {
    /// Evaluates; with `shape`, a gradient must be asked for too.
    fn evaluate(&self, request: Request<'_>, shape: bool) -> Outcome;

    /// What it was built from.
    fn plan(&self) -> &Plan;
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

/// Most tiles that a thread takes in one go.
const TILES: usize = 8;

impl<S: Simd> Engine for Fused<S> {
    fn evaluate(&self, request: Request<'_>, shape: bool) -> Outcome {
        self.halves(request, 0, shape)
    }

    fn plan(&self) -> &Plan {
        &self.plan
    }
}

impl<S: Simd> Fused<S> {
    /// Halves a request until it is small. Where it is cut depends on the number of frames only, and
    /// sums are taken along the cuts: they are the same for any number of threads.
    fn halves(&self, request: Request<'_>, frame: usize, shape: bool) -> Outcome {
        let tiles = request.losses.len().div_ceil(S::COUNT);
        if tiles <= TILES {
            return self.tiles(request, frame, shape);
        }
        let cut = tiles / 2 * S::COUNT;
        let (early, late) = request.split_at(cut);
        let (mut early, late) = rayon::join(
            || self.halves(early, frame, shape),
            || self.halves(late, frame + cut, shape),
        );
        early.not_finite = early.not_finite.or(late.not_finite);
        if let (Some(sums), Some(later)) = (&mut early.shape, &late.shape) {
            sums.add(later);
        }
        early
    }

    fn tiles(&self, mut request: Request<'_>, first_frame: usize, shape: bool) -> Outcome {
        let mut workspace = self.workspace();
        let mut outcome = Outcome {
            not_finite: None,
            shape: shape.then(|| ShapeSums::new(self.plan.sphere_count())),
        };
        let mut frame = first_frame;
        while !request.losses.is_empty() {
            let frames = S::COUNT.min(request.losses.len());
            let (tile, rest) = request.split_at(frames);
            let bad = self.tile(&mut workspace, tile, outcome.shape.as_mut());
            let bad = bad.map(|lane| frame + lane);
            outcome.not_finite = outcome.not_finite.or(bad);
            frame += S::COUNT;
            request = rest;
        }
        if let Ok(mut idle) = self.idle.lock() {
            idle.push(workspace);
        }
        outcome
    }

    fn workspace(&self) -> Box<Workspace<S::Lanes>> {
        let idle = self.idle.lock().ok().and_then(|mut idle| idle.pop());
        idle.unwrap_or_else(|| Box::new(Workspace::new(self.simd, &self.plan)))
    }

    /// Returns the first frame whose loss is not finite.
    fn tile(
        &self,
        workspace: &mut Workspace<S::Lanes>,
        request: Request<'_>,
        shape: Option<&mut ShapeSums>,
    ) -> Option<usize> {
        if request.losses.len() < S::COUNT {
            return self.part_of_tile(workspace, request, shape);
        }
        match request.given {
            Given::Rotations => self.run(Rotations, workspace, request, shape),
            Given::Joints(swings) => self.run(Joints(swings), workspace, request, shape),
        }
    }

    fn run<I: Input>(
        &self,
        input: I,
        workspace: &mut Workspace<S::Lanes>,
        request: Request<'_>,
        shape: Option<&mut ShapeSums>,
    ) -> Option<usize> {
        let losses = request.losses;
        let finite = self.simd.run(Tile {
            input,
            plan: &self.plan,
            penalty: self.penalty,
            workspace,
            frames: request.frames,
            losses,
            gradient: request.gradient,
            shape,
        });
        if finite {
            return None;
        }
        losses.iter().position(|loss| !loss.is_finite())
    }

    /// Fills the tile up with its last frame, which then weighs nothing.
    fn part_of_tile(
        &self,
        workspace: &mut Workspace<S::Lanes>,
        request: Request<'_>,
        shape: Option<&mut ShapeSums>,
    ) -> Option<usize> {
        let (frames, numbers) = (request.losses.len(), request.given.numbers());
        let mut full = std::mem::take(&mut workspace.frames);
        let mut by_full = std::mem::take(&mut workspace.by_frames);
        let (given, last) = (request.frames.len(), request.frames.len() - numbers);
        full[..given].copy_from_slice(request.frames);
        for frame in full[given..S::COUNT * numbers].chunks_exact_mut(numbers) {
            frame.copy_from_slice(&request.frames[last..]);
        }
        let mut full_losses = [0.0; MOST_LANES];
        let mut full_weights = [0.0; MOST_LANES];
        if let Some(gradient) = &request.gradient {
            full_weights[..frames].copy_from_slice(gradient.weights);
        }
        let full_request = Request {
            given: request.given,
            frames: &full[..S::COUNT * numbers],
            losses: &mut full_losses[..S::COUNT],
            gradient: request.gradient.as_ref().map(|_| TileGradient {
                weights: &full_weights,
                by_frames: &mut by_full[..S::COUNT * numbers],
            }),
        };
        let not_finite = self.tile(workspace, full_request, shape);
        request.losses.copy_from_slice(&full_losses[..frames]);
        if let Some(gradient) = request.gradient {
            gradient.by_frames.copy_from_slice(&by_full[..given]);
        }
        workspace.frames = full;
        workspace.by_frames = by_full;
        not_finite
    }
}

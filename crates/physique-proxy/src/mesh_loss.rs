//! The mesh-based self-intersection loss, which the sphere loss stands in for.

mod skin;

use std::fmt;
use std::sync::Mutex;

use glam::DVec3;
use physique_body::{Body, Joint};
use physique_geometry::{ConicField, SharedVertices, TrianglePairs, Triangles};
use rayon::prelude::*;

use crate::self_intersection::{check_length, refuse};
use crate::{Error, PoseMatrices};
use skin::{Posed, Skin};

/// How the mesh loss is measured.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct MeshLossOptions {
    /// What a pair of intersecting triangles costs.
    pub field: ConicField,
    /// Triangles of body parts that are fewer steps apart in the tree of joints are not compared:
    /// skin folds there. 2 leaves out a part with itself and with its neighbours.
    pub least_tree_distance: u8,
}

impl Default for MeshLossOptions {
    fn default() -> Self {
        Self {
            field: ConicField::default(),
            least_tree_distance: 2,
        }
    }
}

/// The self-intersection loss of a body's skin: [conic distance fields](ConicField) over the pairs of
/// triangles that intersect, as SMPLify-X (Pavlakos et al., CVPR 2019) describes it, summed over pairs.
///
/// Pairs are found exactly, by trees of boxes that are refitted from pose to pose
/// ([`TrianglePairs`]); there is no limit to their number. The gradient is that of what is computed,
/// for the pairs that intersect: where a pair begins to, the loss jumps. The result is the same, to
/// the bit, for any number of threads.
///
/// Cost on a body of 13,776 triangles: about a millisecond a frame, some thousand times that of
/// [`SelfIntersection`](crate::SelfIntersection), and 2 MB a thread; `docs/proxy.md` compares.
pub struct MeshLoss {
    skin: Skin,
    triangles: Triangles,
    pairs: TrianglePairs,
    /// By triangle: the part it belongs to.
    parts: Vec<Joint>,
    options: MeshLossOptions,
    /// Workspaces between two uses: as many as threads ever worked at once.
    idle: Mutex<Vec<Workspace>>,
}

/// Scratch of one thread.
struct Workspace {
    pairs: TrianglePairs,
    posed: Posed,
    by_vertices: Vec<DVec3>,
    touched: Vec<u32>,
}

/// Frames that a thread takes in one go.
const FRAMES: usize = 8;

/// Gradients that are wanted, frame by frame.
type GradientChunk<'a> = Option<(&'a [f32], &'a mut [PoseMatrices])>;

impl MeshLoss {
    /// Prepares the loss of a body; some milliseconds.
    ///
    /// # Errors
    /// [`Error::Geometry`] for a mesh that is none.
    pub fn new(body: &Body, options: &MeshLossOptions) -> Result<Self, Error> {
        let model = body.model();
        let triangles = Triangles::new(model.vertex_count(), model.triangles())?;
        let rest = body.rest_vertices();
        Ok(Self {
            pairs: TrianglePairs::new(&triangles, rest, SharedVertices::Skip)?,
            skin: Skin::new(body),
            triangles,
            parts: model.triangle_parts().to_vec(),
            options: *options,
            idle: Mutex::default(),
        })
    }

    /// The loss of every frame, into `losses`.
    ///
    /// # Errors
    /// [`Error::Length`] unless there is one loss a frame; [`Error::NotFinite`] or
    /// [`Error::Overflow`] for rotations that are no numbers, or too large.
    pub fn losses(&self, poses: &[PoseMatrices], losses: &mut [f32]) -> Result<(), Error> {
        check_length("Losses", poses, losses.len())?;
        let chunks = poses.par_chunks(FRAMES).zip(losses.par_chunks_mut(FRAMES));
        let chunks = chunks.enumerate();
        let bad = chunks.filter_map(|(chunk, (poses, losses))| {
            let bad = self.chunk(poses, losses, None)?;
            Some(chunk * FRAMES + bad)
        });
        refuse(poses, bad.min())
    }

    /// The loss of every frame, and the gradient of `sum over frames of weight * loss` by the entries
    /// of the rotation matrices, as [`SelfIntersection::gradient`](crate::SelfIntersection::gradient).
    ///
    /// # Errors
    /// As [`MeshLoss::losses`].
    pub fn gradient(
        &self,
        poses: &[PoseMatrices],
        weights: &[f32],
        losses: &mut [f32],
        by_poses: &mut [PoseMatrices],
    ) -> Result<(), Error> {
        check_length("Losses", poses, losses.len())?;
        check_length("Weights", poses, weights.len())?;
        check_length("Gradient", poses, by_poses.len())?;
        let gradients = weights
            .par_chunks(FRAMES)
            .zip(by_poses.par_chunks_mut(FRAMES));
        let chunks = poses.par_chunks(FRAMES).zip(losses.par_chunks_mut(FRAMES));
        let chunks = chunks.zip(gradients).enumerate();
        let bad = chunks.filter_map(|(chunk, ((poses, losses), gradient))| {
            let bad = self.chunk(poses, losses, Some(gradient))?;
            Some(chunk * FRAMES + bad)
        });
        refuse(poses, bad.min())
    }

    /// Some frames, one after the other; the first that cannot be measured.
    fn chunk(
        &self,
        poses: &[PoseMatrices],
        losses: &mut [f32],
        mut gradient: GradientChunk<'_>,
    ) -> Option<usize> {
        let idle = self.idle.lock().ok().and_then(|mut idle| idle.pop());
        let mut work = idle.unwrap_or_else(|| self.workspace());
        let frames = poses.iter().zip(losses).enumerate();
        let mut bad = None;
        for (frame, (pose, loss)) in frames {
            let by_pose = gradient
                .as_mut()
                .map(|(weights, by_poses)| (weights[frame], &mut by_poses[frame]));
            match self.frame(&mut work, pose, by_pose) {
                Some(cost) => *loss = cost,
                None => bad = bad.or(Some(frame)),
            }
        }
        if let Ok(mut idle) = self.idle.lock() {
            idle.push(work);
        }
        bad
    }

    fn workspace(&self) -> Workspace {
        Workspace {
            pairs: self.pairs.clone(),
            posed: Posed::default(),
            by_vertices: vec![DVec3::ZERO; self.triangles.vertex_count()],
            touched: Vec::new(),
        }
    }

    /// The loss of one frame; `None` if it is no number.
    fn frame(
        &self,
        work: &mut Workspace,
        pose: &PoseMatrices,
        gradient: Option<(f32, &mut PoseMatrices)>,
    ) -> Option<f32> {
        self.skin.pose(pose, &mut work.posed);
        let vertices = &work.posed.vertices;
        let pairs = work.pairs.find(vertices).ok()?;
        let place = |vertex: u32| vertices[vertex as usize].as_dvec3();
        let mut cost = 0.0;
        for &(a, b) in pairs {
            let [a, b] = [a, b].map(|triangle| triangle as usize);
            if self.parts[a].tree_distance(self.parts[b]) < self.options.least_tree_distance {
                continue;
            }
            let [a, b] = [a, b].map(|triangle| self.triangles.corners()[triangle]);
            let (first, second) = (a.map(place), b.map(place));
            if gradient.is_none() {
                cost += self.options.field.pair_cost(first, second);
                continue;
            }
            let by = self.options.field.pair_gradient(first, second);
            cost += by.cost;
            for (vertex, by) in a
                .into_iter()
                .chain(b)
                .zip(by.first.into_iter().chain(by.second))
            {
                work.by_vertices[vertex as usize] += by;
                work.touched.push(vertex);
            }
        }
        if let Some((weight, by_pose)) = gradient {
            work.touched.sort_unstable();
            work.touched.dedup();
            let touched = work.touched.drain(..).map(|vertex| {
                let vertex = vertex as usize;
                let by = std::mem::take(&mut work.by_vertices[vertex]);
                (vertex, by * f64::from(weight))
            });
            *by_pose = self.skin.backward(pose, &work.posed, touched);
        }
        Some(cost as f32)
    }
}

impl fmt::Debug for MeshLoss {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        formatter
            .debug_struct("MeshLoss")
            .field("triangles", &self.triangles.len())
            .field("options", &self.options)
            .finish_non_exhaustive()
    }
}

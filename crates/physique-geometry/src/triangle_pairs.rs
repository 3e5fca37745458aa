//! Which triangles of a moving mesh intersect.

mod lanes;
mod leaf;
mod leaf_pairs;
mod separation;
mod tree;

use glam::Vec3;

use crate::{Error, Triangles};
use leaf::Leaf;
use leaf_pairs::LeafPair;
use tree::Tree;

/// What to do with triangles that share a vertex: they always touch there.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Default)]
pub enum SharedVertices {
    /// Leave such pairs out.
    #[default]
    Skip,
    /// Report such pairs if they meet anywhere beyond what they share: beyond the common corner, or,
    /// with a common edge, if one is folded flat onto the other. This is the rule of CGAL's
    /// `self_intersections`.
    Test,
}

/// Finds the intersecting pairs of triangles of a mesh, pose after pose.
///
/// A tree of boxes is built once, on a rest pose; for every pose its boxes are refitted, not rebuilt.
/// Pairs whose boxes overlap go through a rejection in single precision, whose error bound can only
/// keep a pair too many, and then through [an exact test](crate::exact::triangles_meet): triangles
/// are closed, touching counts, and the result is the same as that of testing all pairs exactly.
///
/// The surface need not be closed. The rest pose only shapes the tree: results do not depend on it.
///
/// Made once a mesh (and a thread); after the first poses it allocates nothing. A body of 13,776
/// triangles takes half a millisecond to two and a half with AVX-512, two to three times that without.
///
/// ```
/// use physique_geometry::{Mesh, SharedVertices, TrianglePairs, shapes};
///
/// let cube = shapes::cuboid([1.0, 1.0, 1.0].into());
/// let other = cube.clone().translated([0.3, 0.4, 0.5].into());
/// let both = Mesh::joined([&cube, &other])?;
/// let mut pairs = TrianglePairs::new(&both.triangles, &both.positions, SharedVertices::Skip)?;
/// let found = pairs.find(&both.positions)?;
/// assert!(found.iter().all(|&(a, b)| a < 12 && b >= 12));
/// assert!(!found.is_empty());
/// # Ok::<(), physique_geometry::Error>(())
/// ```
#[derive(Debug, Clone)]
pub struct TrianglePairs {
    triangles: Triangles,
    shared_vertices: SharedVertices,
    tree: Tree,
    leaves: Vec<Leaf>,
    pairs: Vec<(u32, u32)>,
}

impl TrianglePairs {
    /// Positions farther than this from the origin, in metres, are refused: the squares and cubes of
    /// larger ones overflow single precision.
    pub const FARTHEST: f32 = 1e9;

    /// Builds the tree. O(n log n) for n triangles.
    ///
    /// # Errors
    ///
    /// If there is not one finite position a vertex, or one is beyond [`TrianglePairs::FARTHEST`].
    pub fn new(
        triangles: &Triangles,
        rest_positions: &[Vec3],
        shared_vertices: SharedVertices,
    ) -> Result<Self, Error> {
        check(triangles, rest_positions)?;
        let (tree, order) = Tree::build(triangles, rest_positions);
        let leaves = Leaf::fill(triangles, &order);
        let triangles = triangles.clone();
        Ok(Self {
            triangles,
            shared_vertices,
            tree,
            leaves,
            pairs: Vec::new(),
        })
    }

    /// All intersecting pairs in this pose, each once with its lower triangle first, in ascending
    /// order. Valid until the next call.
    ///
    /// # Errors
    ///
    /// If there is not one finite position a vertex, or one is beyond [`TrianglePairs::FARTHEST`].
    pub fn find(&mut self, positions: &[Vec3]) -> Result<&[(u32, u32)], Error> {
        check(&self.triangles, positions)?;
        for leaf in &mut self.leaves {
            leaf.refit(positions);
        }
        self.tree.refit(&self.leaves);
        self.pairs.clear();
        let (leaves, shared_vertices, pairs) =
            (&self.leaves, self.shared_vertices, &mut self.pairs);
        self.tree
            .visit_overlapping_leaves(|first, second, box_of_second| {
                let same = first == second;
                let leaves = LeafPair {
                    first: &leaves[first],
                    second: &leaves[second],
                    same,
                    box_of_second,
                };
                leaf_pairs::find(leaves, shared_vertices, pairs);
            });
        self.pairs.sort_unstable();
        Ok(&self.pairs)
    }
}

fn check(triangles: &Triangles, positions: &[Vec3]) -> Result<(), Error> {
    let farthest = triangles.check_positions(positions)?;
    if farthest > TrianglePairs::FARTHEST {
        return Err(Error::TooFarForPairs {
            distance: farthest,
            limit: TrianglePairs::FARTHEST,
        });
    }
    Ok(())
}

//! The nodes of a document and how they stand at rest.

use glam::{Mat4, Quat, Vec3};

use super::Context;
use super::document::{Document, Node};
use crate::Error;

/// A rotation, a place and a scale, the same along all axes.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Placement {
    pub(super) rotation: Quat,
    pub(super) position: Vec3,
    pub(super) scale: f32,
}

impl Placement {
    const WORLD: Self = Self {
        rotation: Quat::IDENTITY,
        position: Vec3::ZERO,
        scale: 1.0,
    };

    /// What is placed so within this, placed in the world.
    pub(super) fn of(&self, inner: &Self) -> Self {
        Self {
            rotation: (self.rotation * inner.rotation).normalize(),
            position: self.position + self.rotation * (inner.position * self.scale),
            scale: self.scale * inner.scale,
        }
    }
}

/// The nodes of a document.
pub(super) struct Tree<'a> {
    nodes: &'a [Node],
    parents: Vec<Option<usize>>,
}

impl<'a> Tree<'a> {
    /// Finds every node's parent.
    pub(super) fn new(document: &'a Document<'_>, context: &Context<'_>) -> Result<Self, Error> {
        /// A scan of a city has fewer; a motion's figure has some hundred.
        const MOST_NODES: u64 = 1 << 20;
        let nodes = &document.nodes;
        context.check("the number of nodes", nodes.len() as u64, MOST_NODES)?;
        let mut parents = vec![None; nodes.len()];
        for (parent, node) in nodes.iter().enumerate() {
            for &child in &node.children {
                let place = format!("node {parent}");
                match parents.get_mut(child) {
                    Some(free @ None) => *free = Some(parent),
                    Some(Some(_)) => {
                        let found = format!("node {child} twice");
                        return Err(context.format(place, "children of one parent", found));
                    }
                    None => {
                        let found = format!("node {child}");
                        return Err(context.format(place, "children that exist", found));
                    }
                }
            }
        }
        Ok(Self { nodes, parents })
    }

    pub(super) fn node(&self, node: usize) -> &'a Node {
        &self.nodes[node]
    }

    pub(super) fn count(&self) -> usize {
        self.nodes.len()
    }

    pub(super) fn parent(&self, node: usize) -> Option<usize> {
        self.parents[node]
    }

    /// A node's name, or its number.
    pub(super) fn name(&self, node: usize) -> String {
        match self.nodes[node].name.as_deref() {
            None | Some("") => format!("node_{node}"),
            Some(name) => name.to_owned(),
        }
    }

    /// A node and all above it.
    ///
    /// # Errors
    /// [`Error::Limit`] when there are more than a hierarchy may be deep, as in a circle.
    pub(super) fn path_up(&self, node: usize, context: &Context<'_>) -> Result<Vec<usize>, Error> {
        let depth = context.options.limits.depth;
        let up = std::iter::successors(Some(node), |&at| self.parents[at]);
        let path: Vec<usize> = up.take(depth.saturating_add(1)).collect();
        context.check(
            "the depth of the hierarchy",
            path.len() as u64,
            depth as u64,
        )?;
        Ok(path)
    }

    /// How a node stands in its parent at rest.
    pub(super) fn local(&self, node: usize, context: &Context<'_>) -> Result<Placement, Error> {
        let stated = &self.nodes[node];
        let (scale, rotation, position) = match &stated.matrix {
            Some(matrix) => Mat4::from_cols_array(matrix).to_scale_rotation_translation(),
            None => (
                stated.scale.map_or(Vec3::ONE, Vec3::from_array),
                stated.rotation.map_or(Quat::IDENTITY, Quat::from_array),
                stated.translation.map_or(Vec3::ZERO, Vec3::from_array),
            ),
        };
        // Stretched nodes are taken for their mean: joints have no other.
        let mean = (scale.x * scale.y * scale.z).cbrt();
        let is_sound = rotation.length() > 1e-6
            && rotation.length() < 1e6
            && position.abs().max_element() < 1e12
            && scale.min_element() > 1e-9
            && scale.max_element() < 1e9;
        if !is_sound {
            let place = format!("node {node} ({})", self.name(node).escape_debug());
            let found = format!("scale {scale}, rotation {rotation}, translation {position}");
            return Err(context.format(place, "a pose of ordinary size, not mirrored", found));
        }
        Ok(Placement {
            rotation: rotation.normalize(),
            position,
            scale: mean,
        })
    }

    /// Whether a node's scale differs by axis.
    pub(super) fn is_stretched(&self, node: usize) -> bool {
        let scale = self.nodes[node].scale.map_or(Vec3::ONE, Vec3::from_array);
        scale.max_element() - scale.min_element() > 0.01 * scale.max_element().abs()
    }

    /// How a node stands in the world at rest.
    pub(super) fn world(&self, node: usize, context: &Context<'_>) -> Result<Placement, Error> {
        let mut world = Placement::WORLD;
        for node in self.path_up(node, context)?.into_iter().rev() {
            world = world.of(&self.local(node, context)?);
            if !(world.scale > 1e-9 && world.scale < 1e9) {
                let place = format!("node {node} ({})", self.name(node).escape_debug());
                let found = format!("{} with all above it", world.scale);
                return Err(context.format(place, "a scale of ordinary size", found));
            }
        }
        Ok(world)
    }

    /// How a node's parent stands in the world at rest.
    pub(super) fn base(&self, node: usize, context: &Context<'_>) -> Result<Placement, Error> {
        match self.parents[node] {
            Some(parent) => self.world(parent, context),
            None => Ok(Placement::WORLD),
        }
    }
}

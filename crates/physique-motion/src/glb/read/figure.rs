//! Which nodes of a document are the joints of the figure that an animation moves.

use std::collections::HashMap;
use std::rc::Rc;

use super::document::{Animation, Document, Property};
use super::rest::Figure;
use super::tree::Tree;
use super::{Accessors, Context};
use crate::Error;

/// The figures of a document, each built once.
pub(super) struct Figures<'a> {
    document: &'a Document<'a>,
    tree: Tree<'a>,
    /// By node: skins that it is a joint of.
    skins_of: Vec<Vec<usize>>,
    /// By node: whether any animation moves it.
    animated: Vec<bool>,
    built: HashMap<Option<usize>, Rc<Figure>>,
}

impl<'a> Figures<'a> {
    pub(super) fn new(document: &'a Document<'_>, context: &Context<'_>) -> Result<Self, Error> {
        /// Every mesh of a dressed character may have its own.
        const MOST_SKINS: u64 = 256;
        let tree = Tree::new(document, context)?;
        context.check(
            "the number of skins",
            document.skins.len() as u64,
            MOST_SKINS,
        )?;
        let mut skins_of = vec![Vec::new(); tree.count()];
        let joints: usize = document.skins.iter().map(|skin| skin.joints.len()).sum();
        let most = (context.options.limits.joints as u64).saturating_mul(16);
        context.check("the number of joints of all skins", joints as u64, most)?;
        for (index, skin) in document.skins.iter().enumerate() {
            for &joint in &skin.joints {
                match skins_of.get_mut(joint) {
                    Some(skins) => skins.push(index),
                    None => {
                        let found = format!("node {joint}");
                        let place = format!("skin {index}");
                        return Err(context.format(place, "joints that exist", found));
                    }
                }
            }
        }
        let mut animated = vec![false; tree.count()];
        for animation in &document.animations {
            for node in moved_nodes(animation) {
                if let Some(animated) = animated.get_mut(node) {
                    *animated = true;
                }
            }
        }
        Ok(Self {
            document,
            tree,
            skins_of,
            animated,
            built: HashMap::new(),
        })
    }

    /// The figure that most of an animation's tracks move.
    pub(super) fn of(
        &mut self,
        animation: &Animation,
        accessors: &mut Accessors<'_>,
        context: &Context<'_>,
    ) -> Result<Rc<Figure>, Error> {
        let mut votes = vec![0_usize; self.document.skins.len()];
        for node in moved_nodes(animation) {
            for &skin in self.skins_of.get(node).into_iter().flatten() {
                votes[skin] += 1;
            }
        }
        // The first of the largest, of those that most tracks move.
        let size = |skin: usize| self.document.skins[skin].joints.len();
        let best = (0..votes.len())
            .rev()
            .max_by_key(|&skin| (votes[skin], size(skin)));
        if let Some(figure) = self.built.get(&best) {
            return Ok(Rc::clone(figure));
        }
        let nodes = match best {
            Some(skin) => self.skinned_nodes(skin, context)?,
            None => self.animated_nodes(),
        };
        let nodes = self.up_to_the_moved(nodes, context)?;
        let figure = Figure::new(self.document, &self.tree, nodes, best, accessors, context)?;
        let figure = Rc::new(figure);
        self.built.insert(best, Rc::clone(&figure));
        Ok(figure)
    }

    /// Joints of a skin, and those of other skins above or below its topmost joints.
    fn skinned_nodes(&self, skin: usize, context: &Context<'_>) -> Result<Vec<bool>, Error> {
        let mut in_skin = vec![false; self.tree.count()];
        for &joint in &self.document.skins[skin].joints {
            in_skin[joint] = true;
        }
        let mut members = in_skin.clone();
        for (node, skins) in self.skins_of.iter().enumerate() {
            if skins.is_empty() || members[node] {
                continue;
            }
            let path = self.tree.path_up(node, context)?;
            members[node] = path.iter().any(|&above| in_skin[above]);
        }
        Ok(members)
    }

    /// Without skins: what is animated, and what hangs below it.
    fn animated_nodes(&self) -> Vec<bool> {
        let mut members = self.animated.clone();
        let mut next: Vec<usize> = (0..members.len()).filter(|&node| members[node]).collect();
        while let Some(node) = next.pop() {
            for &child in &self.tree.node(node).children {
                if !std::mem::replace(&mut members[child], true) {
                    next.push(child);
                }
            }
        }
        members
    }

    /// Members, and all nodes from them up to the topmost that is a member or animated: parents
    /// first.
    fn up_to_the_moved(
        &self,
        mut members: Vec<bool>,
        context: &Context<'_>,
    ) -> Result<Vec<usize>, Error> {
        let mut depths = HashMap::new();
        for node in 0..members.len() {
            if !members[node] {
                continue;
            }
            let path = self.tree.path_up(node, context)?;
            let top = path
                .iter()
                .rposition(|&at| members[at] || self.animated[at]);
            for (up, &at) in path.iter().enumerate().take(top.unwrap_or(0) + 1) {
                members[at] = true;
                depths.insert(at, path.len() - up);
            }
            let most = context.options.limits.joints as u64;
            context.check("the number of joints", depths.len() as u64, most)?;
        }
        let mut nodes: Vec<(usize, usize)> = depths
            .into_iter()
            .map(|(node, depth)| (depth, node))
            .collect();
        nodes.sort_unstable();
        Ok(nodes.into_iter().map(|(_, node)| node).collect())
    }
}

/// Nodes that an animation turns or moves.
fn moved_nodes(animation: &Animation) -> impl Iterator<Item = usize> {
    let channels = animation.channels.iter();
    channels.filter_map(|channel| match channel.target.path {
        Property::Rotation | Property::Translation => channel.target.node,
        Property::Scale | Property::Other => None,
    })
}

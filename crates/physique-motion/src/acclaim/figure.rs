//! A figure: the root and its bones, parents first.

use std::collections::HashMap;
use std::path::Path;

use glam::{DQuat, DVec3};

use super::channel::Channel;
use super::text::key;
use crate::limits::check;
use crate::{Error, Limits};

/// A figure at rest, in the file's unit.
pub(super) struct Figure {
    /// Factor of the length unit; 1 where the file states none.
    pub(super) length_factor: f64,
    pub(super) in_degrees: bool,
    /// The root first, then every bone after its parent.
    pub(super) bones: Vec<Bone>,
}

/// The root, or a bone.
#[derive(Clone, Default)]
pub(super) struct Bone {
    pub(super) name: String,
    pub(super) parent: Option<usize>,
    /// From the bone's start to its end, in the world's axes; for the root, its preset position.
    pub(super) reach: DVec3,
    /// The axes of its numbers in the world's; for the root, its preset orientation.
    pub(super) axes: DQuat,
    /// What its numbers mean, in their order.
    pub(super) channels: Vec<Channel>,
}

impl Figure {
    /// Of every bone, whether it has a tip instead of bones below it.
    pub(super) fn ends_chain(&self) -> Vec<bool> {
        let mut ends = vec![true; self.bones.len()];
        ends[0] = false;
        for parent in self.bones.iter().filter_map(|bone| bone.parent) {
            ends[parent] = false;
        }
        ends
    }

    /// Indices by [`key`] of their name.
    pub(super) fn by_name(&self) -> HashMap<String, usize> {
        let bones = self.bones.iter().enumerate();
        bones
            .map(|(index, bone)| (key(bone.name.as_bytes()), index))
            .collect()
    }
}

/// Puts every bone after its parent; `drafts` has the root first. `edges` are names of parents and
/// children, as [`key`].
///
/// # Errors
/// [`Error::Format`] unless all bones hang below the root, each on one parent; [`Error::Limit`].
pub(super) fn in_order(
    mut drafts: Vec<Bone>,
    edges: &[(String, String)],
    path: &Path,
    limits: &Limits,
) -> Result<Vec<Bone>, Error> {
    let error = |place: &str, expected: &str, found: String| Error::Format {
        path: path.into(),
        place: place.into(),
        expected: expected.into(),
        found,
    };
    let mut by_name = HashMap::new();
    for (index, bone) in drafts.iter().enumerate() {
        if by_name.insert(key(bone.name.as_bytes()), index).is_some() {
            let expected = "every bone once";
            return Err(error(":bonedata", expected, format!("{} twice", bone.name)));
        }
    }
    let mut children = vec![Vec::new(); drafts.len()];
    let mut has_parent = vec![false; drafts.len()];
    has_parent[0] = true;
    for (parent, child) in edges {
        let find = |name: &String| {
            by_name.get(name).copied().ok_or_else(|| {
                let name: String = name.chars().take(40).collect();
                error(
                    ":hierarchy",
                    "names of bones",
                    format!("\"{}\"", name.escape_debug()),
                )
            })
        };
        let (parent, child) = (find(parent)?, find(child)?);
        if std::mem::replace(&mut has_parent[child], true) {
            let found = format!("{} under a second parent", drafts[child].name);
            return Err(error(":hierarchy", "a tree of bones below the root", found));
        }
        children[parent].push(child);
    }

    let mut bones = Vec::with_capacity(drafts.len());
    let mut next = vec![(0, None, 1)];
    while let Some((draft, parent, depth)) = next.pop() {
        let what = "the depth of the hierarchy";
        check(path, what, depth, limits.depth as u64)?;
        let index = bones.len();
        bones.push(Bone {
            parent,
            ..std::mem::take(&mut drafts[draft])
        });
        let below = children[draft].iter().rev();
        next.extend(below.map(|&child| (child, Some(index), depth + 1)));
    }
    if bones.len() < drafts.len() {
        let found = format!("{} of them below it", bones.len() - 1);
        let expected = format!("all {} bones below the root", drafts.len() - 1);
        return Err(error(":hierarchy", &expected, found));
    }
    Ok(bones)
}

//! How a skin's joints stood when its mesh was bound to them.

use glam::{Mat4, Vec3};

use super::document::Document;
use super::tree::Tree;
use super::{Accessors, Context};
use crate::{Error, SkeletonPose};

/// How a skin's joints stood when the mesh was bound to them: once taking the mesh for placed in
/// the world as it is, once by the node that shows it. Exporters do either; a uniform scale that
/// tells both from the nodes' own bones is undone.
pub(super) fn bind_poses(
    document: &Document<'_>,
    tree: &Tree<'_>,
    nodes: &[usize],
    skin: usize,
    own: &SkeletonPose,
    accessors: &mut Accessors<'_>,
    context: &Context<'_>,
) -> Result<Vec<SkeletonPose>, Error> {
    let stated = &document.skins[skin];
    let Some(accessor) = stated.inverse_bind_matrices else {
        return Ok(Vec::new());
    };
    let matrices = accessors.numbers(accessor, "MAT4", context)?;
    if matrices.len() / 16 < stated.joints.len() {
        let expected = format!("{} matrices", stated.joints.len());
        let found = (matrices.len() / 16).to_string();
        return Err(context.format(format!("skin {skin}"), expected, found));
    }
    let shown_by = (0..tree.count()).find(|&node| tree.node(node).skin == Some(skin));
    let mut frames = vec![Mat4::IDENTITY];
    if let Some(node) = shown_by {
        let world = tree.world(node, context)?;
        frames.push(Mat4::from_scale_rotation_translation(
            Vec3::splat(world.scale),
            world.rotation,
            world.position,
        ));
    }
    let poses = frames.iter().filter_map(|world_from_mesh| {
        let mut pose = own.clone();
        let mut bound = vec![false; nodes.len()];
        for (joint, matrix) in stated.joints.iter().zip(matrices.chunks_exact(16)) {
            let world = *world_from_mesh * Mat4::from_cols_slice(matrix).inverse();
            let (scale, rotation, position) = world.to_scale_rotation_translation();
            let is_sound = rotation.is_finite()
                && rotation.length() > 0.5
                && position.abs().max_element() < 1e12
                && scale.min_element() > 0.0;
            let index = nodes.iter().position(|node| node == joint)?;
            if !is_sound {
                return None;
            }
            bound[index] = true;
            pose.rotations[index] = rotation.normalize();
            pose.positions[index] = position;
        }
        follow(tree, nodes, &bound, own, &mut pose);
        undo_scale(tree, nodes, &bound, own, &mut pose)?;
        Some(pose)
    });
    Ok(poses.collect())
}

/// Joints of no matrix follow their parents as they do at rest.
fn follow(
    tree: &Tree<'_>,
    nodes: &[usize],
    bound: &[bool],
    own: &SkeletonPose,
    pose: &mut SkeletonPose,
) {
    for index in 0..nodes.len() {
        let parent = tree.parent(nodes[index]);
        let parent = parent.and_then(|parent| nodes.iter().position(|&node| node == parent));
        if let (false, Some(parent)) = (bound[index], parent) {
            let moved = pose.rotations[parent] * own.rotations[parent].inverse();
            pose.rotations[index] = (moved * own.rotations[index]).normalize();
            let offset = own.positions[index] - own.positions[parent];
            pose.positions[index] = pose.positions[parent] + moved * offset;
        }
    }
}

/// Makes bound bones as long in all as the nodes' own; `None` where they have no length.
fn undo_scale(
    tree: &Tree<'_>,
    nodes: &[usize],
    bound: &[bool],
    own: &SkeletonPose,
    pose: &mut SkeletonPose,
) -> Option<()> {
    let (mut stated, mut shown) = (0.0, 0.0);
    for index in 0..nodes.len() {
        let parent = tree.parent(nodes[index]);
        let parent = parent.and_then(|parent| nodes.iter().position(|&node| node == parent));
        if let Some(parent) = parent.filter(|&parent| bound[parent] && bound[index]) {
            stated += pose.positions[index].distance(pose.positions[parent]);
            shown += own.positions[index].distance(own.positions[parent]);
        }
    }
    let scale = shown / stated;
    if !(scale.is_finite() && scale > 0.0) {
        return None;
    }
    if (scale - 1.0).abs() > 0.01 {
        for position in &mut pose.positions {
            *position *= scale;
        }
    }
    Some(())
}

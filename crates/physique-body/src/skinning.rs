//! Linear blend skinning: a vertex moves by the weighted mean of its joints' transforms.
//!
//! The sum runs over the few joints that really move a vertex, not over all of them as the usual
//! dense formulation does. Vertices are visited by the joints they follow, so that the transforms
//! stay in registers, the many rigid vertices pay for one only, and no loop has a branch. Four-lane
//! vectors of glam fit the four columns of a transform on every processor; no fused multiply-add is
//! used, so all of them give the same bits.

use glam::{Affine3A, Vec3, Vec3A, Vec4};

use crate::BlendWeights;

/// `world_from_rest` of one joint, as padded columns.
#[derive(Clone, Copy, Debug)]
#[repr(align(64))]
pub(crate) struct SkinningTransform {
    columns: [Vec4; 4],
}

impl SkinningTransform {
    /// Moves a vertex from the rest pose with its joint.
    pub(crate) fn new(world_from_joint: &Affine3A, rest_joint: Vec3) -> Self {
        let rotation = world_from_joint.matrix3;
        let translation = world_from_joint.translation - rotation * Vec3A::from(rest_joint);
        let axes = [rotation.x_axis, rotation.y_axis, rotation.z_axis];
        let [x, y, z] = axes.map(|axis| axis.extend(0.0));
        Self {
            columns: [x, y, z, translation.extend(0.0)],
        }
    }

    #[inline]
    fn apply(&self, rest: Vec3) -> Vec4 {
        let [x, y, z, translation] = self.columns;
        x * rest.x + y * rest.y + z * rest.z + translation
    }
}

/// The blend weights of a model, laid out for skinning.
#[derive(Clone, Debug, Default)]
pub(crate) struct SkinningPlan {
    one: Vec<Block<1>>,
    two: Vec<Block<2>>,
    three: Vec<Block<3>>,
    four: Vec<Block<4>>,
    /// Vertices of more influences, which no published body has.
    more: Vec<(u32, Vec<(usize, f32)>)>,
}

/// Vertices that follow the same joints.
#[derive(Clone, Debug)]
struct Block<const INFLUENCES: usize> {
    joints: [usize; INFLUENCES],
    vertices: Vec<(u32, [f32; INFLUENCES])>,
}

impl SkinningPlan {
    pub(crate) fn new(blend_weights: &BlendWeights) -> Self {
        let mut rows: Vec<_> = (0..blend_weights.vertex_count())
            .map(|vertex| {
                let row = blend_weights.row(vertex);
                let mut row: Vec<_> = row.filter(|&(_, weight)| weight > 0.0).collect();
                row.sort_by_key(|&(joint, _)| joint);
                (vertex as u32, row)
            })
            .collect();
        // Stable: vertices of the same joints stay in order, so that memory is walked forwards.
        rows.sort_by_cached_key(|(_, row)| row.iter().map(|&(joint, _)| joint).collect::<Vec<_>>());
        let mut plan = Self::default();
        for (vertex, row) in rows {
            match *row {
                [a] => add(&mut plan.one, vertex, [a]),
                [a, b] => add(&mut plan.two, vertex, [a, b]),
                [a, b, c] => add(&mut plan.three, vertex, [a, b, c]),
                [a, b, c, d] => add(&mut plan.four, vertex, [a, b, c, d]),
                _ => plan.more.push((vertex, row)),
            }
        }
        plan
    }

    /// Skins all vertices; `rest_vertices` and `positions` must have one entry a vertex.
    pub(crate) fn skin(
        &self,
        rest_vertices: &[Vec3],
        transforms: &[SkinningTransform],
        positions: &mut [Vec3],
    ) {
        skin_blocks(&self.one, rest_vertices, transforms, positions);
        skin_blocks(&self.two, rest_vertices, transforms, positions);
        skin_blocks(&self.three, rest_vertices, transforms, positions);
        skin_blocks(&self.four, rest_vertices, transforms, positions);
        for (vertex, row) in &self.more {
            let vertex = *vertex as usize;
            let mut moved = Vec4::ZERO;
            for &(joint, weight) in row {
                moved += transforms[joint].apply(rest_vertices[vertex]) * weight;
            }
            positions[vertex] = moved.truncate();
        }
    }
}

/// Adds a vertex to the last block if that has the same joints, else to a new one.
fn add<const INFLUENCES: usize>(
    blocks: &mut Vec<Block<INFLUENCES>>,
    vertex: u32,
    row: [(usize, f32); INFLUENCES],
) {
    let joints = row.map(|(joint, _)| joint);
    let vertex = (vertex, row.map(|(_, weight)| weight));
    match blocks.last_mut() {
        Some(block) if block.joints == joints => block.vertices.push(vertex),
        _ => blocks.push(Block {
            joints,
            vertices: vec![vertex],
        }),
    }
}

fn skin_blocks<const INFLUENCES: usize>(
    blocks: &[Block<INFLUENCES>],
    rest_vertices: &[Vec3],
    transforms: &[SkinningTransform],
    positions: &mut [Vec3],
) {
    for block in blocks {
        let transforms = block.joints.map(|joint| transforms[joint]);
        for (vertex, weights) in &block.vertices {
            let vertex = *vertex as usize;
            let rest = rest_vertices[vertex];
            let mut moved = transforms[0].apply(rest);
            if INFLUENCES > 1 {
                moved *= weights[0];
            }
            for influence in 1..INFLUENCES {
                moved += transforms[influence].apply(rest) * weights[influence];
            }
            positions[vertex] = moved.truncate();
        }
    }
}

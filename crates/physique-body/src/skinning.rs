//! Linear blend skinning: a vertex moves by the weighted mean of its joints' transforms.
//!
//! The sum runs over the few joints that really move a vertex, not over all of them as the usual
//! dense formulation does. Vertices are visited by number of influences, so that the many rigid
//! ones pay for one transform only and no loop has a branch. Four-lane vectors of glam fit the
//! four columns of a transform on every processor; no fused multiply-add is used, so all of them
//! give the same bits.

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
#[derive(Clone, Debug)]
pub(crate) struct SkinningPlan {
    one: Group<1>,
    two: Group<2>,
    three: Group<3>,
    four: Group<4>,
    /// Vertices of more influences, which no published body has.
    more: Vec<(u32, Vec<(u8, f32)>)>,
}

impl SkinningPlan {
    pub(crate) fn new(blend_weights: &BlendWeights) -> Self {
        let mut plan = Self {
            one: Group::default(),
            two: Group::default(),
            three: Group::default(),
            four: Group::default(),
            more: Vec::new(),
        };
        for vertex in 0..blend_weights.vertex_count() {
            let row: Vec<_> = blend_weights
                .row(vertex)
                .filter(|&(_, weight)| weight > 0.0)
                .map(|(joint, weight)| (joint as u8, weight))
                .collect();
            let index = vertex as u32;
            match *row {
                [a] => plan.one.push(index, [a]),
                [a, b] => plan.two.push(index, [a, b]),
                [a, b, c] => plan.three.push(index, [a, b, c]),
                [a, b, c, d] => plan.four.push(index, [a, b, c, d]),
                _ => plan.more.push((index, row)),
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
        skin_group(&self.one, rest_vertices, transforms, positions);
        skin_group(&self.two, rest_vertices, transforms, positions);
        skin_group(&self.three, rest_vertices, transforms, positions);
        skin_group(&self.four, rest_vertices, transforms, positions);
        for (vertex, row) in &self.more {
            let vertex = *vertex as usize;
            let mut moved = Vec4::ZERO;
            for &(joint, weight) in row {
                let transform = &transforms[usize::from(joint)];
                moved += transform.apply(rest_vertices[vertex]) * weight;
            }
            positions[vertex] = moved.truncate();
        }
    }
}

/// Vertices that the same number of joints moves.
#[derive(Clone, Debug)]
struct Group<const INFLUENCES: usize> {
    vertices: Vec<u32>,
    joints: Vec<[u8; INFLUENCES]>,
    weights: Vec<[f32; INFLUENCES]>,
}

impl<const INFLUENCES: usize> Default for Group<INFLUENCES> {
    fn default() -> Self {
        Self {
            vertices: Vec::new(),
            joints: Vec::new(),
            weights: Vec::new(),
        }
    }
}

impl<const INFLUENCES: usize> Group<INFLUENCES> {
    fn push(&mut self, vertex: u32, row: [(u8, f32); INFLUENCES]) {
        self.vertices.push(vertex);
        self.joints.push(row.map(|(joint, _)| joint));
        self.weights.push(row.map(|(_, weight)| weight));
    }
}

fn skin_group<const INFLUENCES: usize>(
    group: &Group<INFLUENCES>,
    rest_vertices: &[Vec3],
    transforms: &[SkinningTransform],
    positions: &mut [Vec3],
) {
    let rows = group.joints.iter().zip(&group.weights);
    for (&vertex, (joints, weights)) in group.vertices.iter().zip(rows) {
        let vertex = vertex as usize;
        let rest = rest_vertices[vertex];
        let mut moved = transforms[usize::from(joints[0])].apply(rest);
        if INFLUENCES > 1 {
            moved *= weights[0];
        }
        for influence in 1..INFLUENCES {
            let transform = &transforms[usize::from(joints[influence])];
            moved += transform.apply(rest) * weights[influence];
        }
        positions[vertex] = moved.truncate();
    }
}

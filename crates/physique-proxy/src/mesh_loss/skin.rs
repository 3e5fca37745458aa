//! A body's skin as it follows rotation matrices, and the way back.

use glam::{DMat3, DVec3, Vec3};
use physique_body::{Body, Joint};

use crate::PoseMatrices;
use crate::chain::{self, ByChain, Chain};
use crate::fit::vertex_rows;

/// Linear blend skinning of all vertices to the 22 joints.
pub(super) struct Skin {
    rest_joints: [Vec3; Joint::COUNT],
    vertices: Vec<Vec3>,
    /// Where the influences of each vertex end.
    ends: Vec<u32>,
    influences: Vec<Influence>,
}

#[derive(Clone, Copy)]
struct Influence {
    joint: u8,
    weight: f32,
}

/// A skin in one pose.
#[derive(Default)]
pub(super) struct Posed {
    pub(super) vertices: Vec<Vec3>,
    world: Option<Chain>,
}

impl Skin {
    pub(super) fn new(body: &Body) -> Self {
        let (mut ends, mut influences) = (Vec::new(), Vec::new());
        for row in vertex_rows(body.model()) {
            let joints = row.into_iter().zip(0_u8..);
            let moving = joints.filter(|(weight, _)| *weight != 0.0);
            influences.extend(moving.map(|(weight, joint)| Influence { joint, weight }));
            ends.push(influences.len() as u32);
        }
        Self {
            rest_joints: Joint::ALL.map(|joint| body.rest_joint(joint)),
            vertices: body.rest_vertices().to_vec(),
            ends,
            influences,
        }
    }

    /// Every vertex with its influences.
    fn rows(&self) -> impl Iterator<Item = (Vec3, &[Influence])> {
        let starts = std::iter::once(&0).chain(&self.ends);
        let ranges = starts.zip(&self.ends);
        let rows = ranges.map(|(&start, &end)| &self.influences[start as usize..end as usize]);
        self.vertices.iter().copied().zip(rows)
    }

    /// Poses the skin about the rest body's root.
    pub(super) fn pose(&self, rotations: &PoseMatrices, posed: &mut Posed) {
        let world = chain::world_from_joint(&self.rest_joints, rotations);
        let mut from_rest = world;
        for ((rotation, position), &rest) in from_rest.iter_mut().zip(&self.rest_joints) {
            *position -= *rotation * rest;
        }
        posed.vertices.clear();
        posed.vertices.extend(self.rows().map(|(rest, row)| {
            let moved = row.iter().map(|&Influence { joint, weight }| {
                let (rotation, translation) = from_rest[usize::from(joint)];
                (rotation * rest + translation) * weight
            });
            moved.sum::<Vec3>()
        }));
        posed.world = Some(world);
    }

    /// From derivatives by some posed vertices to those by the rotations.
    pub(super) fn backward(
        &self,
        rotations: &PoseMatrices,
        posed: &Posed,
        by_vertices: impl Iterator<Item = (usize, DVec3)>,
    ) -> PoseMatrices {
        let Some(world) = &posed.world else {
            return [[0.0; 9]; Joint::COUNT];
        };
        let mut by_world: ByChain = [(DMat3::ZERO, DVec3::ZERO); Joint::COUNT];
        for (vertex, by_vertex) in by_vertices {
            let start = vertex.checked_sub(1).map_or(0, |before| self.ends[before]);
            let row = start as usize..self.ends[vertex] as usize;
            for &Influence { joint, weight } in &self.influences[row] {
                let joint = usize::from(joint);
                let weighted = by_vertex * f64::from(weight);
                let from_joint = self.vertices[vertex] - self.rest_joints[joint];
                by_world[joint].0 += chain::outer(weighted, from_joint.as_dvec3());
                by_world[joint].1 += weighted;
            }
        }
        let by_local = chain::backward(&self.rest_joints, rotations, world, &mut by_world);
        by_local.map(|by| by.transpose().to_cols_array().map(|number| number as f32))
    }
}

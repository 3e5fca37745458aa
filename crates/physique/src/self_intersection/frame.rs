//! Self-intersection of one frame.

use glam::{Quat, Vec3};
use physique_body::{Body, Joint, Pose, PosedBody};
use physique_geometry::{ColumnScanner, LabelDistances, ScanOptions, TriangleLabels, Triangles};

use super::is_crease;
use crate::Error;

/// Cubic centimetres in a cubic metre.
const CM3: f64 = 1e6;

/// What all frames of a body share: its surface, with a body part a triangle.
#[derive(Clone, Debug)]
pub(crate) struct Surface {
    pub(crate) triangles: Triangles,
    labels: TriangleLabels,
}

impl Surface {
    pub(crate) fn new(body: &Body) -> Result<Self, Error> {
        let model = body.model();
        let triangles = Triangles::new(model.vertex_count(), model.triangles())?;
        let distances: Vec<u8> = Joint::ALL
            .iter()
            .flat_map(|a| Joint::ALL.map(|b| a.tree_distance(b)))
            .collect();
        let parts: Vec<u8> = model
            .triangle_parts()
            .iter()
            .map(|&part| part as u8)
            .collect();
        let labels = TriangleLabels::new(&triangles, &parts, LabelDistances::new(&distances)?)?;
        Ok(Self { triangles, labels })
    }
}

/// Overlap of two body parts in one frame.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PairVolume {
    /// The two parts, in [`Joint`]'s order.
    pub parts: [Joint; 2],
    /// Whether the volume is a crease, not an intersection.
    pub crease: bool,
    /// Volume in cm3.
    pub cm3: f64,
}

/// Self-intersection of one frame.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct FrameIntersections {
    /// Volume of parts inside other parts, in cm3.
    pub intersection_cm3: f64,
    /// Volume of skin folds between neighbours, in cm3.
    pub crease_cm3: f64,
    /// Both by pair of parts.
    pub pairs: Vec<PairVolume>,
}

/// Measures frame after frame; one a thread.
pub(crate) struct FrameMeter<'a> {
    body: &'a Body,
    surface: &'a Surface,
    stature: f32,
    posed: PosedBody,
    scanner: ColumnScanner,
    rotations: Vec<Quat>,
    /// By pair of parts: intersection and crease, in m3.
    volumes: Vec<[f64; 2]>,
}

impl<'a> FrameMeter<'a> {
    pub(crate) fn new(
        body: &'a Body,
        surface: &'a Surface,
        options: ScanOptions,
    ) -> Result<Self, Error> {
        Ok(Self {
            body,
            surface,
            stature: body.stature() as f32,
            posed: body.posed(),
            scanner: ColumnScanner::new(&surface.triangles, options)?,
            rotations: Vec::with_capacity(Joint::COUNT),
            volumes: vec![[0.0; 2]; Joint::COUNT * Joint::COUNT],
        })
    }

    /// Self-intersection of the pose with these 22 local rotations; the root's does not matter.
    pub(crate) fn measure(&mut self, rotations: &[Quat]) -> Result<FrameIntersections, Error> {
        self.rotations.clear();
        self.rotations.extend_from_slice(rotations);
        if let Some(root) = self.rotations.first_mut() {
            *root = Quat::IDENTITY;
        }
        let pose = Pose {
            root_translation: Vec3::ZERO,
            rotations: &self.rotations,
        };
        self.body.pose(&pose, &mut self.posed)?;

        let Self {
            posed,
            volumes,
            stature,
            ..
        } = self;
        volumes.fill([0.0; 2]);
        let mut scan = self.scanner.scan(posed.vertices())?;
        scan.visit_overlaps(&self.surface.labels, |overlap| {
            let [low, high] = overlap.labels().map(usize::from);
            let (a, b) = (Joint::ALL[low], Joint::ALL[high]);
            let joint_position = |joint| posed.joint(joint);
            let crease = is_crease(a, b, overlap.middle(), *stature, joint_position);
            volumes[low * Joint::COUNT + high][usize::from(crease)] += overlap.volume;
        })?;
        Ok(self.collect())
    }

    fn collect(&self) -> FrameIntersections {
        let mut frame = FrameIntersections::default();
        for (index, kinds) in self.volumes.iter().enumerate() {
            for (crease, volume) in [false, true].into_iter().zip(kinds) {
                if *volume > 0.0 {
                    let cm3 = volume * CM3;
                    let parts = [index / Joint::COUNT, index % Joint::COUNT];
                    frame.pairs.push(PairVolume {
                        parts: parts.map(|part| Joint::ALL[part]),
                        crease,
                        cm3,
                    });
                    if crease {
                        frame.crease_cm3 += cm3;
                    } else {
                        frame.intersection_cm3 += cm3;
                    }
                }
            }
        }
        frame
    }
}

//! Skinned, animated figures as glTF 2.0: out as one binary file (`.glb`) for Blender, Unreal,
//! Unity, three.js and the viewers of phones and browsers; in from `.glb` and `.gltf`.
//!
//! # Out
//!
//! The file holds the body's rest mesh with normals, a skin of its joints (the rest pose is the
//! bind pose), and one animation: a rotation track for each of the 22 joints and a translation
//! track for the pelvis, keyed at every frame, interpolated linearly. Metres, Y up, facing +Z, as
//! glTF wants it. Nothing is referred to outside the file. Frame `f` stands at `f / frame rate`
//! seconds. Pose-dependent corrections of a body model, which glTF's skins cannot express, are
//! left out: the figure is what linear blend skinning gives.
//!
//! # In
//!
//! Every animation of a file is a motion of the figure that it moves.
//!
//! | question | rule |
//! |---|---|
//! | joints | The joints of the skin that most tracks move, and of other skins on the same figure; without skins, the animated nodes and all below them. Nodes above that stand still are folded into the root. |
//! | rest pose | The skin's inverse bind matrices; the nodes' own pose where they are missing or where the figure would not stand upright, with a note. |
//! | frame rate | Where the fullest track has keys at an even step: that step. Otherwise its smallest step, at most 240 a second; 30 where keys are farther than 0.1 s apart. A note says which. |
//! | between keys | `LINEAR` (the short way), `STEP` and `CUBICSPLINE`, as the standard defines them. |
//! | scale | Scales of nodes multiply bone lengths (armatures of 0.01, as Blender exports them); animated scales are left out, with a note. |
//! | unit | Metres, as the standard says; where only centimetres, millimetres or inches make a human, those, with a note. |
//! | buffers | In the file, in base64, or in files in the same folder or below it; nothing else is opened. |
//!
//! Specification: <https://registry.khronos.org/glTF/specs/2.0/glTF-2.0.html>.

mod animation;
mod buffer;
mod container;
mod figure;
mod read;

use std::path::Path;

use glam::Vec3;
use physique_body::{Body, Joint};

use crate::write_file::write_file;
use crate::{Error, Motion};

pub(crate) use read::parts;
pub use read::{parse, read};

/// A mesh at rest and what binds it to its joints; the first 22 joints are [`Joint`]'s.
#[derive(Clone, Copy, Debug)]
pub struct SkinnedMesh<'a> {
    /// `[vertices]` rest positions, in metres.
    pub positions: &'a [Vec3],
    /// Corners by vertex, counter-clockwise seen from outside.
    pub triangles: &'a [[u32; 3]],
    /// `[joints]` rest positions, in metres.
    pub rest_joints: &'a [Vec3],
    /// `[joints]` parents, each before its children; `None` for the root.
    pub parents: &'a [Option<usize>],
    /// Joints that each vertex may follow.
    pub influences: usize,
    /// `[vertices][influences]` joints.
    pub blend_joints: &'a [u8],
    /// `[vertices][influences]` weights, at least 0. glTF's players know four a vertex: the four
    /// largest are kept and made to sum to 1.
    pub blend_weights: &'a [f32],
}

impl<'a> SkinnedMesh<'a> {
    /// The mesh of a body, in its shape.
    pub fn of(body: &'a Body) -> Self {
        let model = body.model();
        Self {
            positions: body.rest_vertices(),
            triangles: model.triangles(),
            rest_joints: body.rest_joints(),
            parents: model.parents(),
            influences: model.blend_weights().influences(),
            blend_joints: model.blend_weights().joints(),
            blend_weights: model.blend_weights().weights(),
        }
    }

    /// What does not fit together, if anything.
    fn problem(&self) -> Option<String> {
        let (vertices, joints) = (self.positions.len(), self.rest_joints.len());
        let bindings = vertices.checked_mul(self.influences);
        if vertices == 0 || self.triangles.is_empty() || self.influences == 0 {
            return Some("the mesh is empty or bound to nothing".into());
        }
        if !(Joint::COUNT..=256).contains(&joints) || self.parents.len() != joints {
            let parents = self.parents.len();
            return Some(format!(
                "22 to 256 joints with as many parents are needed, not {joints} and {parents}"
            ));
        }
        if bindings != Some(self.blend_joints.len()) || bindings != Some(self.blend_weights.len()) {
            return Some(format!(
                "{vertices} vertices need {} weights each",
                self.influences
            ));
        }
        let in_range = |&index: &u32| (index as usize) < vertices;
        if !self.triangles.iter().flatten().all(in_range) {
            return Some("a triangle names a vertex that does not exist".into());
        }
        if !self
            .blend_joints
            .iter()
            .all(|&joint| usize::from(joint) < joints)
        {
            return Some("a vertex follows a joint that does not exist".into());
        }
        let roots = self
            .parents
            .iter()
            .filter(|parent| parent.is_none())
            .count();
        let ordered = self.parents.iter().enumerate();
        let mut ordered = ordered.map(|(joint, parent)| parent.is_none_or(|parent| parent < joint));
        if roots != 1 || !ordered.all(|ordered| ordered) {
            return Some("the joints are no tree with parents before children".into());
        }
        let finite = |points: &[Vec3]| points.iter().all(|point| point.is_finite());
        let weights_sound = self
            .blend_weights
            .iter()
            .all(|weight| weight.is_finite() && *weight >= 0.0);
        let sums = self.blend_weights.chunks_exact(self.influences);
        let mut sums = sums.map(|row| row.iter().sum::<f32>());
        if !(finite(self.positions)
            && finite(self.rest_joints)
            && weights_sound
            && sums.all(|sum| sum > 0.1))
        {
            return Some(
                "positions or weights are not finite, or weights are negative or all zero".into(),
            );
        }
        None
    }
}

/// Writes a figure and its motion, beside the file first, then renamed; named after the file.
///
/// # Errors
/// [`Error::Io`], and those of [`to_glb`].
pub fn write(path: impl AsRef<Path>, mesh: &SkinnedMesh<'_>, motion: &Motion) -> Result<(), Error> {
    let path = path.as_ref();
    write_file(path, &to_glb(mesh, motion, &crate::read::stem(path))?)
}

/// The bytes of a `.glb` with a figure and its motion, under a name.
///
/// # Errors
/// [`Error::NoFrames`]; [`Error::Unwritable`] for a mesh whose arrays do not fit together, frames
/// too short to tell apart in glTF's 32-bit seconds, and more than glTF's 4 GiB.
pub fn to_glb(mesh: &SkinnedMesh<'_>, motion: &Motion, name: &str) -> Result<Vec<u8>, Error> {
    let unwritable = |reason: String| Error::Unwritable {
        format: "glTF",
        reason,
    };
    if motion.frame_count() == 0 {
        return Err(Error::NoFrames);
    }
    if let Some(problem) = mesh.problem() {
        return Err(unwritable(problem));
    }
    let mut buffer = buffer::Buffer::new();
    let joints = figure::add(&mut buffer, mesh, name);
    animation::add(&mut buffer, mesh, motion, &joints, name).map_err(unwritable)?;
    container::pack(buffer).map_err(unwritable)
}

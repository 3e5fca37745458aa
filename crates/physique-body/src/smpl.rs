//! SMPL, SMPL-H and SMPL-X body files: `.npz` and `.pkl` in every layout that is in use.
//!
//! | array | shape | meaning |
//! |---|---|---|
//! | `v_template` | V, 3 | mean shape, metres |
//! | `shapedirs` | V, 3, B | metres a unit of each beta; of SMPL-X's 400 (or 20) the first 300 (10) are shape, the others expression and left out |
//! | `posedirs` | V, 3, 9 (J - 1) | metres a unit of `R - I`, row-major; may be missing |
//! | `J_regressor` | J, V | joints from vertices, dense or SciPy's sparse `csc` or `csr` |
//! | `weights` | V, J | blend weights |
//! | `kintree_table` | 2, J | parents, and the joints' numbers; the root's parent is -1 or 2^32 - 1 |
//! | `f` | F, 3 | triangles |
//!
//! Element types and memory orders are free. In pickles, arrays may be chumpy's `Ch` or `Select`;
//! they are unfolded as data, see [`physique_files::pickle`]. All other arrays (hands' components,
//! landmarks, texture coordinates) are passed over unread.
//!
//! **Closed or not.** Volume, mass and scores of self-intersection ask for one closed surface. A
//! file's mesh is read as it is; [`BodyModel::surface`] tells how many edges are open and how
//! many parts there are. Scores refuse open meshes and take several parts. SMPL-X carries eyeballs within the head: a score counts what they cover
//! as the head within itself, in every frame. Compare such a body with its own rest pose.
//!
//! Source: Loper et al., "SMPL: A Skinned Multi-Person Linear Model", 2015, and the layouts of the
//! public loaders.

mod arrays;
mod joint_set;
mod regressor;
mod source;

pub use joint_set::JointSet;
pub(crate) use source::Source;

use std::path::Path;

use glam::Vec3;

use crate::model::BodyArrays;
use crate::{BodyModel, Error, JointRegressor};
use arrays::SmplArrays;

/// Joints of SMPL-X: its shape directions end with those of facial expression.
const SMPL_X_JOINTS: usize = 55;

/// Makes the model of a file; `name` is used in errors, and without folder and ending in reports.
pub(crate) fn read(name: &str, source: Source, joints: JointSet) -> Result<BodyModel, Error> {
    let arrays = SmplArrays::read(name, source)?;
    let file_joints = arrays.parents.len();
    let kept = joints.kept(file_joints);
    let pose_directions = match arrays.pose_directions {
        Some(directions) => {
            // Folded joints stay at rest, where their features are zero.
            let features = 9 * (kept - 1);
            by_last_index(&directions.values, directions.shape[2], features)
        }
        None => Vec::new(),
    };
    let betas = match arrays.shape_directions.shape[2] {
        400 if file_joints == SMPL_X_JOINTS => 300,
        20 if file_joints == SMPL_X_JOINTS => 10,
        all => all,
    };
    let shape = &arrays.shape_directions;
    // Reports name the model, not where it lies.
    let stem = Path::new(name).file_stem();
    BodyModel::new(BodyArrays {
        name: stem.map_or_else(|| name.into(), |stem| stem.to_string_lossy().into_owned()),
        template: vectors(&arrays.template.values),
        shape_directions: by_last_index(&shape.values, shape.shape[2], betas),
        pose_directions,
        joint_regressor: JointRegressor::from_rows(arrays.regressor.into_iter().take(kept))?,
        blend_weights: joints.blend_weights(&arrays.weights.values, &arrays.parents)?,
        triangles: arrays.triangles,
        parents: arrays.parents[..kept].to_vec(),
        mirror_vertices: Vec::new(),
        attributes: None,
    })
}

fn vectors(flat: &[f32]) -> Vec<Vec3> {
    let triples = flat.as_chunks::<3>().0.iter();
    triples.map(|&triple| Vec3::from_array(triple)).collect()
}

/// `[V, 3, count]` as the first `kept` of `[count][V]`.
fn by_last_index(values: &[f32], count: usize, kept: usize) -> Vec<Vec<Vec3>> {
    let of = |index: usize| {
        let vertices = values.chunks_exact(3 * count);
        let vector = |vertex: &[f32]| {
            Vec3::new(
                vertex[index],
                vertex[count + index],
                vertex[2 * count + index],
            )
        };
        vertices.map(vector).collect()
    };
    (0..kept.min(count)).map(of).collect()
}

//! The arrays of a SMPL file, checked against each other's shapes.

use super::regressor::Rows;
use super::source::Source;
use crate::Error;

/// Numbers in C order.
#[derive(Clone, Debug)]
pub(super) struct Dense {
    pub(super) shape: Vec<usize>,
    pub(super) values: Vec<f32>,
}

#[derive(Debug)]
pub(super) struct SmplArrays {
    pub(super) template: Dense,
    /// `[V, 3, B]`.
    pub(super) shape_directions: Dense,
    /// `[V, 3, 9 (J - 1)]`.
    pub(super) pose_directions: Option<Dense>,
    pub(super) regressor: Rows,
    /// `[V, J]`.
    pub(super) weights: Dense,
    pub(super) parents: Vec<Option<usize>>,
    pub(super) triangles: Vec<[u32; 3]>,
}

impl SmplArrays {
    pub(super) fn read(file: &str, mut source: Source) -> Result<Self, Error> {
        let content = |problem| Error::Content {
            file: file.into(),
            problem: Box::new(problem),
        };
        let shaped = |dense: Dense, key: &str, expected: &[Option<usize>]| {
            check_shape(file, key, &dense.shape, expected).map(|()| dense)
        };
        let template = source.dense("v_template").map_err(content)?;
        let template = shaped(template, "v_template", &[None, Some(3)])?;
        let vertices = template.shape[0];

        let (tree, shape) = source.integers("kintree_table").map_err(content)?;
        check_shape(file, "kintree_table", &shape, &[Some(2), None])?;
        let parents = parents(file, &tree, shape[1])?;
        let joints = parents.len();

        let shape_directions = source.dense("shapedirs").map_err(content)?;
        let of_vertices = [Some(vertices), Some(3), None];
        let shape_directions = shaped(shape_directions, "shapedirs", &of_vertices)?;
        let pose_directions = if source.contains("posedirs") {
            let directions = source.dense("posedirs").map_err(content)?;
            let expected = [Some(vertices), Some(3), Some(9 * (joints - 1))];
            Some(shaped(directions, "posedirs", &expected)?)
        } else {
            None
        };
        let weights = source.dense("weights").map_err(content)?;
        let weights = shaped(weights, "weights", &[Some(vertices), Some(joints)])?;
        let (faces, shape) = source.integers("f").map_err(content)?;
        check_shape(file, "f", &shape, &[None, Some(3)])?;
        let indices: Result<Vec<u32>, _> = faces.into_iter().map(u32::try_from).collect();
        let indices = indices.map_err(|_| Error::Format {
            file: file.into(),
            place: "array `f`".into(),
            expected: "indices of vertices".into(),
            found: "a negative or huge one".into(),
        })?;
        let regressor = source.regressor("J_regressor", joints, vertices);
        Ok(Self {
            regressor: regressor.map_err(content)?,
            template,
            shape_directions,
            pose_directions,
            weights,
            parents,
            triangles: indices.as_chunks::<3>().0.to_vec(),
        })
    }
}

/// Parents from the two rows of a kinematic tree. The root's parent is any number that is no
/// joint: -1, or 2^32 - 1 where -1 was stored without a sign.
fn parents(file: &str, tree: &[i64], joints: usize) -> Result<Vec<Option<usize>>, Error> {
    let wrong = |expected: &str, found: String| Error::Format {
        file: file.into(),
        place: "array `kintree_table`".into(),
        expected: expected.into(),
        found,
    };
    if !(crate::Joint::COUNT..=256).contains(&joints) {
        let expected = "22 joints (24 in SMPL, 52 in SMPL-H, 55 in SMPL-X) or more";
        return Err(wrong(expected, joints.to_string()));
    }
    let (above, numbers) = tree.split_at(joints);
    if !numbers
        .iter()
        .zip(0..)
        .all(|(&number, index)| number == index)
    {
        return Err(wrong("joints numbered in order", format!("{numbers:?}")));
    }
    let parents = above.iter().enumerate().map(|(joint, &parent)| {
        let parent = usize::try_from(parent)
            .ok()
            .filter(|&parent| parent < joints);
        match parent {
            Some(parent) if parent >= joint => {
                let found = format!("parent {parent} of joint {joint}");
                Err(wrong("parents before children", found))
            }
            None if joint > 0 => Err(wrong("one root", format!("another, joint {joint}"))),
            parent => Ok(parent),
        }
    });
    parents.collect()
}

fn check_shape(
    file: &str,
    key: &str,
    found: &[usize],
    expected: &[Option<usize>],
) -> Result<(), Error> {
    let fits = found.len() == expected.len()
        && found
            .iter()
            .zip(expected)
            .all(|(&found, expected)| found > 0 && expected.is_none_or(|length| length == found));
    if fits {
        return Ok(());
    }
    let lengths = expected.iter().map(|length| match length {
        Some(length) => length.to_string(),
        None => "any".into(),
    });
    Err(Error::Format {
        file: file.into(),
        place: format!("array `{key}`"),
        expected: format!("shape [{}]", lengths.collect::<Vec<_>>().join(", ")),
        found: format!("shape {found:?}"),
    })
}

//! Joint regressors, dense and sparse.

use physique_files::Error;
use physique_files::npz::Array;
use physique_files::pickle::{PickleError, Value};

use super::arrays::Dense;

/// `(vertex, weight)` of each joint.
pub(super) type Rows = Vec<Vec<(u32, f32)>>;

fn wrong(key: &str, expected: &'static str, found: String) -> Error {
    let place = format!("`{key}`");
    PickleError::Content {
        place,
        expected,
        found,
    }
    .into()
}

/// From `[J, V]`.
pub(super) fn from_dense(
    dense: &Dense,
    key: &str,
    joints: usize,
    vertices: usize,
) -> Result<Rows, Error> {
    if dense.shape != [joints, vertices] {
        let found = format!("shape {:?}", dense.shape);
        return Err(wrong(key, "one row a joint and one column a vertex", found));
    }
    let rows = dense.values.chunks_exact(vertices.max(1));
    let row = |row: &[f32]| {
        let entries = (0_u32..).zip(row.iter().copied());
        entries.filter(|&(_, weight)| weight != 0.0).collect()
    };
    Ok(rows.map(row).collect())
}

/// From SciPy's compressed columns or rows.
pub(super) fn from_sparse(
    matrix: Value<'_>,
    key: &str,
    joints: usize,
    vertices: usize,
) -> Result<Rows, Error> {
    let by_column = match matrix.view() {
        physique_files::pickle::View::Object(object) => match object.class {
            "scipy.sparse.csc_matrix" => true,
            "scipy.sparse.csr_matrix" => false,
            other => return Err(wrong(key, "a csc or csr matrix", other.into())),
        },
        _ => return Err(wrong(key, "a sparse matrix", matrix.kind().into())),
    };
    let array = |name: &str| -> Result<Array, Error> {
        let value = matrix.attribute(name);
        let value =
            value.ok_or_else(|| wrong(key, "`data`, `indices` and `indptr`", "less".into()))?;
        Ok(value.array(key)?)
    };
    let weights = array("data")?.to_f32()?;
    let indices = array("indices")?.to_i64()?;
    let starts = array("indptr")?.to_i64()?;
    let (majors, minors) = if by_column {
        (vertices, joints)
    } else {
        (joints, vertices)
    };
    if weights.len() != indices.len() || starts.len() != majors + 1 {
        let found = format!(
            "{} weights, {} indices, {} starts",
            weights.len(),
            indices.len(),
            starts.len()
        );
        return Err(wrong(
            key,
            "arrays of joints by vertices that fit together",
            found,
        ));
    }
    let mut rows = vec![Vec::new(); joints];
    for (major, window) in starts.windows(2).enumerate() {
        let range = usize::try_from(window[0])
            .ok()
            .zip(usize::try_from(window[1]).ok());
        let entries =
            range.and_then(|(start, end)| indices.get(start..end).zip(weights.get(start..end)));
        let Some((minor_indices, minor_weights)) = entries else {
            return Err(wrong(key, "starts within the data", format!("{window:?}")));
        };
        for (&minor, &weight) in minor_indices.iter().zip(minor_weights) {
            let minor = usize::try_from(minor).ok().filter(|&minor| minor < minors);
            let Some(minor) = minor else {
                return Err(wrong(key, "indices within the matrix", "one beyond".into()));
            };
            let (joint, vertex) = if by_column {
                (minor, major)
            } else {
                (major, minor)
            };
            // Vertices are fewer than 2^32: each has three numbers in memory.
            rows[joint].push((vertex as u32, weight));
        }
        // Overlapping ranges would make much out of little.
        if rows.iter().map(Vec::len).sum::<usize>() > weights.len() {
            return Err(wrong(key, "ascending starts", format!("{window:?}")));
        }
    }
    Ok(rows)
}

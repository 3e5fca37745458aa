//! One way to ask for arrays, whether they lie in an archive or in a pickle.

use physique_files::npz::{Archive, Array, ArrayError};
use physique_files::pickle::{Pickle, PickleError, PickleLimits, Value, View};

use super::arrays::Dense;
use super::regressor::{self, Rows};

/// chumpy may wrap what it wraps, but no file does so deeply.
const DEEPEST_WRAPPER: usize = 16;

/// Where a body's arrays are.
#[derive(Debug)]
pub(crate) enum Source {
    Npz(Box<Archive>, PickleLimits),
    Pickle(Pickle),
}

impl Source {
    /// Whether there is a value of this name.
    pub(super) fn contains(&self, key: &str) -> bool {
        match self {
            Self::Npz(archive, _) => archive.contains(key),
            Self::Pickle(pickle) => pickle.root().get(key).is_some(),
        }
    }

    /// An array of numbers.
    pub(super) fn dense(&mut self, key: &str) -> Result<Dense, physique_files::Error> {
        match self {
            Self::Npz(archive, _) => Dense::new(&archive.array(key)?),
            Self::Pickle(pickle) => unwrapped(entry(pickle, key)?, key),
        }
    }

    /// An array of integers, which careless tools store as numbers: flat, and its shape.
    pub(super) fn integers(
        &mut self,
        key: &str,
    ) -> Result<(Vec<i64>, Vec<usize>), physique_files::Error> {
        let array = match self {
            Self::Npz(archive, _) => archive.array(key)?,
            Self::Pickle(pickle) => entry(pickle, key)?.array(key)?,
        };
        let values = match array.to_i64() {
            Ok(values) => values,
            Err(error) => {
                let numbers = array.to_f64()?;
                if numbers.iter().any(|number| number.fract() != 0.0) {
                    return Err(error.into());
                }
                numbers.into_iter().map(|number| number as i64).collect()
            }
        };
        Ok((values, array.shape().to_vec()))
    }

    /// A joint regressor, dense or sparse, as rows of `(vertex, weight)`.
    pub(super) fn regressor(
        &mut self,
        key: &str,
        joints: usize,
        vertices: usize,
    ) -> Result<Rows, physique_files::Error> {
        match self {
            Self::Npz(archive, limits) => match archive.array(key) {
                Ok(array) => regressor::from_dense(&Dense::new(&array)?, key, joints, vertices),
                // `numpy.savez` wraps sparse matrices in an array of one object.
                Err(ArrayError::ElementType { .. }) => {
                    let pickle = archive.objects(key, limits)?;
                    let root = pickle.root();
                    let matrix = root.list().and_then(|items| items.get(0)).unwrap_or(root);
                    regressor::from_sparse(matrix, key, joints, vertices)
                }
                Err(error) => Err(error.into()),
            },
            Self::Pickle(pickle) => {
                let value = entry(pickle, key)?;
                if value.attribute("indptr").is_some() {
                    regressor::from_sparse(value, key, joints, vertices)
                } else {
                    regressor::from_dense(&unwrapped(value, key)?, key, joints, vertices)
                }
            }
        }
    }
}

fn entry<'a>(pickle: &'a Pickle, key: &str) -> Result<Value<'a>, PickleError> {
    let root = pickle.root();
    root.get(key).ok_or_else(|| PickleError::Content {
        place: format!("`{key}`"),
        expected: "an array of that name in a dictionary",
        found: match root.view() {
            View::Dict(_) => {
                let keys = root.entries().filter_map(|(key, _)| key.text());
                let keys: Vec<&str> = keys.take(20).collect();
                format!("only {}", keys.join(", "))
            }
            _ => root.kind().into(),
        },
    })
}

/// The numbers within chumpy's `Ch` (`x`) and `Select` (elements `idxs` of `a`, flat).
fn unwrapped(mut value: Value<'_>, key: &str) -> Result<Dense, physique_files::Error> {
    let mut selections = Vec::new();
    for _ in 0..DEEPEST_WRAPPER {
        if let Some(inner) = value.attribute("x") {
            value = inner;
        } else if let (Some(inner), Some(indices)) = (value.attribute("a"), value.attribute("idxs"))
        {
            let shape = match value.attribute("preferred_shape") {
                Some(shape) => lengths(shape),
                None => None,
            };
            selections.push((indices.array(key)?.to_i64()?, shape));
            value = inner;
        } else {
            break;
        }
    }
    let mut dense = Dense::new(&value.array(key)?)?;
    for (indices, shape) in selections.into_iter().rev() {
        let shape = shape.unwrap_or_else(|| vec![indices.len()]);
        let pick = |index: &i64| {
            let index = usize::try_from(*index).ok()?;
            dense.values.get(index).copied()
        };
        let values: Option<Vec<f32>> = indices.iter().map(pick).collect();
        let fits = shape
            .iter()
            .try_fold(1, |product: usize, &n| product.checked_mul(n))
            == Some(indices.len());
        let (Some(values), true) = (values, fits) else {
            return Err(value.content(key, "a selection within its array").into());
        };
        dense = Dense { shape, values };
    }
    Ok(dense)
}

fn lengths(tuple: Value<'_>) -> Option<Vec<usize>> {
    let lengths = tuple.list()?;
    let lengths = lengths.iter().map(|length| match length.view() {
        View::Integer(length) => usize::try_from(length).ok(),
        _ => None,
    });
    lengths.collect()
}

impl Dense {
    pub(super) fn new(array: &Array) -> Result<Self, physique_files::Error> {
        Ok(Self {
            shape: array.shape().to_vec(),
            values: array.to_f32()?,
        })
    }
}

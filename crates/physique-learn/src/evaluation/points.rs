//! Embeddings as points.

use crate::Error;

/// Points of `width` numbers each.
#[derive(Clone, Debug, PartialEq)]
pub struct Points {
    width: usize,
    values: Vec<f64>,
}

impl Points {
    /// `[points][width]`.
    ///
    /// # Errors
    /// [`Error::Input`] unless `values` are whole, finite points.
    pub fn new(width: usize, values: Vec<f64>) -> Result<Self, Error> {
        if width == 0 || !values.len().is_multiple_of(width) {
            let expected = format!("whole points of {width} numbers");
            return Err(Error::input("Embeddings", expected, values.len()));
        }
        if let Some(index) = values.iter().position(|value| !value.is_finite()) {
            let found = format!("{} in point {}", values[index], index / width);
            return Err(Error::input("Embeddings", "finite numbers", found));
        }
        Ok(Self { width, values })
    }

    /// Number of points.
    pub const fn len(&self) -> usize {
        self.values.len() / self.width
    }

    /// Whether there are none.
    pub const fn is_empty(&self) -> bool {
        self.values.is_empty()
    }

    /// Numbers a point.
    pub const fn width(&self) -> usize {
        self.width
    }

    /// A point.
    ///
    /// # Panics
    /// When there is no such point.
    pub fn point(&self, index: usize) -> &[f64] {
        &self.values[index * self.width..(index + 1) * self.width]
    }

    /// All points in order.
    pub fn iter(&self) -> std::slice::ChunksExact<'_, f64> {
        self.values.chunks_exact(self.width)
    }

    /// `[points][width]`, flat.
    pub fn values(&self) -> &[f64] {
        &self.values
    }
}

/// The Euclidean distance.
pub(super) fn distance(a: &[f64], b: &[f64]) -> f64 {
    let squares = a.iter().zip(b).map(|(a, b)| (a - b) * (a - b));
    squares.sum::<f64>().sqrt()
}

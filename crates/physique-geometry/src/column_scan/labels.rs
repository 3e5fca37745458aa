use std::sync::Arc;

use crate::{Error, Triangles};

/// How far apart the labels of a surface are: small whole numbers, symmetric, zero from a label to
/// itself. For body parts, the number of joints between them.
///
/// ```
/// use physique_geometry::LabelDistances;
///
/// // hand - forearm - upper arm
/// let distances = LabelDistances::new(&[0, 1, 2, 1, 0, 1, 2, 1, 0])?;
/// assert_eq!(distances.between(0, 2), 2);
/// # Ok::<(), physique_geometry::Error>(())
/// ```
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct LabelDistances {
    label_count: usize,
    /// Row by row.
    table: Arc<[u8]>,
}

impl LabelDistances {
    /// Takes a square table, row by row.
    ///
    /// # Errors
    ///
    /// If the table is not square with 1 to 256 rows, not symmetric, or not zero on its diagonal.
    pub fn new(table: &[u8]) -> Result<Self, Error> {
        let label_count = table.len().isqrt();
        if label_count * label_count != table.len() || !(1..=256).contains(&label_count) {
            return Err(Error::LabelTableSize { found: table.len() });
        }
        for row in 0..label_count {
            for column in 0..=row {
                let found = table[row * label_count + column];
                let mirrored = table[column * label_count + row];
                let expected = if row == column { 0 } else { mirrored };
                if found != expected {
                    return Err(Error::LabelDistance {
                        row,
                        column,
                        found,
                        expected,
                    });
                }
            }
        }
        Ok(Self {
            label_count,
            table: table.into(),
        })
    }

    /// Number of labels.
    #[must_use]
    pub fn label_count(&self) -> usize {
        self.label_count
    }

    /// Distance between two labels.
    ///
    /// # Panics
    ///
    /// If one of them is not below [`label_count`](Self::label_count).
    #[must_use]
    pub fn between(&self, a: u8, b: u8) -> u8 {
        self.table[usize::from(a) * self.label_count + usize::from(b)]
    }
}

/// The label of every triangle of a mesh, checked against a table of distances.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct TriangleLabels {
    labels: Arc<[u8]>,
    distances: LabelDistances,
}

impl TriangleLabels {
    /// One label a triangle.
    ///
    /// # Errors
    ///
    /// If the number of labels differs from that of triangles, or a label is not in the table.
    pub fn new(
        triangles: &Triangles,
        labels: &[u8],
        distances: LabelDistances,
    ) -> Result<Self, Error> {
        let (expected, found) = (triangles.len(), labels.len());
        if expected != found {
            return Err(Error::LabelCount { expected, found });
        }
        let label_count = distances.label_count();
        let known = |&&label: &&u8| usize::from(label) < label_count;
        if let Some(triangle) = labels.iter().position(|label| !known(&label)) {
            return Err(Error::LabelOutOfRange {
                triangle,
                label: labels[triangle],
                label_count,
            });
        }
        Ok(Self {
            labels: labels.into(),
            distances,
        })
    }

    /// Label 0 for every triangle: for callers who ask where a surface overlaps, not which parts do.
    #[must_use]
    pub fn uniform(triangles: &Triangles) -> Self {
        let distances = LabelDistances {
            label_count: 1,
            table: [0].into(),
        };
        Self {
            labels: vec![0; triangles.len()].into(),
            distances,
        }
    }

    /// The label of a triangle.
    ///
    /// # Panics
    ///
    /// If there is no such triangle.
    #[must_use]
    pub fn of(&self, triangle: u32) -> u8 {
        self.labels[triangle as usize]
    }

    /// Number of triangles.
    #[must_use]
    pub fn len(&self) -> usize {
        self.labels.len()
    }

    /// Whether there is no triangle.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.labels.is_empty()
    }

    /// The distances between the labels.
    #[must_use]
    pub fn distances(&self) -> &LabelDistances {
        &self.distances
    }
}

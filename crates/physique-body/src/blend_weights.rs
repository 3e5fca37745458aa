//! Blend weights: how much each joint moves each vertex.

use crate::Error;

/// Sparse blend weights: up to [`BlendWeights::influences`] joints a vertex.
///
/// Rows are stored at one width, padded by weight 0 of the row's first joint, so that skinning
/// has no branches.
#[derive(Clone, Debug, PartialEq)]
pub struct BlendWeights {
    influences: usize,
    joints: Vec<u8>,
    weights: Vec<f32>,
}

impl BlendWeights {
    /// From rows of `(joint, weight)`; each row is sorted by descending weight and divided by its
    /// sum.
    ///
    /// # Errors
    /// [`Error::Model`] for a row without a positive sum, or with a negative or infinite weight.
    pub fn from_rows<Row>(rows: impl IntoIterator<Item = Row>) -> Result<Self, Error>
    where
        Row: IntoIterator<Item = (u8, f32)>,
    {
        let mut sorted: Vec<Vec<(u8, f32)>> = Vec::new();
        for row in rows {
            let mut row: Vec<_> = row
                .into_iter()
                .filter(|&(_, weight)| weight != 0.0)
                .collect();
            let sum: f32 = row.iter().map(|&(_, weight)| weight).sum();
            let valid = row.iter().all(|&(_, weight)| weight > 0.0) && sum.is_finite() && sum > 0.0;
            if !valid {
                return Err(Error::Model {
                    what: "a row of blend weights",
                    expected: "non-negative and of positive sum".into(),
                    found: format!("{row:?} at vertex {}", sorted.len()),
                });
            }
            row.sort_by(|a, b| b.1.total_cmp(&a.1).then(a.0.cmp(&b.0)));
            row.iter_mut().for_each(|(_, weight)| *weight /= sum);
            sorted.push(row);
        }
        let influences = sorted.iter().map(Vec::len).max().unwrap_or(0);
        let mut joints = Vec::with_capacity(sorted.len() * influences);
        let mut weights = Vec::with_capacity(sorted.len() * influences);
        for row in &sorted {
            for index in 0..influences {
                let (joint, weight) = row.get(index).copied().unwrap_or((row[0].0, 0.0));
                joints.push(joint);
                weights.push(weight);
            }
        }
        Ok(Self {
            influences,
            joints,
            weights,
        })
    }

    /// Entries a vertex, padding included.
    pub const fn influences(&self) -> usize {
        self.influences
    }

    /// Number of vertices.
    pub fn vertex_count(&self) -> usize {
        self.joints.len().checked_div(self.influences).unwrap_or(0)
    }

    /// `[vertices][influences]` joints, flat.
    pub fn joints(&self) -> &[u8] {
        &self.joints
    }

    /// `[vertices][influences]` weights, flat; each row sums to 1.
    pub fn weights(&self) -> &[f32] {
        &self.weights
    }

    /// Joints and weights of one vertex, heaviest first.
    pub fn row(&self, vertex: usize) -> impl Iterator<Item = (usize, f32)> + '_ {
        let range = vertex * self.influences..(vertex + 1) * self.influences;
        let joints = self.joints[range.clone()]
            .iter()
            .map(|&joint| usize::from(joint));
        joints.zip(self.weights[range].iter().copied())
    }

    /// The joint that moves the vertex most.
    pub fn dominant_joint(&self, vertex: usize) -> usize {
        usize::from(self.joints[vertex * self.influences])
    }

    /// Largest joint index in use.
    pub(crate) fn largest_joint(&self) -> u8 {
        self.joints.iter().copied().max().unwrap_or(0)
    }
}

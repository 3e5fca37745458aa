//! The sparse joint regressor: joints as weighted means of vertices.

use glam::{DVec3, Vec3};

use crate::Error;

/// Joint positions as weighted means of vertex positions, stored as compressed rows.
#[derive(Clone, Debug, PartialEq)]
pub struct JointRegressor {
    row_starts: Vec<usize>,
    vertices: Vec<u32>,
    weights: Vec<f32>,
}

impl JointRegressor {
    /// From one list of `(vertex, weight)` a joint.
    ///
    /// # Errors
    /// [`Error::Model`] when the weights of a joint do not sum to 1 within 1e-3: such joints would
    /// not follow a moved body.
    pub fn from_rows<Row>(rows: impl IntoIterator<Item = Row>) -> Result<Self, Error>
    where
        Row: IntoIterator<Item = (u32, f32)>,
    {
        let mut regressor = Self {
            row_starts: vec![0],
            vertices: Vec::new(),
            weights: Vec::new(),
        };
        for row in rows {
            let mut sum = 0.0;
            for (vertex, weight) in row {
                regressor.vertices.push(vertex);
                regressor.weights.push(weight);
                sum += f64::from(weight);
            }
            if sum.is_nan() || (sum - 1.0).abs() > 1e-3 {
                return Err(Error::Model {
                    what: "a row of the joint regressor",
                    expected: "weights that sum to 1".into(),
                    found: format!("{sum} for joint {}", regressor.joint_count()),
                });
            }
            regressor.row_starts.push(regressor.vertices.len());
        }
        Ok(regressor)
    }

    /// Number of joints.
    pub fn joint_count(&self) -> usize {
        self.row_starts.len() - 1
    }

    /// Vertices and weights of one joint.
    pub fn row(&self, joint: usize) -> impl Iterator<Item = (usize, f32)> + '_ {
        let range = self.row_starts[joint]..self.row_starts[joint + 1];
        let vertices = self.vertices[range.clone()].iter().map(|&v| v as usize);
        vertices.zip(self.weights[range].iter().copied())
    }

    /// Joint positions for vertex positions; sums in f64.
    pub fn joints(&self, vertices: &[Vec3]) -> Vec<Vec3> {
        (0..self.joint_count())
            .map(|joint| {
                self.row(joint)
                    .map(|(vertex, weight)| vertices[vertex].as_dvec3() * f64::from(weight))
                    .sum::<DVec3>()
                    .as_vec3()
            })
            .collect()
    }

    /// Largest vertex index in use.
    pub(crate) fn largest_vertex(&self) -> u32 {
        self.vertices.iter().copied().max().unwrap_or(0)
    }
}

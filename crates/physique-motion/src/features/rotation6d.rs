//! Rotations as six numbers (Zhou et al., "On the Continuity of Rotation Representations in
//! Neural Networks", CVPR 2019), in the two conventions that are in use.

use glam::{Mat3, Vec3};

/// Two vectors that a rotation matrix is made of, and whether they are its columns or its rows.
///
/// HumanML3D, KIT, MDM's text models and MoMask write the first two **columns**; pytorch3d, and so
/// MDM's action models, the first two **rows**: the transpose, which is the inverse rotation.
///
/// ```
/// use physique_motion::features::Rotation6d;
///
/// let numbers = [0.0, 0.0, -1.0, 0.0, 1.0, 0.0];
/// let columns = Rotation6d::columns(numbers).to_matrix();
/// let rows = Rotation6d::rows(numbers).to_matrix();
/// assert_eq!(columns, rows.map(|matrix| matrix.transpose()));
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Rotation6d {
    first: Vec3,
    second: Vec3,
    are_rows: bool,
}

impl Rotation6d {
    /// From the first and the second column, three numbers each.
    pub const fn columns(numbers: [f32; 6]) -> Self {
        let [a, b, c, d, e, f] = numbers;
        Self {
            first: Vec3::new(a, b, c),
            second: Vec3::new(d, e, f),
            are_rows: false,
        }
    }

    /// From the first and the second row, three numbers each.
    pub const fn rows(numbers: [f32; 6]) -> Self {
        let mut rotation = Self::columns(numbers);
        rotation.are_rows = true;
        rotation
    }

    /// The six numbers of a rotation matrix, by columns.
    pub const fn columns_of(matrix: &Mat3) -> [f32; 6] {
        let (first, second) = (matrix.x_axis, matrix.y_axis);
        [first.x, first.y, first.z, second.x, second.y, second.z]
    }

    /// The six numbers of a rotation matrix, by rows.
    pub fn rows_of(matrix: &Mat3) -> [f32; 6] {
        Self::columns_of(&matrix.transpose())
    }

    /// The rotation: the first vector keeps its direction, the second is bent to a right angle.
    ///
    /// `None` when the two do not span a plane.
    pub fn to_matrix(self) -> Option<Mat3> {
        let x = self.first.try_normalize()?;
        let z = x.cross(self.second).try_normalize()?;
        let matrix = Mat3::from_cols(x, z.cross(x), z);
        Some(if self.are_rows {
            matrix.transpose()
        } else {
            matrix
        })
    }
}

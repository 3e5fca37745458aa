//! Matrix products with the same result for any number of threads.

use multiversion::multiversion;
use rayon::prelude::*;

/// Rows of the result that one task computes. Fixed, so that the result does not depend on the
/// number of threads.
const ROWS_A_TASK: usize = 256;

/// A matrix in a slice: element (i, j) is at `i * row_stride + j * column_stride`.
#[derive(Clone, Copy)]
pub(crate) struct Matrix<'a> {
    data: &'a [f32],
    rows: usize,
    columns: usize,
    row_stride: usize,
    column_stride: usize,
}

impl<'a> Matrix<'a> {
    /// Row by row; `data` has `rows * columns` elements.
    pub(crate) fn new(data: &'a [f32], rows: usize, columns: usize) -> Self {
        assert_eq!(data.len(), rows * columns, "a matrix fills its slice");
        Self {
            data,
            rows,
            columns,
            row_stride: columns,
            column_stride: 1,
        }
    }

    /// The same numbers, mirrored at the diagonal; costs nothing.
    pub(crate) fn transposed(self) -> Self {
        Self {
            data: self.data,
            rows: self.columns,
            columns: self.rows,
            row_stride: self.column_stride,
            column_stride: self.row_stride,
        }
    }
}

/// `result = a b`, row by row; `result` is overwritten.
///
/// # Panics
/// If the shapes do not fit.
pub(crate) fn multiply(a: Matrix<'_>, b: Matrix<'_>, result: &mut [f32]) {
    assert_eq!(a.columns, b.rows, "inner dimensions");
    assert_eq!(result.len(), a.rows * b.columns, "outer dimensions");
    if b.columns == 0 || a.rows == 0 {
        return;
    }
    if a.columns == 0 {
        result.fill(0.0);
        return;
    }
    if b.columns == 1 && a.column_stride == 1 {
        // A vector is read once a row: packing would cost more than it brings.
        for (sum, row) in result.iter_mut().zip(a.data.chunks(a.columns)) {
            *sum = dot(row, b.data);
        }
        return;
    }
    result
        .par_chunks_mut(ROWS_A_TASK * b.columns)
        .enumerate()
        .for_each(|(task, rows)| {
            let first = task * ROWS_A_TASK;
            let start = first * a.row_stride;
            // SAFETY: `Matrix` covers its slice exactly, in one of the two orders, so that all
            // elements of rows `first..first + rows` of `a` and of all of `b` lie within them;
            // `rows` is a whole number of rows of the result.
            unsafe {
                matrixmultiply::sgemm(
                    rows.len() / b.columns,
                    a.columns,
                    b.columns,
                    1.0,
                    a.data.as_ptr().add(start),
                    a.row_stride as isize,
                    a.column_stride as isize,
                    b.data.as_ptr(),
                    b.row_stride as isize,
                    b.column_stride as isize,
                    0.0,
                    rows.as_mut_ptr(),
                    b.columns as isize,
                    1,
                );
            }
        });
}

/// Sum of products in 16 interleaved partial sums, so that it vectorises.
#[multiversion(targets = "simd")]
pub(crate) fn dot(a: &[f32], b: &[f32]) -> f32 {
    const LANES: usize = 16;
    let mut sums = [0.0_f32; LANES];
    let (a, a_rest) = a.as_chunks::<LANES>();
    let (b, b_rest) = b.as_chunks::<LANES>();
    for (a, b) in a.iter().zip(b) {
        for lane in 0..LANES {
            sums[lane] += a[lane] * b[lane];
        }
    }
    let rest: f32 = a_rest.iter().zip(b_rest).map(|(a, b)| a * b).sum();
    sums.iter().sum::<f32>() + rest
}

#[cfg(test)]
mod tests {
    use super::{Matrix, multiply};

    #[test]
    fn equals_sums_of_products() {
        let numbers = |count: usize, step: usize| -> Vec<f32> {
            (0..count).map(|i| ((i * step) % 17) as f32 - 8.0).collect()
        };
        for (rows, inner, columns) in [
            (1, 1, 1),
            (600, 7, 5),
            (257, 64, 33),
            (2, 0, 3),
            (600, 77, 1),
        ] {
            let (a, b) = (numbers(rows * inner, 5), numbers(inner * columns, 3));
            let expected: Vec<f32> = (0..rows * columns)
                .map(|place| {
                    let (row, column) = (place / columns, place % columns);
                    (0..inner)
                        .map(|k| a[row * inner + k] * b[k * columns + column])
                        .sum()
                })
                .collect();
            let mut result = vec![f32::NAN; rows * columns];
            let (a, b) = (
                Matrix::new(&a, rows, inner),
                Matrix::new(&b, inner, columns),
            );
            multiply(a, b, &mut result);
            assert_eq!(result, expected);
            let mut turned = vec![f32::NAN; rows * columns];
            multiply(b.transposed(), a.transposed(), &mut turned);
            for (place, value) in expected.iter().enumerate() {
                assert_eq!(turned[place % columns * rows + place / columns], *value);
            }
        }
    }
}

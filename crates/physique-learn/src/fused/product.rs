//! Matrix products of parts of arrays.

use gemm::{Parallelism, gemm};

/// A matrix somewhere in an array.
#[derive(Clone, Copy)]
pub(super) struct Matrix<'a> {
    pub(super) numbers: &'a [f32],
    /// From one row to the next.
    pub(super) row: usize,
    /// From one column to the next.
    pub(super) column: usize,
}

impl<'a> Matrix<'a> {
    /// Rows of an array that are `row` numbers apart.
    pub(super) const fn rows(numbers: &'a [f32], row: usize) -> Self {
        Self {
            numbers,
            row,
            column: 1,
        }
    }

    pub(super) const fn transposed(self) -> Self {
        Self {
            row: self.column,
            column: self.row,
            ..self
        }
    }

    fn assert_holds(&self, rows: usize, columns: usize) {
        let last = (rows - 1) * self.row + (columns - 1) * self.column;
        assert!(last < self.numbers.len(), "{rows} x {columns} numbers");
    }
}

/// Writes `factor * left * right`, `[rows][columns]`, to rows of `output` that are `row` numbers
/// apart; `inner` is what the product sums over. All counts are 1 or more.
pub(super) fn product(
    [rows, inner, columns]: [usize; 3],
    factor: f32,
    left: Matrix<'_>,
    right: Matrix<'_>,
    output: &mut [f32],
    row: usize,
) {
    left.assert_holds(rows, inner);
    right.assert_holds(inner, columns);
    Matrix::rows(output, row).assert_holds(rows, columns);
    assert!(columns <= row, "rows that do not overlap");
    // SAFETY: all that is read and written lies within the slices, as was asserted, and `output` is
    // borrowed for writing, so that nothing else overlaps it. Slices have at most isize::MAX bytes.
    unsafe {
        gemm(
            rows,
            columns,
            inner,
            output.as_mut_ptr(),
            1,
            row as isize,
            false,
            left.numbers.as_ptr(),
            left.column as isize,
            left.row as isize,
            right.numbers.as_ptr(),
            right.column as isize,
            right.row as isize,
            0.0,
            factor,
            false,
            false,
            false,
            Parallelism::None,
        );
    }
}

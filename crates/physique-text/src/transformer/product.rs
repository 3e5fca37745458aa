//! The matrix product.

/// `x w^T`: rows of `x` (`[rows][inner]`) with rows of `w` (`[columns][inner]`), to
/// `[rows][columns]`.
///
/// Every number of the result is a sum in an order that depends on `inner` alone, so that a caption
/// gives the same bits in any company.
///
/// # Panics
/// When the slices are not whole rows of `inner`.
pub(super) fn with_rows_of(x: &[f32], w: &[f32], inner: usize) -> Vec<f32> {
    assert!(inner > 0 && x.len().is_multiple_of(inner) && w.len().is_multiple_of(inner));
    let (rows, columns) = (x.len() / inner, w.len() / inner);
    let mut result = vec![0.0; rows * columns];
    // SAFETY: `x` has `rows` rows of `inner` numbers, `w` `columns` rows of `inner` numbers, which are
    // read as the columns of its transpose, and `result` `rows` rows of `columns` numbers, as was
    // checked and allocated above.
    unsafe {
        matrixmultiply::sgemm(
            rows,
            inner,
            columns,
            1.0,
            x.as_ptr(),
            inner as isize,
            1,
            w.as_ptr(),
            1,
            inner as isize,
            0.0,
            result.as_mut_ptr(),
            columns as isize,
            1,
        );
    }
    result
}

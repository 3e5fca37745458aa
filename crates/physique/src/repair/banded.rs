//! Symmetric positive definite matrices with all entries near the diagonal.

/// The lower half of such a matrix, or its Cholesky factor: row `i` holds the columns
/// `i - width ..= i`.
#[derive(Clone, Debug)]
pub(super) struct Banded {
    width: usize,
    rows: Vec<f64>,
}

impl Banded {
    pub(super) fn new(size: usize, width: usize) -> Self {
        Self {
            width,
            rows: vec![0.0; size * (width + 1)],
        }
    }

    pub(super) fn size(&self) -> usize {
        self.rows.len() / (self.width + 1)
    }

    /// Adds to an entry of the lower half, within the band.
    pub(super) fn add(&mut self, row: usize, column: usize, value: f64) {
        debug_assert!(column <= row && row - column <= self.width);
        self.rows[row * (self.width + 1) + self.width - (row - column)] += value;
    }

    /// Replaces the matrix by its Cholesky factor.
    pub(super) fn factorise(&mut self) {
        let (width, stride) = (self.width, self.width + 1);
        for row in 0..self.size() {
            let (above, rest) = self.rows.split_at_mut(row * stride);
            let of_row = &mut rest[..stride];
            let first = row.saturating_sub(width);
            for column in first..row {
                // Columns that both rows have, before this one.
                let shared = column - first.max(column.saturating_sub(width));
                let place = width - (row - column);
                let pivots = &above[column * stride..][..stride];
                let sum = dot(
                    &of_row[place - shared..place],
                    &pivots[width - shared..width],
                );
                of_row[place] = (of_row[place] - sum) / pivots[width];
            }
            let (before, pivot) = of_row.split_at_mut(width);
            // Rounding must not make a nearly singular matrix indefinite.
            pivot[0] = (pivot[0] - dot(before, before)).max(1e-9).sqrt();
        }
    }

    /// Solves with the factor, in place.
    pub(super) fn solve(&self, values: &mut [f64]) {
        let (width, stride) = (self.width, self.width + 1);
        for row in 0..self.size() {
            let count = row.min(width);
            let of_row = &self.rows[row * stride..][..stride];
            let sum = dot(&of_row[width - count..width], &values[row - count..row]);
            values[row] = (values[row] - sum) / of_row[width];
        }
        for row in (0..self.size()).rev() {
            let count = row.min(width);
            let of_row = &self.rows[row * stride..][..stride];
            let value = values[row] / of_row[width];
            values[row] = value;
            let before = &mut values[row - count..row];
            for (before, factor) in before.iter_mut().zip(&of_row[width - count..width]) {
                *before -= factor * value;
            }
        }
    }
}

/// In four sums, which the processor adds at the same time.
fn dot(a: &[f64], b: &[f64]) -> f64 {
    let mut sums = [0.0; 8];
    let (a, b) = (a.chunks_exact(8), b.chunks_exact(8));
    let rest: f64 = a
        .remainder()
        .iter()
        .zip(b.remainder())
        .map(|(a, b)| a * b)
        .sum();
    for (a, b) in a.zip(b) {
        for lane in 0..8 {
            sums[lane] += a[lane] * b[lane];
        }
    }
    sums.iter().sum::<f64>() + rest
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn solves_what_was_multiplied() {
        for (size, width) in [(1, 0), (5, 4), (40, 11), (60, 25)] {
            let entry = |row: usize, column: usize| {
                let off = ((row * 7 + column * 3) as f64).sin();
                if row == column {
                    3.0 * width as f64 + 4.0
                } else {
                    off
                }
            };
            let mut matrix = Banded::new(size, width);
            let expected: Vec<f64> = (0..size).map(|row| (row as f64).cos()).collect();
            let mut product = vec![0.0; size];
            for row in 0..size {
                for column in row.saturating_sub(width)..=row {
                    let value = entry(row, column);
                    matrix.add(row, column, value);
                    product[row] += value * expected[column];
                    if column < row {
                        product[column] += value * expected[row];
                    }
                }
            }
            matrix.factorise();
            matrix.solve(&mut product);
            for (found, expected) in product.iter().zip(&expected) {
                assert!((found - expected).abs() < 1e-10, "{found} for {expected}");
            }
        }
    }
}

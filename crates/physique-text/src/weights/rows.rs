//! Rows of numbers of 32 or 8 bits.

/// A matrix whose rows are looked up one by one.
#[derive(Clone, Debug)]
pub(crate) struct Rows {
    numbers: Numbers,
    width: usize,
}

#[derive(Clone, Debug)]
enum Numbers {
    Full(Vec<f32>),
    /// Eight bits, and what to multiply each row with.
    Rounded(Vec<i8>, Vec<f32>),
}

impl Rows {
    pub(super) fn full(numbers: Vec<f32>, width: usize) -> Self {
        let numbers = Numbers::Full(numbers);
        Self { numbers, width }
    }

    pub(super) fn rounded(numbers: Vec<i8>, scales: Vec<f32>, width: usize) -> Self {
        let numbers = Numbers::Rounded(numbers, scales);
        Self { numbers, width }
    }

    pub(crate) fn count(&self) -> usize {
        match &self.numbers {
            Numbers::Full(numbers) => numbers.len() / self.width,
            Numbers::Rounded(numbers, _) => numbers.len() / self.width,
        }
    }

    /// Writes a row; the last one in place of one that is not there, which no tokenizer of the right
    /// vocabulary asks for.
    pub(crate) fn copy_to(&self, row: usize, target: &mut [f32]) {
        let row = row.min(self.count().saturating_sub(1));
        let range = row * self.width..(row + 1) * self.width;
        match &self.numbers {
            Numbers::Full(numbers) => target.copy_from_slice(&numbers[range]),
            Numbers::Rounded(numbers, scales) => {
                for (target, &number) in target.iter_mut().zip(&numbers[range]) {
                    *target = f32::from(number) * scales[row];
                }
            }
        }
    }

    /// All rows as 32-bit numbers.
    pub(crate) fn into_floats(self) -> Vec<f32> {
        match self.numbers {
            Numbers::Full(numbers) => numbers,
            Numbers::Rounded(numbers, scales) => numbers
                .chunks_exact(self.width)
                .zip(scales)
                .flat_map(|(row, scale)| row.iter().map(move |&number| f32::from(number) * scale))
                .collect(),
        }
    }
}

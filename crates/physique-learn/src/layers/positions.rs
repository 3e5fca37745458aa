//! Where in a sequence: sines and cosines. Vaswani et al. 2017, section 3.5.

use burn::tensor::{Device, Tensor, TensorData};

/// Rows of the table of positions, `[positions][width]`: sine in even columns, cosine in odd ones,
/// of the position times 10000^(-2i / width).
///
/// Angles are rounded to 32 bits, as PyTorch rounds them but for the last bit of its exponential: at
/// position 1,000 that is 6e-5 radians.
pub fn rows(positions: impl ExactSizeIterator<Item = usize>, width: usize) -> Vec<f32> {
    let scale = -(10_000.0_f64.ln() / width as f64) as f32;
    let mut rows = Vec::with_capacity(positions.len() * width);
    for position in positions {
        rows.extend((0..width).map(|column| {
            let even = column - column % 2;
            let frequency = (even as f32 * scale).exp();
            let angle = position as f32 * frequency;
            if column == even {
                angle.sin()
            } else {
                angle.cos()
            }
        }));
    }
    rows
}

/// [`rows`] as a tensor.
pub fn tensor(
    positions: impl ExactSizeIterator<Item = usize>,
    width: usize,
    device: &Device,
) -> Tensor<2> {
    let count = positions.len();
    Tensor::from_data(
        TensorData::new(rows(positions, width), [count, width]),
        device,
    )
}

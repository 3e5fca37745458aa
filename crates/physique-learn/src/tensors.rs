//! Between Burn's tensors and plain numbers.

use burn::tensor::{Bool, Device, Tensor, TensorData};

use crate::Error;

/// The numbers of a tensor, the last index fastest.
pub(crate) fn numbers<const D: usize>(tensor: Tensor<D>) -> Result<Vec<f32>, Error> {
    tensor
        .try_into_vec_as::<f32>()
        .map_err(|problem| Error::Device {
            problem: format!("{problem:?}"),
        })
}

/// Numbers in a shape; the caller has counted them.
pub(crate) fn tensor<const D: usize>(
    values: Vec<f32>,
    shape: [usize; D],
    device: &Device,
) -> Tensor<D> {
    Tensor::from_data(TensorData::new(values, shape), device)
}

/// `[batch][frames]`: true from each length on.
pub(crate) fn padding(lengths: &[usize], frames: usize, device: &Device) -> Tensor<2, Bool> {
    let hidden = lengths
        .iter()
        .flat_map(|&length| (0..frames).map(move |frame| frame >= length));
    let shape = [lengths.len(), frames];
    Tensor::from_data(
        TensorData::new(hidden.collect::<Vec<bool>>(), shape),
        device,
    )
}

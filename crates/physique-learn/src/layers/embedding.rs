//! A learned vector for each of a few numbers.

use burn::module::{Module, Param};
use burn::tensor::{Int, Tensor, TensorData};

use super::Initialiser;
use crate::Error;

/// `torch.nn.Embedding`, or a bare parameter that rows are taken of.
#[derive(Module, Debug)]
pub struct Embedding {
    /// `[count][width]`.
    weight: Param<Tensor<2>>,
}

impl Embedding {
    /// New vectors of the normal distribution.
    pub fn new(count: usize, width: usize, initialiser: &mut Initialiser) -> Self {
        Self {
            weight: initialiser.normal([count, width], 1.0),
        }
    }

    /// Vectors `[indices][width]`.
    ///
    /// # Errors
    /// [`Error::Input`] for an index that has none; `what` names it.
    pub fn rows(&self, indices: &[usize], what: &'static str) -> Result<Tensor<2>, Error> {
        let weight = self.weight.val();
        let count = weight.dims()[0];
        if let Some(index) = indices.iter().find(|&&index| index >= count) {
            return Err(Error::input(
                what,
                format!("one of 0 to {}", count - 1),
                index,
            ));
        }
        let indices: Vec<i32> = indices.iter().map(|&index| index as i32).collect();
        let shape = [indices.len()];
        let indices =
            Tensor::<1, Int>::from_data(TensorData::new(indices, shape), &weight.device());
        Ok(weight.select(0, indices))
    }
}

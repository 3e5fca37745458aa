//! Every caption finds its motion, and every motion its caption.

use burn::tensor::activation::log_softmax;
use burn::tensor::{Bool, Tensor, TensorData};

use crate::tensors::tensor;

/// In place of what must not be told apart: a probability of 0, and finite.
const NEVER: f64 = -1e9;

/// The mean negative logarithm of the probability that a pair finds its other half, in both
/// directions: a softmax over minus the squared distances, divided by `temperature`.
///
/// `same` is `[pairs][pairs]`: pairs that say the same, which are no negatives of each other.
pub(super) fn contrastive(
    captions: Tensor<2>,
    motions: Tensor<2>,
    same: &[bool],
    temperature: f64,
) -> Tensor<1> {
    let [pairs, _] = captions.dims();
    let device = captions.device();
    let lengths = |points: &Tensor<2>| points.clone().square().sum_dim(1);
    let products = captions.clone().matmul(motions.clone().transpose());
    let squares = lengths(&captions) + lengths(&motions).transpose() - products * 2.0;
    let own = |pair: usize, other: usize| pair == other;
    let hidden = (0..pairs * pairs).map(|at| same[at] && !own(at / pairs, at % pairs));
    let hidden = TensorData::new(hidden.collect::<Vec<bool>>(), [pairs, pairs]);
    let hidden = Tensor::<2, Bool>::from_data(hidden, &device);
    let scores = (squares / -temperature).mask_fill(hidden, NEVER);
    let diagonal = (0..pairs * pairs).map(|at| f32::from(u8::from(own(at / pairs, at % pairs))));
    let diagonal = tensor(diagonal.collect(), [pairs, pairs], &device);
    let found = log_softmax(scores.clone(), 1) + log_softmax(scores, 0);
    (found * diagonal).sum() / (-2.0 * pairs as f64)
}

/// `[pairs][pairs]`: whether the cosine of two captions is at least `least`.
pub(super) fn alike(captions: &[f32], width: usize, least: f64) -> Vec<bool> {
    let rows: Vec<&[f32]> = captions.chunks_exact(width.max(1)).collect();
    let product = |a: &[f32], b: &[f32]| {
        let products = a.iter().zip(b).map(|(a, b)| f64::from(a * b));
        products.sum::<f64>()
    };
    let alike = rows.iter().flat_map(|a| {
        rows.iter().map(|b| {
            let lengths = (product(a, a) * product(b, b)).sqrt();
            product(a, b) >= least * lengths
        })
    });
    alike.collect()
}

#[cfg(test)]
mod tests {
    use burn::tensor::{Device, Tensor};

    use super::{alike, contrastive};

    fn loss(same: [bool; 4]) -> f64 {
        let device = Device::flex();
        let points = |points: [[f32; 2]; 2]| Tensor::<2>::from_data(points, &device);
        let captions = points([[0.0, 0.0], [1.0, 0.0]]);
        let motions = points([[0.0, 1.0], [1.0, 2.0]]);
        let loss = contrastive(captions, motions, &same, 2.0);
        f64::from(loss.into_data().try_into_vec::<f32>().expect("a number")[0])
    }

    #[test]
    fn loss_of_two_pairs() {
        // Squared distances 1 and 5 from the first caption, 2 and 4 from the second.
        let negative = |own: f64, other: f64| (1.0 + ((own - other) / 2.0).exp()).ln();
        let expected =
            negative(1.0, 5.0) + negative(4.0, 2.0) + negative(1.0, 2.0) + negative(4.0, 5.0);
        let found = loss([true, false, false, true]);
        assert!((found - expected / 4.0).abs() < 1e-6, "{found}");
        // With nothing to be told apart from, all are found.
        assert!(loss([true; 4]).abs() < 1e-6);
    }

    #[test]
    fn likeness_is_a_cosine() {
        let captions = [1.0, 0.0, 5.0, 0.1, 0.0, 2.0];
        let found = alike(&captions, 2, 0.9);
        let expected = [true, true, false, true, true, false, false, false, true];
        assert_eq!(found, expected);
    }
}

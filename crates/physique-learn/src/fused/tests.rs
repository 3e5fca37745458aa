//! Fused operations against the same of Burn's elementary ones, values and gradients.

use burn::tensor::activation::{gelu, softmax};
use burn::tensor::{Device, Tensor, TensorData, module::layer_norm as elementary_layer_norm};

use super::{DropMask, add_dropped, attention, dropped, dropped_gelu, layer_norm};
use crate::random::Random;

fn normal<const D: usize>(seed: u64, shape: [usize; D], deviation: f32) -> Tensor<D> {
    let mut values = vec![0.0; shape.iter().product()];
    Random::new(&[seed]).fill_normal(&mut values);
    values.iter_mut().for_each(|value| *value *= deviation);
    Tensor::from_data(TensorData::new(values, shape), &Device::flex().autodiff())
}

fn numbers<const D: usize>(tensor: Tensor<D>) -> Vec<f32> {
    tensor.into_data().try_into_vec::<f32>().expect("floats")
}

/// The mask of a stream, and its factors as a tensor.
fn mask<const D: usize>(shape: [usize; D]) -> (DropMask, Tensor<D>) {
    let mask = DropMask::new(20_000, &Random::new(&[99]));
    let mut factors = vec![1.0; shape.iter().product()];
    mask.multiply(0, &mut factors);
    let share =
        factors.iter().filter(|factor| **factor == 0.0).count() as f64 / factors.len() as f64;
    assert!((share - 20_000.0 / 65_536.0).abs() < 0.1, "{share}");
    let factors = TensorData::new(factors, shape);
    (mask, Tensor::from_data(factors, &Device::flex().autodiff()))
}

/// Output, and gradients by each input of a sum in which every number counts differently.
fn run<const N: usize, const D: usize>(
    inputs: [Tensor<D>; N],
    of: impl Fn([Tensor<D>; N]) -> Tensor<D>,
) -> Vec<Vec<f32>> {
    let leaves = inputs.map(Tensor::require_grad);
    // In the middle of a graph.
    let output = of(leaves.each_ref().map(|leaf| leaf.clone() * 1.25));
    let weights = normal(5, output.dims(), 1.0);
    let gradients = (output.clone() * weights).sum().backward();
    let gradients = leaves.map(|leaf| numbers(leaf.grad(&gradients).expect("it depends on it")));
    std::iter::once(numbers(output)).chain(gradients).collect()
}

fn assert_close(found: &[Vec<f32>], expected: &[Vec<f32>], tolerance: f32) {
    assert_eq!(found.len(), expected.len());
    for (index, (found, expected)) in found.iter().zip(expected).enumerate() {
        assert_eq!(found.len(), expected.len());
        let size = expected.iter().fold(0.0, |most: f32, x| most.max(x.abs()));
        assert!(size > 0.0);
        for (place, (found, expected)) in found.iter().zip(expected).enumerate() {
            let far = (found - expected).abs();
            assert!(
                far <= tolerance * size,
                "{index}, {place}: {found} {expected}"
            );
        }
    }
}

#[test]
fn dropout_is_a_product() {
    let shape = [3, 5, 1111];
    let (mask, factors) = mask(shape);
    let found = run([normal(1, shape, 1.0)], |[x]| dropped(x, mask.clone()));
    let expected = run([normal(1, shape, 1.0)], |[x]| x * factors.clone());
    assert_eq!(found, expected);
    let inputs = || [normal(1, shape, 1.0), normal(2, shape, 1.0)];
    let found = run(inputs(), |[x, y]| add_dropped(x, y, mask.clone()));
    let expected = run(inputs(), |[x, y]| x + y * factors.clone());
    assert_eq!(found, expected);
}

#[test]
fn gelu_is_gelu() {
    let shape = [3, 5, 1111];
    let (mask, factors) = mask(shape);
    let x = || [normal(1, shape, 2.0)];
    let expected = run(x(), |[x]| gelu(x));
    assert_close(&run(x(), |[x]| dropped_gelu(x, None)), &expected, 2e-7);
    let found = run(x(), |[x]| dropped_gelu(x, Some(mask.clone())));
    let expected = run(x(), |[x]| gelu(x) * factors.clone());
    assert_close(&found, &expected, 2e-7);
}

#[test]
fn layers_are_normalised() {
    // More rows than a thread takes at once, and no whole number of vectors.
    let (shape, width) = ([2, 50, 37], 37);
    let x = || normal(1, shape, 3.0) + 0.5;
    let row = |seed: u64| normal(seed, [1, 1, width], 1.0) + 0.2;
    let flat = |x: Tensor<3>| x.reshape([width]);
    let found = run_different(x(), row(2), row(3), |x, a, b| {
        layer_norm(x, flat(a), flat(b), 1e-5)
    });
    let expected = run_different(x(), row(2), row(3), |x, a, b| {
        elementary_layer_norm(x, flat(a), Some(flat(b)), 1e-5)
    });
    assert_close(&found, &expected, 2e-6);
}

fn run_different(
    x: Tensor<3>,
    a: Tensor<3>,
    b: Tensor<3>,
    of: impl Fn(Tensor<3>, Tensor<3>, Tensor<3>) -> Tensor<3>,
) -> Vec<Vec<f32>> {
    run([x, a, b], |[x, a, b]| of(x, a, b))
}

/// All of attention by elementary operations.
fn elementary_attention(
    projected: Tensor<3>,
    heads: usize,
    hidden: &[bool],
    factors: Option<&Tensor<4>>,
) -> Tensor<3> {
    let [batch, frames, width] = projected.dims();
    let width = width / 3;
    let [queries, keys, values] = [0, 1, 2].map(|part| {
        let part = projected.clone().narrow(2, part * width, width);
        part.reshape([batch, frames, heads, width / heads])
            .swap_dims(1, 2)
    });
    let factor = ((width / heads) as f64).sqrt().recip();
    let scores = (queries * factor).matmul(keys.transpose());
    let bias = hidden.iter().map(|&hidden| if hidden { -1e9 } else { 0.0 });
    let bias = TensorData::new(bias.collect::<Vec<f32>>(), [batch, 1, 1, frames]);
    let weights = softmax(scores + Tensor::from_data(bias, &projected.device()), 3);
    let weights = match factors {
        Some(factors) => weights * factors.clone(),
        None => weights,
    };
    weights
        .matmul(values)
        .swap_dims(1, 2)
        .reshape([batch, frames, width])
}

#[test]
fn attention_is_attention() {
    let (heads, frames, width) = (2, 21, 10);
    let shape = [3, frames, 3 * heads * width];
    let (mask, factors) = mask([3, heads, frames, frames]);
    let lengths = [21, 4, 13];
    let hidden: Vec<bool> = lengths
        .iter()
        .flat_map(|&length| (0..frames).map(move |frame| frame >= length))
        .collect();
    let none = vec![false; 3 * frames];
    let x = || [normal(1, shape, 1.5)];
    for (hidden, is_hidden) in [(&none, false), (&hidden, true)] {
        for (mask, factors) in [(None, None), (Some(mask.clone()), Some(&factors))] {
            let given = is_hidden.then(|| hidden.clone().into());
            let found = run(x(), |[x]| attention(x, heads, given.clone(), mask.clone()));
            let expected = run(x(), |[x]| elementary_attention(x, heads, hidden, factors));
            assert_close(&found, &expected, 2e-6);
        }
    }
}

/// Without a graph, as when a network is used.
#[test]
fn values_need_no_graph() {
    let x = normal(1, [2, 9, 12], 1.0);
    let with = numbers(attention(x.clone(), 2, None, None));
    assert_eq!(numbers(attention(x.inner(), 2, None, None)), with);
}

#[test]
fn what_is_no_number_stays_none() {
    let mut values = vec![0.5; 2 * 6 * 12];
    values[40] = f32::NAN;
    let device = Device::flex();
    let x = Tensor::<3>::from_data(TensorData::new(values, [2, 6, 12]), &device);
    let row = Tensor::<1>::ones([12], &device);
    let (mask, _) = mask([2, 6, 12]);
    let broken = |tensor: Tensor<3>| numbers(tensor).iter().any(|x| x.is_nan());
    assert!(broken(attention(x.clone(), 2, None, None)));
    assert!(broken(dropped_gelu(x.clone(), None)));
    assert!(broken(layer_norm(x.clone(), row.clone(), row, 1e-5)));
    assert!(broken(add_dropped(x.clone(), x, mask)));
}

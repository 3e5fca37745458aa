//! A loss from outside of Burn as one operation in its graph.

use std::sync::Arc;

use burn::tensor::{Device, Tensor, TensorData};
use physique_learn::Error;
use physique_learn::motion_loss::{LossAndGradient, MotionLoss, losses};

/// The sum of all cubes within each motion.
#[derive(Debug)]
struct Cubes;

impl MotionLoss for Cubes {
    fn evaluate(
        &self,
        motions: &[f32],
        frames: usize,
        lengths: &[usize],
    ) -> Result<LossAndGradient, Error> {
        let motion = motions.len() / lengths.len();
        let mut gradient = vec![0.0; motions.len()];
        let mut losses = Vec::new();
        for (index, length) in lengths.iter().enumerate() {
            let within = index * motion..index * motion + length * motion / frames;
            losses.push(motions[within.clone()].iter().map(|x| x * x * x).sum());
            for (by, x) in gradient[within.clone()].iter_mut().zip(&motions[within]) {
                *by = 3.0 * x * x;
            }
        }
        Ok(LossAndGradient { losses, gradient })
    }
}

/// Fails whatever it sees.
#[derive(Debug)]
struct Fails;

impl MotionLoss for Fails {
    fn evaluate(&self, _: &[f32], _: usize, _: &[usize]) -> Result<LossAndGradient, Error> {
        Err(Error::Device {
            problem: "a test".into(),
        })
    }
}

fn motions(device: &Device) -> Tensor<3> {
    let values = (0..24).map(|i| (i as f32 * 0.7).sin()).collect::<Vec<_>>();
    Tensor::from_data(TensorData::new(values, [2, 4, 3]), device)
}

/// The same by Burn's own operations.
fn by_burn(motions: Tensor<3>) -> Tensor<1> {
    let within = (0..24).map(|i| f32::from(u8::from(i < 21))).collect();
    let within = TensorData::new::<f32, _>(within, [2, 4, 3]);
    let within = Tensor::<3>::from_data(within, &motions.device());
    (motions.powi_scalar(3) * within).sum_dims_squeeze::<1, _>(&[1, 2])
}

#[test]
fn value_and_gradient_are_those_of_the_loss() {
    let device = Device::flex().autodiff();
    let loss: Arc<dyn MotionLoss> = Arc::new(Cubes);
    let weights = Tensor::<1>::from_data([0.3, -2.0], &device);
    let run = |of: &dyn Fn(Tensor<3>) -> Tensor<1>| {
        let leaf = motions(&device).require_grad();
        // In the middle of a graph, with a part that goes another way.
        let x = leaf.clone() * 1.5 + 0.1;
        let total = (of(x.clone()) * weights.clone()).sum() + x.sum();
        let gradient = leaf.grad(&total.backward()).expect("it depends on it");
        let numbers = |data: TensorData| data.try_into_vec::<f32>().expect("floats");
        (numbers(total.into_data()), numbers(gradient.into_data()))
    };
    let (value, gradient) = run(&|x| losses(x, &[4, 3], &loss));
    let (expected_value, expected_gradient) = run(&by_burn);
    let close = |found: &[f32], expected: &[f32]| {
        let mut pairs = found.iter().zip(expected);
        pairs.all(|(found, expected)| (found - expected).abs() < 1e-5)
    };
    assert!(
        close(&value, &expected_value),
        "{value:?} {expected_value:?}"
    );
    assert!(
        close(&gradient, &expected_gradient),
        "{gradient:?} {expected_gradient:?}"
    );
}

#[test]
fn values_are_the_same_without_a_graph() {
    let loss: Arc<dyn MotionLoss> = Arc::new(Cubes);
    let value = |device: &Device| {
        let losses = losses(motions(device), &[4, 3], &loss);
        losses.into_data().try_into_vec::<f32>().expect("floats")
    };
    assert_eq!(value(&Device::flex()), value(&Device::flex().autodiff()));
}

/// Training stops at NaN, and says so.
#[test]
fn a_loss_that_fails_is_no_number() {
    let loss: Arc<dyn MotionLoss> = Arc::new(Fails);
    let found = losses(motions(&Device::flex()), &[4, 3], &loss);
    let found = found.into_data().try_into_vec::<f32>().expect("floats");
    assert!(found.iter().all(|loss| loss.is_nan()), "{found:?}");
}

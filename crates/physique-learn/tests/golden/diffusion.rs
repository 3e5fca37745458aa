//! Schedules, noising and sampling.

use burn::tensor::{Device, Tensor, TensorData};
use physique_learn::diffusion::{Method, Sampler, Schedule};

use crate::made_up::{Vectors, difference, input};

const VECTORS: &[u8] = include_bytes!("../fixtures/diffusion.npz");

fn close(found: f64, expected: f64) -> bool {
    (found - expected).abs() <= 1e-12 * expected.abs()
}

#[test]
fn schedules_are_the_published_ones() {
    let mut vectors = Vectors::open(VECTORS);
    for steps in [1000, 50, 10] {
        let schedule = Schedule::cosine(steps).expect("in range");
        let mut expected = |name: &str| vectors.f64(&format!("{name}_{steps}"));
        let betas = expected("betas");
        let kept = expected("alphas_cumprod");
        let variance = expected("posterior_variance");
        let log_variance = expected("posterior_log_variance_clipped");
        let from_clean = expected("posterior_mean_coef1");
        let from_noisy = expected("posterior_mean_coef2");
        assert_eq!(schedule.len(), steps);
        for step in 0..steps {
            let posterior = schedule.posterior(step);
            assert!(close(schedule.betas()[step], betas[step]), "{step}");
            assert!(close(schedule.kept()[step], kept[step]), "{step}");
            assert!(close(posterior.variance, variance[step]), "{step}");
            assert!(close(posterior.log_variance, log_variance[step]), "{step}");
            assert!(close(posterior.from_clean, from_clean[step]), "{step}");
            assert!(close(posterior.from_noisy, from_noisy[step]), "{step}");
        }
    }
}

/// Walks 50 steps with the toy model of the vectors: x_0 = tanh(x / 2) + step / 100,000.
fn trace(method: Method) -> Vec<f32> {
    let device = Device::flex();
    let shape = [1, 4, 5];
    let of = |values: Vec<f32>| Tensor::<3>::from_data(TensorData::new(values, shape), &device);
    let sampler = Sampler::new(Schedule::cosine(50).expect("in range"), method);
    let mut x = of(input(20, 0.3));
    let mut trace = Vec::new();
    for (index, step) in (0..50).rev().enumerate() {
        let clean = (x.clone() / 2.0).tanh() + 0.01 * step as f64 / 1000.0;
        let noise = || of(input(20, 0.7 * (index + 1) as f64));
        x = sampler.step(step, x, clean, noise);
        trace.extend(x.to_data_as::<f32>().into_vec::<f32>().expect("floats"));
    }
    trace
}

#[test]
fn sampling_takes_the_published_steps() {
    let mut vectors = Vectors::open(VECTORS);
    let error = difference(&trace(Method::Ancestral), &vectors.f32("ddpm_trace50"));
    assert!(error < 2e-6, "{error}");
    let ddim = trace(Method::Ddim { eta: 0.0 });
    let error = difference(&ddim, &vectors.f32("ddim_trace50"));
    assert!(error < 2e-6, "{error}");
}

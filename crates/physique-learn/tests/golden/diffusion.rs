//! Schedules, noising and sampling.

use burn::tensor::{Device, Tensor, TensorData};
use physique_learn::diffusion::{Method, Sampler, Schedule, add_noise};
use physique_learn::mdm::losses::{FrameMask, squared_error};

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
        trace.extend(x.to_data_as::<f32>().try_into_vec::<f32>().expect("floats"));
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

/// The vectors' clean motions and noise, `[2][263][20]`, whose order of numbers does not matter.
fn motions(phase: f64) -> Tensor<3> {
    let data = TensorData::new(input(2 * 263 * 20, phase), [2, 263, 20]);
    Tensor::from_data(data, &Device::flex())
}

#[test]
fn noise_is_added_as_published() {
    let mut vectors = Vectors::open(VECTORS);
    let schedule = Schedule::cosine(1000).expect("in range");
    let (clean, noise) = (motions(0.0), motions(2.0));
    let noisy = add_noise(&schedule, clean.clone(), &[3, 977], noise.clone());
    let noisy = noisy.into_data().try_into_vec::<f32>().expect("floats");
    let error = difference(&noisy, &vectors.f32("q_sample_x0_noise"));
    assert!(error < 1e-6, "{error}");

    let half = 263 * 20;
    let expected = vectors.f32("post_mean");
    let sampler = Sampler::new(schedule.clone(), Method::Ancestral);
    for (motion, step) in [3, 977].into_iter().enumerate() {
        // Without noise a step gives the mean of the posterior.
        let mean = sampler.step(step, noise.clone(), clean.clone(), || noise.zeros_like());
        let mean = mean.into_data().try_into_vec::<f32>().expect("floats");
        let range = motion * half..(motion + 1) * half;
        let error = difference(&mean[range.clone()], &expected[range]);
        assert!(error < 1e-6, "{error}");
        let variance = schedule.posterior(step).log_variance as f32;
        let expected = vectors.f32("post_logvar_t3_t977")[motion];
        assert!((variance - expected).abs() < 1e-6 * expected.abs());
    }
}

#[test]
fn padding_costs_nothing() {
    let (clean, noise) = (motions(0.0).swap_dims(1, 2), motions(2.0).swap_dims(1, 2));
    let mask = FrameMask::new(&[20, 13], 20, &clean);
    let error = squared_error(clean, noise, &mask, None);
    let found = error.into_data().try_into_vec::<f32>().expect("floats");
    let expected = Vectors::open(VECTORS).f32("masked_l2");
    let error = difference(&found, &expected);
    assert!(error < 1e-6, "{error}");
}

//! Time filters: exact for the polynomials they fit, and of the stated response at any frame rate.

use std::f64::consts::PI;

use physique_motion::FrameRate;
use physique_physics::TimeFilter;

/// `sigma * cut-off` where `(1 + s) exp(-s)`, the response of the quartic filter, falls to 1/sqrt(2).
const SIGMA_HZ: f64 = 0.233_70;
/// The same for the Gaussian response `exp(-s)` of the averaging filter.
const AVERAGE_SIGMA_HZ: f64 = 0.132_505;

fn frames(reach: usize) -> impl Iterator<Item = f64> {
    (0..=2 * reach).map(move |k| k as f64 - reach as f64)
}

fn gain(filter: &TimeFilter, order: usize) -> f64 {
    filter.taps(order).iter().map(|t| t * t).sum::<f64>().sqrt()
}

fn at(fps: f64) -> FrameRate {
    FrameRate::new(fps).unwrap()
}

#[test]
fn averages_are_exact_for_parabolas_and_have_the_stated_response() {
    for fps in [20.0, 30.0, 60.0, 120.0] {
        let filter = TimeFilter::averaging(at(fps), 3.0).unwrap();
        assert!((filter.cutoff_hz() - 3.0).abs() < 1e-12);
        assert!(filter.taps(0).iter().all(|weight| *weight > 0.0));
        let sum = |order: usize, of: &dyn Fn(f64) -> f64| -> f64 {
            let places = frames(filter.reach()).zip(filter.taps(order));
            places.map(|(k, tap)| tap * of(k / fps)).sum()
        };
        for (order, parabola) in [(1, -2.0), (2, 6.0)] {
            let found = sum(order, &|t| 1.0 - 2.0 * t + 3.0 * t * t);
            assert!((found - parabola).abs() < 1e-9, "{fps} {order} {found}");
        }
        for hertz in [0.5, 1.0, 2.0, 3.0, 5.0] {
            let omega = 2.0 * PI * hertz;
            let stated = (-(omega * AVERAGE_SIGMA_HZ / 3.0).powi(2) / 2.0).exp();
            let value = sum(0, &|t| (omega * t).cos());
            let first = sum(1, &|t| (omega * t).sin()) / omega;
            let second = -sum(2, &|t| (omega * t).cos()) / (omega * omega);
            for found in [value, first, second] {
                assert!(
                    (found - stated).abs() < 0.02,
                    "{fps} {hertz}: {found} {stated}"
                );
            }
        }
    }
}

#[test]
fn short_filters_have_the_published_noise_gains() {
    let second = TimeFilter::second_difference(at(20.0));
    assert!((gain(&second, 2) - 979.795_897_113_271_2).abs() < 1e-8);
    let five = TimeFilter::savitzky_golay_5(at(20.0));
    assert!((gain(&five, 2) - 213.808_993_529_939_5).abs() < 1e-8);
}

#[test]
fn quartics_are_exact_at_any_rate() {
    let motion = |t: f64| 1.0 - 2.0 * t + 3.0 * t * t - 4.0 * t.powi(3) + 5.0 * t.powi(4);
    for fps in [8.0, 20.0, 30.0, 60.0, 120.0, 240.0] {
        let filter = TimeFilter::new(at(fps), 4.0).unwrap();
        for (order, expected) in [1.0, -2.0, 6.0, -24.0].into_iter().enumerate() {
            let found: f64 = frames(filter.reach())
                .zip(filter.taps(order))
                .map(|(k, tap)| tap * motion(k / fps))
                .sum();
            assert!((found - expected).abs() < 1e-6, "{fps} {order} {found}");
        }
    }
}

#[test]
fn the_response_is_the_stated_one_at_all_common_rates() {
    for fps in [20.0, 30.0, 60.0, 120.0] {
        let filter = TimeFilter::new(at(fps), 4.0).unwrap();
        for hertz in [0.5, 1.0, 2.0, 3.0, 4.0] {
            let omega = 2.0 * PI * hertz;
            let found: f64 = frames(filter.reach())
                .zip(filter.taps(2))
                .map(|(k, tap)| tap * (omega * k / fps).cos())
                .sum::<f64>()
                / -(omega * omega);
            let s = (omega * SIGMA_HZ / 4.0).powi(2) / 2.0;
            let stated = (1.0 + s) * (-s).exp();
            assert!(
                (found - stated).abs() < 0.02,
                "{fps} {hertz}: {found} {stated}"
            );
        }
        let omega = 8.0 * PI;
        let s = (omega * SIGMA_HZ / 4.0).powi(2) / 2.0;
        assert!(((1.0 + s) * (-s).exp() - 0.5_f64.sqrt()).abs() < 1e-4);
    }
}

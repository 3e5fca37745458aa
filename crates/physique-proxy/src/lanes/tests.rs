//! Every backend of this processor against plain arithmetic.

use super::{Backend, Dispatch, Kernel, Lanes, MOST_LANES, Simd};

/// Runs `F` on every backend, compiled as kernels are.
fn on_every_backend() {
    for backend in Backend::available() {
        backend.dispatch(Check).expect("available");
    }
}

struct Check;

impl Dispatch for Check {
    type Output = ();

    fn with<S: Simd>(self, simd: S) {
        simd.run(self);
    }
}

impl<S: Simd> Kernel<S> for Check {
    type Output = ();

    #[inline(always)]
    fn run(self, simd: S) {
        arithmetic(simd);
        comparisons(simd);
        answers(simd);
        zips(simd);
    }
}

const A: [f32; MOST_LANES] = [
    1.0, -2.0, 0.5, 1e-20, 3e10, -0.25, 7.0, 9.0, 1.5, -8.0, 0.0, 2.5, 1e5, -1e-5, 4.0, 11.0,
];
const B: [f32; MOST_LANES] = [
    2.0, 2.0, -0.5, 1e20, 3.0, 0.75, 7.0, -9.0, 0.1, 0.3, 5.0, 2.0, 1e-5, 6.0, -4.0, 1.0,
];

fn lanes<S: Simd>(lanes: S::Lanes) -> [f32; MOST_LANES] {
    let mut numbers = [0.0; MOST_LANES];
    lanes.store(&mut numbers);
    numbers
}

#[inline(always)]
fn arithmetic<S: Simd>(simd: S) {
    let (a, b, c) = (simd.load(&A), simd.load(&B), simd.splat(3.0));
    let (sum, difference) = (lanes::<S>(a + b), lanes::<S>(a - b));
    let (product, fused) = (lanes::<S>(a * b), lanes::<S>(a.mul_add(b, c)));
    let negative = lanes::<S>(a.neg_mul_add(b, c));
    let (least, most) = (lanes::<S>(a.min(b)), lanes::<S>(a.max(b)));
    let inverse = lanes::<S>((a * a).max(simd.splat(1e-30)).inverse_sqrt());
    let kept = lanes::<S>(b.where_positive(a));
    for lane in 0..S::COUNT {
        let (a, b) = (A[lane], B[lane]);
        assert_eq!(sum[lane], a + b);
        assert_eq!(difference[lane], a - b);
        assert_eq!(product[lane], a * b);
        let close = |found: f32, expected: f64| {
            assert!((f64::from(found) - expected).abs() <= 2e-7 * (3.0 + expected.abs()));
        };
        close(fused[lane], f64::from(a) * f64::from(b) + 3.0);
        close(negative[lane], 3.0 - f64::from(a) * f64::from(b));
        assert_eq!(least[lane], a.min(b));
        assert_eq!(most[lane], a.max(b));
        let expected = 1.0 / (a * a).max(1e-30).sqrt();
        assert!(
            (inverse[lane] / expected - 1.0).abs() < 4e-7,
            "{} {expected}",
            inverse[lane]
        );
        assert_eq!(kept[lane], if a > 0.0 { b } else { 0.0 });
    }
}

#[inline(always)]
fn comparisons<S: Simd>(simd: S) {
    let (one, two, nan) = (simd.splat(1.0), simd.splat(2.0), simd.splat(f32::NAN));
    assert!(S::Lanes::any(one.below(two)));
    assert!(!S::Lanes::any(two.below(one)));
    assert!(!S::Lanes::any(one.below(one)));
    assert_eq!(lanes::<S>(nan.max(one))[0], 1.0);
    for lane in 0..S::COUNT {
        let mut numbers = [1.0; MOST_LANES];
        numbers[lane] = 3.0;
        let numbers = simd.load(&numbers);
        assert!(S::Lanes::any(two.below(numbers)));
        assert!(!S::Lanes::any(two.below(numbers) & two.below(one)));
    }
}

/// Each answer by itself, from each lane.
#[inline(always)]
fn answers<S: Simd>(simd: S) {
    let (zero, infinite) = (simd.splat(0.0), simd.splat(f32::INFINITY));
    for place in 0..16 {
        for lane in 0..S::COUNT {
            let mut numbers = [2.0; MOST_LANES];
            numbers[lane] = -1e-30;
            let mut rows = [[zero, infinite, zero, zero]; 4];
            rows[place / 4][place % 4] = simd.load(&numbers);
            let [a, b, c, d] = rows;
            let mut answers = S::Lanes::gather([
                S::Lanes::any_negative(a),
                S::Lanes::any_negative(b),
                S::Lanes::any_negative(c),
                S::Lanes::any_negative(d),
            ]);
            assert!(answers.any());
            assert_eq!([answers.pop(), answers.pop()], [Some(place), None]);
        }
    }
}

#[inline(always)]
fn zips<S: Simd>(simd: S) {
    let (low, high) = simd.load(&A).zip(simd.load(&B));
    let (low, high) = (lanes::<S>(low), lanes::<S>(high));
    for lane in 0..S::COUNT {
        let zipped = if lane % 2 == 0 { A } else { B };
        let half = S::COUNT / 2;
        assert_eq!(low[lane], zipped[lane / 2]);
        assert_eq!(high[lane], zipped[half + lane / 2]);
    }
}

#[test]
fn backends_compute_as_plain_arithmetic() {
    on_every_backend();
}

#[test]
fn the_best_backend_is_available() {
    assert!(Backend::best().is_available());
    assert_eq!(Backend::available().last(), Some(Backend::Portable));
}

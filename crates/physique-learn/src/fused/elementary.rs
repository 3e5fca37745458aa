//! Functions of one number that compilers turn into vector instructions: no branches, no calls, no
//! fused multiply-add, so that they are the same everywhere.

/// e^x to 2 units in the last place, of numbers from -87 to 88, to which others are clamped; NaN
/// stays NaN.
#[inline(always)]
pub(super) fn exp(x: f32) -> f32 {
    // Added to a number and taken away again, this rounds it: it leaves no bits for fractions.
    const ROUND: f32 = 12_582_912.0;
    // ln 2 in two parts, the first with zeros at its end.
    const HIGH: f32 = 0.693_359_4;
    const LOW: f32 = -2.121_944_4e-4;
    let x = x.clamp(-87.0, 88.0);
    let rounded = x * std::f32::consts::LOG2_E + ROUND;
    let whole = rounded - ROUND;
    let rest = (x - whole * HIGH) - whole * LOW;
    // Taylor's series; the rest is at most ln 2 / 2.
    let mut sum = 1.0 / 5040.0;
    for coefficient in [
        1.0 / 720.0,
        1.0 / 120.0,
        1.0 / 24.0,
        1.0 / 6.0,
        0.5,
        1.0,
        1.0,
    ] {
        sum = sum * rest + coefficient;
    }
    sum * f32::from_bits(rounded.to_bits().wrapping_add(127) << 23)
}

/// The error function to 2e-7. Both polynomials were fitted for the least largest error.
#[inline(always)]
pub(super) fn erf(x: f32) -> f32 {
    let (size, square) = (x.abs(), x * x);
    // erf(x) / x in x^2, for up to 1.
    let mut near = 7.889_119e-5;
    for coefficient in [
        -8.020_841e-4,
        5.189_535e-3,
        -2.685_444_4e-2,
        1.128_36e-1,
        -3.761_262_6e-1,
        std::f32::consts::FRAC_2_SQRT_PI,
    ] {
        near = near * square + coefficient;
    }
    // -ln(1 - erf(x)), from there to 4, where erf is 1.
    let far_size = size.clamp(0.0, 4.0);
    let mut far = -1.855_749e-4;
    for coefficient in [
        2.939_615_6e-3,
        -2.180_535_2e-2,
        1.030_374_3e-1,
        6.382_256e-1,
        1.127_04,
        3.537_089_2e-4,
    ] {
        far = far * far_size + coefficient;
    }
    let far = (1.0 - exp(-far)).copysign(x);
    if size < 1.0 { near * x } else { far }
}

#[cfg(test)]
mod tests {
    use super::{erf, exp};

    #[test]
    fn exponentials_are_those_of_64_bits() {
        for step in -86_000..88_000 {
            let x = step as f32 / 1000.0;
            let expected = f64::from(x).exp();
            let error = (f64::from(exp(x)) / expected - 1.0).abs();
            assert!(error < 2.4e-7, "{x}: {error}");
        }
        assert_eq!(exp(0.0), 1.0);
        assert!(exp(f32::NAN).is_nan());
        assert!(exp(f32::NEG_INFINITY) < 1e-37);
    }

    /// The series 2 / sqrt(pi) sum (-1)^n x^(2n+1) / (n! (2n+1)), in 64 bits.
    fn series(x: f64) -> f64 {
        let (mut term, mut sum) = (x, x);
        for n in 1..200 {
            term *= -x * x / f64::from(n);
            sum += term / f64::from(2 * n + 1);
        }
        sum * std::f64::consts::FRAC_2_SQRT_PI
    }

    #[test]
    fn error_function_is_its_series() {
        for step in -4500..=4500 {
            let x = step as f32 / 1000.0;
            let expected = series(f64::from(x));
            let error = (f64::from(erf(x)) - expected).abs();
            assert!(error < 2e-7, "{x}: {error}");
            let error = error / expected.abs().max(1e-30);
            assert!(error < 4e-7, "{x}: {error} of its size");
        }
        assert_eq!((erf(9.0), erf(-9.0)), (1.0, -1.0));
        assert!(erf(f32::NAN).is_nan());
    }
}

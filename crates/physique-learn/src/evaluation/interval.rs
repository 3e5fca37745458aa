//! Means of repetitions.

/// A mean over repetitions and how sure it is.
#[derive(Clone, Copy, Debug, PartialEq, serde::Serialize)]
pub struct Interval {
    /// Mean.
    pub mean: f64,
    /// Half of the 95 % interval of the mean: 1.96 population deviations over the root of the
    /// number of repetitions, as published.
    pub half_width: f64,
    /// Repetitions.
    pub repetitions: usize,
}

impl Interval {
    /// Of one value a repetition; NaN for none.
    pub fn of(values: &[f64]) -> Self {
        let count = values.len() as f64;
        let mean = values.iter().sum::<f64>() / count;
        let squares = values.iter().map(|value| (value - mean) * (value - mean));
        let deviation = (squares.sum::<f64>() / count).sqrt();
        Self {
            mean,
            half_width: 1.96 * deviation / count.sqrt(),
            repetitions: values.len(),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::Interval;

    #[test]
    fn interval_of_three() {
        let interval = Interval::of(&[1.0, 2.0, 6.0]);
        assert_eq!(interval.mean, 3.0);
        // Population variance 14 / 3.
        let expected = 1.96 * (14.0_f64 / 3.0).sqrt() / 3.0_f64.sqrt();
        assert!((interval.half_width - expected).abs() < 1e-15);
    }
}

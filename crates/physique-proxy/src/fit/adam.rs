//! Adam (Kingma and Ba, "Adam: A Method for Stochastic Optimization", 2015).

use rayon::prelude::*;

const FIRST_DECAY: f32 = 0.9;
const SECOND_DECAY: f32 = 0.999;
const EPSILON: f32 = 1e-8;
/// Parameters that one task updates.
const CHUNK: usize = 1 << 16;

/// The optimiser's memory: running means of gradients and of their squares.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Adam {
    pub(crate) steps: u64,
    pub(crate) first: Vec<f32>,
    pub(crate) second: Vec<f32>,
}

impl Adam {
    pub(crate) fn new(parameters: usize) -> Self {
        Self {
            steps: 0,
            first: vec![0.0; parameters],
            second: vec![0.0; parameters],
        }
    }

    /// One step downhill.
    pub(crate) fn step(&mut self, parameters: &mut [f32], gradient: &[f32], rate: f32) {
        self.steps += 1;
        let exponent = i32::try_from(self.steps).unwrap_or(i32::MAX);
        let first_bias = 1.0 - f64::from(FIRST_DECAY).powi(exponent);
        let second_bias = 1.0 - f64::from(SECOND_DECAY).powi(exponent);
        let rate = (f64::from(rate) / first_bias) as f32;
        let scale = second_bias.sqrt().recip() as f32;
        parameters
            .par_chunks_mut(CHUNK)
            .zip(gradient.par_chunks(CHUNK))
            .zip(self.first.par_chunks_mut(CHUNK))
            .zip(self.second.par_chunks_mut(CHUNK))
            .for_each(|(((parameters, gradient), first), second)| {
                let moments = first.iter_mut().zip(second);
                for ((parameter, slope), (first, second)) in
                    parameters.iter_mut().zip(gradient).zip(moments)
                {
                    *first += (slope - *first) * (1.0 - FIRST_DECAY);
                    *second = *second * SECOND_DECAY + slope * slope * (1.0 - SECOND_DECAY);
                    *parameter -= rate * *first / (second.sqrt() * scale + EPSILON);
                }
            });
    }
}

#[cfg(test)]
mod tests {
    use super::Adam;

    #[test]
    fn takes_the_steps_of_the_paper() {
        // By hand: after the first step both means are unbiased, so the step is the rate.
        let mut adam = Adam::new(2);
        let mut parameters = [1.0, -2.0];
        adam.step(&mut parameters, &[4.0, -0.5], 0.1);
        assert!((parameters[0] - 0.9).abs() < 1e-6 && (parameters[1] + 1.9).abs() < 1e-6);
        // m = 0.9 * 0.4 + 0.1 * 1, v = 0.999 * 0.016 + 0.001 * 1, with their biases removed.
        adam.step(&mut parameters, &[1.0, 0.0], 0.1);
        let (m, v) = (0.46_f64 / 0.19, 0.016_984_f64 / 0.001_999);
        let expected = 0.9 - 0.1 * m / v.sqrt();
        assert!((f64::from(parameters[0]) - expected).abs() < 1e-5);
    }

    #[test]
    fn finds_the_bottom_of_a_bowl() {
        let mut adam = Adam::new(1);
        let mut parameters = [3.0];
        for _ in 0..2000 {
            let gradient = [2.0 * (parameters[0] - 1.0)];
            adam.step(&mut parameters, &gradient, 0.01);
        }
        assert!((parameters[0] - 1.0).abs() < 1e-3);
    }
}

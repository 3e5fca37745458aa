//! Attention of the tokens of a caption to each other.

use super::Linear;

/// Which tokens a token looks at.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Sight {
    /// All of its caption.
    Whole,
    /// Itself and those before it.
    Back,
}

/// `softmax(Q K^T / sqrt(width of a head)) V` by heads, then a linear layer.
#[derive(Clone, Debug)]
pub(crate) struct Attention {
    pub(crate) query: Linear,
    pub(crate) key: Linear,
    pub(crate) value: Linear,
    pub(crate) output: Linear,
    pub(crate) heads: usize,
    pub(crate) sight: Sight,
}

impl Attention {
    /// `x` is `[tokens of all captions][width]`; `lengths` tells the tokens of each caption.
    pub(crate) fn apply(&self, x: &[f32], lengths: &[usize], width: usize) -> Vec<f32> {
        let (q, k, v) = (self.query.apply(x), self.key.apply(x), self.value.apply(x));
        let mut mixed = vec![0.0; x.len()];
        let head_width = width / self.heads;
        let scale = 1.0 / (head_width as f32).sqrt();
        let mut shares = Vec::new();
        let mut first = 0;
        for &length in lengths {
            for head in 0..self.heads {
                let column = head * head_width;
                let part = |token: usize| {
                    let start = (first + token) * width + column;
                    start..start + head_width
                };
                for token in 0..length {
                    let seen = match self.sight {
                        Sight::Whole => length,
                        Sight::Back => token + 1,
                    };
                    let query = &q[part(token)];
                    shares.clear();
                    shares.extend((0..seen).map(|other| scale * dot(query, &k[part(other)])));
                    softmax(&mut shares);
                    let target = &mut mixed[part(token)];
                    for (other, &share) in shares.iter().enumerate() {
                        for (sum, value) in target.iter_mut().zip(&v[part(other)]) {
                            *sum += share * value;
                        }
                    }
                }
            }
            first += length;
        }
        self.output.apply(&mixed)
    }
}

fn dot(a: &[f32], b: &[f32]) -> f32 {
    a.iter().zip(b).map(|(a, b)| a * b).sum()
}

/// Less the greatest, so that nothing overflows.
fn softmax(values: &mut [f32]) {
    let greatest = values.iter().copied().fold(f32::NEG_INFINITY, f32::max);
    let mut sum = 0.0;
    for value in values.iter_mut() {
        *value = (*value - greatest).exp();
        sum += *value;
    }
    for value in values {
        *value /= sum;
    }
}

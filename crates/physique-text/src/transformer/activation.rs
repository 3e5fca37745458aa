//! What stands between the two layers of a feed-forward block.

/// Which function.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Activation {
    /// `x/2 (1 + erf(x / sqrt 2))` (Hendrycks and Gimpel, 2016): BERT and its kin.
    Gelu,
    /// `x sigmoid(1.702 x)`: CLIP.
    QuickGelu,
}

impl Activation {
    pub(crate) fn apply(self, values: &mut [f32]) {
        match self {
            Self::Gelu => {
                for x in values {
                    *x *= 0.5 * (1.0 + libm::erff(*x * std::f32::consts::FRAC_1_SQRT_2));
                }
            }
            Self::QuickGelu => {
                for x in values {
                    *x /= 1.0 + (-1.702 * *x).exp();
                }
            }
        }
    }
}

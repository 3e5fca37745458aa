//! What an overlap of two spheres costs.

/// The cost of two spheres that pass through each other by `depth` beyond a tolerance.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub enum Penalty {
    /// `depth^2`: equation 7 of the paper.
    #[default]
    Squared,
    /// `depth`.
    Linear,
}

impl Penalty {
    /// The cost and its derivative by `depth`, which is positive.
    pub fn of(self, depth: f64) -> (f64, f64) {
        match self {
            Self::Squared => (depth * depth, 2.0 * depth),
            Self::Linear => (depth, 1.0),
        }
    }
}

//! Sentence vectors told apart.

use super::Embeddings;
use crate::Error;

/// Takes the mean of the training captions from sentence vectors, and brings them to the size that
/// networks read well.
///
/// Vectors of all-MiniLM-L6-v2 for "waves with the left hand" and "... right hand" differ by a
/// cosine of 0.02; without the mean they lie far apart. What is left has a mean square of 1 over the
/// training captions, so that no caption at all, a row of zeros, is what an average caption says.
#[derive(Clone, Debug, PartialEq)]
pub struct CaptionCentre {
    mean: Vec<f32>,
    factor: f32,
}

impl CaptionCentre {
    /// The centre of training captions.
    ///
    /// # Errors
    /// [`Error::Input`] for vectors a token, no captions, or captions that are all the same.
    pub fn of(captions: &Embeddings) -> Result<Self, Error> {
        let Embeddings {
            batch,
            tokens,
            width,
            ref values,
            ..
        } = *captions;
        if tokens != 1 || batch == 0 || width == 0 || values.len() != batch * width {
            let found = format!("{batch} x {tokens} of {width}");
            return Err(Error::input("Captions", "one vector each", found));
        }
        let mut mean = vec![0.0_f64; width];
        for row in values.chunks_exact(width) {
            for (sum, &value) in mean.iter_mut().zip(row) {
                *sum += f64::from(value) / batch as f64;
            }
        }
        let rows = values.chunks_exact(width);
        let squares = rows.flat_map(|row| {
            let differences = row.iter().zip(&mean);
            differences.map(|(&value, mean)| (f64::from(value) - mean).powi(2))
        });
        let square = squares.sum::<f64>() / values.len() as f64;
        if square < 1e-12 {
            return Err(Error::input("Captions", "different ones", "all the same"));
        }
        let mean = mean.into_iter().map(|mean| mean as f32).collect();
        Self::new(mean, square.sqrt().recip() as f32)
    }

    /// A centre that is known.
    ///
    /// # Errors
    /// [`Error::Input`] for numbers that are not finite, or a factor that is not above 0.
    pub fn new(mean: Vec<f32>, factor: f32) -> Result<Self, Error> {
        if !(factor.is_finite() && factor > 0.0 && mean.iter().all(|mean| mean.is_finite())) {
            let expected = "finite numbers and a factor above 0";
            return Err(Error::input("Centre of captions", expected, factor));
        }
        Ok(Self { mean, factor })
    }

    /// `[width]`.
    pub fn mean(&self) -> &[f32] {
        &self.mean
    }

    /// What centred vectors are multiplied by.
    pub const fn factor(&self) -> f32 {
        self.factor
    }

    /// Centres vectors of other captions.
    ///
    /// # Errors
    /// [`Error::Input`] for vectors of another width.
    pub fn apply(&self, captions: &mut Embeddings) -> Result<(), Error> {
        if captions.width != self.mean.len() {
            let expected = format!("vectors of {} numbers", self.mean.len());
            return Err(Error::input("Captions", expected, captions.width));
        }
        for row in captions.values.chunks_exact_mut(self.mean.len().max(1)) {
            for (value, mean) in row.iter_mut().zip(&self.mean) {
                *value = (*value - mean) * self.factor;
            }
        }
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::CaptionCentre;
    use crate::text::Embeddings;

    fn embeddings(values: Vec<f32>) -> Embeddings {
        let batch = values.len() / 2;
        Embeddings {
            batch,
            tokens: 1,
            width: 2,
            values,
            padding: vec![false; batch],
        }
    }

    #[test]
    fn training_captions_get_mean_0_and_square_1() {
        let mut captions = embeddings(vec![0.9, 0.1, 0.8, 0.3, 0.7, 0.2]);
        let centre = CaptionCentre::of(&captions).unwrap();
        centre.apply(&mut captions).unwrap();
        let sums = [0, 1].map(|column| captions.values.iter().skip(column).step_by(2).sum::<f32>());
        assert!(sums.iter().all(|sum| sum.abs() < 1e-5), "{sums:?}");
        let square = captions
            .values
            .iter()
            .map(|value| value * value)
            .sum::<f32>()
            / 6.0;
        assert!((square - 1.0).abs() < 1e-5, "{square}");
    }

    #[test]
    fn captions_that_are_all_the_same_have_no_centre() {
        assert!(CaptionCentre::of(&embeddings(vec![0.5, 0.5, 0.5, 0.5])).is_err());
        assert!(CaptionCentre::of(&embeddings(Vec::new())).is_err());
        let centre = CaptionCentre::new(vec![0.0; 3], 1.0).unwrap();
        assert!(centre.apply(&mut embeddings(vec![0.0; 4])).is_err());
    }
}

//! The training caption that is nearest to a prompt.

use crate::{Error, TextEncoder};

/// Captions that a model was trained with, to compare prompts with.
///
/// Distances are 1 less the cosine after the mean caption was taken away: without it, "waves with the
/// left hand" and "... right hand" would be all but equal. They go from 0, the same, over 1, nothing
/// in common, to 2.
#[derive(Clone, Debug)]
pub struct CaptionIndex {
    mean: Vec<f32>,
    /// `[captions][width]`, of length 1.
    directions: Vec<f32>,
    width: usize,
}

/// A caption and how far it is.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Nearest {
    /// Number of the caption.
    pub caption: usize,
    /// 0 to 2.
    pub distance: f32,
}

impl CaptionIndex {
    /// Encodes the captions. Of encoders with a vector a token, the mean over tokens is taken.
    ///
    /// # Errors
    /// [`Error::NoCaptions`].
    pub fn new(encoder: &dyn TextEncoder, captions: &[&str]) -> Result<Self, Error> {
        if captions.is_empty() {
            return Err(Error::NoCaptions);
        }
        let width = encoder.width();
        let mut directions = vectors(encoder, captions);
        let mut mean = vec![0.0_f64; width];
        for row in directions.chunks_exact(width) {
            for (sum, value) in mean.iter_mut().zip(row) {
                *sum += f64::from(*value);
            }
        }
        let mean: Vec<f32> = mean
            .iter()
            .map(|sum| (sum / captions.len() as f64) as f32)
            .collect();
        for row in directions.chunks_exact_mut(width) {
            centre(row, &mean);
        }
        Ok(Self {
            mean,
            directions,
            width,
        })
    }

    /// An index that was taken apart by [`Self::mean`] and [`Self::directions`].
    ///
    /// # Errors
    /// [`Error::NoCaptions`] unless there is a row or more of as many numbers as the mean has.
    pub fn from_parts(mean: Vec<f32>, directions: Vec<f32>) -> Result<Self, Error> {
        let width = mean.len();
        if width == 0 || directions.is_empty() || !directions.len().is_multiple_of(width) {
            return Err(Error::NoCaptions);
        }
        Ok(Self {
            mean,
            directions,
            width,
        })
    }

    /// What is taken from every vector, `[width]`.
    pub fn mean(&self) -> &[f32] {
        &self.mean
    }

    /// `[captions][width]`: what is left of each caption, at length 1.
    pub fn directions(&self) -> &[f32] {
        &self.directions
    }

    /// The nearest caption to each prompt; of equally near ones the first.
    pub fn nearest(&self, encoder: &dyn TextEncoder, prompts: &[&str]) -> Vec<Nearest> {
        let mut found = vectors(encoder, prompts);
        let rows = found.chunks_exact_mut(self.width);
        rows.map(|row| {
            centre(row, &self.mean);
            let captions = self.directions.chunks_exact(self.width).enumerate();
            let start = Nearest {
                caption: 0,
                distance: f32::INFINITY,
            };
            captions.fold(start, |best, (caption, direction)| {
                let cosine: f32 = row.iter().zip(direction).map(|(a, b)| a * b).sum();
                let distance = 1.0 - cosine;
                match distance < best.distance {
                    true => Nearest { caption, distance },
                    false => best,
                }
            })
        })
        .collect()
    }

    /// The distance that 95 in 100 of these prompts stay below: of held-out wordings of what a model
    /// knows, it tells from where on a prompt is about something else.
    pub fn usual_distance(&self, encoder: &dyn TextEncoder, prompts: &[&str]) -> Option<f32> {
        let nearest = self.nearest(encoder, prompts);
        let mut distances: Vec<f32> = nearest.iter().map(|nearest| nearest.distance).collect();
        distances.sort_by(f32::total_cmp);
        distances
            .get((distances.len() * 95).div_ceil(100).saturating_sub(1))
            .copied()
    }
}

/// A vector a caption.
fn vectors(encoder: &dyn TextEncoder, captions: &[&str]) -> Vec<f32> {
    let embeddings = encoder.encode(captions);
    if embeddings.tokens() == 1 {
        return embeddings.values().to_vec();
    }
    let (tokens, width) = (embeddings.tokens(), embeddings.width());
    let masks = embeddings.mask().chunks_exact(tokens.max(1));
    let means = embeddings.rows().zip(masks).flat_map(|(rows, mask)| {
        let mut mean = vec![0.0; width];
        for row in rows.chunks_exact(width) {
            for (sum, value) in mean.iter_mut().zip(row) {
                *sum += value;
            }
        }
        let count = mask.iter().filter(|&&is_token| is_token).count().max(1);
        mean.iter()
            .map(|sum| sum / count as f32)
            .collect::<Vec<_>>()
    });
    means.collect()
}

/// Takes the mean away, and leaves a direction of length 1; the mean itself has none.
fn centre(row: &mut [f32], mean: &[f32]) {
    for (value, mean) in row.iter_mut().zip(mean) {
        *value -= mean;
    }
    let length = row.iter().map(|x| x * x).sum::<f32>().sqrt();
    if length > 1e-6 {
        for value in row {
            *value /= length;
        }
    }
}

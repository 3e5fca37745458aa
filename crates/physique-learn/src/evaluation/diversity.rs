//! Distances of motions from each other.

use super::points::distance;
use super::{NumpyRandom, Points};
use crate::Error;

/// Mean distance between `pairs` points and `pairs` others, drawn apart from each other without
/// repetition; published with 300. A point may meet itself.
///
/// # Errors
/// [`Error::Input`] when there are fewer points than pairs.
pub fn diversity(points: &Points, pairs: usize, random: &mut NumpyRandom) -> Result<f64, Error> {
    multimodality(std::slice::from_ref(points), pairs, random)
}

/// The same within each caption's motions, with the same `pairs` drawn for all captions; published
/// with 10 pairs of 30 motions for 100 captions.
///
/// # Errors
/// [`Error::Input`] when captions have different numbers of motions, or fewer than pairs.
pub fn multimodality(
    motions_by_caption: &[Points],
    pairs: usize,
    random: &mut NumpyRandom,
) -> Result<f64, Error> {
    let count = motions_by_caption.first().map_or(0, Points::len);
    if let Some(other) = motions_by_caption
        .iter()
        .find(|points| points.len() != count)
    {
        let expected = format!("{count} motions for each caption");
        return Err(Error::input("Embeddings", expected, other.len()));
    }
    if pairs == 0 || count < pairs {
        let expected = format!("at least {} points", pairs.max(1));
        return Err(Error::input("Embeddings", expected, count));
    }
    let first = random.choice(count, pairs);
    let second = random.choice(count, pairs);
    let sums = motions_by_caption.iter().map(|points| {
        let pairs = first.iter().zip(&second);
        pairs
            .map(|(&first, &second)| distance(points.point(first), points.point(second)))
            .sum::<f64>()
    });
    Ok(sums.sum::<f64>() / (pairs * motions_by_caption.len()) as f64)
}

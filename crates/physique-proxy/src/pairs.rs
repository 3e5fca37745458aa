//! Which spheres must not intersect.

use crate::Error;

/// A sorted list of pairs `(i, j)` with `i < j`: the spheres that a self-intersection loss compares.
///
/// The paper leaves out spheres of one joint and those that touch in nearly every pose, because
/// neighbours on the body always overlap; [`Pairs::all`] is for the ablation.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Pairs {
    sphere_count: usize,
    pairs: Vec<(u16, u16)>,
}

impl Pairs {
    /// Most spheres that a body may have: indices are 16 bits wide.
    pub const MOST_SPHERES: usize = 1 << 16;

    /// Pairs of `sphere_count` spheres, in any order; doubles count once.
    ///
    /// # Errors
    /// [`Error::Pair`] for a sphere with itself or one that is not there; [`Error::SphereBody`] for
    /// more than [`Pairs::MOST_SPHERES`].
    pub fn new(
        sphere_count: usize,
        pairs: impl IntoIterator<Item = (usize, usize)>,
    ) -> Result<Self, Error> {
        if sphere_count > Self::MOST_SPHERES {
            return Err(Error::SphereBody {
                expected: "at most 65,536 spheres",
                found: sphere_count.to_string(),
            });
        }
        let ordered = pairs.into_iter().map(|(first, second)| {
            if first == second || first.max(second) >= sphere_count {
                return Err(Error::Pair {
                    first,
                    second,
                    spheres: sphere_count,
                });
            }
            // Below 65,536, so that nothing is lost.
            Ok((first.min(second) as u16, first.max(second) as u16))
        });
        let mut pairs = ordered.collect::<Result<Vec<_>, _>>()?;
        pairs.sort_unstable();
        pairs.dedup();
        Ok(Self {
            sphere_count,
            pairs,
        })
    }

    /// Every two of `sphere_count` spheres.
    ///
    /// # Errors
    /// As [`Pairs::new`].
    pub fn all(sphere_count: usize) -> Result<Self, Error> {
        let pairs = (0..sphere_count).flat_map(|j| (0..j).map(move |i| (i, j)));
        Self::new(sphere_count, pairs)
    }

    /// The pairs that `keep(i, j)` keeps.
    #[must_use]
    pub fn filtered(&self, mut keep: impl FnMut(usize, usize) -> bool) -> Self {
        let kept = |&(i, j): &(u16, u16)| keep(i.into(), j.into());
        Self {
            sphere_count: self.sphere_count,
            pairs: self.pairs.iter().copied().filter(kept).collect(),
        }
    }

    /// Number of spheres that the pairs were chosen among.
    pub fn sphere_count(&self) -> usize {
        self.sphere_count
    }

    /// Number of pairs.
    pub fn len(&self) -> usize {
        self.pairs.len()
    }

    /// Whether no two spheres are compared.
    pub fn is_empty(&self) -> bool {
        self.pairs.is_empty()
    }

    /// The pairs in order.
    pub fn iter(&self) -> impl ExactSizeIterator<Item = (usize, usize)> + Clone + '_ {
        self.pairs.iter().map(|&(i, j)| (i.into(), j.into()))
    }
}

#[cfg(test)]
mod tests {
    use super::Pairs;

    #[test]
    fn are_ordered_without_doubles() {
        let pairs = Pairs::new(4, [(3, 1), (0, 2), (1, 3)]).expect("in range");
        assert_eq!(pairs.iter().collect::<Vec<_>>(), [(0, 2), (1, 3)]);
    }

    #[test]
    fn all_are_all() {
        let pairs = Pairs::all(5).expect("few");
        assert_eq!(pairs.len(), 10);
        assert!(pairs.iter().all(|(i, j)| i < j && j < 5));
        assert_eq!(pairs.filtered(|i, _| i == 0).len(), 4);
    }

    #[test]
    fn impossible_pairs_are_refused() {
        for pair in [(1, 1), (0, 4), (7, 0)] {
            let message = Pairs::new(4, [pair]).expect_err("no such pair").to_string();
            assert!(
                message.contains(&format!("({}, {})", pair.0, pair.1)),
                "{message}"
            );
        }
        assert!(Pairs::all(Pairs::MOST_SPHERES + 1).is_err());
    }
}

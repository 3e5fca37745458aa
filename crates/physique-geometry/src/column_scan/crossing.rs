/// A place where a line crosses a triangle: depth, triangle and direction in one word that sorts by
/// depth, then by triangle.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Default)]
pub(crate) struct Crossing(u64);

/// Makes depths positive: they start near 0 but may round to just below.
const DEPTH_BIAS: i32 = 1 << 30;

impl Crossing {
    /// `depth` in depth units, below 2^30 (the lattice's limits keep it below 2^28).
    #[inline]
    pub(crate) fn new(depth: i32, triangle: u32, leaving: bool) -> Self {
        // Wraps for lines that miss a steep triangle: the raster drops those.
        let high = u64::from(depth.wrapping_add(DEPTH_BIAS) as u32);
        Self(high << 32 | u64::from(triangle) << 1 | u64::from(leaving))
    }

    #[inline]
    pub(crate) fn depth(self) -> i64 {
        (self.0 >> 32) as i64 - i64::from(DEPTH_BIAS)
    }

    #[inline]
    pub(crate) fn triangle(self) -> u32 {
        (self.0 as u32) >> 1
    }

    /// Whether the line comes out of the surface here.
    #[inline]
    pub(crate) fn leaving(self) -> bool {
        self.0 & 1 == 1
    }

    /// By how much the winding number changes here.
    #[inline]
    pub(crate) fn step(self) -> i64 {
        1 - 2 * (self.0 & 1) as i64
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn sorts_by_depth_then_triangle_and_keeps_its_parts() {
        let crossings = [
            (-3, 9, true),
            (0, 1, false),
            (0, 2, true),
            (1 << 28, 0, false),
        ];
        let packed =
            crossings.map(|(depth, triangle, leaving)| Crossing::new(depth, triangle, leaving));
        assert!(packed.is_sorted());
        for (&(depth, triangle, leaving), packed) in crossings.iter().zip(packed) {
            assert_eq!(packed.depth(), i64::from(depth));
            assert_eq!((packed.triangle(), packed.leaving()), (triangle, leaving));
            assert_eq!(packed.step(), if leaving { -1 } else { 1 });
        }
    }

    #[test]
    fn keeps_the_highest_triangle() {
        let last = (1u32 << 31) - 1;
        assert_eq!(Crossing::new(0, last, true).triangle(), last);
    }
}

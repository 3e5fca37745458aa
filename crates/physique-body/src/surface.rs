//! Whether a mesh is the closed surface that volume and self-intersection ask for.

use std::collections::HashMap;

/// How the triangles of a mesh hang together.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Surface {
    /// Sides of triangles that do not run once each way. 0 in a closed, oriented surface; its
    /// volume is then meaningful.
    pub open_edges: usize,
    /// Parts without a common vertex: 1, or more where eyeballs or clothes lie apart. What one
    /// part covers of another counts as self-intersection.
    pub components: usize,
}

impl Surface {
    /// Looks at every side of every triangle. Cost: a few milliseconds for 14,000 triangles.
    pub(crate) fn of(triangles: &[[u32; 3]]) -> Self {
        // Runs from the lower to the higher vertex, less runs back.
        let mut balance: HashMap<(u32, u32), (i32, u32)> = HashMap::new();
        let mut parts = Parts::default();
        for &[a, b, c] in triangles {
            for (from, to) in [(a, b), (b, c), (c, a)] {
                let entry = balance.entry((from.min(to), from.max(to))).or_default();
                entry.0 += if from < to { 1 } else { -1 };
                entry.1 += 1;
                parts.join(from, to);
            }
        }
        let closed = |&&(balance, count): &&(i32, u32)| balance == 0 && count == 2;
        Self {
            open_edges: balance.len() - balance.values().filter(closed).count(),
            components: parts.count(),
        }
    }
}

/// Disjoint sets of vertices (Galler and Fischer, 1964).
#[derive(Default)]
struct Parts {
    above: HashMap<u32, u32>,
}

impl Parts {
    fn top(&mut self, mut vertex: u32) -> u32 {
        loop {
            let above = *self.above.entry(vertex).or_insert(vertex);
            if above == vertex {
                return vertex;
            }
            // Halve the path on the way up.
            let next = self.above.get(&above).copied().unwrap_or(above);
            self.above.insert(vertex, next);
            vertex = next;
        }
    }

    fn join(&mut self, a: u32, b: u32) {
        let (a, b) = (self.top(a), self.top(b));
        self.above.insert(a, b);
    }

    fn count(&self) -> usize {
        self.above
            .iter()
            .filter(|(vertex, above)| vertex == above)
            .count()
    }
}

#[cfg(test)]
mod tests {
    use super::Surface;

    const TETRAHEDRON: [[u32; 3]; 4] = [[0, 2, 1], [0, 1, 3], [1, 2, 3], [2, 0, 3]];

    #[test]
    fn closed_open_and_apart() {
        let surface = |triangles: &[[u32; 3]]| {
            let surface = Surface::of(triangles);
            (surface.open_edges, surface.components)
        };
        assert_eq!(surface(&TETRAHEDRON), (0, 1));
        assert_eq!(surface(&TETRAHEDRON[..3]), (3, 1));
        let apart = TETRAHEDRON.map(|triangle| triangle.map(|vertex| vertex + 10));
        assert_eq!(surface(&[TETRAHEDRON, apart].concat()), (0, 2));
        let [first, rest @ ..] = TETRAHEDRON;
        let turned = [&[[first[0], first[2], first[1]]], &rest[..]].concat();
        assert_eq!(surface(&turned), (3, 1));
    }
}

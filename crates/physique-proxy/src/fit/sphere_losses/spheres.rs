//! Spheres side by side.

/// One number a sphere, in vectors of 16; what is beyond the last sphere is far away.
pub(crate) const LANES: usize = 16;

/// Spheres of one body, structure of arrays, padded by spheres that nothing is near to.
#[derive(Debug, Default)]
pub(crate) struct Spheres {
    count: usize,
    pub(super) x: Vec<[f32; LANES]>,
    pub(super) y: Vec<[f32; LANES]>,
    pub(super) z: Vec<[f32; LANES]>,
    pub(super) r: Vec<[f32; LANES]>,
}

/// Where padding lies: far, but its square is finite.
const FAR: f32 = 1e9;

impl Spheres {
    /// From `[log r, x, y, z]` a sphere.
    pub(crate) fn set(&mut self, outputs: &[f32]) {
        let rows = outputs.as_chunks::<4>().0;
        self.count = rows.len();
        let arrays = [&mut self.x, &mut self.y, &mut self.z, &mut self.r];
        let padding = [FAR, FAR, FAR, 0.0];
        for (array, value) in arrays.into_iter().zip(padding) {
            array.clear();
            array.resize(self.count.div_ceil(LANES), [value; LANES]);
        }
        for (index, &[log_radius, x, y, z]) in rows.iter().enumerate() {
            let (group, lane) = (index / LANES, index % LANES);
            self.x[group][lane] = x;
            self.y[group][lane] = y;
            self.z[group][lane] = z;
            self.r[group][lane] = log_radius.exp();
        }
    }

    pub(crate) fn len(&self) -> usize {
        self.count
    }

    /// Radii in order, padding left out.
    pub(crate) fn radii(&self) -> impl Iterator<Item = f32> + '_ {
        self.r.as_flattened().iter().copied().take(self.count)
    }

    /// x, y, z and radius of one sphere.
    #[inline(always)]
    pub(super) fn get(&self, index: usize) -> [f32; 4] {
        let (group, lane) = (index / LANES, index % LANES);
        [
            self.x[group][lane],
            self.y[group][lane],
            self.z[group][lane],
            self.r[group][lane],
        ]
    }
}

//! The made-up weights and inputs that the vectors were made with.

use physique_files::npz::{Archive, ArrayLimits};
use physique_learn::parameters::Parameters;

/// A number in [-1, 1) from a stream and an index.
fn number(stream: u64, index: u64) -> f64 {
    let mut z = (stream + 1)
        .wrapping_mul(0x9E37_79B9_7F4A_7C15)
        .wrapping_add(index.wrapping_mul(0xD1B5_4A32_D192_ED03));
    z = (z ^ (z >> 30)).wrapping_mul(0xBF58_476D_1CE4_E5B9);
    z = (z ^ (z >> 27)).wrapping_mul(0x94D0_49BB_1331_11EB);
    z ^= z >> 31;
    (z >> 40) as f64 / f64::from(1 << 23) - 1.0
}

/// Inputs of a phase.
pub(crate) fn input(count: usize, phase: f64) -> Vec<f32> {
    let stream = 1000 + (100.0 * phase).round() as u64;
    (0..count as u64)
        .map(|index| number(stream, index) as f32)
        .collect()
}

/// Fills parameters by their place in the order of names; `is_scale` tells those of layer norms.
pub(crate) fn fill(parameters: &mut Parameters, is_scale: impl Fn(&str) -> bool) {
    for (stream, (name, array)) in parameters.arrays.iter_mut().enumerate() {
        let inputs: usize = array.shape.iter().skip(1).product();
        let spread = 3.0_f64.sqrt() / (inputs as f64).sqrt();
        let value = |index: usize| {
            let number = number(stream as u64, index as u64);
            match array.shape.len() {
                1 if is_scale(name) => 1.0 + 0.1 * number,
                1 => 0.1 * number,
                _ => spread * number,
            }
        };
        array.values = (0..array.values.len())
            .map(|index| value(index) as f32)
            .collect();
    }
}

/// The arrays of a fixture.
pub(crate) struct Vectors(Archive);

impl Vectors {
    pub(crate) fn open(bytes: &[u8]) -> Self {
        let limits = ArrayLimits::default();
        Self(Archive::open(bytes.to_vec(), limits).expect("a sound archive"))
    }

    pub(crate) fn f32(&mut self, key: &str) -> Vec<f32> {
        self.0.array(key).expect(key).to_f32().expect(key)
    }

    pub(crate) fn f64(&mut self, key: &str) -> Vec<f64> {
        self.0.array(key).expect(key).to_f64().expect(key)
    }
}

/// `[batch][rows][columns]` to `[batch][columns][rows]`.
pub(crate) fn swapped(values: &[f32], [batch, rows, columns]: [usize; 3]) -> Vec<f32> {
    let at = |index: usize| {
        let (motion, rest) = (index / (rows * columns), index % (rows * columns));
        let (column, row) = (rest / rows, rest % rows);
        values[(motion * rows + row) * columns + column]
    };
    (0..batch * rows * columns).map(at).collect()
}

/// The largest difference.
pub(crate) fn difference(found: &[f32], expected: &[f32]) -> f32 {
    assert_eq!(found.len(), expected.len());
    let differences = found.iter().zip(expected).map(|(a, b)| (a - b).abs());
    // NaN must not pass as small.
    differences.fold(
        0.0,
        |most, difference| {
            if difference <= most { most } else { difference }
        },
    )
}

#[test]
fn numbers_are_those_of_the_vectors() {
    // As written down beside the vectors.
    assert!((number(0, 0) - 0.766_621_589_660_644_5).abs() < 1e-14);
    assert!((number(1100, 4) + 0.722_205_400_466_919).abs() < 1e-14);
}

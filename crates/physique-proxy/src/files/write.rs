//! Writing proxies.

use std::collections::HashMap;
use std::path::Path;

use half::f16;
use physique_body::Joint;
use physique_files::write_file;
use safetensors::{Dtype, serialize, tensor::TensorView};

use super::{BLEND_WEIGHTS, CHOSEN, FORMAT, JOINTS, SPHERES, STATISTICS};
use crate::regressor::Network;
use crate::{Error, PairChoice, SphereProxy};

/// How exactly parameters are stored.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Precision {
    /// To the bit.
    #[default]
    Exact,
    /// In 16-bit floats.
    Half,
    /// Directions of weight-normalised rows in 8 bits, since their length means nothing; all else
    /// in 16-bit floats.
    Compact,
}

/// Writes a proxy as `.safetensors`, whole or not at all.
///
/// # Errors
/// [`Error::File`].
pub fn write_proxy(path: &Path, proxy: &SphereProxy, precision: Precision) -> Result<(), Error> {
    let name = path.display().to_string();
    Ok(write_file(path, &bytes_of(&name, proxy, precision)?)?)
}

/// The bytes that [`write_proxy`] writes; the same for the same proxy.
///
/// # Errors
/// None in practice: a proxy has nothing that the format cannot hold.
pub fn proxy_bytes(proxy: &SphereProxy, precision: Precision) -> Result<Vec<u8>, Error> {
    bytes_of("proxy", proxy, precision)
}

fn bytes_of(name: &str, proxy: &SphereProxy, precision: Precision) -> Result<Vec<u8>, Error> {
    let mut arrays = Vec::new();
    add_network(
        &mut arrays,
        SPHERES,
        proxy.sphere_regressor().network(),
        precision,
    );
    add_network(
        &mut arrays,
        JOINTS,
        proxy.joint_regressor().network(),
        precision,
    );

    let spheres = proxy.sphere_count();
    let mut weights = vec![0.0_f32; spheres * Joint::COUNT];
    for (row, entries) in weights.chunks_mut(Joint::COUNT).zip(proxy.blend_weights()) {
        for &(joint, weight) in entries {
            row[usize::from(joint)] += weight;
        }
    }
    arrays.push(StoredArray::floats(
        BLEND_WEIGHTS,
        vec![spheres, Joint::COUNT],
        &weights,
    ));
    let mut poses = 0;
    match proxy.pair_choice() {
        PairChoice::Statistics(statistics) => {
            poses = statistics.poses();
            let counts = statistics.counts();
            arrays.push(StoredArray {
                name: STATISTICS.into(),
                shape: vec![counts.len()],
                kind: Dtype::U32,
                bytes: counts
                    .iter()
                    .flat_map(|count| count.to_le_bytes())
                    .collect(),
            });
        }
        PairChoice::Chosen(pairs) => arrays.push(StoredArray {
            name: CHOSEN.into(),
            shape: vec![pairs.len(), 2],
            kind: Dtype::U32,
            bytes: pairs
                .iter()
                .flat_map(|(i, j)| [i as u32, j as u32])
                .flat_map(u32::to_le_bytes)
                .collect(),
        }),
    }

    // One entry of the header, since the order of several is not fixed by the library.
    let mut notes: Vec<String> = vec![FORMAT.to_owned(), format!("poses: {poses}")];
    let told = proxy.notes().iter();
    notes.extend(told.map(|(name, text)| format!("{name}: {}", text.replace('\n', " "))));
    let metadata = HashMap::from([("proxy".to_owned(), notes.join("\n"))]);

    let refuse = |error: safetensors::SafeTensorError| Error::ProxyFile {
        file: name.to_owned(),
        place: "the whole file".into(),
        expected: "arrays that can be written".into(),
        found: error.to_string(),
    };
    let views = arrays
        .iter()
        .map(|array| {
            let view = TensorView::new(array.kind, array.shape.clone(), &array.bytes);
            Ok((array.name.as_str(), view.map_err(refuse)?))
        })
        .collect::<Result<Vec<_>, Error>>()?;
    serialize(views, Some(metadata)).map_err(refuse)
}

struct StoredArray {
    name: String,
    shape: Vec<usize>,
    kind: Dtype,
    bytes: Vec<u8>,
}

impl StoredArray {
    fn floats(name: &str, shape: Vec<usize>, values: &[f32]) -> Self {
        Self {
            name: name.to_owned(),
            shape,
            kind: Dtype::F32,
            bytes: values
                .iter()
                .flat_map(|value| value.to_le_bytes())
                .collect(),
        }
    }
}

fn add_network(
    arrays: &mut Vec<StoredArray>,
    prefix: &str,
    network: &Network,
    precision: Precision,
) {
    for parameter in network.layout().parameters() {
        let values = &network.parameters()[parameter.range.clone()];
        let name = format!("{prefix}{}", parameter.name);
        let shape = parameter.shape.clone();
        let direction = parameter.name.ends_with("weight_v");
        arrays.push(match precision {
            Precision::Exact => StoredArray::floats(&name, shape, values),
            Precision::Compact if direction => StoredArray {
                name,
                kind: Dtype::I8,
                bytes: directions(values, shape.last().copied().unwrap_or(1)),
                shape,
            },
            Precision::Half | Precision::Compact => StoredArray {
                name,
                shape,
                kind: Dtype::F16,
                bytes: values
                    .iter()
                    .flat_map(|&value| f16::from_f32(value).to_le_bytes())
                    .collect(),
            },
        });
    }
}

/// Rows in 8 bits, each as long as the range allows.
fn directions(values: &[f32], width: usize) -> Vec<u8> {
    let quantised = values.chunks(width.max(1)).flat_map(|row| {
        let most = row
            .iter()
            .fold(0.0_f32, |most, value| most.max(value.abs()));
        let scale = if most > 0.0 { 127.0 / most } else { 0.0 };
        row.iter().map(move |value| (value * scale).round() as i8)
    });
    quantised.map(|value| value.to_le_bytes()[0]).collect()
}

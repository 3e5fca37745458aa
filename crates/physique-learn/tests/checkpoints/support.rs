//! What the fixtures hold.

use std::path::{Path, PathBuf};

use burn::tensor::{Device, Tensor, TensorData};
use physique_files::npz::{Archive, ArrayLimits};
use physique_learn::layers::Dropout;
use physique_learn::mdm::{Condition, Mdm, MdmQuery};

pub(crate) fn fixture(name: &str) -> PathBuf {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/fixtures/checkpoints");
    folder.join(name)
}

/// Array of `expected.npz`.
pub(crate) fn expected<const D: usize>(key: &str) -> Tensor<D> {
    array("expected.npz", key)
}

pub(crate) fn array<const D: usize>(file: &str, key: &str) -> Tensor<D> {
    let bytes = std::fs::read(fixture(file)).expect("a fixture");
    let mut archive = Archive::open(bytes, ArrayLimits::default()).expect("sound");
    let array = archive.array(key).expect(key);
    let data = TensorData::new(array.to_f32().expect(key), array.shape().to_vec());
    Tensor::from_data(data, &Device::flex())
}

/// Largest difference from what PyTorch's own transformer predicted.
pub(crate) fn error(model: &Mdm) -> f32 {
    let condition = Condition::Text {
        tokens: expected::<2>("text").unsqueeze_dim(1),
        padding: None,
    };
    let query = MdmQuery {
        noisy: expected("x"),
        steps: &[3, 41],
        condition: &condition,
        conditioned: None,
        lengths: None,
        context: None,
    };
    let predicted = model.forward(query, &Dropout::none()).expect("it fits");
    let error = (predicted - expected::<3>("predicted")).abs().max();
    error.into_scalar::<f32>()
}

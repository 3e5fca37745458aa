//! Checkpoints that PyTorch wrote, in every layout that published ones have
//! (`tools/checkpoints/build.py` makes them, with made-up numbers).

use std::path::{Path, PathBuf};

use burn::module::Module;
use burn::tensor::{Device, Tensor, TensorData};
use physique_files::npz::{Archive, ArrayLimits};
use physique_learn::checkpoint::{
    CheckpointLimits, Precision, TorchCheckpoint, read_safetensors, write_safetensors,
};
use physique_learn::layers::Dropout;
use physique_learn::mdm::{
    Condition, ConditionKind, Mdm, MdmConfig, MdmDescription, MdmFolder, MdmQuery,
    PublishedArguments, StartingNetwork, from_parameters, parameters_of, read_published,
};
use physique_motion::features::{FeatureSkeleton, FeatureStatistics};

fn fixture(name: &str) -> PathBuf {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/fixtures/checkpoints");
    folder.join(name)
}

/// Array of `expected.npz`.
fn expected<const D: usize>(key: &str) -> Tensor<D> {
    let bytes = std::fs::read(fixture("expected.npz")).expect("a fixture");
    let mut archive = Archive::open(bytes, ArrayLimits::default()).expect("sound");
    let array = archive.array(key).expect(key);
    let data = TensorData::new(array.to_f32().expect(key), array.shape().to_vec());
    Tensor::from_data(data, &Device::flex())
}

/// Largest difference from what PyTorch's own transformer predicted.
fn error(model: &Mdm) -> f32 {
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
    };
    let predicted = model.forward(query, &Dropout::none()).expect("it fits");
    let error = (predicted - expected::<3>("predicted")).abs().max();
    error.into_scalar::<f32>()
}

#[test]
fn every_published_layout_is_read() {
    for name in [
        "flat.pt",
        "legacy.pt",
        "with_clip.pt",
        "without_tables.pt",
        "parameters.pt",
        "average.pt",
    ] {
        let read = read_published(
            &fixture(name),
            &CheckpointLimits::default(),
            &Device::flex(),
        );
        let (model, arguments) = read.unwrap_or_else(|problem| panic!("{name}: {problem}"));
        assert_eq!(arguments.diffusion_steps, 50);
        let config = model.config();
        let sizes = [
            config.columns,
            config.width,
            config.layers,
            config.feed_forward,
        ];
        assert_eq!(sizes, [6, 8, 2, 12], "{name}");
        let error = error(&model);
        assert!(error < 2e-6, "{name}: {error}");
    }
}

/// Another network of this shape begins where the published one ended.
#[test]
fn training_can_start_from_a_published_file() {
    let (path, limits) = (fixture("average.pt"), CheckpointLimits::default());
    let start = StartingNetwork::read(&path, &limits, &Device::flex()).expect("sound");
    assert_eq!((start.diffusion_steps, start.signal), (50, 1.0));
    assert_eq!(start.text_encoder.as_deref(), Some("CLIP"));
    assert_eq!(start.origin.path, path.display().to_string());
    let config = MdmConfig {
        dropout: 0.3,
        ..start.network.config().clone()
    };
    let device = Device::flex().autodiff();
    let network = start.network(&config, &device).expect("of this shape");
    assert_eq!(network.config().dropout, 0.3);
    assert!(error(&network.valid()) < 2e-6);
    let other = MdmConfig {
        layers: 3,
        ..config
    };
    let told = start.network(&other, &device).expect_err("deeper");
    let told = told.to_string();
    assert!(
        told.contains("average.pt, the network's layers: expected 3") && told.contains("found 2"),
        "{told}"
    );
}

/// The model beside the average is another one: which of them is read is no accident.
#[test]
fn the_model_beside_the_average_is_there_for_those_who_ask() {
    let limits = CheckpointLimits::default();
    let file = TorchCheckpoint::open(&fixture("average.pt"), &limits).expect("sound");
    assert_eq!(file.keys(), ["model", "model_avg"]);
    let parameters = file.state_dictionary(Some("model")).expect("it is there");
    let arguments = PublishedArguments::default();
    let model = from_parameters(parameters, &arguments, &Device::flex()).expect("whole");
    assert!(error(&model) > 0.1);
    let problem = file
        .state_dictionary(Some("modl"))
        .expect_err("no such key");
    let told = problem.to_string();
    assert!(
        told.contains("`modl`") && told.contains("`model`, `model_avg`"),
        "{told}"
    );
}

#[test]
fn wrong_names_are_all_told() {
    let limits = CheckpointLimits::default();
    let read = read_published(&fixture("misnamed.pt"), &limits, &Device::flex());
    let told = read.expect_err("misnamed").to_string();
    // Without the layer's weight it looks like a model without captions.
    assert!(
        told.contains("misnamed.pt: expected exactly those of MDM; missing: none"),
        "{told}"
    );
    assert!(
        told.ends_with("not known: `embed_text.bias`, `embed_txt.weight`."),
        "{told}"
    );
}

#[test]
fn wrong_shapes_are_told() {
    let limits = CheckpointLimits::default();
    let file = TorchCheckpoint::open(&fixture("flat.pt"), &limits).expect("sound");
    let mut parameters = file.state_dictionary(None).expect("flat");
    let name = "seqTransEncoder.layers.1.linear2.weight";
    let array = parameters.arrays.get_mut(name).expect(name);
    array.shape = vec![12, 8];
    let arguments = PublishedArguments::default();
    let told = from_parameters(parameters, &arguments, &Device::flex());
    let told = told.expect_err("transposed").to_string();
    assert!(
        told.contains(name) && told.contains("[8, 12], found [12, 8]"),
        "{told}"
    );
}

#[test]
fn broken_files_are_refused() {
    let folder = tempfile::tempdir().expect("a folder");
    let bytes = std::fs::read(fixture("flat.pt")).expect("a fixture");
    let path = folder.path().join("model.pt");
    std::fs::copy(fixture("args.json"), folder.path().join("args.json")).expect("copied");
    let limits = CheckpointLimits::default();
    for length in (0..bytes.len()).step_by(509) {
        std::fs::write(&path, &bytes[..length]).expect("written");
        let read = read_published(&path, &limits, &Device::flex());
        assert!(read.is_err(), "{length} bytes of {}", bytes.len());
    }
    // A limit holds for the numbers, too.
    std::fs::write(&path, &bytes).expect("written");
    let small = CheckpointLimits {
        bytes: 17_000,
        ..limits
    };
    assert!(read_published(&path, &small, &Device::flex()).is_ok());
    let smaller = CheckpointLimits {
        bytes: 4_000,
        ..limits
    };
    assert!(read_published(&path, &smaller, &Device::flex()).is_err());
}

#[test]
fn our_own_files_keep_every_bit() {
    let folder = tempfile::tempdir().expect("a folder");
    let path = folder.path().join("model.safetensors");
    let limits = CheckpointLimits::default();
    let read = read_published(&fixture("flat.pt"), &limits, &Device::flex());
    let (model, arguments) = read.expect("sound");
    let parameters = parameters_of(&model, "a test").expect("readable");
    let words = [("step".to_owned(), "7".to_owned())].into();
    write_safetensors(&path, &parameters, words, Precision::Single).expect("written");
    let (again, words) = read_safetensors(&path, &limits).expect("just written");
    assert_eq!(again.arrays, parameters.arrays);
    assert_eq!(words["step"], "7");
    let model = from_parameters(again, &arguments, &Device::flex()).expect("whole");
    assert!(error(&model) < 2e-6);
}

#[test]
fn a_folder_of_ours_is_all_that_is_needed() {
    let skeleton = FeatureSkeleton::Kit;
    let columns = skeleton.feature_count();
    let config = MdmConfig {
        columns,
        width: 8,
        layers: 1,
        heads: 2,
        feed_forward: 6,
        condition: ConditionKind::Sentence { width: 3 },
        ..MdmConfig::default()
    };
    let mean = (0..columns).map(|column| column as f32 * 0.1).collect();
    let deviation = (0..columns).map(|column| 1.0 + column as f32).collect();
    let written = MdmFolder {
        network: Mdm::new(&config, 4, &Device::flex()).expect("possible"),
        statistics: FeatureStatistics::new(skeleton, mean, deviation).expect("possible"),
        captions: None,
        description: MdmDescription {
            frame_rate: 12.5,
            longest_frames: Some(120),
            diffusion_steps: 50,
            signal: 0.09,
            text_encoder: "a test".into(),
            notes: [("licence".to_owned(), "CC0".to_owned())].into(),
        },
    };
    let root = tempfile::tempdir().expect("a folder");
    let folder = root.path().join("new/folder");
    written.write(&folder, Precision::Single).expect("written");
    let limits = CheckpointLimits::default();
    let read = || MdmFolder::read(&folder, &limits, &Device::flex());
    let found = read().expect("just written");
    assert_eq!(found.network.config(), &config);
    assert_eq!(found.statistics, written.statistics);
    assert_eq!(found.description, written.description);
    let parameters = |folder: &MdmFolder| {
        let parameters = parameters_of(&folder.network, "").expect("readable");
        parameters.arrays
    };
    assert_eq!(parameters(&found), parameters(&written));

    // Numbers of another network, another format, half a file.
    let path = folder.join("config.json");
    let text = std::fs::read_to_string(&path).expect("text");
    let other = text.replace("\"layers\": 1", "\"layers\": 2");
    std::fs::write(&path, other).expect("written");
    let told = read().expect_err("a layer is missing").to_string();
    assert!(
        told.contains("`seqTransEncoder.layers.1.linear1.bias`"),
        "{told}"
    );
    std::fs::write(&path, text.replace("mdm 1", "mdm 2")).expect("written");
    let told = read().expect_err("a later format").to_string();
    assert!(
        told.contains("`format`") && told.contains("mdm 2"),
        "{told}"
    );
    std::fs::write(&path, &text[..text.len() / 2]).expect("written");
    assert!(read().is_err());
}

//! Published transformers: every layout, and files that lie.

use burn::module::Module;
use burn::tensor::Device;
use physique_learn::checkpoint::{CheckpointLimits, TorchCheckpoint};
use physique_learn::mdm::{
    MdmConfig, PublishedArguments, StartingNetwork, from_parameters, read_published,
};

use crate::support::{error, fixture};

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

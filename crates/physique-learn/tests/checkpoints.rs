//! Checkpoints that PyTorch wrote, in every layout that published ones have
//! (`tools/checkpoints/build.py` makes them, with made-up numbers).

use std::path::{Path, PathBuf};

use burn::module::Module;
use burn::tensor::{Bool, Device, Tensor, TensorData};
use physique_files::npz::{Archive, ArrayLimits};
use physique_learn::checkpoint::{
    CheckpointLimits, Precision, TorchCheckpoint, read_safetensors, write_safetensors,
};
use physique_learn::diffusion::{Method, Sampler, Schedule};
use physique_learn::layers::Dropout;
use physique_learn::mdm::{
    Architecture, Condition, ConditionKind, GenerateRequest, Mdm, MdmConfig, MdmDescription,
    MdmFolder, MdmQuery, PUBLISHED_NAMES, PlannerConfig, PublishedArguments, StartingNetwork,
    from_parameters, generate, parameters_of, plan_motions, read_published,
};
use physique_motion::features::{FeatureSkeleton, FeatureStatistics};

fn fixture(name: &str) -> PathBuf {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/fixtures/checkpoints");
    folder.join(name)
}

/// Array of `expected.npz`.
fn expected<const D: usize>(key: &str) -> Tensor<D> {
    array("expected.npz", key)
}

fn array<const D: usize>(file: &str, key: &str) -> Tensor<D> {
    let bytes = std::fs::read(fixture(file)).expect("a fixture");
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
        context: None,
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

/// Array of `expected_others.npz`.
fn other<const D: usize>(key: &str) -> Tensor<D> {
    array("expected_others.npz", key)
}

/// Largest difference from what PyTorch predicted for its three motions.
fn error_of_other(
    model: &Mdm,
    key: &str,
    condition: Condition,
    (lengths, context): (Option<&[usize]>, Option<Tensor<3>>),
) -> f32 {
    let query = MdmQuery {
        noisy: other("x"),
        steps: &[3, 41, 0],
        condition: &condition,
        conditioned: None,
        lengths,
        context,
    };
    let predicted = model.forward(query, &Dropout::none()).expect("it fits");
    (predicted - other::<3>(key))
        .abs()
        .max()
        .into_scalar::<f32>()
}

#[test]
fn recurrent_networks_are_read() {
    let limits = CheckpointLimits::default();
    let read = read_published(&fixture("gru/model.pt"), &limits, &Device::flex());
    let (model, _) = read.expect("sound");
    let config = model.config();
    assert_eq!(config.architecture, Architecture::GruOverBatch);
    assert_eq!([config.columns, config.width, config.layers], [6, 8, 2]);
    let text = || Condition::Text {
        tokens: other::<2>("text").unsqueeze_dim(1),
        padding: None,
    };
    // As published it walks over the batch.
    let error = error_of_other(&model, "gru_over_batch", text(), (None, None));
    assert!(error < 2e-6, "{error}");
    // The same numbers, over frames.
    let over_frames = MdmConfig {
        architecture: Architecture::Gru,
        ..config.clone()
    };
    let parameters = parameters_of(&model, "a test").expect("readable");
    let network = Mdm::new(&over_frames, 0, &Device::flex()).expect("possible");
    let network = parameters
        .load(network, "MDM", PUBLISHED_NAMES)
        .expect("the same names");
    let error = error_of_other(&network, "gru_over_frames", text(), (None, None));
    assert!(error < 2e-6, "{error}");
}

fn planner() -> Mdm {
    let limits = CheckpointLimits::default();
    let read = read_published(&fixture("planner/model.pt"), &limits, &Device::flex());
    let (model, arguments) = read.expect("sound");
    assert_eq!(arguments.diffusion_steps, 10);
    model
}

/// Vectors of tokens, of which the second caption has two.
fn tokens() -> Condition {
    let padding: Vec<bool> = (0..12)
        .map(|token| token / 4 == 1 && token % 4 >= 2)
        .collect();
    let padding = TensorData::new(padding, [3, 4]);
    Condition::Text {
        tokens: other("tokens"),
        padding: Some(Tensor::<2, Bool>::from_data(padding, &Device::flex())),
    }
}

#[test]
fn planners_go_on_from_clean_frames() {
    let model = planner();
    let expected = PlannerConfig {
        context: 3,
        prediction: 7,
    };
    assert_eq!(model.config().planner, Some(expected));
    let context = other::<3>("context");
    let lengths = Some(&[7, 5, 1][..]);
    let error = error_of_other(
        &model,
        "planned",
        tokens(),
        (lengths, Some(context.clone())),
    );
    assert!(error < 3e-6, "{error}");

    // Without frames to go on from, or with others than it was trained with.
    let condition = tokens();
    for (wrong, found) in [
        (None, "found none"),
        (Some(context.narrow(1, 0, 2)), "found [3, 2, 6]"),
    ] {
        let query = MdmQuery {
            noisy: other("x"),
            steps: &[3, 41, 0],
            condition: &condition,
            conditioned: None,
            lengths: None,
            context: wrong,
        };
        let told = model.forward(query, &Dropout::none()).expect_err("misfit");
        assert!(told.to_string().contains(found), "{told}");
    }
}

#[test]
fn plans_are_made_piece_by_piece() {
    let (model, condition, context) = (planner(), tokens(), other::<3>("context"));
    let schedule = Schedule::cosine(10).expect("in range");
    let sampler = Sampler::new(schedule, Method::Ancestral);
    let request = |lengths, context| GenerateRequest {
        condition: &condition,
        lengths,
        seeds: &[1, 2, 3],
        guidance: 7.5,
        edit: None,
        guides: &[],
        context,
    };
    let mut left = Vec::new();
    let lengths = [17, 7, 4];
    let planned = plan_motions(
        &model,
        &sampler,
        request(&lengths, None),
        &context,
        |steps| {
            left.push(steps);
        },
    );
    let planned = planned.expect("it fits");
    assert_eq!(left, (0..30).rev().collect::<Vec<_>>());
    let frames: Vec<usize> = planned.iter().map(|motion| motion.len() / 6).collect();
    assert_eq!(frames, lengths);

    // The first piece is that of the same seeds; the second depends on the first one's end.
    let first = generate(&model, &sampler, request(&[7; 3], Some(&context)), |_| ());
    let first = first.expect("it fits");
    assert_eq!(planned[0][..42], first[0]);
    assert_eq!(planned[1], first[1]);
    assert_eq!(planned[2], first[2][..24]);
    let elsewhere = context.clone() * -1.0;
    let other = plan_motions(
        &model,
        &sampler,
        request(&lengths, None),
        &elsewhere,
        |_| (),
    );
    assert_ne!(other.expect("it fits")[0][42..], planned[0][42..]);

    let told = |request, context: &Tensor<3>| {
        let planned = plan_motions(&model, &sampler, request, context, |_| ());
        planned.expect_err("misfit").to_string()
    };
    assert!(told(request(&lengths, Some(&context)), &context).contains("no edit and no context"));
    let short = context.clone().narrow(1, 0, 1);
    assert!(told(request(&lengths, None), &short).contains("expected [3, 3, 6]"));
    let limits = CheckpointLimits::default();
    let whole = read_published(&fixture("flat.pt"), &limits, &Device::flex());
    let whole = whole.expect("sound").0;
    let planned = plan_motions(&whole, &sampler, request(&lengths, None), &context, |_| ());
    let told = planned.expect_err("no planner").to_string();
    assert!(told.contains("one that makes whole motions"), "{told}");
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
    // More than its numbers can fill: no memory is taken for it.
    let huge = text.replace("\"width\": 8", "\"width\": 16384");
    let huge = huge.replace("\"layers\": 1", "\"layers\": 1024");
    std::fs::write(&path, huge).expect("written");
    let told = read().expect_err("terabytes").to_string();
    assert!(
        told.contains("Setting network: expected one of about"),
        "{told}"
    );
    std::fs::write(&path, &text).expect("written");

    // Cut short anywhere, each of its files is refused.
    for name in ["model.safetensors", "config.json", "mean.npy", "std.npy"] {
        let path = folder.join(name);
        let whole = std::fs::read(&path).expect("written");
        for length in (0..whole.len()).step_by(whole.len().div_ceil(40)) {
            std::fs::write(&path, &whole[..length]).expect("written");
            let told = read().expect_err("half a file").to_string();
            assert!(told.contains(name), "{name}, {length} bytes: {told}");
        }
        std::fs::write(&path, whole).expect("written");
    }
    assert!(read().is_ok());
    // A head of 2^63 bytes, and numbers behind the end of the file.
    let path = folder.join("model.safetensors");
    let whole = std::fs::read(&path).expect("written");
    let head = [&(1_u64 << 63).to_le_bytes()[..], &whole[8..]].concat();
    std::fs::write(&path, head).expect("written");
    assert!(read().is_err());
    let text = String::from_utf8_lossy(&whole[8..300]).replace("[0,", "[9,");
    let moved = [&whole[..8], text.as_bytes(), &whole[300..]].concat();
    std::fs::write(&path, moved).expect("written");
    assert!(read().is_err());
}

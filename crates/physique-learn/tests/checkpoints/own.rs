//! Files and folders of our own.

use burn::tensor::Device;
use physique_learn::checkpoint::{
    CheckpointLimits, Precision, read_safetensors, write_safetensors,
};
use physique_learn::mdm::{
    ConditionKind, Mdm, MdmConfig, MdmDescription, MdmFolder, from_parameters, parameters_of,
    read_published,
};
use physique_motion::features::{FeatureSkeleton, FeatureStatistics};

use crate::support::{error, fixture};

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

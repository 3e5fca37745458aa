//! HumanML3D's layout.

mod support;

use physique::motion::features::write_positions;
use physique_data::{
    DataLimits, Dataset, PublishedSet, Reason, Source, Split, Storage, Window, build,
};
use support::{features, published};

fn open(folder: &std::path::Path) -> Dataset {
    let output = folder.join("out.pmd");
    let limits = DataLimits::default();
    let source = Source::Published(PublishedSet::HumanMl3d);
    build(&source, folder, &output, &limits, &()).unwrap();
    Dataset::open(output, &limits).unwrap()
}

#[test]
fn whole_clips_and_parts_come_with_their_captions() {
    let folder = published();
    let dataset = open(folder.path());
    let index = dataset.index();
    assert_eq!(index.storage, Storage::Features);
    let told: Vec<(String, Split, usize, usize)> = index
        .clips
        .iter()
        .map(|clip| (index.clip_name(clip), clip.split, clip.start, clip.frames))
        .collect();
    let expected = [
        ("000001", Split::Train, 0, 60),
        ("M000001", Split::Train, 0, 60),
        ("000002", Split::Test, 0, 120),
        ("000002[0..50]", Split::Test, 0, 50),
    ];
    assert_eq!(told.len(), expected.len());
    for (told, (name, split, start, frames)) in told.iter().zip(expected) {
        assert_eq!(told, &(name.to_owned(), split, start, frames));
    }
    let set = &index.caption_sets[index.clips[3].captions];
    let caption = &index.captions[set.training[0]];
    assert_eq!(caption.text, "he starts");
    assert_eq!(caption.tokens.as_deref(), Some("he/PRON start/VERB"));
}

#[test]
fn broken_clips_are_listed() {
    let folder = published();
    let report = open(folder.path()).index().report.clone();
    let told: Vec<(&str, Reason)> = report
        .left_out
        .iter()
        .map(|left_out| (left_out.name.as_str(), left_out.reason))
        .collect();
    let expected = [
        ("000001", Reason::Duplicate),
        ("000002[20..30]", Reason::TooShort),
        ("000003", Reason::TooShort),
        ("000004", Reason::TooLong),
        ("000005", Reason::Text),
        ("000009", Reason::Unreadable),
        ("007975", Reason::NotFinite),
    ];
    assert_eq!(told, expected);
    let nan = &report.left_out[6].message;
    assert!(nan.contains("Frame 57"), "{nan}");
    assert_eq!(
        report.notes.len(),
        1,
        "statistics are missing: {:?}",
        report.notes
    );
}

#[test]
fn windows_are_cut_out_of_the_features_as_they_are() {
    let folder = published();
    let dataset = open(folder.path());
    let window = Window {
        clip: 3,
        start: 10,
        frames: 40,
    };
    let found = dataset.features(window).unwrap();
    let all = features(120);
    assert_eq!(found.values(), &all.values()[10 * 263..50 * 263]);
    assert_eq!(
        dataset.recording_rows(2).unwrap(),
        all.values(),
        "nothing is copied or changed"
    );
}

#[test]
fn the_folders_own_statistics_are_taken() {
    let folder = published();
    let dataset = open(folder.path());
    let (mean, deviation) = (dataset.statistics().mean().to_vec(), vec![0.5_f32; 263]);
    drop(dataset);
    for (name, values) in [("Mean.npy", &mean), ("Std.npy", &deviation)] {
        let bytes = physique::motion::npz::npy_f32(&[263], values).unwrap();
        std::fs::write(folder.path().join(name), bytes).unwrap();
    }
    let dataset = open(folder.path());
    assert_eq!(dataset.statistics().deviation(), deviation);
    assert!(dataset.index().report.notes.is_empty());
}

#[test]
fn features_of_another_width_are_told() {
    let folder = published();
    let positions = physique::motion::features::recover_from_positions(&features(60)).unwrap();
    let file = folder.path().join("new_joint_vecs/M000001.npy");
    write_positions(file, &positions).unwrap();
    let report = open(folder.path()).index().report.clone();
    let told = report
        .left_out
        .iter()
        .find(|of| of.name == "M000001")
        .unwrap();
    assert_eq!(told.reason, Reason::Unreadable);
    assert!(
        told.message.contains("expected shape [frames][263]"),
        "{}",
        told.message
    );
}

//! A folder of motions becomes a data file by a recipe.

mod support;

use std::fs;

use physique::motion::features::{
    FeatureStatistics, JointPositions, StatisticsGatherer, extract, recover_from_positions,
    recover_from_rotations,
};
use physique::motion::mapping::BodyRest;
use physique_data::{DataLimits, Dataset, Error, Reason, Recipe, Source, Split, Window, build};
use support::{RECIPE, body, built, folder, walk};

#[test]
fn clips_are_named_split_and_described() {
    let folder = folder();
    let (dataset, _) = built(RECIPE, folder.path());
    let index = dataset.index();
    let told: Vec<(String, Split, usize)> = index
        .clips
        .iter()
        .map(|clip| (index.clip_name(clip), clip.split, clip.frames))
        .collect();
    let names: Vec<&str> = told.iter().map(|(name, ..)| name.as_str()).collect();
    let expected = [
        "takes/turn-left_plain_0",
        "takes/turn-left_plain_0 mirrored",
        "takes/walk_sad_0",
        "takes/walk_sad_0 mirrored",
        "takes/walk_sad_1",
        "takes/walk_sad_1 mirrored",
        "takes/walk_sad_2",
        "takes/walk_sad_2 mirrored",
    ];
    assert_eq!(names, expected);
    for pair in told.chunks_exact(2) {
        assert_eq!(
            pair[0].1, pair[1].1,
            "a clip and its mirror image are on one side"
        );
    }
    let walks_tested = told[2..]
        .iter()
        .filter(|(_, split, _)| *split == Split::Test);
    assert_eq!(
        walks_tested.count(),
        2,
        "a third of three walks, and its mirror image"
    );
    assert_eq!(told[0].1, Split::Train, "the only turn is trained on");

    let captions = |clip: usize| -> Vec<&str> {
        let set = &index.caption_sets[index.clips[clip].captions];
        let captions = set.training.iter();
        captions
            .map(|&caption| index.captions[caption].text.as_str())
            .collect()
    };
    assert_eq!(captions(0), ["a person turns left"]);
    assert_eq!(captions(1), ["a person turns right"]);
    let walks = [
        "a person walks",
        "a person is walking",
        "a sad person walks",
        "a sad person is walking",
    ];
    assert_eq!(captions(2), walks);
    assert_eq!(
        index.clips[2].captions, index.clips[5].captions,
        "sets are shared"
    );
    assert_eq!(index.report.held_out_captions, 2);
}

#[test]
fn what_is_not_trained_on_is_listed_with_its_reason() {
    let folder = folder();
    let (dataset, _) = built(RECIPE, folder.path());
    let report = &dataset.index().report;
    let told: Vec<(&str, Reason)> = report
        .left_out
        .iter()
        .map(|left_out| (left_out.name.as_str(), left_out.reason))
        .collect();
    let expected = [
        ("takes/dance_sad_0", Reason::Recipe),
        ("takes/hop_sad_0", Reason::NoCaption),
        ("takes/walk_broken_0", Reason::Unreadable),
        ("takes/walk_short_0", Reason::TooShort),
    ];
    assert_eq!(told, expected);
    assert_eq!(
        (report.found, report.recorded.clips, report.unnamed_files),
        (8, 4, 1)
    );
    let place = folder.path().display().to_string();
    let messages = report.left_out.iter().map(|left_out| &left_out.message);
    for message in messages {
        assert!(
            !message.contains(&place),
            "tells where it was built: {message}"
        );
    }
}

#[test]
fn the_whole_clip_has_the_features_of_the_motion_itself() {
    let folder = folder();
    let (dataset, _) = built(RECIPE, folder.path());
    let motion = walk(100, 0.0).resampled(dataset.frame_rate()).unwrap();
    let positions = JointPositions::from_motion(&motion, &BodyRest::from(&body())).unwrap();
    let expected = extract(&positions).unwrap();
    let features = dataset.features(dataset.whole(2).unwrap()).unwrap();
    assert_eq!(features.frame_count(), expected.frame_count());
    let furthest = features
        .values()
        .iter()
        .zip(expected.values())
        .map(|(a, b)| (a - b).abs())
        .fold(0.0, f32::max);
    assert!(furthest < 2e-5, "{furthest}");
}

/// The trap of cutting windows out of a clip's features: rotations disagree with positions.
#[test]
fn rotations_of_a_window_agree_with_its_positions() {
    let folder = folder();
    let (dataset, _) = built(RECIPE, folder.path());
    for clip in [4, 5] {
        let window = Window {
            clip,
            start: 17,
            frames: 20,
        };
        let features = dataset.features(window).unwrap();
        let by_positions = recover_from_positions(&features).unwrap();
        let offsets = dataset.skeleton().offsets();
        let by_rotations = recover_from_rotations(&features, &offsets).unwrap();
        let furthest = by_positions
            .positions()
            .iter()
            .zip(by_rotations.positions())
            .map(|(a, b)| a.distance(*b))
            .fold(0.0, f32::max);
        assert!(furthest < 1e-4, "clip {clip}: {furthest} m");
        let start = by_positions.frame(0)[0];
        assert!(start.x.abs() < 1e-5 && start.z.abs() < 1e-5, "{start}");
    }
}

#[test]
fn statistics_are_those_of_all_clips_and_mirror_images() {
    let folder = folder();
    let (dataset, _) = built(RECIPE, folder.path());
    let mut gatherer = StatisticsGatherer::new(dataset.skeleton());
    for clip in 0..dataset.index().clips.len() {
        let features = dataset.features(dataset.whole(clip).unwrap()).unwrap();
        gatherer.add(&features).unwrap();
    }
    let expected: FeatureStatistics = gatherer.finish().unwrap();
    assert_eq!(dataset.statistics(), &expected);
    let deviation = dataset.statistics().deviation();
    assert!(
        deviation[4..67].windows(2).all(|pair| pair[0] == pair[1]),
        "one a block"
    );
}

#[test]
fn a_batch_is_normalised_and_padded_with_zeros() {
    let folder = folder();
    let (dataset, _) = built(RECIPE, folder.path());
    let windows = [(2, 3, 12), (3, 0, 20)].map(|(clip, start, frames)| Window {
        clip,
        start,
        frames,
    });
    let batch = dataset.batch(&windows, 24).unwrap();
    assert_eq!(
        (batch.frames, batch.columns, &batch.lengths[..]),
        (24, 263, &[12, 20][..])
    );
    assert_eq!(batch.mask().iter().filter(|&&is_row| is_row).count(), 32);
    for (rows, window) in batch.values.chunks_exact(24 * 263).zip(windows) {
        let (own, padding) = rows.split_at(window.frames * 263);
        let mut own = own.to_vec();
        dataset.statistics().denormalise(&mut own);
        let features = dataset.features(window).unwrap();
        let furthest = own.iter().zip(features.values());
        let furthest = furthest.map(|(a, b)| (a - b).abs()).fold(0.0, f32::max);
        assert!(furthest < 1e-5, "{furthest}");
        assert!(padding.iter().all(|&value| value == 0.0));
    }
}

#[test]
fn windows_that_are_not_there_are_refused() {
    let folder = folder();
    let (dataset, _) = built(RECIPE, folder.path());
    let frames = dataset.index().clips[0].frames;
    for (clip, start, length) in [
        (99, 0, 1),
        (0, 0, frames + 1),
        (0, 1, frames),
        (0, 0, 0),
        (0, usize::MAX, 2),
    ] {
        let window = Window {
            clip,
            start,
            frames: length,
        };
        let refused = dataset.features(window);
        assert!(matches!(refused, Err(Error::Window { .. })), "{window:?}");
    }
    assert!(matches!(dataset.whole(99), Err(Error::Window { .. })));
    assert!(matches!(
        dataset.recording_rows(99),
        Err(Error::Window { .. })
    ));
}

#[test]
fn the_same_folder_gives_the_same_bytes_for_any_number_of_threads() {
    let folder = folder();
    let (dataset, output) = built(RECIPE, folder.path());
    dataset.verify().unwrap();
    let first = fs::read(&output).unwrap();
    drop(dataset);
    let single = rayon_of_one(|| built(RECIPE, folder.path()));
    assert_eq!(first, fs::read(&single.1).unwrap());
    let left: Vec<_> = fs::read_dir(folder.path())
        .unwrap()
        .map(|entry| entry.unwrap().file_name())
        .filter(|name| name.to_string_lossy().contains("partial"))
        .collect();
    assert!(left.is_empty(), "{left:?}");
}

fn rayon_of_one<T: Send>(work: impl FnOnce() -> T + Send) -> T {
    let pool = rayon::ThreadPoolBuilder::new().num_threads(1);
    pool.build().unwrap().install(work)
}

#[test]
fn a_folder_without_such_files_is_an_error_that_says_so() {
    let folder = tempfile::tempdir().unwrap();
    fs::write(folder.path().join("a.bvh"), b"").unwrap();
    let recipe = Recipe::parse(RECIPE, "test").unwrap();
    let output = folder.path().join("out.pmd");
    let limits = DataLimits::default();
    let problem = build(
        &Source::Recipe(Box::new(recipe)),
        folder.path(),
        &output,
        &limits,
        &(),
    );
    let problem = problem.unwrap_err().to_string();
    assert!(problem.contains("expected files such as"), "{problem}");

    let all = RECIPE.replace("**/{content}_{style}_{take}.npz", "{content}.bvh");
    let recipe = Recipe::parse(&all, "test").unwrap();
    let problem = build(
        &Source::Recipe(Box::new(recipe)),
        folder.path(),
        &output,
        &limits,
        &(),
    );
    assert!(
        matches!(problem, Err(Error::NothingLeft { found: 1, .. })),
        "{problem:?}"
    );
    assert!(!output.exists());
}

#[test]
fn a_file_that_is_open_stays_readable_when_it_is_built_anew() {
    let folder = folder();
    let (old, output) = built(RECIPE, folder.path());
    let rows = old.recording_rows(0).unwrap().to_vec();
    let recipe = RECIPE.replace("mirror = true", "mirror = false");
    let (new, _) = built(&recipe, folder.path());
    assert_eq!(old.recording_rows(0).unwrap(), rows);
    assert_eq!(new.index().clips.len(), 4);
    let limits = DataLimits::default();
    assert_eq!(
        Dataset::open(&output, &limits).unwrap().index(),
        new.index()
    );
}

//! Several data files as one.

mod support;

use std::fs;

use physique_data::{DataLimits, Dataset, Error, SET_LABEL, join};
use support::{RECIPE, built, folder};

#[test]
fn joined_files_give_the_windows_of_their_parts() {
    let folder = folder();
    let (first, _) = built(RECIPE, folder.path());
    let other = RECIPE
        .replace("name = \"small\"", "name = \"other\"")
        .replace("licence = \"CC0\"", "licence = \"CC BY 4.0\"")
        // What is held out here, the first file trains with.
        .replace(
            "held_out.does = [\"strolls\"]",
            "held_out.does = [\"walks\", \"ambles\"]",
        )
        .replace("does = [\"walks\", \"is walking\"]", "does = [\"strides\"]");
    let (second, _) = built(&other, folder.path());
    let path = folder.path().join("joined.pmd");
    let parts = [first, second];
    let report = join(&parts, &path).unwrap();

    let limits = DataLimits::default();
    let whole = Dataset::open(&path, &limits).unwrap();
    whole.verify().unwrap();
    let index = whole.index();
    assert_eq!(index.licence, "small: CC0; other: CC BY 4.0");
    assert_eq!(report, index.report);
    let clips: usize = parts.iter().map(|part| part.index().clips.len()).sum();
    assert_eq!(index.clips.len(), clips);
    let mut number = 0;
    for part in &parts {
        let of = part.index();
        for clip in 0..of.clips.len() {
            let (old, new) = (&of.clips[clip], &index.clips[number]);
            assert_eq!(new.labels[SET_LABEL], of.name);
            assert_eq!(new.split, old.split);
            assert_eq!(
                index.clip_name(new),
                format!("{}/{}", of.name, of.clip_name(old))
            );
            let texts = |index: &physique_data::Index, set: &[usize]| -> Vec<String> {
                let captions = set
                    .iter()
                    .map(|&caption| index.captions[caption].text.clone());
                captions.collect()
            };
            assert_eq!(
                texts(of, &of.caption_sets[old.captions].training),
                texts(index, &index.caption_sets[new.captions].training)
            );
            let rows = |set: &Dataset, clip| {
                set.features(set.whole(clip).unwrap())
                    .unwrap()
                    .values()
                    .to_vec()
            };
            assert_eq!(rows(part, clip), rows(&whole, number));
            number += 1;
        }
    }
    let held_out = index.caption_sets.iter().flat_map(|set| &set.held_out);
    let held_out: Vec<&str> = held_out
        .map(|&caption| index.captions[caption].text.as_str())
        .collect();
    assert!(held_out.iter().any(|text| text.contains("ambles")));
    assert!(
        !held_out.iter().any(|text| text.contains("walks")),
        "{held_out:?}"
    );
}

#[test]
fn files_of_other_frame_rates_do_not_join() {
    let folder = folder();
    let (first, _) = built(RECIPE, folder.path());
    let other = format!("frame_rate = 10.0\n{RECIPE}");
    let (second, _) = built(&other, folder.path());
    let path = folder.path().join("joined.pmd");
    let problem = join(&[first, second], &path).unwrap_err();
    assert!(
        matches!(
            problem,
            Error::Join {
                what: "frame rate",
                ..
            }
        ),
        "{problem}"
    );
    assert!(!fs::exists(&path).unwrap());
    assert!(matches!(join(&[], &path), Err(Error::Join { .. })));
}

//! Word vectors from small made-up files.

use std::fs;
use std::path::Path;

use physique_data::Caption;
use physique_files::npz::npy_f32;
use physique_learn::evaluation::{CaptionReading, WordLimits, WordVectors};

const WORD: usize = 300;

/// A pickle of texts in a list, as Python writes it.
fn list(words: &[&str]) -> Vec<u8> {
    let mut pickle = b"\x80\x02](".to_vec();
    words.iter().for_each(|word| pickle.extend(text(word)));
    pickle.extend(b"e.");
    pickle
}

/// A pickle of numbers by text.
fn dictionary(words: &[(&str, u16)]) -> Vec<u8> {
    let mut pickle = b"\x80\x02}(".to_vec();
    for (word, number) in words {
        pickle.extend(text(word));
        pickle.push(b'M');
        pickle.extend(number.to_le_bytes());
    }
    pickle.extend(b"u.");
    pickle
}

fn text(word: &str) -> Vec<u8> {
    let length = u32::try_from(word.len()).expect("short");
    [&b"X"[..], &length.to_le_bytes(), word.as_bytes()].concat()
}

/// Word vectors of the three marks and these words; that of row k begins with k.
pub(crate) fn write_vectors(folder: &Path, words: &[String]) {
    let marks = ["sos", "eos", "unk"].into_iter();
    let words: Vec<&str> = marks.chain(words.iter().map(String::as_str)).collect();
    let vector = |row: usize| {
        (0..WORD).map(move |column| {
            if column == 0 {
                row as f32
            } else {
                (row * column) as f32 * 1e-3
            }
        })
    };
    let vectors: Vec<f32> = (0..words.len()).flat_map(vector).collect();
    let array = npy_f32(&[words.len(), WORD], &vectors).expect("whole");
    let rows = words.iter().copied().zip(0..).collect::<Vec<_>>();
    fs::write(folder.join("our_vab_data.npy"), array).expect("written");
    fs::write(folder.join("our_vab_words.pkl"), list(&words)).expect("written");
    fs::write(folder.join("our_vab_idx.pkl"), dictionary(&rows)).expect("written");
}

fn folder() -> tempfile::TempDir {
    let folder = tempfile::tempdir().expect("a folder");
    let words = ["a", "person", "walk", "left", "and"].map(str::to_owned);
    write_vectors(folder.path(), &words);
    folder
}

fn caption(tokens: &str) -> Caption {
    Caption {
        text: String::new(),
        tokens: Some(tokens.to_owned()),
    }
}

#[test]
fn words_stand_between_marks_and_unknown_ones_behind() {
    let folder = folder();
    let vectors = WordVectors::read(folder.path(), &WordLimits::default()).expect("sound");
    let walk = caption("a/DET person/NOUN walk/VERB to/ADP left/ADJ and/CCONJ person/X");
    let long = caption(&"a/DET ".repeat(25));
    let read = |reading| vectors.vectorise(&[&walk, &long], reading).expect("words");
    let words = read(CaptionReading::Whole);
    assert_eq!((words.words, words.lengths), (22, vec![9, 22]));
    let rows: Vec<f32> = words.vectors.iter().copied().step_by(WORD).collect();
    // sos a person walk unk left and person eos, then unk.
    assert_eq!(
        rows[..11],
        [0.0, 3.0, 4.0, 5.0, 2.0, 6.0, 7.0, 4.0, 1.0, 2.0, 2.0]
    );
    assert_eq!(
        words.parts_of_speech[..10],
        [14, 2, 1, 12, 14, 9, 14, 14, 14, 14]
    );
    // 20 words at most.
    assert_eq!(rows[22..43], [&[0.0][..], &[3.0; 20]].concat());
    assert_eq!(rows[43], 1.0);
    // The bug changes lengths only.
    let padded = read(CaptionReading::WithPadding);
    assert_eq!(padded.lengths, [22, 22]);
    assert_eq!(padded.vectors, words.vectors);

    let wordless = Caption {
        text: "walks".into(),
        tokens: None,
    };
    for (caption, expected) in [
        (&wordless, "its words as `lemma/POS`, found only \"walks\""),
        (&caption("a/DET person"), "`lemma/POS`, found \"person\""),
    ] {
        let told = vectors.vectorise(&[caption], CaptionReading::Whole);
        let told = told.expect_err("no words").to_string();
        assert!(told.contains(expected), "{told}");
    }
}

#[test]
fn files_that_lie_are_told() {
    let told = |change: &dyn Fn(&Path)| {
        let folder = folder();
        change(folder.path());
        let read = WordVectors::read(folder.path(), &WordLimits::default());
        read.map_or_else(|problem| problem.to_string(), |_| "accepted".into())
    };
    let with = |name: &str, bytes: Vec<u8>| {
        let name = format!("our_vab_{name}");
        told(&|folder: &Path| fs::write(folder.join(&name), &bytes).expect("written"))
    };
    let missing = told(&|folder: &Path| {
        fs::remove_file(folder.join("our_vab_idx.pkl")).expect("removed");
    });
    assert!(missing.contains("our_vab_idx.pkl"), "{missing}");
    let narrow = npy_f32(&[8, 3], &[0.0; 24]).expect("whole");
    assert!(with("data.npy", narrow).contains("300 numbers a word, found shape [8, 3]"));
    let nan = npy_f32(&[1, WORD], &[f32::NAN; WORD]).expect("whole");
    assert!(with("data.npy", nan).contains("finite numbers, found NaN in row 0"));
    assert!(with("idx.pkl", list(&["sos"])).contains("a dictionary of words"));
    let beyond = dictionary(&[("sos", 8)]);
    assert!(with("idx.pkl", beyond).contains("rows below 8, found 8"));
    assert!(with("words.pkl", dictionary(&[])).contains("a list of words"));
    assert!(with("words.pkl", list(&["sos", "jump"])).contains("\"jump\", which has none"));
    assert!(with("words.pkl", list(&["sos", "eos"])).contains("no unk"));
    // Python would run this.
    let code = b"\x80\x02cos\nsystem\n(X\x02\x00\x00\x00lstR.".to_vec();
    let refused = with("words.pkl", code);
    assert!(
        refused.contains("os.system") || refused.contains("`os`"),
        "{refused}"
    );

    let limits = WordLimits {
        words: 7,
        ..WordLimits::default()
    };
    let told = WordVectors::read(folder().path(), &limits).expect_err("8 words");
    assert!(
        told.to_string().contains("at most 7 words, found 8"),
        "{told}"
    );
    let limits = WordLimits {
        bytes: 100,
        ..WordLimits::default()
    };
    assert!(WordVectors::read(folder().path(), &limits).is_err());
}

#[test]
fn every_truncation_is_refused() {
    let folder = folder();
    for name in ["data.npy", "words.pkl", "idx.pkl"] {
        let path = folder.path().join(format!("our_vab_{name}"));
        let whole = fs::read(&path).expect("there");
        for length in (0..whole.len()).step_by(whole.len() / 40 + 1) {
            fs::write(&path, &whole[..length]).expect("written");
            let read = WordVectors::read(folder.path(), &WordLimits::default());
            assert!(read.is_err(), "{length} bytes of {name}");
        }
        fs::write(&path, &whole).expect("written");
    }
}

//! Tokenizers give the numbers of the published ones; see `fixtures/make.py`.

use std::fs;
use std::path::Path;

use physique_text::TextLimits;
use physique_text::tokens::{BytePairs, WordPieces};
use serde_json::Value;

fn golden(name: &str) -> Vec<(String, Vec<u32>)> {
    let bytes = fs::read(Path::new("tests/fixtures").join(name)).unwrap();
    let golden: Value = serde_json::from_slice(&bytes).unwrap();
    let captions = golden["captions"].as_array().unwrap().iter();
    captions
        .zip(golden["ids"].as_array().unwrap())
        .map(|(caption, ids)| {
            let ids = ids.as_array().unwrap().iter();
            let ids = ids.map(|id| id.as_u64().unwrap() as u32).collect();
            (caption.as_str().unwrap().to_owned(), ids)
        })
        .collect()
}

#[test]
fn word_pieces_equal_the_published_tokenizer() {
    let vocabulary = fs::read("assets/vocab.txt").unwrap();
    let tokens = WordPieces::from_list(&vocabulary, Path::new("vocab.txt")).unwrap();
    let golden = golden("minilm.json");
    assert_eq!(golden.len(), 9);
    for (caption, ids) in golden {
        assert_eq!(tokens.encode(&caption, 256), ids, "{caption:?}");
        let cut = tokens.encode(&caption, 6);
        assert_eq!(cut.len(), ids.len().min(6));
        assert_eq!(
            (cut.first(), cut.last()),
            (ids.first(), ids.last()),
            "start and end stay"
        );
    }
}

#[test]
fn a_vocabulary_may_stand_in_tokenizer_json() {
    let list = fs::read_to_string("tests/fixtures/distil_bert/vocab.txt").unwrap();
    let pieces: serde_json::Map<String, Value> = list
        .lines()
        .zip(0_u32..)
        .map(|(piece, number)| (piece.to_owned(), number.into()))
        .collect();
    let folder = tempfile::tempdir().unwrap();
    let file = serde_json::json!({"model": {"type": "WordPiece", "vocab": pieces}});
    fs::write(folder.path().join("tokenizer.json"), file.to_string()).unwrap();
    let limits = TextLimits::default();
    let tokens = WordPieces::read(folder.path(), &limits).unwrap();
    let listed = WordPieces::read(Path::new("tests/fixtures/distil_bert"), &limits).unwrap();
    for (caption, ids) in golden("distil_bert/golden.json") {
        assert_eq!(tokens.encode(&caption, 40), ids);
        assert_eq!(listed.encode(&caption, 40), ids);
    }
}

#[test]
fn byte_pairs_equal_the_published_tokenizer() {
    let limits = TextLimits::default();
    let tokens = BytePairs::read(Path::new("tests/fixtures/clip"), &limits).unwrap();
    for (caption, ids) in golden("clip/golden.json") {
        assert_eq!(tokens.encode(&caption, 77), ids, "{caption:?}");
        let cut = tokens.encode(&caption, 5);
        assert_eq!(cut.len(), ids.len().min(5));
        assert_eq!(cut.last(), ids.last(), "the end stays");
    }
}

#[test]
fn byte_pairs_are_read_from_a_single_file() {
    let limits = TextLimits::default();
    let fixture = Path::new("tests/fixtures/clip");
    let vocabulary: Value =
        serde_json::from_slice(&fs::read(fixture.join("vocab.json")).unwrap()).unwrap();
    let merges = fs::read_to_string(fixture.join("merges.txt")).unwrap();
    let lines: Vec<&str> = merges.lines().skip(1).collect();
    let split: Vec<Vec<&str>> = lines.iter().map(|line| line.split(' ').collect()).collect();
    for merges in [serde_json::json!(lines), serde_json::json!(split)] {
        let folder = tempfile::tempdir().unwrap();
        let file = serde_json::json!({"model": {"vocab": vocabulary, "merges": merges}});
        fs::write(folder.path().join("tokenizer.json"), file.to_string()).unwrap();
        let tokens = BytePairs::read(folder.path(), &limits).unwrap();
        for (caption, ids) in golden("clip/golden.json") {
            assert_eq!(tokens.encode(&caption, 77), ids, "{caption:?}");
        }
    }
}

#[test]
fn openais_list_numbers_pieces_by_their_order() {
    let folder = tempfile::tempdir().unwrap();
    let list = folder.path().join("bpe_simple_vocab_16e6.txt");
    fs::write(&list, "a heading\nw a\nl k</w>\nwa lk</w>\n").unwrap();
    let tokens = BytePairs::read(&list, &TextLimits::default()).unwrap();
    // 256 bytes, 256 at the end of a word, then merges, start and end.
    assert_eq!(tokens.encode("walk", 77), [515, 514, 516]);
    assert_eq!(tokens.encode("a", 77), [515, 256 + 64, 516]);
}

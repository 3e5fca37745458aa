//! Encoders give what PyTorch gives; see `fixtures/make.py`.

use std::fs;
use std::path::{Path, PathBuf};

use physique_text::{
    Clip, ClipContext, DistilBert, Error, MiniLm, TextEncoder, TextLimits, open, open_with,
};
use serde_json::Value;

fn fixture(name: &str) -> PathBuf {
    Path::new("tests/fixtures").join(name)
}

fn golden(name: &str) -> Value {
    serde_json::from_slice(&fs::read(fixture(name)).unwrap()).unwrap()
}

fn texts(value: &Value) -> Vec<&str> {
    let texts = value.as_array().unwrap().iter();
    texts.map(|text| text.as_str().unwrap()).collect()
}

fn vectors(value: &Value) -> Vec<Vec<f32>> {
    let rows = value.as_array().unwrap().iter();
    rows.map(|row| {
        let numbers = row.as_array().unwrap().iter();
        numbers
            .map(|number| number.as_f64().unwrap() as f32)
            .collect()
    })
    .collect()
}

/// Greatest difference, relative to the greatest number.
fn furthest(found: &[f32], expected: &[f32]) -> f32 {
    assert_eq!(found.len(), expected.len());
    let greatest = expected.iter().fold(0.0_f32, |most, x| most.max(x.abs()));
    let differences = found.iter().zip(expected).map(|(a, b)| (a - b).abs());
    differences.fold(0.0, f32::max) / greatest
}

fn cosine(a: &[f32], b: &[f32]) -> f32 {
    let dot = |a: &[f32], b: &[f32]| a.iter().zip(b).map(|(a, b)| a * b).sum::<f32>();
    dot(a, b) / (dot(a, a) * dot(b, b)).sqrt()
}

#[test]
fn distil_bert_equals_pytorch() {
    let encoder = open(&fixture("distil_bert"), &TextLimits::default()).unwrap();
    assert!(encoder.is_by_token());
    assert_eq!((encoder.name(), encoder.width()), ("DistilBERT", 32));
    let golden = golden("distil_bert/golden.json");
    let found = encoder.encode(&texts(&golden["captions"]));
    assert_eq!(
        (found.captions(), found.tokens(), found.width()),
        (2, 8, 32)
    );
    for (rows, expected) in found.rows().zip(vectors(&golden["states"])) {
        let difference = furthest(rows, &expected);
        assert!(difference < 1e-5, "{difference}");
    }
    assert!(found.mask().iter().all(|&is_token| is_token));

    // A shorter caption is padded with zeros, and the mask says so.
    let found = encoder.encode(&["walks with the left hand", "walk"]);
    let expected: Vec<bool> = (0..8).map(|token| token < 3).collect();
    assert_eq!(&found.mask()[8..], expected);
    assert!(
        found.values()[(8 + 3) * 32..]
            .iter()
            .all(|&value| value == 0.0)
    );
}

#[test]
fn clip_equals_pytorch_in_both_layouts() {
    let limits = TextLimits::default();
    let golden = golden("clip/golden.json");
    let captions = texts(&golden["captions"]);
    for context in [ClipContext::Whole, ClipContext::Mdm] {
        let expected = match context {
            ClipContext::Whole => vectors(&golden["vectors"]),
            ClipContext::Mdm => vectors(&golden["vectors_of_22"]),
        };
        let hugging_face = Clip::read(&fixture("clip"), context, &limits).unwrap();
        for (rows, expected) in hugging_face.encode(&captions).rows().zip(&expected) {
            let difference = furthest(rows, expected);
            assert!(difference < 1e-5, "{context:?}: {difference}");
        }
    }
    // OpenAI's layout tells no heads: 64 numbers each, one head here, two above.
    let openai = Clip::read_files(
        &fixture("clip_openai"),
        &fixture("clip"),
        ClipContext::Whole,
        &limits,
    );
    assert_eq!(openai.unwrap().width(), 24);
}

#[test]
fn clip_takes_openais_layout() {
    let folder = tempfile::tempdir().unwrap();
    for (name, from) in [
        ("model.pt", "clip_openai"),
        ("config.json", "clip"),
        ("vocab.json", "clip"),
        ("merges.txt", "clip"),
    ] {
        fs::copy(fixture(from).join(name), folder.path().join(name)).unwrap();
    }
    let encoder = open(folder.path(), &TextLimits::default()).unwrap();
    let golden = golden("clip/golden.json");
    let found = encoder.encode(&texts(&golden["captions"]));
    for (rows, expected) in found.rows().zip(vectors(&golden["vectors"])) {
        let difference = furthest(rows, &expected);
        assert!(difference < 1e-5, "{difference}");
    }
}

/// OpenAI's own file is a program: its parameters are read, its code is not run.
#[test]
fn clip_takes_openais_own_file() {
    let folder = tempfile::tempdir().unwrap();
    let at = |name: &str| folder.path().join(name);
    for (name, from) in [
        ("ViT-B-32.pt", "clip_script"),
        ("vocab.json", "clip"),
        ("merges.txt", "clip"),
    ] {
        fs::copy(fixture(from).join(name), at(name)).unwrap();
    }
    let limits = TextLimits::default();
    let captions = golden("clip/golden.json");
    let captions = texts(&captions["captions"]);
    let expected = vectors(&golden("clip_script/golden.json")["vectors"]);
    // The file itself, or its folder.
    for path in [at("ViT-B-32.pt"), folder.path().to_owned()] {
        let encoder = open(&path, &limits).unwrap();
        assert_eq!((encoder.name(), encoder.width()), ("CLIP", 16));
        for (rows, expected) in encoder.encode(&captions).rows().zip(&expected) {
            let difference = furthest(rows, expected);
            assert!(difference < 1e-5, "{difference}");
        }
    }
    // As MDM reads: nothing behind the twentieth piece.
    let long = "a person walks ".repeat(20);
    let same = |context| {
        let encoder = open_with(&at("ViT-B-32.pt"), context, &limits).unwrap();
        let [cut, whole] = [&long[..150], &long].map(|text| encoder.encode(&[text]));
        cut == whole
    };
    assert!(same(ClipContext::Mdm) && !same(ClipContext::Whole));

    let told = |path: &Path, limits: &TextLimits| open(path, limits).unwrap_err().to_string();
    let bytes = fs::read(at("ViT-B-32.pt")).unwrap();
    for length in (0..bytes.len()).step_by(9973) {
        fs::write(at("ViT-B-32.pt"), &bytes[..length]).unwrap();
        assert!(
            told(&at("ViT-B-32.pt"), &limits).contains("ViT-B-32.pt"),
            "{length}"
        );
    }
    fs::write(at("ViT-B-32.pt"), &bytes).unwrap();
    let small = TextLimits {
        weight_bytes: 150_000,
        ..limits
    };
    assert!(told(&at("ViT-B-32.pt"), &small).contains("ViT-B-32.pt"));
    fs::remove_file(at("merges.txt")).unwrap();
    let problem = told(&at("ViT-B-32.pt"), &limits);
    assert!(
        problem.contains("bpe_simple_vocab_16e6.txt.gz"),
        "{problem}"
    );
}

#[test]
fn embedded_mini_lm_points_where_the_published_one_does() {
    let encoder = MiniLm::embedded().unwrap();
    assert_eq!((encoder.name(), encoder.width()), ("all-MiniLM-L6-v2", 384));
    let golden = golden("minilm.json");
    let captions = texts(&golden["captions"]);
    let found = encoder.encode(&captions);
    for ((caption, rows), expected) in captions
        .iter()
        .zip(found.rows())
        .zip(vectors(&golden["vectors"]))
    {
        let cosine = cosine(rows, &expected);
        assert!(cosine > 0.995, "{caption:?}: {cosine}");
        let length = rows.iter().map(|x| x * x).sum::<f32>().sqrt();
        assert!((length - 1.0).abs() < 1e-5, "{length}");
    }
}

#[test]
fn company_and_threads_change_no_bit() {
    let encoder = MiniLm::embedded().unwrap();
    let captions: Vec<String> = (0..40)
        .map(|number| format!("a person walks {}", "and turns ".repeat(number % 9)))
        .collect();
    let captions: Vec<&str> = captions.iter().map(String::as_str).collect();
    let together = encoder.encode(&captions);
    for (caption, rows) in captions.iter().zip(together.rows()) {
        assert_eq!(encoder.encode(&[caption]).values(), rows, "{caption}");
    }
    let pool = rayon::ThreadPoolBuilder::new()
        .num_threads(1)
        .build()
        .unwrap();
    assert_eq!(pool.install(|| encoder.encode(&captions)), together);
    assert_eq!(encoder.encode(&[]).captions(), 0);
}

#[test]
fn broken_folders_are_told() {
    let limits = TextLimits::default();
    let folder = tempfile::tempdir().unwrap();
    let at = |name: &str| folder.path().join(name);
    let told = |problem: Result<Box<dyn TextEncoder>, Error>| problem.unwrap_err().to_string();
    assert!(told(open(folder.path(), &limits)).contains("config.json"));
    fs::write(at("config.json"), "{\"model_type\": \"gpt2\"}").unwrap();
    assert!(told(open(folder.path(), &limits)).contains("expected bert, distilbert, clip"));
    fs::write(
        at("config.json"),
        "{\"model_type\": \"distilbert\", \"n_heads\": 0}",
    )
    .unwrap();
    assert!(told(open(folder.path(), &limits)).contains("n_heads: expected a count above 0"));
    fs::write(
        at("config.json"),
        "{\"model_type\": \"distilbert\", \"n_heads\": 5}",
    )
    .unwrap();
    assert!(told(open(folder.path(), &limits)).contains("vocab.txt or tokenizer.json"));
    fs::write(at("vocab.txt"), "[CLS]\n[SEP]\n").unwrap();
    assert!(told(open(folder.path(), &limits)).contains("expected [UNK], found none"));
    fs::copy(fixture("distil_bert/vocab.txt"), at("vocab.txt")).unwrap();
    assert!(told(open(folder.path(), &limits)).contains("model.safetensors or pytorch_model.bin"));
    fs::write(at("model.safetensors"), "no").unwrap();
    assert!(told(open(folder.path(), &limits)).contains("expected a safetensors file"));
    fs::remove_file(at("model.safetensors")).unwrap();
    let weights = fs::read(fixture("distil_bert/pytorch_model.bin")).unwrap();
    fs::write(at("pytorch_model.bin"), &weights).unwrap();
    assert!(told(open(folder.path(), &limits)).contains("32 in 5 heads"));
    fs::write(at("config.json"), "{\"model_type\": \"bert\"}").unwrap();
    let problem = told(open(folder.path(), &limits));
    assert!(problem.contains("a width of whole heads"), "{problem}");
    fs::write(
        at("config.json"),
        "{\"model_type\": \"distilbert\", \"n_heads\": 4}",
    )
    .unwrap();
    for length in (0..weights.len()).step_by(997) {
        fs::write(at("pytorch_model.bin"), &weights[..length]).unwrap();
        assert!(
            DistilBert::read(folder.path(), &limits).is_err(),
            "{length}"
        );
    }
}

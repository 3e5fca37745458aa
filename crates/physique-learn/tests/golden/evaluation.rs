//! The evaluator's networks and the metrics.

use burn::tensor::Device;
use physique_learn::evaluation::{
    CaptionWords, Evaluator, Moments, NumpyRandom, Points, Retrieval, diversity, frechet_distance,
    multimodality,
};

use crate::made_up::{Vectors, difference, fill, input};

const VECTORS: &[u8] = include_bytes!("../fixtures/evaluation.npz");
/// What the vectors demand of values of about 1.
const TOLERANCE: f32 = 2e-4;

fn evaluator(columns: usize) -> Evaluator {
    let blank = Evaluator::new(columns, 1, &Device::flex()).expect("possible");
    let mut parameters = blank.parameters().expect("readable");
    for parameters in &mut parameters {
        fill(parameters, |name| name == "output_net.1.weight");
    }
    blank.with_parameters(parameters).expect("its own")
}

#[allow(clippy::cast_possible_truncation)]
fn f32s(points: &Points) -> Vec<f32> {
    points.values().iter().map(|&value| value as f32).collect()
}

#[test]
fn networks_embed_as_published() {
    let mut vectors = Vectors::open(VECTORS);
    for (name, columns) in [("t2m", 263), ("kit", 251)] {
        let evaluator = evaluator(columns);
        let motions = input(3 * 60 * columns, 0.0);
        let movement = evaluator.movements(&motions, 60).expect("whole motions");
        let error = difference(&movement, &vectors.f32(&format!("{name}_movement")));
        assert!(error < TOLERANCE, "{name}: {error}");

        let motion = evaluator.embed_motions(&motions, 60, &[60, 52, 40]);
        let motion = f32s(&motion.expect("whole motions"));
        let error = difference(&motion, &vectors.f32(&format!("{name}_motion_emb")));
        assert!(error < TOLERANCE, "{name}: {error}");

        let captions = CaptionWords {
            words: 22,
            vectors: input(3 * 22 * 300, 0.2),
            parts_of_speech: (0..66).map(|word| (word % 22 % 15) as u8).collect(),
            lengths: vec![22, 10, 7],
        };
        let text = f32s(&evaluator.embed_captions(&captions).expect("they fit"));
        let error = difference(&text, &vectors.f32(&format!("{name}_text_emb")));
        assert!(error < TOLERANCE, "{name}: {error}");
    }
}

fn points(vectors: &mut Vectors, key: &str) -> Points {
    Points::new(8, vectors.f64(key)).expect("finite")
}

#[test]
fn metrics_are_the_published_ones() {
    let mut vectors = Vectors::open(VECTORS);
    let (a, b) = (points(&mut vectors, "A"), points(&mut vectors, "B"));
    let mut retrieval = Retrieval::default();
    retrieval.add(&a, &b).expect("as many");
    let hits = vectors.f64("top3");
    assert_eq!(
        retrieval.precision().to_vec(),
        [hits[0] / 64.0, hits[1] / 64.0, hits[2] / 64.0]
    );
    let sum = retrieval.multimodal_distance() * 64.0;
    assert!((sum - vectors.f64("match")[0]).abs() < 1e-12);

    let moments = [&a, &b].map(|points| Moments::of(points).expect("64 points"));
    let fid = frechet_distance(&moments[0], &moments[1]).expect("of one width");
    assert!((fid - vectors.f64("fid")[0]).abs() < 1e-9, "{fid}");

    let found = diversity(&a, 20, &mut NumpyRandom::new(0)).expect("64 points");
    assert!((found - vectors.f64("diversity_seed0_20")[0]).abs() < 1e-12);
    // Four captions with 16 motions each.
    let captions: Vec<Points> = (a.values().chunks(16 * 8))
        .map(|motions| Points::new(8, motions.to_vec()).expect("finite"))
        .collect();
    let found = multimodality(&captions, 5, &mut NumpyRandom::new(0)).expect("16 motions");
    assert!((found - vectors.f64("mm_seed0_5")[0]).abs() < 1e-12);
}

#[test]
fn a_distribution_is_no_distance_from_itself() {
    let points = Points::new(8, Vectors::open(VECTORS).f64("A")).expect("finite");
    let moments = Moments::of(&points).expect("64 points");
    let distance = frechet_distance(&moments, &moments).expect("of one width");
    assert!(distance.abs() < 1e-12, "{distance}");
    // Fewer points than dimensions: a singular covariance.
    let few = Points::new(8, points.values()[..5 * 8].to_vec()).expect("finite");
    let few = Moments::of(&few).expect("five points");
    let distance = frechet_distance(&few, &few).expect("of one width");
    assert!(distance.abs() < 1e-7, "{distance}");
}

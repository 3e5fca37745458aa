//! The protocol, with evaluators and generators whose results are known.

use physique_data::{Caption, Dataset};
use physique_learn::Error;
use physique_learn::evaluation::sentence::{SentenceConfig, SentenceEvaluator, SentenceNetworks};
use physique_learn::evaluation::{
    CaptionReading, EvaluationProtocol, Evaluator, MotionGenerator, MultimodalityOptions,
    PairEvaluator, Points, Prompt, ProtocolOptions, PublishedEvaluator, RepetitionMeasures,
    SelfIntersectionMeter, WordVectors,
};
use physique_learn::text::{CaptionCentre, Embeddings, PromptEncoder};
use physique_motion::FrameRate;
use physique_motion::features::{FeatureSkeleton, FeatureStatistics, MotionFeatures};
use physique_text::{MiniLm, TextEncoder as _};

use crate::support::{COLUMNS, MadeUp, NUMBER, dataset};
use crate::words::write_vectors;

/// 64 numbered clips to train with, and 64 others to test with.
fn numbered(folder: &std::path::Path) -> Dataset {
    let clips = |from: usize| (from..from + 64).map(MadeUp::numbered).collect();
    dataset(folder, clips(100), clips(0))
}

fn number(caption: &Caption) -> f64 {
    let number = caption.text.strip_prefix("clip ").expect("numbered");
    number.parse().expect("a number")
}

fn plain_statistics() -> FeatureStatistics {
    let skeleton = FeatureSkeleton::HumanMl3d;
    FeatureStatistics::new(skeleton, vec![0.0; COLUMNS], vec![1.0; COLUMNS]).expect("possible")
}

/// Reads the number of a clip, of its first frame or of the first one behind its length.
struct Oracle {
    statistics: FeatureStatistics,
    behind: bool,
}

impl Oracle {
    fn new(behind: bool) -> Self {
        Self {
            statistics: plain_statistics(),
            behind,
        }
    }
}

fn on_a_line(numbers: impl Iterator<Item = f64>) -> Result<Points, Error> {
    Points::new(
        2,
        numbers.flat_map(|number| [number, 0.5 * number]).collect(),
    )
}

impl PairEvaluator for Oracle {
    fn about(&self) -> String {
        "a test".into()
    }

    fn statistics(&self) -> &FeatureStatistics {
        &self.statistics
    }

    fn embed_motions(
        &self,
        motions: &[f32],
        frames: usize,
        lengths: &[usize],
    ) -> Result<Points, Error> {
        assert_eq!(frames, 196);
        assert_eq!(motions.len(), lengths.len() * frames * COLUMNS);
        let motions = motions.chunks_exact(frames * COLUMNS).zip(lengths);
        on_a_line(motions.map(|(motion, length)| {
            let frame = if self.behind { *length } else { 0 };
            f64::from(motion[frame * COLUMNS + NUMBER])
        }))
    }

    fn embed_captions(&self, captions: &[&Caption], _: CaptionReading) -> Result<Points, Error> {
        on_a_line(captions.iter().map(|caption| number(caption)))
    }
}

/// Makes clips of the right number, off by so much, and by up to 1 more by seed.
struct Numbers {
    off: f32,
    by_seed: bool,
}

impl MotionGenerator for Numbers {
    fn name(&self) -> &str {
        "numbers"
    }

    fn about(&self) -> String {
        "a test".into()
    }

    fn generate(&self, prompts: &[Prompt]) -> Result<Vec<MotionFeatures>, Error> {
        assert_eq!(prompts.len(), 32);
        let motions = prompts.iter().map(|prompt| {
            assert!([40, 44].contains(&prompt.frames), "{}", prompt.frames);
            let mut row = [0.0; COLUMNS];
            row[NUMBER] = number(&prompt.caption) as f32 + self.off;
            if self.by_seed {
                row[NUMBER] += (prompt.seed % 1000) as f32 / 1000.0;
            }
            // More frames than asked for.
            let rows = row.repeat(prompt.frames + 8);
            let rate = FrameRate::new(20.0).expect("possible");
            Ok(MotionFeatures::new(rate, FeatureSkeleton::HumanMl3d, rows)?)
        });
        motions.collect()
    }
}

const fn numbers(off: f32, by_seed: bool) -> Numbers {
    Numbers { off, by_seed }
}

fn options() -> ProtocolOptions {
    ProtocolOptions {
        repetitions: 2,
        multimodality: Some(MultimodalityOptions {
            repetitions: 1,
            ..MultimodalityOptions::default()
        }),
        ..ProtocolOptions::default()
    }
}

fn generated(
    protocol: &EvaluationProtocol<'_>,
    of: &Numbers,
    repetition: usize,
) -> RepetitionMeasures {
    let mut made = 0;
    let measures = protocol.generated(of, repetition, &mut |motions| made += motions);
    assert_eq!(made, protocol.motions_to_generate(repetition));
    measures.expect("it works")
}

#[test]
fn what_agrees_is_found_and_no_distance_away() {
    let folder = tempfile::tempdir().expect("a folder");
    let (dataset, oracle) = (numbered(folder.path()), Oracle::new(false));
    let protocol = EvaluationProtocol::new(&dataset, &oracle, None, options()).expect("possible");
    let real = protocol.real(0).expect("it works");
    let right = generated(&protocol, &numbers(0.0, false), 0);
    for measures in [&real, &right] {
        assert_eq!(measures.r_precision, [1.0; 3]);
        assert!(measures.multimodal_distance < 1e-4);
        // Both draws have all 64 clips once.
        assert!(measures.fid.abs() < 1e-6, "{}", measures.fid);
        assert!(measures.diversity > 1.0);
        assert_eq!([measures.motions, measures.real_motions], [64; 2]);
        assert_eq!(measures.diversity_pairs, 64);
    }
    assert_eq!(real.multimodality, None);
    assert!(right.multimodality.expect("measured") < 1e-4);
    assert_eq!(real.self_intersection_cm3, None);
    // Two batches, 30 times each.
    assert_eq!(protocol.motions_to_generate(0), 1920);
    assert_eq!(protocol.motions_to_generate(1), 64);
}

#[test]
fn a_shift_is_measured_as_such() {
    let folder = tempfile::tempdir().expect("a folder");
    let (dataset, oracle) = (numbered(folder.path()), Oracle::new(false));
    let protocol = EvaluationProtocol::new(&dataset, &oracle, None, options()).expect("possible");
    let shifted = generated(&protocol, &numbers(3.0, false), 1);
    // By 3 and 1.5 along the two dimensions.
    let square = 3.0_f64.powi(2) + 1.5_f64.powi(2);
    assert!((shifted.fid - square).abs() < 1e-4, "{}", shifted.fid);
    let distance = shifted.multimodal_distance;
    assert!((distance - square.sqrt()).abs() < 1e-5, "{distance}");
    assert!(shifted.r_precision[0] < 0.2);
    assert_eq!(shifted.multimodality, None);
    // In the repetition that measures it: two numbers of [0, 1) are a third apart in the mean.
    let varied = generated(&protocol, &numbers(0.0, true), 0);
    let multimodality = varied.multimodality.expect("measured");
    let expected = 1.25_f64.sqrt() / 3.0;
    assert!(
        (multimodality - expected).abs() < 0.15 * expected,
        "{multimodality}"
    );
}

#[test]
fn what_lies_behind_the_end_is_zero_or_what_was_generated() {
    let folder = tempfile::tempdir().expect("a folder");
    let (dataset, oracle) = (numbered(folder.path()), Oracle::new(true));
    let protocol = EvaluationProtocol::new(&dataset, &oracle, None, options()).expect("possible");
    // Real clips are zero there, as if all were number 0.
    let real = protocol.real(0).expect("it works");
    assert_eq!(real.diversity, 0.0);
    let made = generated(&protocol, &numbers(0.0, false), 1);
    assert_eq!(made.r_precision, [1.0; 3]);
}

#[test]
fn repetitions_depend_on_seed_and_number_only() {
    let folder = tempfile::tempdir().expect("a folder");
    let (dataset, oracle) = (numbered(folder.path()), Oracle::new(false));
    let measure = |seed: u64, repetitions: &[usize]| {
        let options = ProtocolOptions { seed, ..options() };
        let protocol = EvaluationProtocol::new(&dataset, &oracle, None, options);
        let protocol = protocol.expect("possible");
        let of = numbers(0.0, true);
        let measures = repetitions.iter().map(|&repetition| {
            let real = protocol.real(repetition).expect("it works");
            (real, generated(&protocol, &of, repetition))
        });
        measures.collect::<Vec<_>>()
    };
    let both = measure(1, &[0, 1]);
    assert_eq!(measure(1, &[1])[0], both[1]);
    assert_ne!(both[0].0.diversity, both[1].0.diversity);
    assert_ne!(measure(2, &[1])[0].1, both[1].1);
}

#[test]
fn rows_say_where_they_are_not_the_papers() {
    let folder = tempfile::tempdir().expect("a folder");
    let (dataset, oracle) = (numbered(folder.path()), Oracle::new(false));
    let protocol = EvaluationProtocol::new(&dataset, &oracle, None, options()).expect("possible");
    let measures: Vec<_> = (0..2)
        .map(|r| protocol.real(r).expect("it works"))
        .collect();
    let row = protocol.row("Real", "the data", &measures);
    assert_eq!(row.diversity.repetitions, 2);
    let mean = (measures[0].diversity + measures[1].diversity) / 2.0;
    assert_eq!(row.diversity.mean, mean);
    assert_eq!(
        row.remarks,
        [
            "64 real motions: FID is biased upwards",
            "64 pairs for diversity",
            "2 repetitions"
        ]
    );
}

/// A sentence evaluator that has learnt nothing.
fn untrained() -> SentenceEvaluator {
    let device = burn::tensor::Device::flex();
    let networks = SentenceNetworks::new(&SentenceConfig::small(COLUMNS, 384), 3, &device);
    let encoder = MiniLm::embedded().expect("embedded");
    let captions = Embeddings::from(&encoder.encode(&["a clip", "a walk", "number 7"]));
    let centre = CaptionCentre::of(&captions).expect("different");
    let prompts = PromptEncoder::new(Box::new(encoder), Some(centre)).expect("of one width");
    let notes = std::collections::BTreeMap::new();
    SentenceEvaluator::new(
        networks.expect("possible"),
        plain_statistics(),
        prompts,
        notes,
    )
    .expect("it fits")
}

#[test]
fn threads_change_nothing() {
    let folder = tempfile::tempdir().expect("a folder");
    let dataset = numbered(folder.path());
    let body = physique::body::open_body_low().expect("embedded");
    let body = physique::body::Body::mean(body, physique::body::Sex::Neutral).expect("possible");
    let meter = SelfIntersectionMeter::new(body).expect("closed");
    let measure = |threads: usize| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build();
        pool.expect("threads").install(|| {
            let evaluator = untrained();
            let protocol = EvaluationProtocol::new(&dataset, &evaluator, Some(&meter), options());
            let protocol = protocol.expect("possible");
            let of = numbers(0.0, true);
            (
                protocol.real(1).expect("it works"),
                generated(&protocol, &of, 1),
            )
        })
    };
    let alone = measure(1);
    assert!(alone.0.self_intersection_cm3.is_some());
    assert_eq!(measure(2), alone);
}

#[test]
fn the_bug_of_issue_182_changes_what_looks_at_captions_only() {
    let folder = tempfile::tempdir().expect("a folder");
    let clips = |from: usize| (from..from + 32).map(MadeUp::numbered).collect();
    let dataset = dataset(folder.path(), clips(40), clips(0));
    let names: Vec<String> = (0..32).map(|number| format!("n{number}")).collect();
    write_vectors(folder.path(), &names);
    let words = WordVectors::read(folder.path(), &Default::default()).expect("sound");
    let networks = Evaluator::new(COLUMNS, 4, &burn::tensor::Device::flex()).expect("possible");
    let name = "a test".to_owned();
    let evaluator = PublishedEvaluator::new(networks, words, plain_statistics(), name);
    let evaluator = evaluator.expect("it fits");
    let measure = |caption_length_bug| {
        let options = ProtocolOptions {
            caption_length_bug,
            ..options()
        };
        let protocol = EvaluationProtocol::new(&dataset, &evaluator, None, options);
        let protocol = protocol.expect("possible");
        (
            protocol.real(1).expect("it works"),
            generated(&protocol, &numbers(0.0, true), 1),
        )
    };
    let (right, wrong) = (measure(false), measure(true));
    assert_eq!(right.0, wrong.0);
    let (right, wrong) = (right.1, wrong.1);
    assert_ne!(right.multimodal_distance, wrong.multimodal_distance);
    let with = RepetitionMeasures {
        r_precision: wrong.r_precision,
        multimodal_distance: wrong.multimodal_distance,
        ..right
    };
    assert_eq!(with, wrong);
    // Sentence evaluators know no words.
    let captions = [&dataset.index().captions[0]];
    let told = untrained().embed_captions(&captions, CaptionReading::WithPadding);
    assert!(
        told.expect_err("refused")
            .to_string()
            .contains("word by word")
    );
}

#[test]
fn what_does_not_fit_is_refused() {
    let folder = tempfile::tempdir().expect("a folder");
    let clips = |from: usize, count: usize| (from..from + count).map(MadeUp::numbered).collect();
    let few = dataset(folder.path(), clips(40, 3), clips(0, 31));
    let oracle = Oracle::new(false);
    let told = |dataset: &Dataset, options: ProtocolOptions| {
        let protocol = EvaluationProtocol::new(dataset, &oracle, None, options);
        protocol
            .err()
            .map_or_else(String::new, |error| error.to_string())
    };
    assert!(told(&few, options()).contains("a batch of 32 or more, found 31"));
    let folder = tempfile::tempdir().expect("a folder");
    let enough = numbered(folder.path());
    let none = ProtocolOptions {
        repetitions: 0,
        ..options()
    };
    assert!(told(&enough, none).contains("repetitions: expected 1 or more"));
    let pairs = ProtocolOptions {
        multimodality: Some(MultimodalityOptions {
            motions: 9,
            ..MultimodalityOptions::default()
        }),
        ..options()
    };
    assert!(told(&enough, pairs).contains("as many as pairs"));
}

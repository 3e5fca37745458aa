//! Our own evaluator: that it learns, goes on, and keeps what it learnt.

use std::f32::consts::TAU;
use std::fs;
use std::path::Path;

use burn::tensor::Device;
use physique_data::{Caption, Dataset};
use physique_learn::Error;
use physique_learn::checkpoint::CheckpointLimits;
use physique_learn::evaluation::sentence::{
    EvaluatorRun, SentenceConfig, SentenceEvaluator, SentenceTraining, train_evaluator,
};
use physique_learn::evaluation::{
    CaptionReading, EvaluationProtocol, EvaluatorSizes, PairEvaluator, ProtocolOptions,
    RepetitionMeasures,
};
use physique_learn::random::Random;
use physique_learn::trainer::TrainerConfig;

use crate::support::{COLUMNS, MadeUp, dataset};

const ACTIONS: [&str; 8] = [
    "walks forward",
    "waves the left hand",
    "waves the right hand",
    "sits down",
    "jumps",
    "turns around",
    "kicks a ball",
    "dances",
];
const MANNERS: [&str; 4] = ["slowly", "quickly", "happily", "sadly"];

/// A wave whose columns tell the action, and whose frequency the manner, with noise.
fn clip(action: usize, manner: usize, take: u64) -> MadeUp {
    let mut random = Random::new(&[action as u64, manner as u64, take]);
    let mut noise = vec![0.0; 60 * COLUMNS];
    random.fill_normal(&mut noise);
    let phase = random.unit() as f32;
    let rows = noise.into_iter().enumerate().map(|(at, noise)| {
        let (frame, column) = (at / COLUMNS, at % COLUMNS);
        let time = phase + frame as f32 / 40.0 * (1 + manner) as f32;
        let strength = if column % ACTIONS.len() == action {
            1.0
        } else {
            0.1
        };
        strength * (TAU * time).sin() + 0.2 * noise
    });
    MadeUp {
        rows: rows.collect(),
        caption: format!("a person {} {}", ACTIONS[action], MANNERS[manner]),
        tokens: "a/DET person/NOUN".into(),
    }
}

/// Each action in each manner: some takes to train with, another one to test with.
fn made_up(folder: &Path) -> Dataset {
    let takes = |takes: std::ops::Range<u64>| {
        let all = takes.flat_map(|take| {
            (0..ACTIONS.len()).flat_map(move |action| {
                (0..MANNERS.len()).map(move |manner| clip(action, manner, take))
            })
        });
        all.collect()
    };
    dataset(folder, takes(0..4), takes(4..5))
}

fn run(steps: u64) -> EvaluatorRun {
    EvaluatorRun {
        networks: Some(SentenceConfig {
            columns: COLUMNS,
            text: 384,
            sizes: EvaluatorSizes {
                movement: 32,
                motion_state: 32,
                text_state: 64,
                embedding: 32,
            },
        }),
        training: SentenceTraining {
            batch: 16,
            ..SentenceTraining::default()
        },
        trainer: TrainerConfig {
            steps,
            save_every: 2,
            log_every: 1,
            ..EvaluatorRun::default().trainer
        },
    }
}

fn trained(dataset: &Dataset, steps: u64, folder: &Path) -> SentenceEvaluator {
    let evaluator = train_evaluator(dataset, &run(steps), folder, &Device::flex(), |_| true);
    evaluator.expect("it trains").expect("it is not stopped")
}

fn measure(dataset: &Dataset, evaluator: &SentenceEvaluator) -> RepetitionMeasures {
    let options = ProtocolOptions::default();
    let protocol = EvaluationProtocol::new(dataset, evaluator, None, options);
    protocol.expect("it fits").real(0).expect("it works")
}

#[test]
fn it_learns_which_caption_belongs_to_which_motion() {
    let folder = tempfile::tempdir().expect("a folder");
    let dataset = made_up(folder.path());
    let before = measure(
        &dataset,
        &trained(&dataset, 1, &folder.path().join("short")),
    );
    let after = measure(
        &dataset,
        &trained(&dataset, 200, &folder.path().join("long")),
    );
    // By chance 1 and 3 of 32: 0.03 and 0.09.
    assert!(before.r_precision[2] < 0.3, "{:?}", before.r_precision);
    assert!(after.r_precision[0] > 0.3, "{:?}", after.r_precision);
    assert!(after.r_precision[2] > 0.8, "{:?}", after.r_precision);
}

#[test]
fn it_is_read_as_it_was_written() {
    let folder = tempfile::tempdir().expect("a folder");
    let dataset = made_up(folder.path());
    let out = folder.path().join("out");
    let evaluator = trained(&dataset, 2, &out);
    let read = |folder: &Path| {
        SentenceEvaluator::read(folder, &CheckpointLimits::default(), &Device::flex())
    };
    let again = read(&out).expect("just written");
    assert_eq!(again.about(), evaluator.about());
    assert!(
        again.about().contains("data humanml3d"),
        "{}",
        again.about()
    );
    assert_eq!(measure(&dataset, &again), measure(&dataset, &evaluator));
    let captions = [Caption {
        text: "a person jumps".into(),
        tokens: None,
    }];
    let embed = |evaluator: &SentenceEvaluator| {
        let points = evaluator.embed_captions(&[&captions[0]], CaptionReading::Whole);
        points.expect("a sentence")
    };
    assert_eq!(embed(&again), embed(&evaluator));
    assert_eq!(embed(&again).width(), 32);

    // What is broken is told, with the file.
    let config = fs::read_to_string(out.join("config.json")).expect("written");
    let told = |from: &str, to: &str| {
        assert!(config.contains(from), "{from}");
        fs::write(out.join("config.json"), config.replacen(from, to, 1)).expect("written");
        read(&out).expect_err("broken").to_string()
    };
    assert!(told("physique-evaluator 1", "physique-evaluator 2").contains("`format`"));
    assert!(told("all-MiniLM-L6-v2", "another").contains("`text_encoder`: expected all-MiniLM"));
    assert!(told("\"columns\": 263", "\"columns\": 251").contains("expected shape [32, 247, 4]"));
    assert!(told("\"columns\": 263", "\"columns\": 99999999999").contains("at most 8192"));
    assert!(told("\"movement\": 32", "\"movement\": 0").contains("movement: expected 1 to 8192"));
    assert!(told("\"text\"", "\"test\"").contains("unknown field `test`"));
    assert!(told("\"factor\":", "\"factor\": -1, \"factor\":").contains("config.json"));
    fs::write(out.join("config.json"), &config).expect("written");
    fs::remove_file(out.join("model.safetensors")).expect("removed");
    assert!(
        read(&out)
            .expect_err("gone")
            .to_string()
            .contains("model.safetensors")
    );
}

#[test]
fn a_stopped_run_goes_on_bit_for_bit() {
    let folder = tempfile::tempdir().expect("a folder");
    let dataset = made_up(folder.path());
    let [whole, parts] = ["whole", "parts"].map(|name| folder.path().join(name));
    let pool = rayon::ThreadPoolBuilder::new().num_threads(1).build();
    pool.expect("a thread").install(|| {
        trained(&dataset, 5, &whole);
        let stop = |report: &physique_learn::trainer::StepReport| report.step < 3;
        let stopped = train_evaluator(&dataset, &run(5), &parts, &Device::flex(), stop);
        assert!(stopped.expect("it trains").is_none());
        assert!(!parts.join("config.json").exists());
        trained(&dataset, 5, &parts);
    });
    let model = |folder: &Path| fs::read(folder.join("model.safetensors")).expect("written");
    assert_eq!(model(&whole), model(&parts));

    // Other settings are another run.
    let mut other = run(5);
    other.training.temperature = 3.0;
    let told = train_evaluator(&dataset, &other, &parts, &Device::flex(), |_| true);
    let told = told.expect_err("another run").to_string();
    assert!(
        told.contains("settings.json") && told.contains("10.0"),
        "{told}"
    );
}

#[test]
fn settings_that_cannot_be_are_refused() {
    let folder = tempfile::tempdir().expect("a folder");
    let dataset = made_up(folder.path());
    let told = |change: fn(&mut SentenceTraining)| {
        let mut run = run(1);
        change(&mut run.training);
        let out = tempfile::tempdir().expect("a folder");
        match train_evaluator(&dataset, &run, out.path(), &Device::flex(), |_| true) {
            Err(Error::Setting { what, .. }) => what,
            other => panic!("{other:?}"),
        }
    };
    assert_eq!(told(|training| training.batch = 1), "batch");
    assert_eq!(told(|training| training.temperature = 0.0), "temperature");
    assert_eq!(
        told(|training| training.same_caption = f64::NAN),
        "same_caption"
    );
    assert_eq!(told(|training| training.dropout = 1.0), "dropout");
}

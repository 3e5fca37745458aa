//! Training: that it learns, and that a run that was killed goes on as if nothing had been.

use std::f32::consts::TAU;
use std::path::Path;
use std::process::{Command, Stdio};
use std::time::{Duration, Instant};

use burn::tensor::Device;
use physique_learn::Error;
use physique_learn::layers::NormPlace;
use physique_learn::mdm::{
    Architecture, ConditionKind, Mdm, MdmConfig, MdmTask, MdmTraining, PlannerConfig, parameters_of,
};
use physique_learn::random::Random;
use physique_learn::text::Embeddings;
use physique_learn::trainer::{
    AdamWConfig, BatchCondition, MotionBatch, MotionSource, RateSchedule, Trainer, TrainerConfig,
};
use physique_motion::features::{FeatureSkeleton, FeatureStatistics};

const COLUMNS: usize = 263;
const FRAMES: usize = 8;

/// Two kinds of waves, told apart by a caption of two numbers.
#[derive(Debug)]
struct Waves {
    /// The step whose motions are NaN.
    broken: Option<u64>,
}

impl MotionSource for Waves {
    fn columns(&self) -> usize {
        COLUMNS
    }

    fn batch(&self, size: usize, seed: u64, step: u64) -> Result<MotionBatch, Error> {
        let mut random = Random::new(&[seed, step]);
        let (mut features, mut lengths, mut captions) = (Vec::new(), Vec::new(), Vec::new());
        for _ in 0..size {
            let kind = random.below(2);
            let (phase, length) = (random.unit() as f32, 5 + random.below(4));
            for frame in 0..FRAMES {
                let time = phase + frame as f32 / FRAMES as f32 * (1 + kind) as f32;
                let within = if frame < length { 1.0 } else { 0.0 };
                let row = (0..COLUMNS).map(|column| (TAU * time + column as f32).sin() * within);
                features.extend(row);
            }
            lengths.push(length);
            captions.extend([1.0 - kind as f32, kind as f32]);
        }
        if self.broken == Some(step) {
            features[7] = f32::NAN;
        }
        Ok(MotionBatch {
            frames: FRAMES,
            features,
            lengths,
            condition: BatchCondition::Text(Embeddings {
                batch: size,
                tokens: 1,
                width: 2,
                values: captions,
                padding: vec![false; size],
            }),
        })
    }
}

fn config(steps: u64) -> TrainerConfig {
    TrainerConfig {
        steps,
        seed: 3,
        optimiser: AdamWConfig {
            rate: 2e-3,
            weight_decay: 0.01,
            ..AdamWConfig::default()
        },
        rate: RateSchedule::Constant,
        clip: Some(1.0),
        average: Some(0.9),
        save_every: 3,
        keep: None,
        log_every: 1,
    }
}

fn trainer(folder: &Path, config: TrainerConfig, broken: Option<u64>) -> Trainer<MdmTask<Waves>> {
    with_dropout(0.1, folder, config, broken)
}

fn with_dropout(
    dropout: f64,
    folder: &Path,
    config: TrainerConfig,
    broken: Option<u64>,
) -> Trainer<MdmTask<Waves>> {
    let skeleton = FeatureSkeleton::HumanMl3d;
    let statistics = FeatureStatistics::new(skeleton, vec![0.0; COLUMNS], vec![1.0; COLUMNS]);
    let device = Device::flex().autodiff();
    let training = MdmTraining {
        batch: 4,
        diffusion_steps: 20,
        signal: 0.3,
        root_weight: 2.0,
        velocity_weight: 0.5,
        ..MdmTraining::default()
    };
    let statistics = statistics.expect("possible");
    let task = MdmTask::new(Waves { broken }, &statistics, training);
    let network = MdmConfig {
        width: 16,
        layers: 2,
        heads: 2,
        feed_forward: 32,
        condition: ConditionKind::Sentence { width: 2 },
        mask_frames: true,
        norm: NormPlace::Pre,
        condition_every_frame: true,
        frames_per_token: 2,
        dropout,
        ..MdmConfig::default()
    };
    let network = Mdm::new(&network, 5, &device).expect("possible");
    Trainer::open(task.expect("it fits"), network, config, folder).expect("a new run")
}

/// Losses of all steps, and the network, to the bit.
fn losses(trainer: &mut Trainer<MdmTask<Waves>>) -> Vec<u64> {
    let mut losses = Vec::new();
    let run = trainer.run(|report| {
        losses.push(report.loss.to_bits());
        true
    });
    run.expect("finite");
    losses
}

fn on_one_thread<T: Send>(run: impl FnOnce() -> T + Send) -> T {
    let threads = rayon::ThreadPoolBuilder::new().num_threads(1).build();
    threads.expect("a thread").install(run)
}

/// Lines of the log without the time they took.
fn log(folder: &Path) -> Vec<String> {
    let text = std::fs::read_to_string(folder.join("log.jsonl")).expect("a log");
    let lines = text.lines().map(|line| {
        let end = line.find(",\"seconds\"").expect("seconds come last");
        line[..end].to_owned()
    });
    lines.collect()
}

#[test]
fn it_learns() {
    let folder = tempfile::tempdir().expect("a folder");
    let mut trainer = trainer(folder.path(), config(150), None);
    let losses: Vec<f64> = (losses(&mut trainer).into_iter())
        .map(f64::from_bits)
        .collect();
    let mean = |losses: &[f64]| losses.iter().sum::<f64>() / losses.len() as f64;
    let (first, last) = (mean(&losses[..20]), mean(&losses[130..]));
    assert!(last < 0.5 * first, "from {first} to {last}");
}

#[test]
fn a_stopped_run_goes_on_bit_for_bit() {
    let [whole, parts] = [(); 2].map(|()| tempfile::tempdir().expect("a folder"));
    on_one_thread(|| {
        let mut uninterrupted = trainer(whole.path(), config(8), None);
        let expected = losses(&mut uninterrupted);
        let mut first = trainer(parts.path(), config(8), None);
        let mut found = Vec::new();
        let stopped = first.run(|report| {
            found.push(report.loss.to_bits());
            report.step < 5
        });
        stopped.expect("finite");
        drop(first);
        let mut second = trainer(parts.path(), config(8), None);
        assert_eq!(second.steps_done(), 5);
        found.extend(losses(&mut second));
        assert_eq!(found, expected);
        let parameters = |trainer: &Trainer<MdmTask<Waves>>| {
            parameters_of(&trainer.network(), "a test").expect("readable")
        };
        assert_eq!(parameters(&second), parameters(&uninterrupted));
    });
    assert_eq!(log(parts.path()), log(whole.path()));
}

/// The run that [`a_killed_run_goes_on_bit_for_bit`] kills; by itself it does nothing.
#[test]
fn child() {
    if let Ok(folder) = std::env::var("PHYSIQUE_TEST_RUN") {
        on_one_thread(|| losses(&mut trainer(Path::new(&folder), config(1_000_000), None)));
    }
}

#[test]
fn a_killed_run_goes_on_bit_for_bit() {
    let [whole, killed] = [(); 2].map(|()| tempfile::tempdir().expect("a folder"));
    let lines = || {
        let log = std::fs::read(killed.path().join("log.jsonl")).unwrap_or_default();
        log.iter().filter(|byte| **byte == b'\n').count()
    };
    let mut child = Command::new(std::env::current_exe().expect("this test"))
        .args(["--exact", "child"])
        .env("PHYSIQUE_TEST_RUN", killed.path())
        .stdout(Stdio::null())
        .spawn()
        .expect("a child");
    let start = Instant::now();
    while lines() < 7 && start.elapsed() < Duration::from_secs(120) {
        std::thread::sleep(Duration::from_millis(2));
    }
    // SIGKILL on Unix: the child cannot clean up.
    child.kill().expect("it runs");
    child.wait().expect("it is gone");
    let reached = lines();
    assert!(reached >= 7);
    // Half a line, as a kill may leave it.
    let log_path = killed.path().join("log.jsonl");
    let mut text = std::fs::read(&log_path).expect("a log");
    text.extend(b"{\"step\":9");
    std::fs::write(&log_path, text).expect("written");

    let steps = reached as u64 + 5;
    on_one_thread(|| {
        let mut resumed = trainer(killed.path(), config(steps), None);
        // The newest checkpoint: every third step is one.
        assert!(resumed.steps_done() >= 3 && resumed.steps_done().is_multiple_of(3));
        losses(&mut resumed);
        losses(&mut trainer(whole.path(), config(steps), None));
    });
    assert_eq!(log(killed.path()), log(whole.path()));
}

#[test]
fn numbers_that_are_none_stop_the_run() {
    let folder = tempfile::tempdir().expect("a folder");
    let mut broken = trainer(folder.path(), config(20), Some(4));
    let told = broken.run(|_| true).expect_err("NaN").to_string();
    assert!(
        told.starts_with("Training, step 5: the squared_error is NaN"),
        "{told}"
    );
    drop(broken);
    // What was saved before is sound.
    let mut mended = trainer(folder.path(), config(6), None);
    assert_eq!(mended.steps_done(), 3);
    assert_eq!(losses(&mut mended).len(), 3);
}

#[test]
fn a_run_with_other_settings_is_refused() {
    let folder = tempfile::tempdir().expect("a folder");
    losses(&mut trainer(folder.path(), config(3), None));
    let skeleton = FeatureSkeleton::HumanMl3d;
    let statistics = FeatureStatistics::new(skeleton, vec![0.0; COLUMNS], vec![1.0; COLUMNS]);
    let device = Device::flex().autodiff();
    let training = MdmTraining::default();
    let statistics = statistics.expect("possible");
    let task = MdmTask::new(Waves { broken: None }, &statistics, training);
    let network = MdmConfig {
        condition: ConditionKind::Sentence { width: 2 },
        width: 16,
        layers: 1,
        ..MdmConfig::default()
    };
    let network = Mdm::new(&network, 5, &device).expect("possible");
    let other = TrainerConfig {
        seed: 4,
        ..config(3)
    };
    let told = Trainer::open(task.expect("it fits"), network, other, folder.path());
    let told = told.expect_err("another seed").to_string();
    assert!(
        told.contains("seed 4") && told.contains("found seed 3"),
        "{told}"
    );
}

/// Two and four parts of each batch, on copies of the network, with averaged gradients: the same run.
#[test]
fn a_batch_may_be_shared_among_devices() {
    let run = |devices: usize| {
        let folder = tempfile::tempdir().expect("a folder");
        let devices = vec![Device::flex().autodiff(); devices];
        let trainer = with_dropout(0.0, folder.path(), config(4), None);
        let mut trainer = trainer.on_devices(devices);
        let mut reports = Vec::new();
        let done = trainer.run(|report| {
            reports.push((report.loss, report.gradient_norm, report.parts.clone()));
            true
        });
        done.expect("finite");
        reports
    };
    let alone = run(0);
    assert_eq!(alone, run(1), "one device is no change, to the bit");
    for devices in [2, 4] {
        for ((loss, norm, parts), (shared, shared_norm, shared_parts)) in
            alone.iter().zip(run(devices))
        {
            assert!((loss / shared - 1.0).abs() < 1e-5, "{loss} {shared}");
            assert!(
                (norm / shared_norm - 1.0).abs() < 1e-4,
                "{norm} {shared_norm}"
            );
            for ((name, part), (_, shared)) in parts.iter().zip(shared_parts) {
                assert!(
                    (part / shared - 1.0).abs() < 1e-5,
                    "{name}: {part} {shared}"
                );
            }
        }
    }

    let folder = tempfile::tempdir().expect("a folder");
    let trainer = with_dropout(0.0, folder.path(), config(4), None);
    let mut trainer = trainer.on_devices(vec![Device::flex().autodiff(); 3]);
    let told = trainer
        .run(|_| true)
        .expect_err("4 motions for 3")
        .to_string();
    assert!(told.contains("a multiple of 3"), "{told}");
}

#[test]
fn a_planner_learns_to_go_on() {
    let loss = |context: usize| {
        let skeleton = FeatureSkeleton::HumanMl3d;
        let statistics = FeatureStatistics::new(skeleton, vec![0.0; COLUMNS], vec![1.0; COLUMNS]);
        let training = MdmTraining {
            batch: 4,
            diffusion_steps: 10,
            velocity_weight: 0.5,
            ..MdmTraining::default()
        };
        let task = MdmTask::new(
            Waves { broken: None },
            &statistics.expect("possible"),
            training,
        );
        let network = MdmConfig {
            width: 16,
            layers: 1,
            heads: 2,
            feed_forward: 32,
            condition: ConditionKind::Sentence { width: 2 },
            architecture: Architecture::Decoder,
            mask_frames: true,
            planner: Some(PlannerConfig {
                context,
                prediction: 4,
            }),
            ..MdmConfig::default()
        };
        let folder = tempfile::tempdir().expect("a folder");
        let network = Mdm::new(&network, 5, &Device::flex().autodiff()).expect("possible");
        let task = task.expect("it fits");
        let mut trainer = Trainer::open(task, network, config(60), folder.path())?;
        let mut losses = Vec::new();
        trainer.run(|report| {
            losses.push(report.loss);
            true
        })?;
        Ok::<_, Error>(losses)
    };
    let losses = loss(4).expect("finite");
    let mean = |losses: &[f64]| losses.iter().sum::<f64>() / losses.len() as f64;
    let (first, last) = (mean(&losses[..10]), mean(&losses[50..]));
    assert!(last < 0.8 * first, "{first} {last}");
    // Motions of five frames cannot be gone on with after five.
    let told = loss(5).expect_err("too short").to_string();
    assert!(told.contains("more than the 5 frames"), "{told}");
}

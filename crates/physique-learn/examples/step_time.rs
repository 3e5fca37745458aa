//! Time and memory of training steps, beside `benches/peers/step_time.py`, which does the same in
//! PyTorch.
//!
//! Usage: step_time [large|small] [STEPS] [SELF_INTERSECTION_WEIGHT], as many threads as
//! `RAYON_NUM_THREADS`, else all cores.
#![allow(clippy::expect_used, reason = "an example has no one to report to")]

use burn::tensor::Device;
use physique_learn::Error;
use physique_learn::layers::NormPlace;
use physique_learn::mdm::{ConditionKind, Mdm, MdmConfig, MdmTask, MdmTraining};
use physique_learn::random::Random;
use physique_learn::text::Embeddings;
use physique_learn::trainer::{BatchCondition, MotionBatch, MotionSource, Trainer, TrainerConfig};
use physique_motion::embedded;
use physique_motion::features::{
    FeatureSkeleton, FeatureStatistics, JointPositions, StatisticsGatherer, extract,
};
use physique_motion::mapping::BodyRest;

/// A network and what it sees in a step.
struct Case {
    network: MdmConfig,
    batch: usize,
    frames: usize,
}

/// As published for HumanML3D.
fn large() -> Case {
    Case {
        network: MdmConfig::default(),
        batch: 64,
        frames: 196,
    }
}

/// As for a model that fits into a program.
fn small() -> Case {
    Case {
        network: MdmConfig {
            width: 256,
            layers: 5,
            condition: ConditionKind::Sentence { width: 384 },
            mask_frames: true,
            norm: NormPlace::Pre,
            condition_every_frame: true,
            frames_per_token: 2,
            ..MdmConfig::default()
        },
        batch: 16,
        frames: 120,
    }
}

fn main() {
    let mut arguments = std::env::args().skip(1);
    let name = arguments.next().unwrap_or_else(|| "small".into());
    let case = if name == "large" { large() } else { small() };
    let steps = arguments
        .next()
        .map_or(5, |steps| steps.parse().expect("a number"));
    let weight = arguments
        .next()
        .map_or(0.0, |weight| weight.parse().expect("a number"));

    let device = Device::flex().autodiff();
    let (features, statistics) = features();
    let ConditionKind::Sentence { width } = case.network.condition else {
        unreachable!("both read sentences");
    };
    let source = Clip {
        features,
        frames: case.frames,
        width,
    };
    let training = MdmTraining {
        batch: case.batch,
        diffusion_steps: 50,
        self_intersection_weight: weight,
        ..MdmTraining::default()
    };
    let task = MdmTask::new(source, &statistics, training).expect("it fits");
    let network = Mdm::new(&case.network, 1, &device).expect("possible");
    let config = TrainerConfig {
        // One more, which is not counted.
        steps: steps + 1,
        clip: Some(1.0),
        average: Some(0.999),
        ..TrainerConfig::default()
    };
    let folder = tempfile::tempdir().expect("a folder");
    let mut trainer = Trainer::open(task, network, config, folder.path()).expect("a new run");
    let (mut wall, mut losses, mut cpu) = (Vec::new(), Vec::new(), Vec::new());
    let run = trainer.run(|report| {
        cpu.push(processor_seconds());
        if report.step > 1 {
            wall.push(report.seconds);
        }
        losses.push(report.loss);
        true
    });
    run.expect("finite");
    let cpu = (cpu[steps as usize] - cpu[0]) / steps as f64;
    wall.sort_by(f64::total_cmp);
    println!(
        "{name}: wall {:.4} s, CPU {cpu:.4} s a step, process {:.0} MiB at most, losses {losses:.4?}",
        wall[wall.len() / 2],
        memory("VmHWM"),
    );
}

/// Features of a real clip, and their statistics.
fn features() -> (Vec<f32>, FeatureStatistics) {
    let body = physique::body::open_body().expect("embedded");
    let body = physique::body::Body::new(body, &[]).expect("mean shape");
    let clip = embedded::clips().iter().next().expect("clips");
    let motion = clip.load().expect("embedded").motion;
    let positions = JointPositions::from_motion(&motion, &BodyRest::from(&body));
    let features = extract(&positions.expect("finite")).expect("frames");
    let mut gatherer = StatisticsGatherer::new(FeatureSkeleton::HumanMl3d);
    gatherer.add(&features).expect("of one skeleton");
    let statistics = gatherer.finish().expect("it moves");
    let mut features = features.values().to_vec();
    statistics.normalise(&mut features);
    (features, statistics)
}

/// Windows of one clip, from any frame on, round and round.
#[derive(Debug)]
struct Clip {
    features: Vec<f32>,
    frames: usize,
    width: usize,
}

impl MotionSource for Clip {
    fn columns(&self) -> usize {
        FeatureSkeleton::HumanMl3d.feature_count()
    }

    fn batch(&self, size: usize, seed: u64, step: u64) -> Result<MotionBatch, Error> {
        let mut random = Random::new(&[seed, step]);
        let count = self.frames * self.columns();
        let features = (0..size).flat_map(|_| {
            let start = random.below(self.features.len() / self.columns()) * self.columns();
            self.features
                .iter()
                .copied()
                .cycle()
                .skip(start)
                .take(count)
        });
        let features = features.collect();
        let mut values = vec![0.0; size * self.width];
        random.fill_normal(&mut values);
        Ok(MotionBatch {
            frames: self.frames,
            features,
            lengths: vec![self.frames; size],
            condition: BatchCondition::Text(Embeddings {
                batch: size,
                tokens: 1,
                width: self.width,
                values,
                padding: vec![false; size],
            }),
        })
    }
}

/// Processor time of all threads; 0 where the system does not tell.
fn processor_seconds() -> f64 {
    let stat = std::fs::read_to_string("/proc/self/stat").unwrap_or_default();
    // User and system time are the 14th and 15th number; names may hold spaces, but end in `)`.
    let after = stat.rsplit(')').next().unwrap_or_default();
    let ticks = after.split_whitespace().skip(11).take(2);
    ticks
        .filter_map(|ticks| ticks.parse::<f64>().ok())
        .sum::<f64>()
        / 100.0
}

/// A line of the process's status, in MiB; 0 where the system does not tell.
fn memory(line: &str) -> f64 {
    let status = std::fs::read_to_string("/proc/self/status").unwrap_or_default();
    let found = status.lines().find_map(|text| text.strip_prefix(line));
    let number = found.and_then(|text| text.split_whitespace().nth(1));
    number
        .and_then(|number| number.parse::<f64>().ok())
        .unwrap_or(0.0)
        / 1024.0
}

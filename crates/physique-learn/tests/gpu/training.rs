//! Steps of training: losses and gradients by every parameter.

use std::collections::BTreeMap;

use burn::module::{Module, ModuleVisitor, Param};
use burn::tensor::{Device, Gradients, Tensor};
use physique_learn::Error;
use physique_learn::layers::NormPlace;
use physique_learn::mdm::{Architecture, ConditionKind, Mdm, MdmConfig, MdmTask, MdmTraining};
use physique_learn::random::Random;
use physique_learn::text::Embeddings;
use physique_learn::trainer::{
    BatchCondition, MotionBatch, MotionSource, Task, Trainer, TrainerConfig,
};
use physique_motion::features::{FeatureSkeleton, FeatureStatistics};

use crate::support::{FRAMES, LENGTHS, batch, difference, gpu, numbers};

const WIDTH: usize = 6;
const TOKENS: usize = 5;

/// The same motions at every step, with captions.
#[derive(Clone, Debug)]
struct Motions {
    features: Vec<f32>,
    tokens: Option<usize>,
}

impl MotionSource for Motions {
    fn columns(&self) -> usize {
        FeatureSkeleton::HumanMl3d.feature_count()
    }

    fn batch(&self, _size: usize, _seed: u64, _step: u64) -> Result<MotionBatch, Error> {
        let condition = self.tokens.map_or(BatchCondition::Nothing, |tokens| {
            let batch = LENGTHS.len();
            let mut values = vec![0.0; batch * tokens * WIDTH];
            Random::new(&[6]).fill_normal(&mut values);
            // The last vector of the first caption is padding, where there is more than one.
            let hidden = |place| tokens > 1 && place == tokens - 1;
            BatchCondition::Text(Embeddings {
                batch,
                tokens,
                width: WIDTH,
                values,
                padding: (0..batch * tokens).map(hidden).collect(),
            })
        });
        Ok(MotionBatch {
            frames: FRAMES,
            features: self.features.clone(),
            lengths: LENGTHS.to_vec(),
            condition,
        })
    }
}

/// Small networks of every kind.
fn networks() -> [(MdmConfig, Option<usize>); 3] {
    let small = MdmConfig {
        width: 16,
        layers: 2,
        heads: 2,
        feed_forward: 32,
        condition: ConditionKind::Sentence { width: WIDTH },
        mask_frames: true,
        ..MdmConfig::default()
    };
    let decoder = MdmConfig {
        architecture: Architecture::DecoderWithTimeToken,
        condition: ConditionKind::Tokens { width: WIDTH },
        ..small.clone()
    };
    let shortened = MdmConfig {
        norm: NormPlace::Pre,
        condition: ConditionKind::Unconditioned,
        frames_per_token: 2,
        ..small.clone()
    };
    [(small, Some(1)), (decoder, Some(TOKENS)), (shortened, None)]
}

fn task(tokens: Option<usize>) -> MdmTask<Motions> {
    let (features, statistics): (_, FeatureStatistics) = batch(FeatureSkeleton::HumanMl3d, 0.0);
    let training = MdmTraining {
        batch: LENGTHS.len(),
        diffusion_steps: 20,
        velocity_weight: 0.5,
        self_intersection_weight: 0.5,
        ground_weight: 0.1,
        sliding_weight: 0.1,
        ..MdmTraining::default()
    };
    MdmTask::new(Motions { features, tokens }, &statistics, training).expect("it fits")
}

/// Gradients by the parameters' names.
struct Collector {
    path: Vec<String>,
    gradients: Gradients,
    found: BTreeMap<String, Vec<f32>>,
}

impl ModuleVisitor for Collector {
    fn enter_module(&mut self, name: &str, _kind: &str) {
        self.path.push(name.into());
    }

    fn exit_module(&mut self, _name: &str, _kind: &str) {
        self.path.pop();
    }

    fn visit_float<const D: usize>(&mut self, parameter: &Param<Tensor<D>>) {
        if let Some(by) = parameter.val().grad(&self.gradients) {
            self.found.insert(self.path.join("."), numbers(by));
        }
    }
}

struct Found {
    total: f32,
    parts: Vec<(&'static str, f32)>,
    gradients: BTreeMap<String, Vec<f32>>,
}

fn differentiate(config: &MdmConfig, tokens: Option<usize>, device: &Device) -> Found {
    let network = Mdm::new(config, 5, &device.clone().autodiff()).expect("possible");
    let loss = task(tokens).loss(&network, 3, 0).expect("finite");
    let mut collector = Collector {
        path: Vec::new(),
        gradients: loss.total.clone().backward(),
        found: BTreeMap::new(),
    };
    network.visit(&mut collector);
    let parts = loss.parts.into_iter();
    Found {
        total: numbers(loss.total)[0],
        parts: parts.map(|(name, part)| (name, numbers(part)[0])).collect(),
        gradients: collector.found,
    }
}

/// With dropout, whose masks are the same everywhere.
#[test]
fn losses_and_gradients_of_a_step_are_those_of_the_processor() {
    let Some(device) = gpu() else { return };
    for (config, tokens) in networks() {
        let expected = differentiate(&config, tokens, &Device::flex());
        let found = differentiate(&config, tokens, &device);
        assert_eq!(found.parts.len(), 5);
        for ((name, found), (_, expected)) in found.parts.iter().zip(&expected.parts) {
            let far = (found - expected).abs();
            assert!(far < 1e-4 * expected, "{name}: {found} {expected}");
        }
        assert!((found.total - expected.total).abs() < 1e-4 * expected.total);
        let all = |found: &Found| {
            found
                .gradients
                .values()
                .flatten()
                .copied()
                .collect::<Vec<_>>()
        };
        let whole = difference(&all(&found), &all(&expected));
        println!("{:?}: gradients {whole:.1e}", config.architecture);
        assert!(whole < 1e-4, "{whole}");
        let most = all(&expected)
            .iter()
            .fold(0.0, |most: f32, by| most.max(by.abs()));
        for (name, expected) in &expected.gradients {
            let found = &found.gradients[name];
            let size = expected
                .iter()
                .fold(0.0, |most: f32, by| most.max(by.abs()));
            // Some cancel but for rounding, as those of the keys' offsets.
            let size = size.max(1e-3 * most);
            for (found, expected) in found.iter().zip(expected) {
                let far = (found - expected).abs();
                assert!(far < 1e-3 * size, "{name}: {found} {expected} of {size}");
            }
        }
    }
}

/// A run on one device goes on, on the other.
#[test]
fn runs_are_those_of_the_processor() {
    let Some(device) = gpu() else { return };
    let (config, tokens) = networks()[0].clone();
    let run = |device: &Device, folder: &std::path::Path, until: u64| {
        let network = Mdm::new(&config, 5, &device.clone().autodiff()).expect("possible");
        let plan = TrainerConfig {
            steps: 4,
            save_every: 2,
            clip: Some(1.0),
            average: Some(0.9),
            ..TrainerConfig::default()
        };
        let mut trainer = Trainer::open(task(tokens), network, plan, folder).expect("a run");
        let mut losses = Vec::new();
        let done = trainer.run(|report| {
            losses.push(report.loss as f32);
            report.step < until
        });
        done.expect("finite");
        losses
    };
    let folders = [(); 2].map(|()| tempfile::tempdir().expect("a folder"));
    let cpu = Device::flex();
    let expected = run(&cpu, folders[0].path(), 4);
    let mut found = run(&device, folders[1].path(), 2);
    found.extend(run(&cpu, folders[1].path(), 4));
    assert_eq!(found.len(), 4);
    let far = difference(&found, &expected);
    println!("losses of a run: {far:.1e}");
    assert!(far < 1e-3, "{found:?} {expected:?}");
    assert!(expected[3] < expected[0]);
}

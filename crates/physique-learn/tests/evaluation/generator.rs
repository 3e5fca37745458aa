//! Diffusion models as generators of the protocol.

use burn::tensor::Device;
use physique_data::Caption;
use physique_learn::evaluation::{MotionGenerator, Prompt, TextToMotionGenerator};
use physique_learn::mdm::{self, EmbeddedNetwork, MdmFolder, Sampling, TextToMotion};
use physique_text::MiniLm;

const LONGEST: usize = 60;

fn network(mask_frames: bool) -> TextToMotion {
    let mut folder = MdmFolder::embedded(EmbeddedNetwork::Small, &Device::flex()).expect("whole");
    if !mask_frames {
        let config = mdm::MdmConfig {
            mask_frames,
            ..folder.network.config().clone()
        };
        folder.network = mdm::Mdm::new(&config, 1, &Device::flex()).expect("possible");
    }
    let encoder = MiniLm::embedded().expect("embedded");
    TextToMotion::new(folder, Some(Box::new(encoder))).expect("its encoder")
}

fn prompts() -> Vec<Prompt> {
    let lengths = [40, 8, 24, 60, 9, 33, 12, 50, 16, 21];
    let prompt = |(seed, frames): (usize, usize)| Prompt {
        caption: Caption {
            text: format!("a person walks, take {seed}"),
            tokens: None,
        },
        frames,
        seed: seed as u64,
    };
    lengths.into_iter().enumerate().map(prompt).collect()
}

fn sampling() -> Sampling {
    Sampling {
        steps: Some(3),
        ..Sampling::default()
    }
}

/// As the published evaluation samples them: all with the frames of the longest window.
fn published(network: &TextToMotion, prompts: &[Prompt]) -> Vec<Vec<f32>> {
    let asked: Vec<mdm::Prompt<'_>> = prompts
        .iter()
        .map(|prompt| mdm::Prompt {
            text: &prompt.caption.text,
            upper_body: None,
            frames: prompt.frames,
            seed: prompt.seed,
        })
        .collect();
    let made = network.generate_whole(&asked, sampling(), LONGEST);
    let made = made.expect("finite").into_iter();
    made.map(|motion| motion.values().to_vec()).collect()
}

/// Motions of like length are sampled together, and no more frames than are seen.
#[test]
fn what_the_evaluator_sees_is_as_published() {
    let prompts = prompts();
    let whole = published(&network(true), &prompts);
    let generator = TextToMotionGenerator::new(network(true), sampling(), "groups".into(), LONGEST);
    let made = generator.generate(&prompts).expect("finite");
    assert_eq!(made.len(), prompts.len());
    for ((made, whole), prompt) in made.iter().zip(&whole).zip(&prompts) {
        let columns = made.skeleton().feature_count();
        let seen = (prompt.frames + 3).min(LONGEST);
        assert!(made.frame_count() >= seen, "{}", made.frame_count());
        let pairs = made.values().iter().zip(whole).take(seen * columns);
        let most = pairs.map(|(a, b)| (a - b).abs()).fold(0.0, f32::max);
        assert!(most < 1e-3, "{} frames: {most}", prompt.frames);
    }
    let frames = made.iter().map(|motion| motion.frame_count());
    assert!(
        frames.min() < Some(LONGEST),
        "short motions are not made long"
    );
}

/// What such a network makes of a frame depends on how many there are.
#[test]
fn networks_that_see_padding_see_all_of_it() {
    let prompts = prompts();
    let whole = published(&network(false), &prompts);
    let generator = TextToMotionGenerator::new(network(false), sampling(), "whole".into(), LONGEST);
    let made = generator.generate(&prompts).expect("finite");
    for (made, whole) in made.iter().zip(&whole) {
        assert_eq!(made.values(), whole);
    }
}

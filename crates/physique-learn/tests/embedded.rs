//! The networks inside the program.
#![cfg(feature = "embedded")]

use burn::tensor::Device;
use physique_learn::diffusion::Edit;
use physique_learn::mdm::{
    EmbeddedNetwork, KnownMotion, MdmFolder, Prompt, Sampling, TextToMotion,
};
use physique_motion::features::recover_from_positions;
use physique_text::MiniLm;

fn network() -> TextToMotion {
    open(EmbeddedNetwork::Small)
}

fn open(network: EmbeddedNetwork) -> TextToMotion {
    let folder = MdmFolder::embedded(network, &Device::flex()).expect("whole");
    let encoder = MiniLm::embedded().expect("embedded");
    TextToMotion::new(folder, Some(Box::new(encoder))).expect("its encoder")
}

#[test]
fn they_say_whose_data_they_are_from() {
    for network in EmbeddedNetwork::ALL {
        let folder = MdmFolder::embedded(network, &Device::flex()).expect("whole");
        let notes = &folder.description.notes;
        let not_free = network == EmbeddedNetwork::Small;
        assert_eq!(notes["licence"].contains("-NC"), not_free, "{notes:?}");
        assert_eq!(
            notes["attribution"].contains("Bandai"),
            not_free,
            "{notes:?}"
        );
        assert!(notes["attribution"].contains("100STYLE"), "{notes:?}");
        assert_eq!(EmbeddedNetwork::named(network.name()), Some(network));
    }
    assert_eq!(EmbeddedNetwork::named("mdm-huge"), None);
}

#[test]
fn it_tells_what_it_knows_from_what_it_does_not() {
    let network = network();
    for known in ["a person walks", "someone waves with the left hand"] {
        let nearest = network.nearest(known).expect("captions are known");
        assert!(!nearest.unusual, "{known}: {nearest:?}");
    }
    for unknown in [
        "a chef chops onions",
        "two people play chess",
        "a man swims",
    ] {
        let nearest = network.nearest(unknown).expect("captions are known");
        assert!(nearest.unusual, "{unknown}: {nearest:?}");
    }
}

const LEFT_WRIST: usize = 20;
const RIGHT_WRIST: usize = 21;

/// A walk gets somewhere, raised hands end above the head, and left is left.
#[test]
fn it_does_as_it_is_told() {
    let network = network();
    let texts = [
        "a person walks",
        "a person raises the left hand",
        "a person raises the right hand",
    ];
    let prompts = texts.map(|text| Prompt {
        text,
        upper_body: None,
        frames: 80,
        seed: 3,
    });
    let motions = network.generate(&prompts, Sampling::default(), None, |_| ());
    let motions = motions.expect("finite");
    let joints: Vec<_> = motions
        .iter()
        .map(|features| recover_from_positions(features).expect("positions"))
        .collect();
    let travelled = joints[0].frame(79)[0].distance(joints[0].frame(0)[0]);
    assert!(travelled > 1.0, "{travelled} m");
    let highest = |motion: usize, joint: usize| {
        let heights = joints[motion].frames().map(|frame| frame[joint].y);
        heights.fold(0.0, f32::max)
    };
    let differences =
        [1, 2].map(|motion| highest(motion, LEFT_WRIST) - highest(motion, RIGHT_WRIST));
    assert!(
        differences[0] > 0.3 && differences[1] < -0.3,
        "{differences:?} m"
    );
}

/// No clip that it was trained with shows both.
#[test]
fn legs_and_arms_do_different_things() {
    let prompt = Prompt {
        text: "a person walks",
        upper_body: Some("a person raises the left hand"),
        frames: 80,
        seed: 3,
    };
    let motions = network().generate(&[prompt], Sampling::default(), None, |_| ());
    let joints = recover_from_positions(&motions.expect("finite")[0]).expect("positions");
    let travelled = joints.frame(79)[0].distance(joints.frame(0)[0]);
    assert!(travelled > 1.0, "{travelled} m");
    let highest = |joint: usize| {
        let heights = joints.frames().map(|frame| frame[joint].y);
        heights.fold(0.0, f32::max)
    };
    let difference = highest(LEFT_WRIST) - highest(RIGHT_WRIST);
    assert!(difference > 0.3, "{difference} m");
}

/// Whatever else is in the batch; and what is kept of a known motion leaves no room for other arms.
#[test]
fn divided_texts_are_made_one_by_one() {
    let network = network();
    let plain = Prompt {
        text: "a person runs",
        upper_body: None,
        frames: 40,
        seed: 1,
    };
    let divided = Prompt {
        upper_body: Some("a person waves both hands"),
        frames: 60,
        seed: 2,
        ..plain
    };
    let sampling = Sampling {
        steps: Some(5),
        ..Sampling::default()
    };
    let mut left = Vec::new();
    let both = network.generate(&[plain, divided], sampling, None, |steps| left.push(steps));
    let both = both.expect("finite");
    assert!(left.into_iter().eq((0..10).rev()), "two passes of 5 steps");
    for (motion, prompt) in both.iter().zip([plain, divided]) {
        assert_eq!(motion.frame_count(), prompt.frames);
        let alone = network.generate(&[prompt], sampling, None, |_| ());
        let alone = alone.expect("finite").remove(0);
        let differences = motion.values().iter().zip(alone.values());
        let most = differences.map(|(a, b)| (a - b).abs()).fold(0.0, f32::max);
        assert!(most < 1e-3, "{most}");
    }
    let known = KnownMotion {
        features: both[1].clone(),
        edit: Edit::upper_body(60, both[1].skeleton()),
    };
    let refused = network.generate(&[divided], sampling, Some(&known), |_| ());
    let refused = refused.expect_err("two masters").to_string();
    assert!(refused.contains("upper body"), "{refused}");
}

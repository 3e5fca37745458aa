//! Motions from a small network that has learnt nothing: what must hold for any.

use burn::tensor::{Device, Tensor};
use physique_learn::diffusion::{Edit, Method, Sampler, Schedule};
use physique_learn::mdm::{Condition, ConditionKind, GenerateRequest, Mdm, MdmConfig, generate};
use physique_learn::text::Embeddings;
use physique_text::{MiniLm, TextEncoder as _};

const CAPTIONS: [&str; 2] = ["a person walks", "a person waves with the left hand"];

fn network() -> Mdm {
    let config = MdmConfig {
        columns: 10,
        width: 16,
        layers: 2,
        heads: 2,
        feed_forward: 32,
        condition: ConditionKind::Sentence { width: 384 },
        mask_frames: true,
        frames_per_token: 2,
        ..MdmConfig::default()
    };
    Mdm::new(&config, 9, &Device::flex()).expect("possible")
}

fn condition(captions: &[&str]) -> Condition {
    let encoder = MiniLm::embedded().expect("embedded");
    let embeddings = Embeddings::from(&encoder.encode(captions));
    Condition::text(&embeddings, &Device::flex()).expect("whole")
}

fn sampler() -> Sampler {
    Sampler::new(Schedule::cosine(10).expect("in range"), Method::Ancestral)
}

fn motions(captions: &[&str], lengths: &[usize], seeds: &[u64], guidance: f64) -> Vec<Vec<f32>> {
    let request = GenerateRequest {
        condition: &condition(captions),
        lengths,
        seeds,
        guidance,
        edit: None,
        guides: &[],
        context: None,
    };
    let mut told = Vec::new();
    let motions = generate(&network(), &sampler(), request, |left| told.push(left));
    assert!(told.into_iter().eq((0..10).rev()));
    motions.expect("it fits")
}

#[test]
fn motions_have_their_lengths_and_depend_on_caption_seed_and_guidance() {
    let both = motions(&CAPTIONS, &[7, 12], &[1, 2], 2.5);
    let lengths: Vec<_> = both.iter().map(|motion| motion.len() / 10).collect();
    assert_eq!(lengths, [7, 12]);
    assert!(both.iter().flatten().all(|number| number.is_finite()));
    assert_eq!(both, motions(&CAPTIONS, &[7, 12], &[1, 2], 2.5));
    let same = [CAPTIONS[1]; 2];
    assert_eq!(both[1], motions(&same, &[7, 12], &[1, 2], 2.5)[1]);
    assert_ne!(both[0], motions(&same, &[7, 12], &[1, 2], 2.5)[0]);
    assert_ne!(both[0], motions(&CAPTIONS, &[7, 12], &[3, 2], 2.5)[0]);
    assert_ne!(both[0], motions(&CAPTIONS, &[7, 12], &[1, 2], 1.0)[0]);
}

/// Frames of the other motion are hidden, so that only rounding can differ.
#[test]
fn a_motion_is_the_same_by_itself() {
    let both = motions(&CAPTIONS, &[7, 12], &[1, 2], 2.5);
    let alone = motions(&CAPTIONS[..1], &[7], &[1], 2.5);
    let differences = both[0].iter().zip(&alone[0]).map(|(a, b)| (a - b).abs());
    let most = differences.fold(0.0, f32::max);
    assert!(most < 1e-4, "{most}");
}

#[test]
fn what_is_known_stays() {
    let known = Tensor::<3>::ones([1, 12, 10], &Device::flex()) * 0.25;
    let edit = Edit::in_between(12, 12, 10);
    let batch = Edit::of_batch(std::slice::from_ref(&edit), known).expect("of one shape");
    let request = GenerateRequest {
        condition: &condition(&CAPTIONS[..1]),
        lengths: &[12],
        seeds: &[1],
        guidance: 2.5,
        edit: Some(&batch),
        guides: &[],
        context: None,
    };
    let motions = generate(&network(), &sampler(), request, |_| ()).expect("it fits");
    let kept = motions[0].iter().zip(edit.kept());
    let (kept, made): (Vec<_>, Vec<_>) = kept.partition(|(_, kept)| **kept);
    assert!(
        kept.iter()
            .all(|(number, _)| (**number - 0.25).abs() < 1e-6)
    );
    assert!(made.iter().any(|(number, _)| (**number - 0.25).abs() > 0.1));
}

#[test]
fn what_does_not_fit_is_refused() {
    let (network, sampler) = (network(), sampler());
    let condition = condition(&CAPTIONS);
    let told = |condition: &Condition, lengths: &[usize], seeds: &[u64]| {
        let request = GenerateRequest {
            condition,
            lengths,
            seeds,
            guidance: 2.5,
            edit: None,
            guides: &[],
            context: None,
        };
        let refused = generate(&network, &sampler, request, |_| ());
        refused.expect_err("it does not fit").to_string()
    };
    assert!(told(&condition, &[4, 4], &[1]).starts_with("Seeds: expected 2"));
    assert!(told(&condition, &[4], &[1]).starts_with("Conditions: expected 1"));
    assert!(told(&condition, &[4, 0], &[1, 2]).starts_with("Length of a motion: expected 1 to 4"));
    assert!(told(&Condition::Nothing, &[4], &[1]).contains("found nothing"));
    assert!(told(&condition, &[], &[]).starts_with("Seeds"));
}

//! Guidance by losses while sampling, on a network that has learnt nothing.

use burn::tensor::{Device, Tensor};
use physique_learn::diffusion::{Edit, GuideWeights, Method, Sampler, Schedule};
use physique_learn::mdm::{Condition, ConditionKind, GenerateRequest, Mdm, MdmConfig, generate};
use physique_learn::motion_loss::WeightedLoss;
use physique_motion::embedded;
use physique_motion::features::{
    FeatureSkeleton, FeatureStatistics, JointPositions, StatisticsGatherer, extract,
};
use physique_motion::mapping::BodyRest;

const COLUMNS: usize = 263;
const FRAMES: usize = 16;
const LENGTHS: [usize; 2] = [16, 11];

/// Of real motions.
fn statistics() -> FeatureStatistics {
    let body = physique::body::open_body().expect("embedded");
    let body = physique::body::Body::new(body, &[]).expect("mean shape");
    let mut gatherer = StatisticsGatherer::new(FeatureSkeleton::HumanMl3d);
    for clip in embedded::clips().iter().take(4) {
        let motion = clip.load().expect("embedded").motion;
        let positions = JointPositions::from_motion(&motion, &BodyRest::from(&body));
        let features = extract(&positions.expect("finite")).expect("frames");
        gatherer.add(&features).expect("of one skeleton");
    }
    gatherer.finish().expect("they move")
}

fn network() -> Mdm {
    let config = MdmConfig {
        width: 16,
        layers: 1,
        heads: 2,
        feed_forward: 32,
        condition: ConditionKind::Unconditioned,
        mask_frames: true,
        ..MdmConfig::default()
    };
    Mdm::new(&config, 9, &Device::flex()).expect("possible")
}

fn sample(
    guides: &[WeightedLoss],
    method: Method,
    edit: Option<(&[Edit; 2], f32)>,
) -> Vec<Vec<f32>> {
    let edit = edit.map(|(edits, known)| {
        let known = Tensor::<3>::ones([2, FRAMES, COLUMNS], &Device::flex()) * known;
        Edit::of_batch(edits, known).expect("of one shape")
    });
    let request = GenerateRequest {
        condition: &Condition::Nothing,
        lengths: &LENGTHS,
        seeds: &[1, 2],
        guidance: 1.0,
        edit: edit.as_ref(),
        guides,
        context: None,
    };
    let sampler = Sampler::new(Schedule::cosine(10).expect("in range"), method);
    generate(&network(), &sampler, request, |_| ()).expect("it fits")
}

fn guides(text: &str) -> Vec<WeightedLoss> {
    let weights: GuideWeights = text.parse().expect("weights");
    weights.guides(&statistics()).expect("embedded")
}

/// Losses of motions, one after the other.
fn losses(guide: &WeightedLoss, motions: &[Vec<f32>]) -> Vec<f32> {
    let loss = |motion: &Vec<f32>| {
        let frames = motion.len() / COLUMNS;
        let found = guide.loss().evaluate(motion, frames, &[frames]);
        found.expect("finite").losses[0]
    };
    motions.iter().map(loss).collect()
}

#[test]
fn guided_motions_lose_less() {
    for method in [Method::Ancestral, Method::Ddim { eta: 0.0 }] {
        let plain = sample(&[], method, None);
        let all = sample(&guides("self=1,ground=1,feet=1"), method, None);
        for guide in guides("self=1,ground=1,feet=1") {
            let alone = sample(std::slice::from_ref(&guide), method, None);
            let [plain, alone, all] = [&plain, &alone, &all].map(|motions| losses(&guide, motions));
            for motion in 0..LENGTHS.len() {
                let [plain, alone, all] = [&plain, &alone, &all].map(|losses| losses[motion]);
                assert!(plain > 1e-4, "{}: nothing to lose", guide.name());
                assert!(alone < 0.75 * plain, "{}: {plain} {alone}", guide.name());
                assert!(all < plain, "{}: {plain} {all}", guide.name());
            }
        }
    }
}

#[test]
fn without_guides_samples_are_the_same_to_the_bit() {
    let method = Method::Ancestral;
    let plain = sample(&[], method, None);
    let weightless = guides("self=1,ground=1,feet=1").into_iter();
    let weightless = weightless.map(|guide| guide.with_weight(0.0).expect("a weight"));
    assert_eq!(sample(&weightless.collect::<Vec<_>>(), method, None), plain);
    let guides = guides("self=1,feet=1");
    let guided = sample(&guides, method, None);
    assert_ne!(guided, plain);
    assert_eq!(sample(&guides, method, None), guided);
}

#[test]
fn what_is_known_stays() {
    let edit = Edit::in_between(FRAMES, FRAMES, COLUMNS);
    let edits = [edit.clone(), edit];
    let guides = guides("self=1,ground=1,feet=1");
    let known = 0.25;
    let plain = sample(&[], Method::Ancestral, Some((&edits, known)));
    let guided = sample(&guides, Method::Ancestral, Some((&edits, known)));
    let mut moved = 0;
    for (plain, guided) in plain.iter().zip(&guided) {
        for ((plain, guided), &kept) in plain.iter().zip(guided).zip(edits[0].kept()) {
            if kept {
                assert_eq!(plain, guided);
                assert!((guided - known).abs() < 1e-6, "{guided}");
            }
            moved += usize::from(plain != guided);
        }
    }
    assert!(moved > 1000, "{moved}");
}

/// A guided motion is what it would be by itself.
#[test]
fn motions_are_guided_one_by_one() {
    let guides = guides("self=1,ground=1,feet=1");
    let both = sample(&guides, Method::Ancestral, None);
    let request = GenerateRequest {
        condition: &Condition::Nothing,
        lengths: &LENGTHS[..1],
        seeds: &[1],
        guidance: 1.0,
        edit: None,
        guides: &guides,
        context: None,
    };
    let sampler = Sampler::new(Schedule::cosine(10).expect("in range"), Method::Ancestral);
    let alone = generate(&network(), &sampler, request, |_| ()).expect("it fits");
    let differences = both[0].iter().zip(&alone[0]).map(|(a, b)| (a - b).abs());
    let most = differences.fold(0.0, f32::max);
    assert!(most < 1e-2, "{most}");
}

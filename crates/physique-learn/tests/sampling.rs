//! Sampling and editing.

use burn::tensor::{Device, Tensor, TensorData};
use physique_learn::diffusion::{Edit, Method, NoiseStreams, Sampler, Schedule, guide};
use physique_motion::features::FeatureSkeleton;

fn tensor(values: Vec<f32>, shape: [usize; 3]) -> Tensor<3> {
    Tensor::from_data(TensorData::new(values, shape), &Device::flex())
}

fn numbers(tensor: Tensor<3>) -> Vec<f32> {
    tensor.into_data().try_into_vec().expect("floats")
}

/// A made-up clean motion.
fn clean(shape: [usize; 3]) -> Tensor<3> {
    let count = shape.iter().product::<usize>();
    tensor((0..count).map(|i| (i as f32 * 0.37).sin()).collect(), shape)
}

fn samplers() -> Vec<Sampler> {
    let schedule = Schedule::cosine(50).expect("in range");
    let faster = schedule.respaced(10).expect("fewer");
    let ddim = schedule.respaced_for_ddim(10).expect("a stride of 5");
    vec![
        Sampler::new(schedule.clone(), Method::Ancestral),
        Sampler::new(faster.clone(), Method::Ancestral),
        Sampler::new(schedule, Method::Ddim { eta: 0.0 }),
        Sampler::new(faster, Method::Ddim { eta: 1.0 }),
        Sampler::new(ddim, Method::Ddim { eta: 0.0 }),
    ]
}

#[test]
fn a_network_that_knows_the_answer_gives_it() {
    let shape = [2, 6, 4];
    let expected = clean(shape);
    let noise = NoiseStreams::new(&[1, 2], 6, 4, &Device::flex());
    for sampler in samplers() {
        let found = sampler
            .sample(&noise, |_, _| Ok(expected.clone()))
            .expect("it cannot fail");
        let error = (found - expected.clone()).abs().max().into_scalar::<f32>();
        assert!(error < 1e-5, "{error}");
    }
}

#[test]
fn a_sample_does_not_depend_on_its_batch() {
    let device = Device::flex();
    for sampler in samplers() {
        let sample = |seeds: &[u64]| {
            let noise = NoiseStreams::new(seeds, 6, 4, &device);
            let found = sampler.sample(&noise, |x, step| Ok((x * 0.5).tanh() + step as f64 * 1e-3));
            numbers(found.expect("it cannot fail"))
        };
        let together = sample(&[5, 7]);
        assert_eq!(sample(&[5]), together[..24]);
        assert_eq!(sample(&[7]), together[24..]);
        assert_ne!(together[..24], together[24..]);
    }
}

#[test]
fn a_longer_motion_starts_with_the_same_noise() {
    let start = |frames| numbers(NoiseStreams::new(&[3], frames, 4, &Device::flex()).start());
    assert_eq!(start(10)[..24], start(6)[..]);
}

#[test]
fn respacing_keeps_first_and_last_step_and_the_noise_of_the_kept() {
    let schedule = Schedule::cosine(1000).expect("in range");
    for steps in [2, 10, 50, 999, 1000] {
        let fewer = schedule.respaced(steps).expect("fewer");
        assert_eq!(fewer.len(), steps);
        assert_eq!(fewer.network_step(0), 0);
        assert_eq!(fewer.network_step(steps - 1), 999);
        for step in 0..steps {
            assert_eq!(
                fewer.kept()[step],
                schedule.kept()[fewer.network_step(step)]
            );
        }
    }
    assert!(schedule.respaced(1).is_err() && schedule.respaced(1001).is_err());
    let fifty = schedule.respaced_for_ddim(50).expect("a stride of 20");
    assert_eq!((fifty.network_step(1), fifty.network_step(49)), (20, 980));
    assert!(schedule.respaced_for_ddim(600).is_err());
}

#[test]
fn a_shifted_schedule_has_the_ratio_asked_for() {
    let schedule = Schedule::cosine(50).expect("in range");
    let shifted = schedule.with_signal(0.09).expect("above 0");
    for (kept, shifted) in schedule.kept().iter().zip(shifted.kept()) {
        let ratio = |kept: f64| kept / (1.0 - kept);
        assert!((ratio(*shifted) / ratio(*kept) / 0.09 - 1.0).abs() < 1e-9);
    }
    assert!(schedule.with_signal(0.0).is_err() && schedule.with_signal(f64::NAN).is_err());
}

#[test]
fn guidance_pushes_away_from_the_unconditioned() {
    let with = clean([1, 2, 3]);
    let without = with.clone() * 0.5 - 0.1;
    let guided = |scale| {
        let mut asked = Vec::new();
        let found = guide(scale, |conditioned| {
            asked.push(conditioned);
            Ok(if conditioned {
                with.clone()
            } else {
                without.clone()
            })
        });
        (numbers(found.expect("it cannot fail")), asked)
    };
    assert_eq!(guided(1.0), (numbers(with.clone()), vec![true]));
    assert_eq!(guided(0.0), (numbers(without.clone()), vec![false]));
    let expected = numbers(without.clone() + (with.clone() - without.clone()) * 2.5);
    assert_eq!(guided(2.5), (expected, vec![false, true]));
}

#[test]
fn edits_keep_what_they_say() {
    let skeleton = FeatureSkeleton::HumanMl3d;
    let upper = Edit::upper_body(3, skeleton);
    let kept = upper.kept()[263..2 * 263]
        .iter()
        .filter(|kept| **kept)
        .count();
    // As published: root, hips, knees, ankles, feet and contacts.
    assert_eq!(kept, 107);

    let between = Edit::in_between(41, 60, 2);
    let frames: Vec<_> = (0..60).filter(|frame| between.kept()[2 * frame]).collect();
    // The first 10 of 41 frames, and all from frame 30.
    assert_eq!(frames, (0..10).chain(30..60).collect::<Vec<_>>());

    let joint = Edit::all_new(4, 263).keep_joints(1..2, &[20, 99], skeleton);
    let columns: Vec<_> = (0..4 * 263).filter(|&index| joint.kept()[index]).collect();
    let expected = (4 + 57..4 + 60)
        .chain(67 + 114..67 + 120)
        .chain(193 + 60..193 + 63);
    assert_eq!(
        columns,
        expected.map(|column| 263 + column).collect::<Vec<_>>()
    );
}

#[test]
fn edited_samples_hold_the_known_numbers() {
    let shape = [2, 8, 5];
    let known = clean(shape);
    let edits = [
        Edit::in_between(8, 8, 5),
        Edit::all_new(8, 5).keep(0..3, 1..4),
    ];
    let edit = Edit::of_batch(&edits, known.clone()).expect("of one shape");
    let noise = NoiseStreams::new(&[1, 2], 8, 5, &Device::flex());
    let sampler = &samplers()[0];
    let found = sampler.sample(&noise, |x, _| Ok(edit.apply(x * 0.3)));
    let found = numbers(found.expect("it cannot fail"));
    let kept = edits.iter().flat_map(|edit| edit.kept());
    let mut made = 0;
    for ((found, known), kept) in found.iter().zip(numbers(known.clone())).zip(kept) {
        if *kept {
            assert!((found - known).abs() < 1e-6);
        } else {
            made += usize::from((found - known).abs() > 1e-3);
        }
    }
    assert!(made > 20, "{made}");
    assert!(Edit::of_batch(&edits[..1], known).is_err());
}

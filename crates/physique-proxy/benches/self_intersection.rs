//! The self-intersection loss of the open body's 192 spheres, forward and backward, on real motion, and
//! what surrounds it.
#![allow(clippy::expect_used, reason = "a benchmark has no one to report to")]

#[path = "../tests/loss/real.rs"]
mod real;

use std::hint::black_box;
use std::sync::LazyLock;

use divan::{Bencher, counter::ItemsCount};
use physique_body::{Body, open_body};
use physique_motion::embedded;
use physique_motion::features::{
    FeatureSkeleton, GradientRule, JointPositions, MotionFeatures, RotationLayer, extract,
};
use physique_motion::mapping::BodyRest;
use physique_proxy::{
    Backend, FeatureBatch, FeatureLoss, MeshLoss, MeshLossOptions, Pairs, PoseMatrices,
    SelfIntersection, SelfIntersectionOptions, SphereBody, explain, open_proxy,
};

/// Body, pairs, and real poses.
static CASE: LazyLock<(SphereBody, Pairs, Vec<PoseMatrices>)> = LazyLock::new(|| {
    let (body, pairs) = real::body_and_pairs();
    (body, pairs, real::poses())
});

fn main() {
    LazyLock::force(&CASE);
    divan::main();
}

#[divan::bench(args = [64, 1024, 12_544])]
fn gradient(bencher: Bencher<'_, '_>, frames: usize) {
    run(bencher, frames, Backend::best());
}

#[divan::bench(args = Backend::available().collect::<Vec<_>>())]
fn backends_1024(bencher: Bencher<'_, '_>, backend: Backend) {
    run(bencher, 1024, backend);
}

fn run(bencher: Bencher<'_, '_>, frames: usize, backend: Backend) {
    let (body, pairs, _) = &*CASE;
    let options = SelfIntersectionOptions {
        backend: Some(backend),
        ..Default::default()
    };
    let loss = SelfIntersection::with_options(body, pairs, &options).expect("sound");
    let mut arrays = Arrays::new(frames);
    bencher.counter(ItemsCount::new(frames)).bench_local(|| {
        let Arrays {
            poses,
            weights,
            losses,
            by_poses,
        } = &mut arrays;
        loss.gradient(poses, weights, losses, by_poses)
            .expect("finite");
    });
}

/// Inputs and outputs.
struct Arrays {
    poses: Vec<PoseMatrices>,
    weights: Vec<f32>,
    losses: Vec<f32>,
    by_poses: Vec<PoseMatrices>,
}

impl Arrays {
    fn new(frames: usize) -> Self {
        Self {
            poses: CASE.2.iter().copied().cycle().take(frames).collect(),
            weights: vec![1.0 / frames as f32; frames],
            losses: vec![0.0; frames],
            by_poses: vec![[[0.0; 9]; 22]; frames],
        }
    }
}

#[divan::bench]
fn losses_alone_1024(bencher: Bencher<'_, '_>) {
    let loss = SelfIntersection::new(&CASE.0, &CASE.1).expect("sound");
    let mut arrays = Arrays::new(1024);
    bencher.bench_local(|| {
        loss.losses(&arrays.poses, &mut arrays.losses)
            .expect("finite");
    });
}

#[divan::bench]
fn shape_gradient_1024(bencher: Bencher<'_, '_>) {
    let loss = SelfIntersection::new(&CASE.0, &CASE.1).expect("sound");
    let mut arrays = Arrays::new(1024);
    bencher.bench_local(|| {
        let Arrays {
            poses,
            weights,
            losses,
            by_poses,
        } = &mut arrays;
        loss.shape_gradient(poses, weights, losses, by_poses)
            .expect("finite")
    });
}

/// 64 motions of 196 frames of HumanML3D's features, value and gradient.
#[divan::bench(args = ["parents constant", "full"])]
fn features_64_by_196(bencher: Bencher<'_, '_>, rule: &str) {
    let rule = match rule {
        "full" => GradientRule::Full,
        _ => GradientRule::ParentsConstant,
    };
    let loss = SelfIntersection::new(&CASE.0, &CASE.1).expect("sound");
    let layer = RotationLayer::published(FeatureSkeleton::HumanMl3d);
    let loss = FeatureLoss::new(loss, &layer, rule);
    let motion = features(196);
    let features = motion.values().repeat(64);
    let batch = FeatureBatch {
        skeleton: motion.skeleton(),
        statistics: None,
        features: &features,
        frames: 196,
        lengths: &[196; 64],
        weights: &[1.0 / 196.0; 64 * 196],
    };
    bencher
        .counter(ItemsCount::new(64_usize * 196))
        .bench_local(|| loss.batch(&batch).expect("finite"));
}

/// The first embedded clip, repeated until it is long enough.
fn features(frames: usize) -> MotionFeatures {
    let body = Body::new(open_body().expect("embedded"), &[]).expect("mean shape");
    let clip = embedded::clips().iter().next().expect("clips");
    let motion = clip.load().expect("embedded").motion;
    let positions = JointPositions::from_motion(&motion, &BodyRest::from(&body)).expect("finite");
    let joints = positions.positions().iter().copied().cycle();
    let joints = joints.take((frames + 1) * 22).collect();
    let rate = motion.frame_rate();
    let positions = JointPositions::new(rate, FeatureSkeleton::HumanMl3d, joints).expect("finite");
    extract(&positions).expect("frames")
}

/// The mesh loss of 64 frames, value and gradient.
#[divan::bench]
fn mesh_gradient_64(bencher: Bencher<'_, '_>) {
    let body = Body::new(open_body().expect("embedded"), &[]).expect("mean shape");
    let loss = MeshLoss::new(&body, &MeshLossOptions::default()).expect("sound");
    let mut arrays = Arrays::new(64);
    bencher.bench_local(|| {
        let Arrays {
            poses,
            weights,
            losses,
            by_poses,
        } = &mut arrays;
        loss.gradient(poses, weights, losses, by_poses)
            .expect("finite");
    });
}

#[divan::bench]
fn prepare(bencher: Bencher<'_, '_>) {
    let (body, pairs, _) = &*CASE;
    bencher.bench_local(|| SelfIntersection::new(black_box(body), pairs).expect("sound"));
}

#[divan::bench]
fn explain_one_pose(bencher: Bencher<'_, '_>) {
    let (body, pairs, poses) = &*CASE;
    bencher.bench_local(|| explain(body, pairs, black_box(&poses[100])));
}

#[divan::bench]
fn regress_spheres(bencher: Bencher<'_, '_>) {
    let proxy = open_proxy().expect("embedded");
    let betas = [0.5; 10];
    bencher.bench_local(|| {
        let spheres = proxy.sphere_regressor().spheres(black_box(&betas));
        spheres.expect("betas")
    });
}

#[divan::bench]
fn regress_joints(bencher: Bencher<'_, '_>) {
    let proxy = open_proxy().expect("embedded");
    let betas = [0.5; 10];
    bencher.bench_local(|| {
        let joints = proxy.joint_regressor().joints(black_box(&betas));
        joints.expect("betas")
    });
}

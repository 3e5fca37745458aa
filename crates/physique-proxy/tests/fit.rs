//! A whole fit in small: it learns, goes on after a kill, and does not depend on threads.

use std::path::Path;
use std::sync::{Arc, Mutex};

use physique_body::{BodyModel, open_body_low};
use physique_proxy::evaluate::evaluate;
use physique_proxy::fit::{BlendOptions, FitObserver, FitOptions, Stage, fit_proxy};
use physique_proxy::{Error, SphereProxy};

fn model() -> Arc<BodyModel> {
    open_body_low().expect("embedded")
}

fn options() -> FitOptions {
    FitOptions {
        spheres: 24,
        beta_range: 1.0,
        sphere_bodies: 6,
        joint_bodies: 24,
        ball_points: 2_000,
        surface_points: 16_000,
        step_points: 1_024,
        batch: 4,
        sphere_epochs: 12,
        joint_epochs: 9,
        joint_rate: 1e-3,
        width: 32,
        ..FitOptions::default()
    }
}

/// Notes losses; copies the checkpoints that lie there when some epoch ends.
#[derive(Default)]
struct Watcher<'a> {
    losses: Mutex<Vec<(Stage, f64)>>,
    copy: Option<(Stage, usize, &'a Path, &'a Path)>,
}

impl FitObserver for Watcher<'_> {
    fn epoch(&self, stage: Stage, done: usize, loss: f64) {
        self.losses.lock().expect("no panic").push((stage, loss));
        if let Some((_, _, from, to)) = self
            .copy
            .filter(|&(s, epoch, ..)| (s, epoch) == (stage, done))
        {
            for name in ["joints.checkpoint", "spheres.checkpoint"] {
                // The stage's own may not be there yet.
                let _ = std::fs::copy(from.join(name), to.join(name));
            }
        }
    }

    fn wants_checkpoint(&self) -> bool {
        true
    }
}

fn fit(folder: &Path, options: &FitOptions, watcher: &Watcher<'_>) -> Result<SphereProxy, Error> {
    let blend = BlendOptions {
        bodies: 4,
        ..BlendOptions::default()
    };
    fit_proxy(&model(), options, &blend, folder, watcher)
}

fn parameters(proxy: &SphereProxy) -> [&[f32]; 2] {
    [
        proxy.sphere_regressor().network().parameters(),
        proxy.joint_regressor().network().parameters(),
    ]
}

#[test]
fn losses_fall_and_spheres_follow_the_body() {
    let folder = tempfile::tempdir().expect("a folder");
    let watcher = Watcher::default();
    let mut options = options();
    options.sphere_epochs = 60;
    options.joint_epochs = 100;
    let proxy = fit(folder.path(), &options, &watcher).expect("fits");
    let losses = watcher.losses.into_inner().expect("no panic");
    for stage in [Stage::Joints, Stage::Spheres] {
        let of_stage: Vec<f64> = losses
            .iter()
            .filter(|l| l.0 == stage)
            .map(|l| l.1)
            .collect();
        let (first, last) = (of_stage[0], of_stage[of_stage.len() - 1]);
        assert!(last < 0.6 * first, "{stage:?}: {first} to {last}");
    }
    // Two dozen spheres are coarse; a body of one ball would be off by some 20 cm.
    let evaluation = evaluate(&proxy, &model(), 4, 1.0, 10).expect("a body");
    assert!(
        evaluation.vertices.mean_cm < 4.0,
        "{:?}",
        evaluation.vertices
    );
    assert_eq!(evaluation.vertices.count, 4 * model().vertex_count());
    let of_joints: usize = evaluation
        .by_joint
        .iter()
        .map(|part| part.vertices.count)
        .sum();
    assert_eq!(of_joints, evaluation.vertices.count);
    // Every sphere follows joints, the heaviest first.
    for row in proxy.blend_weights() {
        let sum: f32 = row.iter().map(|(_, weight)| weight).sum();
        assert!((sum - 1.0).abs() < 1e-5 && row.windows(2).all(|pair| pair[0].1 >= pair[1].1));
    }
}

#[test]
fn a_fit_that_was_killed_ends_in_the_same_proxy() {
    let whole_folder = tempfile::tempdir().expect("a folder");
    let whole = fit(whole_folder.path(), &options(), &Watcher::default()).expect("fits");
    for (stage, epoch) in [(Stage::Joints, 4), (Stage::Spheres, 1), (Stage::Spheres, 8)] {
        let [first, second] = [(); 2].map(|()| tempfile::tempdir().expect("a folder"));
        let watcher = Watcher {
            copy: Some((stage, epoch, first.path(), second.path())),
            ..Watcher::default()
        };
        fit(first.path(), &options(), &watcher).expect("fits");
        let resumed = Watcher::default();
        let proxy = fit(second.path(), &options(), &resumed).expect("goes on");
        assert_eq!(parameters(&proxy), parameters(&whole));
        assert_eq!(proxy.blend_weights(), whole.blend_weights());
        let losses = resumed.losses.into_inner().expect("no panic");
        let epochs = losses.iter().filter(|loss| loss.0 == stage).count();
        let all = if stage == Stage::Joints { 9 } else { 12 };
        assert_eq!(epochs, all - (epoch - 1), "it went on where it was");
    }
}

#[test]
fn a_fit_does_not_depend_on_threads() {
    let fitted = [1, 3].map(|threads| {
        let folder = tempfile::tempdir().expect("a folder");
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build();
        let proxy = pool
            .expect("threads")
            .install(|| fit(folder.path(), &options(), &Watcher::default()));
        proxy.expect("fits")
    });
    assert_eq!(parameters(&fitted[0]), parameters(&fitted[1]));
    assert_eq!(fitted[0].blend_weights(), fitted[1].blend_weights());
}

#[test]
fn a_checkpoint_of_another_fit_is_refused() {
    let folder = tempfile::tempdir().expect("a folder");
    fit(folder.path(), &options(), &Watcher::default()).expect("fits");
    let mut other = options();
    other.seed += 1;
    let error = fit(folder.path(), &other, &Watcher::default()).expect_err("another seed");
    assert!(matches!(error, Error::Checkpoint { .. }), "{error}");
    for damage in [&b"short"[..], &[0xFF; 64]] {
        std::fs::write(folder.path().join("joints.checkpoint"), damage).expect("written");
        let error = fit(folder.path(), &options(), &Watcher::default()).expect_err("damaged");
        assert!(matches!(error, Error::Checkpoint { .. }), "{error}");
    }
}

#[test]
fn impossible_recipes_are_refused() {
    let folder = tempfile::tempdir().expect("a folder");
    let change: [fn(&mut FitOptions); 6] = [
        |options| options.spheres = 0,
        |options| options.step_points = 1_000,
        |options| options.ball_points = 10,
        |options| options.beta_range = f32::NAN,
        |options| options.losses.emptiness = -1.0,
        |options| options.batch = 0,
    ];
    for change in change {
        let mut options = options();
        change(&mut options);
        let error = fit(folder.path(), &options, &Watcher::default()).expect_err("impossible");
        assert!(matches!(error, Error::FitOptions { .. }), "{error}");
    }
}

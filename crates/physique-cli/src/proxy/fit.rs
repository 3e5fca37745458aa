//! `physique proxy fit`.

use std::sync::Mutex;
use std::time::{Duration, Instant};

use anyhow::Result;
use indicatif::{ProgressBar, ProgressStyle};
use physique::proxy::files::write_proxy;
use physique::proxy::fit::{
    BlendOptions, FitObserver, FitOptions, NeighbourWeights, Stage, fit_proxy,
};

use super::arguments::{FitArguments, NeighboursName};
use crate::body_choice::model;
use crate::exit::Exit;

/// Time between checkpoints: what a kill costs at most.
const CHECKPOINT_EVERY: Duration = Duration::from_secs(30);

pub(crate) fn run(arguments: &FitArguments) -> Result<Exit> {
    let model = model(&arguments.body)?;
    let options = FitOptions {
        spheres: arguments.spheres,
        beta_range: arguments.beta_range,
        sphere_bodies: arguments.bodies,
        ball_points: arguments.points / 3,
        surface_points: arguments.points - arguments.points / 3,
        step_points: arguments.step_points,
        sphere_epochs: arguments.epochs,
        joint_epochs: arguments.joint_epochs,
        seed: arguments.seed,
        ..FitOptions::default()
    };
    let blend = BlendOptions {
        neighbours: match arguments.neighbours {
            NeighboursName::Equal => NeighbourWeights::Equal,
            NeighboursName::Distance => NeighbourWeights::Distance,
        },
        ..BlendOptions::default()
    };
    let work = arguments.work.clone().unwrap_or_else(|| {
        let mut folder = arguments.output.as_os_str().to_owned();
        folder.push(".work");
        folder.into()
    });
    let watcher = Watcher::new(&options);
    let proxy = fit_proxy(&model, &options, &blend, &work, &watcher);
    watcher.finish();
    let proxy = proxy?;
    write_proxy(&arguments.output, &proxy, arguments.precision.into())?;
    println!("{}", arguments.output.display());
    eprintln!(
        "note: samples and checkpoints stay in {}; delete it when no fit shall go on",
        work.display()
    );
    eprintln!(
        "note: no poses are counted yet; `physique proxy pairs` counts which spheres always touch"
    );
    Ok(Exit::Done)
}

/// Shows progress, and says when it is time for a checkpoint.
struct Watcher {
    bar: ProgressBar,
    totals: [(Stage, usize); 3],
    state: Mutex<State>,
}

struct State {
    stage: Option<Stage>,
    checkpoint: Instant,
}

impl Watcher {
    fn new(options: &FitOptions) -> Self {
        let bar = ProgressBar::no_length();
        bar.enable_steady_tick(Duration::from_millis(500));
        Self {
            bar,
            totals: [
                (Stage::Joints, options.joint_epochs),
                (Stage::Samples, options.sphere_bodies),
                (Stage::Spheres, options.sphere_epochs),
            ],
            state: Mutex::new(State {
                stage: None,
                checkpoint: Instant::now(),
            }),
        }
    }

    fn finish(&self) {
        self.bar.finish_and_clear();
    }

    /// A new stage starts its bar anew.
    fn begin(&self, stage: Stage, done: usize) {
        let name = match stage {
            Stage::Joints => "joints: passes",
            Stage::Samples => "points: bodies",
            Stage::Spheres => "spheres: passes",
        };
        let template =
            format!("{name} {{bar:30}} {{pos}}/{{len}}, {{msg}} {{elapsed}} (left: {{eta}})");
        // A constant template; were it wrong, indicatif's own style would show.
        if let Ok(style) = ProgressStyle::with_template(&template) {
            self.bar.set_style(style);
        }
        let total = self.totals.iter().find(|entry| entry.0 == stage);
        self.bar.set_length(total.map_or(0, |entry| entry.1) as u64);
        // What an earlier run did costs this one no time.
        self.bar.set_position(done.saturating_sub(1) as u64);
        self.bar.reset_eta();
        self.bar.reset_elapsed();
    }
}

impl FitObserver for Watcher {
    fn epoch(&self, stage: Stage, done: usize, loss: f64) {
        if let Ok(mut state) = self.state.lock()
            && state.stage != Some(stage)
        {
            state.stage = Some(stage);
            self.begin(stage, done);
        }
        self.bar.set_position(done as u64);
        if stage != Stage::Samples {
            self.bar.set_message(format!("loss {loss:.6},"));
        }
    }

    fn wants_checkpoint(&self) -> bool {
        let Ok(mut state) = self.state.lock() else {
            return true;
        };
        let due = state.checkpoint.elapsed() >= CHECKPOINT_EVERY;
        if due {
            state.checkpoint = Instant::now();
        }
        due
    }
}

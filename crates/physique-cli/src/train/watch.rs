//! How a run is told of while it goes.

use std::time::{Duration, Instant};

use indicatif::{ProgressBar, ProgressStyle};
use physique_learn::trainer::StepReport;

/// Time between lines where nobody watches a bar.
const LINE_EVERY: Duration = Duration::from_secs(60);

/// A bar with loss and time left; lines now and then where standard error is no terminal.
pub(super) struct Watch {
    bar: ProgressBar,
    /// Loss, averaged over some hundred steps.
    loss: f64,
    line: Instant,
}

impl Watch {
    pub(super) fn new(done: u64, steps: u64) -> Self {
        let bar = ProgressBar::new(steps);
        // A constant template; were it wrong, indicatif's own style would show.
        if let Ok(style) = ProgressStyle::with_template(
            "{bar:30} {pos}/{len} steps, {msg}, {elapsed} (left: {eta})",
        ) {
            bar.set_style(style);
        }
        bar.set_position(done);
        bar.reset_eta();
        bar.enable_steady_tick(Duration::from_millis(500));
        Self {
            bar,
            loss: f64::NAN,
            line: Instant::now(),
        }
    }

    pub(super) fn step(&mut self, report: &StepReport) {
        self.loss = match self.loss.is_nan() {
            true => report.loss,
            false => self.loss + (report.loss - self.loss) * 0.01,
        };
        let message = format!("loss {:.4}, {:.2} s a step", self.loss, report.seconds);
        self.bar.set_position(report.step);
        if self.bar.is_hidden() && self.line.elapsed() >= LINE_EVERY {
            self.line = Instant::now();
            eprintln!("step {} of {}: {message}", report.step, report.steps);
        }
        self.bar.set_message(message);
    }

    pub(super) fn finish(&self) {
        self.bar.finish_and_clear();
    }
}

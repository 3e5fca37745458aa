//! Progress on standard error, where a person watches.

use std::sync::atomic::{AtomicUsize, Ordering};
use std::time::Duration;

use indicatif::{ProgressBar, ProgressStyle};

/// A bar over motions that counts frames; invisible when standard error is not a terminal.
pub(crate) struct Progress {
    bar: ProgressBar,
    frames: AtomicUsize,
}

impl Progress {
    pub(crate) fn new(motions: usize) -> Self {
        let bar = ProgressBar::new(motions as u64);
        // The template is a constant; were it wrong, indicatif's own style would show.
        if let Ok(style) = ProgressStyle::with_template(
            "{bar:40} {pos}/{len} motions, {msg} frames, {elapsed} (left: {eta})",
        ) {
            bar.set_style(style);
        }
        bar.set_message("0");
        bar.enable_steady_tick(Duration::from_millis(200));
        Self {
            bar,
            frames: AtomicUsize::new(0),
        }
    }

    /// Some frames of a motion are done.
    pub(crate) fn frames(&self, count: usize) {
        let total = self.frames.fetch_add(count, Ordering::Relaxed) + count;
        self.bar.set_message(total.to_string());
    }

    /// So many were done by an earlier run.
    pub(crate) fn skip(&self, files: usize) {
        self.bar.set_position(files as u64);
        self.bar.reset_eta();
    }

    /// A whole motion is done.
    pub(crate) fn motion(&self) {
        self.bar.inc(1);
    }

    pub(crate) fn finish(&self) {
        self.bar.finish_and_clear();
    }
}

/// How far a repair has come: a line of its own, where a person watches.
pub(crate) struct Rounds {
    line: ProgressBar,
}

impl Rounds {
    pub(crate) fn new() -> Self {
        let line = ProgressBar::new_spinner();
        line.set_message("measuring");
        line.enable_steady_tick(Duration::from_millis(200));
        Self { line }
    }

    /// For those of many motions.
    pub(crate) fn hidden() -> Self {
        let line = ProgressBar::hidden();
        Self { line }
    }

    /// So many rounds are done, and so much self-intersection is left.
    pub(crate) fn tell(&self, round: usize, self_intersection_cm3: f64) {
        self.line.set_message(format!(
            "round {round}: {self_intersection_cm3:.1} cm³ of self-intersection left"
        ));
    }

    pub(crate) fn finish(&self) {
        self.line.finish_and_clear();
    }
}

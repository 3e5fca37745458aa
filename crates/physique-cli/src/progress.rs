//! Progress on standard error, where a person watches.

use std::time::Duration;

use indicatif::{ProgressBar, ProgressStyle};

/// A bar over `count` motions; invisible when standard error is not a terminal.
pub(crate) fn motions(count: usize) -> ProgressBar {
    let bar = ProgressBar::new(count as u64);
    // The template is a constant, so a mistake in it shows on the first run.
    if let Ok(style) = ProgressStyle::with_template(
        "{bar:40} {pos}/{len} motions, {msg} frames, {elapsed} (left: {eta})",
    ) {
        bar.set_style(style);
    }
    bar.set_message("0");
    bar.enable_steady_tick(Duration::from_millis(200));
    bar
}

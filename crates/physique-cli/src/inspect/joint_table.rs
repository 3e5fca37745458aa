//! How far each joint turns, and which joint of the file it follows.

use std::fmt::Write as _;

use physique::inspect::{AxisRange, MotionInspection};

/// Widest name of a file's joint.
const SOURCE: usize = 24;

/// One line a joint; angles beyond what people reach carry a `!`.
pub(super) fn joint_table(motion: &MotionInspection) -> String {
    let heads = ["bend °", "side °", "twist °"].map(|head| format!("{head:^20}"));
    let mut text = format!("{:<15}{:<SOURCE$}{}", "joint", "follows", heads.concat());
    text.truncate(text.trim_end().len());
    let columns = format!("{:>5}{:>6}{:>6}   ", "min", "max", "p95");
    let _ = writeln!(text, "\n{:39}{}", "", columns.repeat(3).trim_end());
    let rule = "─".repeat(99);
    let _ = writeln!(text, "{rule}");
    let matches = motion.source.iter().flat_map(|source| &source.matches);
    let follows = |joint: &str| {
        let found = matches.clone().find(|found| found.joint == joint);
        found.map_or(String::new(), |found| shortened(&found.source.join(" + ")))
    };
    for range in &motion.range_of_motion {
        let _ = write!(text, "{:<15}{:<SOURCE$}", range.joint, follows(range.joint));
        let mut line = String::new();
        for axis in [range.bend, range.side, range.twist] {
            line += &cells(&axis);
        }
        let _ = writeln!(text, "{}", line.trim_end());
    }
    let _ = writeln!(text, "{rule}");
    let beyond = motion
        .range_of_motion
        .iter()
        .flat_map(|range| [range.bend, range.side, range.twist]);
    if beyond.into_iter().any(|axis| is_beyond(&axis)) {
        text += "! beyond what people reach, in at least one of 100 frames\n";
    }
    text
}

fn cells(axis: &AxisRange) -> String {
    let mark = |is: bool| if is && is_beyond(axis) { '!' } else { ' ' };
    format!(
        "{:>5.0}{}{:>5.0}{}{:>5.0}   ",
        whole(axis.min),
        mark(axis.min < axis.human[0]),
        whole(axis.max),
        mark(axis.max > axis.human[1]),
        whole(axis.percentile_95),
    )
}

/// To the degree, without a negative zero.
fn whole(degrees: f32) -> f32 {
    degrees.round() + 0.0
}

/// Not only for a moment.
fn is_beyond(axis: &AxisRange) -> bool {
    axis.beyond_percent >= 1.0
}

fn shortened(name: &str) -> String {
    if name.chars().count() < SOURCE {
        return name.to_owned();
    }
    let start: String = name.chars().take(SOURCE - 2).collect();
    start + "…"
}

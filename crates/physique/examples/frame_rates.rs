//! How much the measures depend on the frame rate of a recording, in medians over files:
//! `cargo run --release --example frame_rates -- FILES recorded at 120 fps` prints a table in Markdown.
//!
//! Every clip is resampled to lower rates and measured again. What the table shows for a lower rate is
//! the median over clips of the measure itself, and, behind it, of how much a clip's value moved.

use std::path::Path;

use physique::body::{Body, Sex, open_body};
use physique::load::{LoadOptions, load};
use physique::motion::{FrameRate, Motion};
use physique::physics::{Physics, PhysicsOptions};

use support::{MEASURES, measured, median};

mod support;

const LOWER_RATES: [f64; 3] = [60.0, 30.0, 20.0];

/// The values of one measure over all clips: at the recorded rate, then at the lower ones.
type Values = [Vec<f64>; 1 + LOWER_RATES.len()];

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let body = Body::mean(open_body()?, Sex::Neutral)?;
    let physics = Physics::new(&body)?;
    let mut table = [const { [const { Vec::new() }; 1 + LOWER_RATES.len()] }; MEASURES.len()];
    let mut clips = 0;
    for file in std::env::args().skip(1) {
        let recorded = load(Path::new(&file), &body, &LoadOptions::default())?.motion;
        let measure = |motion: &Motion| physics.measure(motion, &PhysicsOptions::default());
        let mut by_rate = vec![measured(&measure(&recorded)?)];
        for fps in LOWER_RATES {
            let resampled = recorded.resampled(FrameRate::new(fps)?)?;
            by_rate.push(measured(&measure(&resampled)?));
        }
        clips += 1;
        for (column, values) in table.iter_mut().enumerate() {
            let of_clip: Option<Vec<f64>> = by_rate.iter().map(|row| row[column]).collect();
            for (rate, value) in of_clip.into_iter().flatten().enumerate() {
                values[rate].push(value);
            }
        }
    }
    println!("{clips} clips\n");
    println!(
        "| measure | recorded | {} |",
        LOWER_RATES.map(|fps| fps.to_string()).join(" | ")
    );
    println!("|---|--:{}|", "|--:".repeat(LOWER_RATES.len()));
    for (name, values) in MEASURES.iter().zip(&table) {
        let lower = (1..=LOWER_RATES.len()).map(|rate| cell(values, rate));
        let cells: Vec<String> = lower.collect();
        println!(
            "| {name} | {:.2} | {} |",
            median(values[0].clone()),
            cells.join(" | ")
        );
    }
    Ok(())
}

/// A median, and the median change against the recorded rate in per cent where the value is not 0.
fn cell(values: &Values, rate: usize) -> String {
    let changes = values[rate].iter().zip(&values[0]);
    let changes = changes.filter(|(_, recorded)| recorded.abs() > 1e-9);
    let changes =
        changes.map(|(found, recorded)| 100.0 * (found - recorded).abs() / recorded.abs());
    format!(
        "{:.2} ({:.1} %)",
        median(values[rate].clone()),
        median(changes.collect())
    )
}

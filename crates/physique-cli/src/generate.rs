//! `physique generate`: motions from words.

pub(crate) mod arguments;
mod edit;
pub(crate) mod model;
pub(crate) mod motion;
mod output;
pub(crate) mod parts;

use std::time::Duration;

use anyhow::{Context, Result, bail};
use indicatif::{ProgressBar, ProgressStyle};
use physique::motion::features::MotionFeatures;
use physique::report::{MotionReport, ReportHead};
use physique::{Report, ScoreOptions, Scorer};
use physique_learn::diffusion::Method;
use physique_learn::mdm::{Prompt, Sampling, TextToMotion};

use crate::exit::Exit;
use crate::table::table;
use arguments::{GenerateArguments, SamplingArguments};
use edit::Given;
use output::Outputs;

/// Motions that are sampled together: memory grows with them.
const AT_ONCE: usize = 32;

pub(crate) fn run(arguments: &GenerateArguments) -> Result<Exit> {
    let texts = texts(arguments)?;
    let outputs = Outputs::new(arguments, texts.len() * usize::from(arguments.count))?;
    let network = model::open(&arguments.model, &arguments.read)?;
    let scorer = Scorer::new(arguments.body.body()?, ScoreOptions::default())?;
    let given = edit::read(&arguments.edit, &arguments.read, &network, scorer.body())?;
    let frames = match &given {
        Given::Known(known) => known.features.frame_count(),
        Given::Nothing | Given::After(_) => frames(arguments.seconds, &network)?,
    };
    let parts: Vec<_> = texts
        .iter()
        .map(|text| parts::of(text, arguments, &network))
        .collect();
    let mut prompts = Vec::new();
    for parts in &parts {
        for _ in 0..arguments.count {
            prompts.push(Prompt {
                text: &parts.text,
                upper_body: parts.upper_body.as_deref(),
                frames,
                seed: arguments.seed + prompts.len() as u64,
            });
        }
    }
    let motions = sample(&network, &prompts, arguments, &given)?;

    let mut reports = Vec::new();
    for (number, (features, prompt)) in motions.iter().zip(&prompts).enumerate() {
        let text = &texts[number / usize::from(arguments.count)];
        let loaded = motion::on_body(features, scorer.body())?;
        let path = outputs.path(number, text);
        let mut notes = outputs.write(&path, &loaded, (text, prompt.seed), scorer.body())?;
        if arguments.png {
            outputs.draw(&path, &loaded, text, &scorer)?;
        }
        notes.splice(0..0, loaded.notes);
        let name = path
            .file_name()
            .map(|name| name.to_string_lossy().into_owned());
        reports.push(MotionReport {
            file: path.display().to_string(),
            name: name.unwrap_or_default(),
            text: Some(text.clone()),
            score: Some(scorer.score(&loaded.motion)?),
            unscorable: None,
            mapping: None,
            notes,
        });
    }
    let report = Report {
        head: ReportHead::new(scorer.options(), scorer.body()),
        motions: reports,
    };
    if arguments.json {
        println!("{}", serde_json::to_string_pretty(&report)?);
    } else {
        print!("{}", table(&report, None));
        println!("{}", arguments.output.display());
    }
    Ok(Exit::Done)
}

/// The texts of the flags and of their file.
fn texts(arguments: &GenerateArguments) -> Result<Vec<String>> {
    let mut texts = arguments.texts.clone();
    if let Some(path) = &arguments.prompts {
        let lines = std::fs::read_to_string(path).with_context(|| path.display().to_string())?;
        let lines = lines.lines().map(str::trim);
        texts.extend(lines.filter(|line| !line.is_empty()).map(str::to_owned));
    }
    if texts.is_empty() {
        bail!("expected a text to generate a motion of, found none");
    }
    Ok(texts)
}

fn frames(seconds: f64, network: &TextToMotion) -> Result<usize> {
    if !(0.2..=600.0).contains(&seconds) {
        bail!("--seconds: expected 0.2 to 600, found {seconds}");
    }
    let rate = network.frame_rate().per_second();
    let frames = (seconds * rate).round().max(2.0) as usize;
    if let Some(longest) = network.folder().description.longest_frames
        && frames > longest
    {
        eprintln!(
            "note: the network was trained with motions of up to {:.1} s; longer ones may come to a halt or repeat",
            longest as f64 / rate
        );
    }
    Ok(frames)
}

fn sample(
    network: &TextToMotion,
    prompts: &[Prompt<'_>],
    arguments: &GenerateArguments,
    given: &Given,
) -> Result<Vec<MotionFeatures>> {
    let mut sampling = sampling(&arguments.sampling);
    if arguments.sampling.smooth.is_none() && network.frame_rate().per_second() > 16.0 {
        sampling.smooth_hz = Some(SMOOTH_HZ);
    }
    let default = network.folder().description.diffusion_steps;
    let frames = prompts.iter().map(|prompt| prompt.frames).max();
    let planner = network.folder().network.config().planner;
    let pieces = planner.map_or(1, |of| frames.unwrap_or(0).div_ceil(of.prediction));
    let steps = sampling.steps.unwrap_or(default) * pieces;
    let divided = |batch: &[Prompt<'_>]| batch.iter().any(|prompt| prompt.upper_body.is_some());
    let passes: usize = prompts
        .chunks(AT_ONCE)
        .map(|batch| 1 + usize::from(divided(batch)))
        .sum();
    let bar = ProgressBar::new((passes * steps) as u64);
    // A constant template; were it wrong, indicatif's own style would show.
    if let Ok(style) = ProgressStyle::with_template("{bar:40} {pos}/{len} steps (left: {eta})") {
        bar.set_style(style);
    }
    bar.enable_steady_tick(Duration::from_millis(200));
    let mut motions = Vec::new();
    for batch in prompts.chunks(AT_ONCE) {
        let observe = |_| bar.inc(1);
        let made = match given {
            Given::Nothing => network.generate(batch, sampling, None, observe)?,
            Given::Known(known) => network.generate(batch, sampling, Some(known), observe)?,
            Given::After(motion) => network.go_on(batch, sampling, motion, observe)?,
        };
        motions.extend(made);
    }
    bar.finish_and_clear();
    Ok(motions)
}

/// What biomechanics filters joints with: no one swings a limb faster.
pub(crate) const SMOOTH_HZ: f64 = 6.0;

/// How motions are sampled, by the flags.
pub(crate) fn sampling(arguments: &SamplingArguments) -> Sampling {
    Sampling {
        guidance: arguments.guidance,
        method: match arguments.ddim {
            Some(eta) => Method::Ddim { eta },
            None => Method::Ancestral,
        },
        steps: arguments.steps,
        guides: arguments.guide,
        smooth_hz: arguments.smooth.filter(|&cutoff| cutoff != 0.0),
    }
}

//! `physique demo`: the main job on embedded data.

use std::fs;
use std::time::Instant;

use anyhow::{Context, Result};
use physique::load::load_recording;
use physique::motion::{Motion, embedded};
use physique::report::{MotionReport, ReportHead};
use physique::{Report, ScoreOptions, Scorer};
use physique_view::MotionSheet;

use crate::arguments::DemoArguments;
use crate::exit::Exit;
use crate::table::table;
use physique_files::write_file;

pub(crate) fn run(arguments: &DemoArguments) -> Result<Exit> {
    let start = Instant::now();
    let scorer = Scorer::new(arguments.body.body()?, ScoreOptions::default())?;
    let folder = &arguments.output;
    fs::create_dir_all(folder).with_context(|| folder.display().to_string())?;

    let mut motions = Vec::new();
    for clip in embedded::clips() {
        let loaded = load_recording(clip.load()?, scorer.body())?;
        motions.push(MotionReport {
            file: clip.name.to_owned(),
            name: clip.name.to_owned(),
            text: None,
            score: Some(scorer.score(&loaded.motion)?),
            unscorable: None,
            mapping: None,
            notes: loaded.notes,
        });
        draw(&scorer, clip.name, clip.summary, &loaded.motion, arguments)?;
    }
    #[cfg(feature = "learn")]
    motions.push(generated(&scorer, arguments)?);
    let report = Report {
        head: ReportHead::new(scorer.options(), scorer.body()),
        motions,
    };
    let json = serde_json::to_string_pretty(&report)? + "\n";
    write_file(&folder.join("scores.json"), json.as_bytes())?;

    print!("{}", table(&report, None));
    let generated = match cfg!(feature = "learn") {
        true => "; the last one is generated",
        false => "",
    };
    println!(
        "Real motion, embedded{generated}. Scores and pictures are in {}/ ({:.1} s).",
        folder.display(),
        start.elapsed().as_secs_f64()
    );
    println!(
        "Next: physique score your-motion.bvh, and physique view your-motion.bvh --png sheet.png"
    );
    Ok(Exit::Done)
}

/// A motion of the embedded network, which knows some words.
#[cfg(feature = "learn")]
fn generated(scorer: &Scorer, arguments: &DemoArguments) -> Result<MotionReport> {
    use physique_learn::DeviceChoice;
    use physique_learn::mdm::{Prompt, Sampling};

    use crate::generate::SMOOTH_HZ;
    use crate::generate::parts::Parts;

    const NAME: &str = "generated";
    const TEXT: &str = "a tired person walks and waves with the left hand";
    let network = crate::network::default(DeviceChoice::Cpu)?;
    let parts = Parts::divided(TEXT);
    let prompt = Prompt {
        text: &parts.text,
        upper_body: parts.upper_body.as_deref(),
        frames: 80,
        seed: 0,
    };
    let sampling = Sampling {
        smooth_hz: Some(SMOOTH_HZ),
        ..Sampling::default()
    };
    let made = network.generate(&[prompt], sampling, None, |_| ())?;
    let features = made.first().context("no motion was generated")?;
    let loaded = crate::generate::motion::on_body(features, scorer.body())?;
    draw(scorer, NAME, TEXT, &loaded.motion, arguments)?;
    Ok(MotionReport {
        file: NAME.to_owned(),
        name: NAME.to_owned(),
        text: Some(TEXT.to_owned()),
        score: Some(scorer.score(&loaded.motion)?),
        unscorable: None,
        mapping: None,
        notes: loaded.notes,
    })
}

fn draw(
    scorer: &Scorer,
    name: &str,
    summary: &str,
    motion: &Motion,
    arguments: &DemoArguments,
) -> Result<()> {
    let intersections = scorer.self_intersections(motion, |_| ())?;
    let sheet = MotionSheet {
        title: &format!("{name}: {summary}"),
        motion,
        body: scorer.body(),
        intersections: &intersections,
        moments: 8,
    };
    let path = arguments.output.join(format!("{name}.png"));
    sheet.render()?.write_png(&path)?;
    Ok(())
}

//! Pictures of what a network generates while it is trained.

use std::path::Path;

use anyhow::Result;
use physique::body::Body;
use physique_learn::mdm::{Prompt, Sampling, TextToMotion};
use physique_view::MotionSheet;

use crate::generate::motion::on_body;

/// Draws one motion a prompt into a folder.
pub(super) fn draw(
    network: &TextToMotion,
    prompts: &[String],
    frames: usize,
    body: &Body,
    folder: &Path,
) -> Result<()> {
    std::fs::create_dir_all(folder)?;
    let asked: Vec<Prompt<'_>> = prompts
        .iter()
        .map(|text| Prompt {
            text,
            upper_body: None,
            frames,
            seed: 0,
        })
        .collect();
    let motions = network.generate(&asked, Sampling::default(), None, |_| ())?;
    for (number, (features, prompt)) in motions.iter().zip(prompts).enumerate() {
        let loaded = on_body(features, body)?;
        let sheet = MotionSheet {
            title: prompt,
            motion: &loaded.motion,
            body,
            intersections: &[],
            moments: 8,
        };
        sheet
            .render()?
            .write_png(folder.join(format!("{number}.png")))?;
    }
    Ok(())
}

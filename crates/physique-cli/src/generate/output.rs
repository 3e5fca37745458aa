//! Where generated motions go.

use std::path::{Path, PathBuf};

use anyhow::{Context, Result, bail};
use physique::body::Body;
use physique::export::{ExportOptions, Provenance, export};
use physique::load::Loaded;
use physique::{ExportFormat, Scorer};
use physique_view::MotionSheet;

use super::arguments::GenerateArguments;
use crate::convert::plan::format;

/// A file for one motion, or a folder for many.
pub(super) struct Outputs {
    output: PathBuf,
    format: ExportFormat,
    into_folder: bool,
}

impl Outputs {
    /// Makes the folder, where there is to be one.
    pub(super) fn new(arguments: &GenerateArguments, motions: usize) -> Result<Self> {
        let output = arguments.output.clone();
        let ends_as_folder = output.to_string_lossy().ends_with(['/', '\\']);
        let into_folder = motions > 1 || output.is_dir() || ends_as_folder;
        let format = match arguments.to {
            None if into_folder => ExportFormat::Glb,
            to => format(&output, to, into_folder)?,
        };
        if into_folder {
            if output.is_file() {
                bail!(
                    "{}: is a file; {motions} motions need a folder",
                    output.display()
                );
            }
            std::fs::create_dir_all(&output).with_context(|| output.display().to_string())?;
        }
        Ok(Self {
            output,
            format,
            into_folder,
        })
    }

    /// Where a motion goes: a number and words of its text, in a folder.
    pub(super) fn path(&self, number: usize, text: &str) -> PathBuf {
        if !self.into_folder {
            return self.output.clone();
        }
        let words = text.split(|c: char| !c.is_alphanumeric());
        let words: Vec<&str> = words.filter(|word| !word.is_empty()).collect();
        let name: String = words.join("-").chars().take(60).collect();
        let ending = self.format.ending();
        self.output.join(format!("{number:03}-{name}.{ending}"))
    }

    /// Writes a motion; tells what the format could not carry.
    pub(super) fn write(
        &self,
        path: &Path,
        loaded: &Loaded,
        (text, seed): (&str, u64),
        body: &Body,
    ) -> Result<Vec<String>> {
        let provenance = Provenance {
            name: text.to_owned(),
            source: Some("physique generate".into()),
            notes: vec![format!("Seed {seed}.")],
        };
        let options = ExportOptions::new(self.format);
        Ok(export(path, &loaded.motion, body, provenance, &options)?)
    }

    /// Draws a contact sheet beside a motion.
    pub(super) fn draw(
        &self,
        path: &Path,
        loaded: &Loaded,
        text: &str,
        scorer: &Scorer,
    ) -> Result<()> {
        let sheet = MotionSheet {
            title: text,
            motion: &loaded.motion,
            body: scorer.body(),
            intersections: &scorer.self_intersections(&loaded.motion, |_| ())?,
            moments: 8,
        };
        Ok(sheet.render()?.write_png(path.with_extension("png"))?)
    }
}

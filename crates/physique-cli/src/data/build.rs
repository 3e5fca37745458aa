//! `physique data build`.

use std::path::Path;

use anyhow::{Context, Result, bail};
use indicatif::{ProgressBar, ProgressStyle};
use physique_data::recipe::embedded::EmbeddedRecipe;
use physique_data::{BuildObserver, BuildReport, DataLimits, PublishedSet, Recipe, Source, build};

use super::arguments::BuildArguments;
use super::table;
use crate::exit::Exit;

pub(crate) fn run(arguments: &BuildArguments) -> Result<Exit> {
    let limits = DataLimits::default();
    let source = source(&arguments.recipe, &limits)?;
    let bar = Bar(ProgressBar::no_length());
    let report = build(&source, &arguments.folder, &arguments.output, &limits, &bar);
    bar.0.finish_and_clear();
    let report = report?;
    tell(&report, &arguments.output, arguments.json)?;
    Ok(Exit::Done)
}

/// Prints the report of a file that was just written.
pub(super) fn tell(report: &BuildReport, output: &Path, json: bool) -> Result<()> {
    if json {
        println!("{}", serde_json::to_string_pretty(report)?);
        return Ok(());
    }
    table::print(report);
    let file = std::fs::metadata(output).with_context(|| output.display().to_string())?;
    println!("{}: {:.1} MB", output.display(), file.len() as f64 / 1e6);
    Ok(())
}

/// The recipe of a file or a name.
fn source(name: &str, limits: &DataLimits) -> Result<Source> {
    if let Some(set) = PublishedSet::named(name) {
        return Ok(Source::Published(set));
    }
    if let Some(embedded) = EmbeddedRecipe::named(name) {
        return Ok(Source::Recipe(Box::new(embedded.recipe()?)));
    }
    let path = Path::new(name);
    if !path.exists() {
        let embedded = EmbeddedRecipe::ALL.map(|recipe| recipe.name).join(", ");
        bail!("{name}: no such recipe file, nor an embedded recipe: {embedded}, humanml3d, kit");
    }
    Ok(Source::Recipe(Box::new(Recipe::read(path, limits)?)))
}

/// Progress on standard error, where a person watches.
struct Bar(ProgressBar);

impl BuildObserver for Bar {
    fn begin(&self, files: usize) {
        // A constant template; were it wrong, indicatif's own style would show.
        if let Ok(style) =
            ProgressStyle::with_template("{bar:40} {pos}/{len} files, {elapsed} (left: {eta})")
        {
            self.0.set_style(style);
        }
        self.0.set_length(files as u64);
        self.0
            .enable_steady_tick(std::time::Duration::from_millis(200));
    }

    fn file(&self) {
        self.0.inc(1);
    }
}

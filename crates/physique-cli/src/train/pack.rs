//! `physique train pack`.

use std::fs;

use anyhow::{Context, Result};
use physique_files::write_file;
use physique_learn::checkpoint::{CheckpointLimits, Precision};
use physique_learn::mdm::MdmFolder;

use super::arguments::PackArguments;
use crate::exit::Exit;

const CARD: &str = "CARD.md";

pub(crate) fn run(arguments: &PackArguments) -> Result<Exit> {
    let (from, to) = (&arguments.model, &arguments.output);
    let device = physique_learn::device();
    let folder = MdmFolder::read(from, &CheckpointLimits::default(), &device)?;
    folder.write(to, Precision::Half)?;
    let card = from.join(CARD);
    if card.exists() {
        let text = fs::read(&card).with_context(|| card.display().to_string())?;
        write_file(&to.join(CARD), &text)?;
    }
    println!("{}", to.display());
    Ok(Exit::Done)
}

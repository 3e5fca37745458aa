//! `physique data join`.

use anyhow::Result;
use physique_data::{DataLimits, Dataset, join};

use super::arguments::JoinArguments;
use super::build::tell;
use crate::exit::Exit;

pub(crate) fn run(arguments: &JoinArguments) -> Result<Exit> {
    let limits = DataLimits::default();
    let sets = arguments.files.iter();
    let sets = sets.map(|file| Dataset::open(file, &limits));
    let sets = sets.collect::<Result<Vec<_>, _>>()?;
    let report = join(&sets, &arguments.output)?;
    tell(&report, &arguments.output, arguments.json)?;
    Ok(Exit::Done)
}

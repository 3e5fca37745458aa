//! Flags of `physique inspect`.

use std::path::PathBuf;

use clap::Args;

use crate::arguments::ReadArguments;
use crate::body_choice::BodyArguments;

#[derive(Debug, Args)]
pub(crate) struct InspectArguments {
    /// Motion and body files, folders that are searched for them, or patterns.
    #[arg(required_unless_present = "schema", value_name = "FILE")]
    pub(crate) files: Vec<PathBuf>,
    /// Tell everything about each of several motions, not one line each.
    #[arg(long, conflicts_with_all = ["json", "warnings"])]
    pub(crate) full: bool,
    /// Tell only what looks wrong.
    #[arg(long, conflicts_with = "json")]
    pub(crate) warnings: bool,
    /// Print JSON, whose schema `--schema` prints.
    #[arg(long)]
    pub(crate) json: bool,
    /// Write to a file instead of printing.
    #[arg(short, long, value_name = "FILE")]
    pub(crate) output: Option<PathBuf>,
    /// Print the JSON schema of `--json` and exit.
    #[arg(long, exclusive = true)]
    pub(crate) schema: bool,
    #[command(flatten)]
    pub(crate) body: BodyArguments,
    #[command(flatten)]
    pub(crate) read: ReadArguments,
}

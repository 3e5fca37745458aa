//! Flags of `physique data`.

use std::path::PathBuf;

use clap::{Args, Subcommand};

#[derive(Debug, Subcommand)]
pub(crate) enum DataVerb {
    /// Build a data file from a folder of motions: brings every clip to one skeleton, makes captions,
    /// splits by clip, and lists what is broken.
    Build(BuildArguments),
    /// Put several data files into one, with statistics of all of them.
    Join(JoinArguments),
    /// Tell what a data file holds.
    Show(ShowArguments),
    /// Print an embedded recipe to start an own one from, or list them.
    Recipe {
        /// Its name.
        name: Option<String>,
    },
}

#[derive(Debug, Args)]
pub(crate) struct BuildArguments {
    /// A recipe file (.toml), the name of an embedded recipe, `humanml3d` or `kit`.
    #[arg(value_name = "RECIPE")]
    pub(crate) recipe: String,
    /// Folder of the motions.
    #[arg(value_name = "FOLDER")]
    pub(crate) folder: PathBuf,
    /// Where the data file goes (.pmd).
    #[arg(short, long, value_name = "FILE")]
    pub(crate) output: PathBuf,
    /// Print the report as JSON.
    #[arg(long)]
    pub(crate) json: bool,
}

#[derive(Debug, Args)]
pub(crate) struct JoinArguments {
    /// The data files.
    #[arg(value_name = "FILE", required = true)]
    pub(crate) files: Vec<PathBuf>,
    /// Where the joined data file goes (.pmd).
    #[arg(short, long, value_name = "FILE")]
    pub(crate) output: PathBuf,
    /// Print the report as JSON.
    #[arg(long)]
    pub(crate) json: bool,
}

#[derive(Debug, Args)]
pub(crate) struct ShowArguments {
    /// The data file.
    #[arg(value_name = "FILE")]
    pub(crate) file: PathBuf,
    /// Print the report as JSON.
    #[arg(long)]
    pub(crate) json: bool,
    /// List every clip with its split, seconds and one caption, instead of counts.
    #[arg(long, conflicts_with = "json")]
    pub(crate) clips: bool,
    /// List what was left out, with the reason of each.
    #[arg(long, conflicts_with_all = ["json", "clips"])]
    pub(crate) left_out: bool,
    /// Read all rows and hold them against the file's checksum.
    #[arg(long)]
    pub(crate) verify: bool,
}

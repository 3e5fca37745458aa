//! Flags of `physique repair`.

use std::num::NonZeroUsize;
use std::path::PathBuf;

use clap::{Args, ValueEnum};
use physique::RepairOptions;
use physique::repair::Targets;

use crate::arguments::ReadArguments;
use crate::body_choice::BodyArguments;
use crate::convert::arguments::FormatName;
use crate::proxy::arguments::ProxyChoice;

#[derive(Debug, Args)]
#[command(after_long_help = EXAMPLES)]
pub(crate) struct RepairArguments {
    /// Motion files, folders that are searched for them, or patterns such as 'data/**/*.bvh'.
    #[arg(required_unless_present = "schema", value_name = "IN")]
    pub(crate) inputs: Vec<PathBuf>,
    /// Where it goes: a file, or a folder that mirrors the inputs' folders and keeps a record of
    /// what is done, `repair.jsonl`: a run that is stopped continues.
    #[arg(short, long, value_name = "OUT", required_unless_present = "schema")]
    pub(crate) output: Option<PathBuf>,
    /// Format [default: by the ending of OUT].
    #[arg(long, value_enum, value_name = "FORMAT")]
    pub(crate) to: Option<FormatName>,
    /// Repair only these faults.
    #[arg(long, value_enum, value_delimiter = ',', value_name = "FAULT")]
    pub(crate) only: Option<Vec<TargetName>>,
    /// How much faults weigh against changes: 2 repairs more thoroughly, 0.5 changes less.
    #[arg(long, value_name = "X", default_value_t = 1.0)]
    pub(crate) strength: f64,
    /// Print JSON, whose schema `--schema` prints.
    #[arg(long)]
    pub(crate) json: bool,
    /// Repair again what is done.
    #[arg(long)]
    pub(crate) force: bool,
    /// Files to work on at the same time [default: one a core].
    #[arg(short, long, value_name = "N")]
    pub(crate) jobs: Option<NonZeroUsize>,
    /// Print the JSON schema of `--json` and exit.
    #[arg(long, exclusive = true)]
    pub(crate) schema: bool,
    #[command(flatten)]
    pub(crate) body: BodyArguments,
    #[command(flatten)]
    pub(crate) proxy: ProxyChoice,
    #[command(flatten)]
    pub(crate) read: ReadArguments,
}

const EXAMPLES: &str = "\
No measure of `score` gets worse beyond a tolerance: a repair that would make one worse is made
gentler, or not at all; then the result is the source. Exit code 4 says that this happened.

Examples:
  physique repair walk.bvh -o fixed.bvh
  physique repair walk.bvh -o fixed.glb --only self
  physique repair generated/ -o fixed/ --to bvh
  physique repair walk.bvh -o fixed.npz --stature 1.8 --mass 110 --strength 2";

impl RepairArguments {
    pub(crate) fn options(&self) -> RepairOptions {
        let wanted = |name| self.only.as_ref().is_none_or(|only| only.contains(&name));
        RepairOptions {
            targets: Targets {
                self_intersection: wanted(TargetName::SelfIntersection),
                ground: wanted(TargetName::Ground),
                feet: wanted(TargetName::Feet),
            },
            strength: self.strength,
            ..RepairOptions::default()
        }
    }
}

#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub(crate) enum TargetName {
    /// Parts of the body inside others.
    #[value(name = "self", alias = "self-intersection")]
    SelfIntersection,
    /// Skin in the ground, and bodies that float above it.
    Ground,
    /// Feet that slide where they stand.
    Feet,
}

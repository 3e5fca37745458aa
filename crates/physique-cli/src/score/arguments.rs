//! Flags of `physique score`.

use std::path::PathBuf;

use clap::Args;
use physique::{Condition, Group, Protocol, ScoreOptions};

use crate::arguments::ReadArguments;
use crate::batch::Shard;
use crate::body_choice::BodyArguments;
use crate::names::{FloorName, GroupName, ProtocolName};

#[derive(Debug, Args)]
pub(crate) struct ScoreArguments {
    /// Motion files, or folders that are searched for them; with `--merge`, parts.
    #[arg(required_unless_present_any = ["schema", "protocols"], value_name = "FILE")]
    pub(crate) files: Vec<PathBuf>,
    #[command(flatten)]
    pub(crate) body: BodyArguments,
    #[command(flatten)]
    pub(crate) read: ReadArguments,
    #[command(flatten)]
    pub(crate) measure: MeasureArguments,
    #[command(flatten)]
    pub(crate) output: OutputArguments,
    #[command(flatten)]
    pub(crate) batch: BatchArguments,
    /// Exit with code 3 if a motion meets this condition, such as
    /// `self_intersection_mean_cm3>20 or feet_slide_mean_cm_s>30`.
    #[arg(long, value_name = "EXPR")]
    pub(crate) fail_on: Option<Condition>,
    /// Print the JSON schema of `--json` and exit.
    #[arg(long, exclusive = true)]
    pub(crate) schema: bool,
    /// List the protocols with their measures, sources and frame rates, and exit.
    #[arg(long, exclusive = true)]
    pub(crate) protocols: bool,
}

/// What is measured.
#[derive(Debug, Args)]
#[command(next_help_heading = "Measures")]
pub(crate) struct MeasureArguments {
    /// Definitions of the measures, separated by commas. Those that count in frames resample the
    /// motion to the rate they assume.
    #[arg(
        long,
        value_enum,
        value_delimiter = ',',
        value_name = "NAME",
        default_value = "native",
        hide_possible_values = false
    )]
    pub(crate) protocol: Vec<ProtocolName>,
    /// Only these groups of Physique's own measures.
    #[arg(long, value_enum, value_delimiter = ',', value_name = "GROUP")]
    pub(crate) only: Option<Vec<GroupName>>,
    /// All groups but these; `--without self` takes a fifth of the time.
    #[arg(
        long,
        value_enum,
        value_delimiter = ',',
        value_name = "GROUP",
        conflicts_with = "only"
    )]
    pub(crate) without: Option<Vec<GroupName>>,
    /// Where the floor is, for every protocol.
    #[arg(long, value_enum, default_value_t = FloorName::Zero)]
    pub(crate) floor: FloorName,
    /// Distance between the lines along which volume is measured, in metres.
    #[arg(long, value_name = "METRES", default_value_t = 0.01)]
    pub(crate) spacing: f32,
}

impl MeasureArguments {
    pub(crate) fn protocols(&self) -> Vec<Protocol> {
        ProtocolName::named(&self.protocol)
    }

    fn groups(&self) -> Vec<Group> {
        let named = |names: &Option<Vec<GroupName>>, group| {
            names
                .as_ref()
                .map(|names| names.contains(&GroupName(group)))
        };
        let wanted = |&group: &Group| {
            named(&self.only, group).unwrap_or(true)
                && !named(&self.without, group).unwrap_or(false)
        };
        Group::ALL.into_iter().filter(wanted).collect()
    }

    pub(crate) fn options(&self, series: bool) -> ScoreOptions {
        ScoreOptions {
            protocols: self.protocols(),
            groups: self.groups(),
            floor: self.floor.into(),
            spacing_m: self.spacing,
            series,
        }
    }
}

/// Where the figures go.
#[derive(Debug, Args)]
#[command(next_help_heading = "Output")]
pub(crate) struct OutputArguments {
    /// Print JSON, whose schema `--schema` prints.
    #[arg(long, conflicts_with_all = ["jsonl", "csv"])]
    pub(crate) json: bool,
    /// Print JSON Lines: what measured, then a line a motion.
    #[arg(long, conflicts_with = "csv")]
    pub(crate) jsonl: bool,
    /// Print comma-separated values, one line a motion.
    #[arg(long)]
    pub(crate) csv: bool,
    /// Add the measures of every frame to JSON and JSON Lines.
    #[arg(long)]
    pub(crate) series: bool,
    /// Show only the N worst motions in the table, worst first.
    #[arg(long, value_name = "N", conflicts_with_all = ["json", "jsonl", "csv"])]
    pub(crate) worst: Option<usize>,
    /// Write to a file instead of printing; its ending (.json, .jsonl, .csv, .parquet) says the
    /// format where no flag does. A run that is stopped continues from FILE.partial.
    #[arg(short, long, value_name = "FILE")]
    pub(crate) output: Option<PathBuf>,
    /// Also write a row a motion to this Parquet file.
    #[arg(long, value_name = "FILE")]
    pub(crate) parquet: Option<PathBuf>,
    /// Also write a row a frame to this file (.parquet or .csv).
    #[arg(long, value_name = "FILE")]
    pub(crate) frames: Option<PathBuf>,
}

/// Large jobs.
#[derive(Debug, Args)]
#[command(next_help_heading = "Large jobs")]
pub(crate) struct BatchArguments {
    /// Do only part I of N: every Nth file. The output must be a file (.jsonl to be merged).
    #[arg(
        long,
        value_name = "I/N",
        requires = "output",
        conflicts_with = "merge"
    )]
    pub(crate) shard: Option<Shard>,
    /// FILES are all parts of a job, as .jsonl: put them together as one run would have written
    /// them.
    #[arg(long)]
    pub(crate) merge: bool,
    /// Leave out the files that this list names, one a line, such as `physique scan -o` writes.
    #[arg(long, value_name = "LIST", conflicts_with = "merge")]
    pub(crate) exclude: Option<PathBuf>,
}

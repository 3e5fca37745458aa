//! Flags of `physique scan`.

use std::path::PathBuf;

use clap::builder::PossibleValue;
use clap::{Args, ValueEnum};
use physique::defects::{DefectKind, DefectLimits};

use crate::arguments::ReadArguments;
use crate::batch::Shard;
use crate::body_choice::BodyArguments;

#[derive(Debug, Args)]
pub(crate) struct ScanArguments {
    /// Folders that are searched for motion files, or files.
    #[arg(required_unless_present = "schema", value_name = "FOLDER")]
    pub(crate) files: Vec<PathBuf>,
    /// Write a filter list: the bad clips, one a line.
    #[arg(short, long, value_name = "LIST")]
    pub(crate) output: Option<PathBuf>,
    /// Write a list of the good clips.
    #[arg(long, value_name = "LIST")]
    pub(crate) good: Option<PathBuf>,
    /// Print JSON: every clip with its defects. `--schema` prints its schema.
    #[arg(long, conflicts_with = "csv")]
    pub(crate) json: bool,
    /// Print comma-separated values: a line a defect.
    #[arg(long)]
    pub(crate) csv: bool,
    /// Do only part I of N: every Nth file. Lists and lines of parts add up.
    #[arg(long, value_name = "I/N")]
    pub(crate) shard: Option<Shard>,
    /// Exit with code 3 if a clip is bad.
    #[arg(long)]
    pub(crate) strict: bool,
    /// Print the JSON schema of `--json` and exit.
    #[arg(long, exclusive = true)]
    pub(crate) schema: bool,
    #[command(flatten)]
    pub(crate) look: LookArguments,
    #[command(flatten)]
    pub(crate) body: BodyArguments,
    #[command(flatten)]
    pub(crate) read: ReadArguments,
}

/// A kind of defect.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct KindName(DefectKind);

impl ValueEnum for KindName {
    fn value_variants<'a>() -> &'a [Self] {
        const NAMES: [KindName; DefectKind::ALL.len()] = {
            let mut names = [KindName(DefectKind::ALL[0]); DefectKind::ALL.len()];
            let mut index = 0;
            while index < DefectKind::ALL.len() {
                names[index] = KindName(DefectKind::ALL[index]);
                index += 1;
            }
            names
        };
        &NAMES
    }

    fn to_possible_value(&self) -> Option<PossibleValue> {
        Some(PossibleValue::new(self.0.name()))
    }
}

/// What counts as bad. The defaults let motion capture pass.
#[derive(Debug, Args)]
#[command(next_help_heading = "What is bad")]
pub(crate) struct LookArguments {
    /// Look only for these kinds of defects.
    #[arg(long, value_enum, value_delimiter = ',', value_name = "KIND")]
    only: Option<Vec<KindName>>,
    /// Do not look for these; `--without self-intersection` takes half the time.
    #[arg(
        long,
        value_enum,
        value_delimiter = ',',
        value_name = "KIND",
        conflicts_with = "only"
    )]
    without: Option<Vec<KindName>>,
    /// Clips shorter than this.
    #[arg(long, value_name = "SECONDS", default_value_t = DefectLimits::default().least_s)]
    least_seconds: f64,
    /// Joints that move so much farther in one frame than three times their usual step.
    #[arg(long, value_name = "CM", default_value_t = DefectLimits::default().jump_cm)]
    jump_cm: f64,
    /// Joints that turn so much farther in one frame.
    #[arg(long, value_name = "DEGREES", default_value_t = DefectLimits::default().jump_degrees)]
    jump_degrees: f64,
    /// Standstill of the whole body for so long.
    #[arg(long, value_name = "SECONDS", default_value_t = DefectLimits::default().frozen_s)]
    frozen: f64,
    /// More frames than this that repeat the one before.
    #[arg(long, value_name = "PERCENT", default_value_t = DefectLimits::default().repeated_percent)]
    repeated: f64,
    /// Frame rates outside these.
    #[arg(long, value_name = "FPS", num_args = 2, default_values_t = DefectLimits::default().frame_rates_fps)]
    frame_rates: Vec<f64>,
    /// Stated frame rates that are off by more than this factor, by how fast bodies fall in flight.
    #[arg(long, value_name = "FACTOR", default_value_t = DefectLimits::default().frame_rate_factor)]
    frame_rate_factor: f64,
    /// Lowest skin deeper in the ground than this on average.
    #[arg(long, value_name = "CM", default_value_t = DefectLimits::default().below_ground_cm)]
    below_ground: f64,
    /// Lowest skin higher above ground than this on average, flight left out.
    #[arg(long, value_name = "CM", default_value_t = DefectLimits::default().floating_cm)]
    floating: f64,
    /// More self-intersection than this on average.
    #[arg(long, value_name = "CM3", default_value_t = DefectLimits::default().self_intersection_cm3)]
    self_intersection: f64,
}

impl LookArguments {
    pub(crate) fn limits(&self) -> DefectLimits {
        let defaults = DefectLimits::default();
        DefectLimits {
            least_s: self.least_seconds,
            jump_cm: self.jump_cm,
            jump_degrees: self.jump_degrees,
            frozen_s: self.frozen,
            repeated_percent: self.repeated,
            frame_rates_fps: match self.frame_rates[..] {
                [least, greatest] => [least, greatest],
                _ => defaults.frame_rates_fps,
            },
            frame_rate_factor: self.frame_rate_factor,
            below_ground_cm: self.below_ground,
            floating_cm: self.floating,
            self_intersection_cm3: self.self_intersection,
        }
    }

    pub(crate) fn kinds(&self) -> Vec<DefectKind> {
        let named = |names: &Option<Vec<KindName>>, kind| {
            names.as_ref().map(|names| names.contains(&KindName(kind)))
        };
        let wanted = |&kind: &DefectKind| {
            named(&self.only, kind).unwrap_or(true) && !named(&self.without, kind).unwrap_or(false)
        };
        DefectKind::ALL.into_iter().filter(wanted).collect()
    }
}

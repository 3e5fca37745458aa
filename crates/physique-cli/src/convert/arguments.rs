//! Flags of `physique convert`.

use std::num::NonZeroUsize;
use std::path::PathBuf;

use clap::{Args, ValueEnum};
use physique::ExportFormat;
use physique::motion::UpAxis;
use physique::motion::bvh::LengthUnit;

use crate::arguments::ReadArguments;
use crate::body_choice::BodyArguments;

#[derive(Debug, Args)]
#[command(after_long_help = EXAMPLES)]
pub(crate) struct ConvertArguments {
    /// Motion files, folders that are searched for them, or patterns such as 'data/**/*.bvh'.
    #[arg(required = true, value_name = "IN")]
    pub(crate) inputs: Vec<PathBuf>,
    /// Where it goes: a file, or a folder that mirrors the inputs' folders.
    #[arg(value_name = "OUT")]
    pub(crate) output: PathBuf,
    /// Format [default: by the ending of OUT].
    #[arg(long, value_enum, value_name = "FORMAT")]
    pub(crate) to: Option<FormatName>,
    /// Frame rate of the result: rotations are interpolated spherically
    /// [default: the source's; 20 for 263 and positions, 12.5 for kit].
    #[arg(long, value_name = "FPS", value_parser = frame_rate)]
    pub(crate) resample: Option<f64>,
    /// Up axis of BVH.
    #[arg(long, value_enum, value_name = "AXIS", ignore_case = true)]
    pub(crate) up: Option<AxisName>,
    /// Length unit of BVH [default: cm].
    #[arg(long, value_enum, value_name = "UNIT")]
    pub(crate) unit: Option<UnitName>,
    /// Convert again what is newer than its source and whole.
    #[arg(long)]
    pub(crate) force: bool,
    /// Files to work on at the same time [default: one a core].
    #[arg(short, long, value_name = "N")]
    pub(crate) jobs: Option<NonZeroUsize>,
    #[command(flatten)]
    pub(crate) body: BodyArguments,
    #[command(flatten)]
    pub(crate) read: ReadArguments,
}

const EXAMPLES: &str = "\
Examples:
  physique convert walk.bvh walk.glb
  physique convert walk.bvh walk.npy --to 263
  physique convert recordings/ features/ --to 263 --jobs 8
  physique convert 'recordings/**/*_walk.bvh' amass/ --to amass --resample 30";

fn frame_rate(text: &str) -> Result<f64, String> {
    match text.parse() {
        Ok(rate) if (1.0..=1000.0).contains(&rate) => Ok(rate),
        _ => Err("expected 1 to 1000 frames a second".into()),
    }
}

/// Names of formats, as typed.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub(crate) enum FormatName {
    /// Biovision hierarchy (.bvh).
    Bvh,
    /// AMASS, SMPL-H with flat hands (.npz).
    Amass,
    /// Skinned, animated figure (.glb).
    Glb,
    /// HumanML3D features, 20 fps (.npy).
    #[value(name = "263", alias = "humanml3d")]
    HumanMl3d,
    /// KIT-ML features, 12.5 fps (.npy).
    #[value(name = "kit", alias = "251")]
    Kit,
    /// Positions of the 22 joints, 20 fps (.npy).
    Positions,
    /// Positions of the 22 joints as text (.csv).
    Csv,
    /// Path of the pelvis and local quaternions as text (.rotations.csv).
    RotationsCsv,
    /// Physique's own, which keeps every bit (.motion.npz).
    Motion,
}

impl From<FormatName> for ExportFormat {
    fn from(name: FormatName) -> Self {
        match name {
            FormatName::Bvh => Self::Bvh,
            FormatName::Amass => Self::Amass,
            FormatName::Glb => Self::Glb,
            FormatName::HumanMl3d => Self::HumanMl3d,
            FormatName::Kit => Self::Kit,
            FormatName::Positions => Self::Positions,
            FormatName::Csv => Self::PositionCsv,
            FormatName::RotationsCsv => Self::RotationCsv,
            FormatName::Motion => Self::Native,
        }
    }
}

#[derive(Clone, Copy, Debug, ValueEnum)]
pub(crate) enum AxisName {
    Y,
    Z,
}

impl From<AxisName> for UpAxis {
    fn from(name: AxisName) -> Self {
        match name {
            AxisName::Y => Self::Y,
            AxisName::Z => Self::Z,
        }
    }
}

#[derive(Clone, Copy, Debug, ValueEnum)]
pub(crate) enum UnitName {
    M,
    Cm,
    Mm,
    #[value(name = "in")]
    Inch,
}

impl From<UnitName> for LengthUnit {
    fn from(name: UnitName) -> Self {
        match name {
            UnitName::M => Self::Metre,
            UnitName::Cm => Self::Centimetre,
            UnitName::Mm => Self::Millimetre,
            UnitName::Inch => Self::Inch,
        }
    }
}

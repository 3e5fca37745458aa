//! Commands and flags.

use std::num::NonZeroUsize;
use std::path::PathBuf;

use clap::{Args, Parser, Subcommand, ValueEnum};

use crate::body_choice::BodyArguments;
use crate::convert::arguments::ConvertArguments;
use crate::data::arguments::DataVerb;
#[cfg(feature = "learn")]
use crate::evaluate::arguments::EvaluateArguments;
#[cfg(feature = "learn")]
use crate::generate::arguments::GenerateArguments;
use crate::inspect::arguments::InspectArguments;
use crate::proxy::arguments::ProxyVerb;
use crate::repair::arguments::RepairArguments;
use crate::scan::arguments::ScanArguments;
use crate::score::arguments::ScoreArguments;
#[cfg(feature = "learn")]
use crate::train::arguments::TrainVerb;

/// Human motion that a body could really perform: score it, look at it, repair it, convert it.
#[derive(Debug, Parser)]
#[command(
    name = "physique",
    version,
    arg_required_else_help = true,
    max_term_width = 100
)]
pub(crate) struct Arguments {
    /// Threads to use [default: one a core]. Results do not depend on it.
    #[arg(long, global = true, value_name = "N")]
    pub(crate) threads: Option<NonZeroUsize>,
    #[command(subcommand)]
    pub(crate) verb: Verb,
}

#[derive(Debug, Subcommand)]
pub(crate) enum Verb {
    /// Measure what a body could not really perform: self-intersection, ground, feet, balance,
    /// smoothness; by Physique's own or published definitions.
    Score(Box<ScoreArguments>),
    /// Find the bad clips of a collection: unreadable, jumping, frozen, at a wrong frame rate, sunk,
    /// floating, deep in themselves; write a list of them.
    Scan(Box<ScanArguments>),
    /// Draw a motion on a body: a contact sheet over time, intersections in red.
    View(ViewArguments),
    /// Tell what files hold: skeleton, rate, units, range of motion, movement, and what looks wrong.
    Inspect(Box<InspectArguments>),
    /// Bring motions to the body and write them in any format: BVH, AMASS, GLB, HumanML3D, KIT, CSV.
    Convert(ConvertArguments),
    /// Change motions as little as possible so that a body could really perform them: without
    /// self-intersection, sinking, floating and sliding, and with no measure made worse.
    Repair(Box<RepairArguments>),
    /// Score embedded clips of real motion and draw them, to see what Physique does.
    Demo(DemoArguments),
    /// Spheres in place of a body: fit them, count which touch, measure them.
    #[command(subcommand)]
    Proxy(ProxyVerb),
    /// Motions with captions as one file to learn from.
    #[command(subcommand)]
    Data(DataVerb),
    /// Generate motions from words.
    #[cfg(feature = "learn")]
    Generate(Box<GenerateArguments>),
    /// Train a network that generates motions.
    #[cfg(feature = "learn")]
    #[command(subcommand)]
    Train(TrainVerb),
    /// Evaluate networks that generate motion by the published protocol, or by the labels of the
    /// data: the paper's table, with intervals.
    #[cfg(feature = "learn")]
    Evaluate(Box<EvaluateArguments>),
    /// Print a completion script for a shell.
    Completions {
        /// The shell.
        shell: clap_complete::Shell,
    },
}

/// How motions are read.
#[derive(Clone, Debug, Args)]
#[command(next_help_heading = "Reading")]
pub(crate) struct ReadArguments {
    /// Frame rate of the files, where they do not state it or state it wrongly.
    #[arg(long, value_name = "FPS")]
    pub(crate) frame_rate: Option<f64>,
    /// Axis that points up in the files, where they do not say.
    #[arg(long, value_enum, value_name = "AXIS")]
    pub(crate) up_axis: Option<UpAxisName>,
    /// Skeleton (`.asf`) of Acclaim motions (`.amc`), where none of their name lies beside them.
    #[arg(long, value_name = "FILE")]
    pub(crate) skeleton: Option<PathBuf>,
    /// Mean of the data set (`Mean.npy`), for features that are normalised.
    #[arg(long, value_name = "FILE", requires = "std")]
    pub(crate) mean: Option<PathBuf>,
    /// Deviation of the data set (`Std.npy`), for features that are normalised.
    #[arg(long, value_name = "FILE", requires = "mean")]
    pub(crate) std: Option<PathBuf>,
    /// How rotations are found for files of joint positions and features.
    #[arg(long, value_enum, default_value_t = RotationsName::InverseKinematics)]
    pub(crate) rotations: RotationsName,
    /// TOML file that names the source's joints: lines such as `left_hip = "LeftUpLeg"`.
    #[arg(long, value_name = "FILE")]
    pub(crate) mapping: Option<PathBuf>,
}

#[derive(Clone, Copy, Debug, ValueEnum)]
pub(crate) enum UpAxisName {
    Y,
    Z,
}

#[derive(Clone, Copy, Debug, ValueEnum)]
pub(crate) enum RotationsName {
    /// Joints are met; the pelvis keeps its tilt, and limbs their twist where it can be told.
    InverseKinematics,
    /// The self-intersection paper's own layer: heading only, no twist.
    PaperLayer,
}

#[derive(Debug, Args)]
pub(crate) struct ViewArguments {
    /// The motion.
    #[arg(value_name = "FILE")]
    pub(crate) file: PathBuf,
    /// Where the picture goes.
    #[arg(long, value_name = "SHEET", required = true)]
    pub(crate) png: PathBuf,
    /// Moments to show, evenly spread, the worst one among them.
    #[arg(long, value_name = "N", default_value_t = 8, value_parser = clap::value_parser!(u16).range(1..=64))]
    pub(crate) moments: u16,
    #[command(flatten)]
    pub(crate) body: BodyArguments,
    #[command(flatten)]
    pub(crate) read: ReadArguments,
}

#[derive(Debug, Args)]
pub(crate) struct DemoArguments {
    /// Folder for the scores and pictures.
    #[arg(short, long, value_name = "FOLDER", default_value = "physique-demo")]
    pub(crate) output: PathBuf,
    #[command(flatten)]
    pub(crate) body: BodyArguments,
}

//! Flags of `physique proxy`.

use std::path::PathBuf;

use clap::{Args, Subcommand, ValueEnum};
use physique::proxy::files::Precision;

use crate::arguments::ReadArguments;

#[derive(Debug, Subcommand)]
pub(crate) enum ProxyVerb {
    /// Fit spheres to a body model: regressors from betas to spheres and joints, and blend weights.
    /// Goes on where it was stopped. The default is the paper's recipe.
    Fit(FitArguments),
    /// Count how often spheres intersect in real motion, which decides what the loss compares.
    Pairs(PairsArguments),
    /// Measure how well spheres stand in for bodies that no fit has seen.
    Evaluate(EvaluateArguments),
}

#[derive(Debug, Args)]
pub(crate) struct FitArguments {
    /// Body model: `open`, `open-low`, or a file: SMPL, SMPL-H or SMPL-X as .npz or .pkl, or a
    /// compact body.
    #[arg(long, value_name = "FILE", default_value = "open")]
    pub(crate) body: String,
    /// Number of spheres.
    #[arg(long, value_name = "N", default_value_t = 192)]
    pub(crate) spheres: usize,
    /// Where the proxy goes (.safetensors).
    #[arg(short, long, value_name = "FILE")]
    pub(crate) output: PathBuf,
    /// Folder for samples and checkpoints [default: the output with `.work` behind it]. Fits of
    /// other sizes may share it one after the other: samples are kept.
    #[arg(long, value_name = "FOLDER")]
    pub(crate) work: Option<PathBuf>,
    /// Betas are drawn uniformly from plus and minus this.
    #[arg(long, value_name = "BETA", default_value_t = 3.0)]
    pub(crate) beta_range: f32,
    /// Bodies that the spheres are fitted to.
    #[arg(long, value_name = "N", default_value_t = 800)]
    pub(crate) bodies: usize,
    /// Points around each body: a third in the ball, the rest near the surface.
    #[arg(long, value_name = "N", default_value_t = 750_000)]
    pub(crate) points: usize,
    /// Points that a body shows in one step: 16384, or that divided by a whole number.
    #[arg(long, value_name = "N", default_value_t = 16_384)]
    pub(crate) step_points: usize,
    /// Passes over the bodies for the spheres; the learning rate's steps scale along.
    #[arg(long, value_name = "N", default_value_t = 2_800)]
    pub(crate) epochs: usize,
    /// Passes over 8,000 bodies for the joints.
    #[arg(long, value_name = "N", default_value_t = 300)]
    pub(crate) joint_epochs: usize,
    /// Random seed: the same seed gives the same proxy, for any number of threads.
    #[arg(long, value_name = "N", default_value_t = 10)]
    pub(crate) seed: u64,
    /// How vertices next to a sphere share in its blend weights.
    #[arg(long, value_enum, default_value_t = NeighboursName::Equal)]
    pub(crate) neighbours: NeighboursName,
    /// How exactly parameters are stored.
    #[arg(long, value_enum, default_value_t = PrecisionName::Exact)]
    pub(crate) precision: PrecisionName,
}

#[derive(Clone, Copy, Debug, ValueEnum)]
pub(crate) enum NeighboursName {
    /// All alike, as the paper says.
    Equal,
    /// By signed distance, as the published program does.
    Distance,
}

#[derive(Clone, Copy, Debug, ValueEnum)]
pub(crate) enum PrecisionName {
    /// To the bit.
    Exact,
    /// 16-bit floats.
    Half,
    /// Directions of weights in 8 bits, all else in 16.
    Compact,
}

impl From<PrecisionName> for Precision {
    fn from(name: PrecisionName) -> Self {
        match name {
            PrecisionName::Exact => Self::Exact,
            PrecisionName::Half => Self::Half,
            PrecisionName::Compact => Self::Compact,
        }
    }
}

/// Which proxy.
#[derive(Clone, Debug, Args)]
#[command(next_help_heading = "Proxy")]
pub(crate) struct ProxyChoice {
    /// Proxy file (.safetensors), or a folder in the published layout [default: embedded].
    #[arg(long, value_name = "FILE")]
    pub(crate) proxy: Option<PathBuf>,
    /// Spheres of the open body's embedded proxy: 128, 192 or 256.
    #[arg(
        long,
        value_name = "N",
        default_value_t = 192,
        conflicts_with = "proxy"
    )]
    pub(crate) spheres: usize,
}

#[derive(Debug, Args)]
pub(crate) struct PairsArguments {
    /// Motion files or folders of them; every frame counts as one pose.
    #[arg(long, required = true, num_args = 1.., value_name = "FOLDER")]
    pub(crate) motions: Vec<PathBuf>,
    /// Proxy files whose counts are renewed in place: motions are read once for all of them.
    #[arg(long, required = true, num_args = 1.., value_name = "FILE")]
    pub(crate) proxy: Vec<PathBuf>,
    /// Body model that the proxy was fitted to.
    #[arg(long, value_name = "FILE", default_value = "open")]
    pub(crate) body: String,
    /// Count only every N-th frame.
    #[arg(long, value_name = "N", default_value = "1")]
    pub(crate) every: std::num::NonZeroUsize,
    /// How exactly parameters are stored. What a file has rounded stays rounded.
    #[arg(long, value_enum, default_value_t = PrecisionName::Exact)]
    pub(crate) precision: PrecisionName,
    #[command(flatten)]
    pub(crate) read: ReadArguments,
}

#[derive(Debug, Args)]
pub(crate) struct EvaluateArguments {
    #[command(flatten)]
    pub(crate) proxy: ProxyChoice,
    /// Body model that the proxy was fitted to.
    #[arg(long, value_name = "FILE", default_value = "open")]
    pub(crate) body: String,
    /// Held-out bodies.
    #[arg(long, value_name = "N", default_value_t = 150)]
    pub(crate) bodies: usize,
    /// Betas are drawn uniformly from plus and minus this.
    #[arg(long, value_name = "BETA", default_value_t = 3.0)]
    pub(crate) beta_range: f32,
    /// Random seed; that of the fit draws bodies that the fit has not seen.
    #[arg(long, value_name = "N", default_value_t = 10)]
    pub(crate) seed: u64,
    /// Print JSON.
    #[arg(long)]
    pub(crate) json: bool,
    /// Draw bodies and their spheres, front and side, into this picture.
    #[arg(long, value_name = "FILE")]
    pub(crate) png: Option<PathBuf>,
}

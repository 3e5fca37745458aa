//! Flags of `physique train`.

use std::path::PathBuf;

use clap::{Args, Subcommand};
use physique_learn::DeviceChoice;

use crate::device::DeviceArguments;

#[derive(Debug, Subcommand)]
pub(crate) enum TrainVerb {
    /// Train a motion diffusion model (MDM, Tevet et al. 2023) on a data file; a run that was
    /// stopped or killed goes on where it was.
    Mdm(Box<MdmArguments>),
    /// Train an evaluator for a data file that has no published one: `physique evaluate` compares
    /// motions and captions by it. Some minutes on a core.
    Evaluator(EvaluatorArguments),
    /// Write a trained network again in 16 bits a number: half the space, the same motions to the eye.
    Pack(PackArguments),
}

#[derive(Debug, Args)]
pub(crate) struct EvaluatorArguments {
    /// Data file, of `physique data build`.
    #[arg(long, value_name = "FILE")]
    pub(crate) data: PathBuf,
    /// Folder of the evaluator; the run is kept in `run` below it, and goes on if it was stopped.
    #[arg(short, long, value_name = "FOLDER")]
    pub(crate) output: PathBuf,
    /// Steps of the optimiser [default: 3000].
    #[arg(long, value_name = "N")]
    pub(crate) steps: Option<u64>,
    /// Pairs of a motion and a caption in a step [default: 32].
    #[arg(long, value_name = "N")]
    pub(crate) batch: Option<usize>,
    /// What all random numbers depend on [default: 10].
    #[arg(long, value_name = "N")]
    pub(crate) seed: Option<u64>,
    #[command(flatten)]
    pub(crate) device: DeviceArguments,
}

#[derive(Debug, Args)]
pub(crate) struct PackArguments {
    /// Folder of the network: `model` of a run.
    #[arg(value_name = "MODEL")]
    pub(crate) model: PathBuf,
    /// Folder for the packed network.
    #[arg(short, long, value_name = "FOLDER")]
    pub(crate) output: PathBuf,
}

#[derive(Debug, Args)]
pub(crate) struct MdmArguments {
    /// Data file, of `physique data build`.
    #[arg(long, value_name = "FILE")]
    pub(crate) data: PathBuf,
    /// Folder of the run: checkpoints, log, samples, and the network in `model`.
    #[arg(short, long, value_name = "FOLDER")]
    pub(crate) output: PathBuf,
    /// A plan: `published`, `fast`, `kit`, `small`, or a TOML file; a run that goes on has one.
    #[arg(long, value_name = "NAME|FILE")]
    pub(crate) plan: Option<String>,
    /// Start a new run from the weights of a trained network, with a fresh optimiser: a folder of a
    /// network, a published checkpoint (.pt) with args.json beside it, or a state of another run.
    /// Without --plan, the network's shape and the steps of noise are that network's.
    #[arg(long, value_name = "FOLDER|FILE")]
    pub(crate) start_from: Option<PathBuf>,
    /// Text encoder: `minilm`, a folder in the layout of Hugging Face (CLIP, DistilBERT, BERT), or
    /// OpenAI's ViT-B-32.pt; `none` for a network that is told nothing.
    #[arg(long, value_name = "NAME|FOLDER|FILE", default_value = "minilm")]
    pub(crate) text: String,
    /// Where it is trained: `cpu`; `wgpu` for a graphics processor by Vulkan, Metal or Direct3D, or
    /// `cuda`, in programs built with that feature. With a number for one of several, such as
    /// `cuda:1`; more than one, by commas, share each batch.
    #[arg(
        long,
        value_name = "NAME[:N],...",
        value_delimiter = ',',
        default_value = "cpu"
    )]
    pub(crate) device: Vec<DeviceChoice>,
    /// Print the plan with all its settings as JSON, and train nothing.
    #[arg(long)]
    pub(crate) print_plan: bool,
    #[command(flatten)]
    pub(crate) change: ChangeArguments,
    #[command(flatten)]
    pub(crate) samples: SampleArguments,
}

/// What of a plan is changed.
#[derive(Debug, Args)]
#[command(next_help_heading = "Instead of the plan's")]
pub(crate) struct ChangeArguments {
    /// Steps of the optimiser.
    #[arg(long, value_name = "N")]
    pub(crate) steps: Option<u64>,
    /// Motions a step.
    #[arg(long, value_name = "N")]
    pub(crate) batch: Option<usize>,
    /// Learning rate.
    #[arg(long, value_name = "RATE")]
    pub(crate) rate: Option<f64>,
    /// What all random numbers depend on.
    #[arg(long, value_name = "N")]
    pub(crate) seed: Option<u64>,
    /// Weight of the self-intersection loss: 0.01 makes MDM a SIA-MDM.
    #[arg(long, value_name = "WEIGHT")]
    pub(crate) self_intersection: Option<f64>,
    /// Steps from one checkpoint to the next.
    #[arg(long, value_name = "N")]
    pub(crate) save_every: Option<u64>,
}

/// Motions that are generated while training.
#[derive(Debug, Args)]
#[command(next_help_heading = "Samples while training")]
pub(crate) struct SampleArguments {
    /// Checkpoints from one set of samples to the next; 0 for none.
    #[arg(long, value_name = "N", default_value_t = 4)]
    pub(crate) sample_every: u64,
    /// A prompt to draw at each; may be given more than once [default: training captions].
    #[arg(long = "prompt", value_name = "TEXT")]
    pub(crate) prompts: Vec<String>,
}

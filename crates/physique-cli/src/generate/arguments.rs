//! Flags of `physique generate`.

use std::path::PathBuf;

use clap::{Args, ValueEnum};
use physique_learn::diffusion::GuideWeights;

use crate::arguments::ReadArguments;
use crate::body_choice::BodyArguments;
use crate::convert::arguments::FormatName;
use crate::device::DeviceArguments;

#[derive(Debug, Args)]
#[command(after_long_help = EXAMPLES)]
pub(crate) struct GenerateArguments {
    /// What motions are to show, one text each.
    #[arg(value_name = "TEXT", required_unless_present = "prompts")]
    pub(crate) texts: Vec<String>,
    /// What trunk and arms do, while legs do as the texts say [default: texts that tell two things at
    /// once, such as "walks and waves", are divided].
    #[arg(long, value_name = "TEXT", conflicts_with_all = ["from", "after"])]
    pub(crate) upper_body: Option<String>,
    /// Take texts as they stand: divide none.
    #[arg(long, conflicts_with = "upper_body")]
    pub(crate) undivided: bool,
    /// File of more texts, one a line.
    #[arg(long, value_name = "FILE")]
    pub(crate) prompts: Option<PathBuf>,
    /// Where it goes: a file for one motion, or a folder.
    #[arg(short, long, value_name = "OUT")]
    pub(crate) output: PathBuf,
    /// Format [default: by the ending of OUT, glTF in folders].
    #[arg(long, value_enum, value_name = "FORMAT")]
    pub(crate) to: Option<FormatName>,
    /// Length in seconds.
    #[arg(long, value_name = "SECONDS", default_value_t = 4.0)]
    pub(crate) seconds: f64,
    /// Motions of each text.
    #[arg(short = 'n', long, value_name = "N", default_value_t = 1, value_parser = clap::value_parser!(u16).range(1..))]
    pub(crate) count: u16,
    /// Seed of the first motion; the next ones count up.
    #[arg(long, value_name = "N", default_value_t = 0)]
    pub(crate) seed: u64,
    /// Draw contact sheets, too: PNG beside each motion.
    #[arg(long)]
    pub(crate) png: bool,
    /// Print scores as JSON instead of a table.
    #[arg(long)]
    pub(crate) json: bool,
    #[command(flatten)]
    pub(crate) model: ModelArguments,
    #[command(flatten)]
    pub(crate) sampling: SamplingArguments,
    #[command(flatten)]
    pub(crate) edit: EditArguments,
    #[command(flatten)]
    pub(crate) body: BodyArguments,
    #[command(flatten)]
    pub(crate) read: ReadArguments,
}

/// Which network generates.
#[derive(Debug, Args)]
#[command(next_help_heading = "Network")]
pub(crate) struct ModelArguments {
    /// A network inside the program: `mdm-small`, or `mdm-small-free`, which knows less and may be
    /// used for anything; a folder of `physique train`; or a published checkpoint (.pt) with args.json
    /// beside it [default: mdm-small].
    #[arg(long, value_name = "NAME|FOLDER|FILE")]
    pub(crate) model: Option<PathBuf>,
    /// Text encoder: `minilm`, a folder in the layout of Hugging Face, or OpenAI's ViT-B-32.pt with
    /// bpe_simple_vocab_16e6.txt.gz beside it [default: `minilm`, where the network was trained with it].
    #[arg(long, value_name = "NAME|FOLDER|FILE", requires = "model")]
    pub(crate) text: Option<String>,
    #[command(flatten)]
    pub(crate) device: DeviceArguments,
}

#[derive(Debug, Args)]
#[command(next_help_heading = "Sampling")]
pub(crate) struct SamplingArguments {
    /// Scale of classifier-free guidance: how strictly the text is followed.
    #[arg(long, value_name = "SCALE", default_value_t = 2.5)]
    pub(crate) guidance: f64,
    /// Steps of noise to walk [default: all that the network was trained with].
    #[arg(long, value_name = "N")]
    pub(crate) steps: Option<usize>,
    /// Sample by DDIM with this share of the noise (0: none) instead of from the posterior.
    #[arg(long, value_name = "ETA", num_args = 0..=1, default_missing_value = "0")]
    pub(crate) ddim: Option<f64>,
    /// Losses that motions are moved against while they are made, on any network: NAME=WEIGHT of
    /// `self`, `ground` and `feet`, 1 for a full step; such as `self=1,feet=1`.
    #[arg(
        long,
        value_name = "NAME=WEIGHT,...",
        default_value = "",
        hide_default_value = true
    )]
    pub(crate) guide: GuideWeights,
    /// Take out what swings faster than so many Hz, as biomechanics does with recorded joints; 0 for
    /// nothing [default: 6 in `generate`, where the frame rate allows it, and 0 in `evaluate`].
    #[arg(long, value_name = "HZ")]
    pub(crate) smooth: Option<f64>,
}

/// Parts of another motion that stay.
#[derive(Debug, Args)]
#[command(next_help_heading = "Editing")]
pub(crate) struct EditArguments {
    /// A motion that parts are kept of; its length is that of the result.
    #[arg(long, value_name = "FILE", requires = "keep")]
    pub(crate) from: Option<PathBuf>,
    /// What is kept of it; may be given more than once.
    #[arg(long, value_enum, value_name = "PART", requires = "from")]
    pub(crate) keep: Vec<KeptPart>,
    /// A motion whose last frames a planner (DiP) goes on from; they are not in the result.
    #[arg(long, value_name = "FILE", conflicts_with = "from")]
    pub(crate) after: Option<PathBuf>,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub(crate) enum KeptPart {
    /// The first and the last quarter of the frames: the middle is made anew.
    Ends,
    /// The first quarter: the motion goes on from there.
    Start,
    /// Path and legs: trunk and arms are made anew.
    Legs,
    /// Trunk, head and arms.
    UpperBody,
}

const EXAMPLES: &str = "\
Examples:
  physique generate \"a tired person walks\" -o out.glb
  physique generate \"a person runs\" \"a person waves\" -n 5 -o motions/ --png
  physique generate \"a person walks and waves with the left hand\" -o out.glb
  physique generate \"a person runs\" --upper-body \"a person raises both hands\" -o out.glb
  physique generate \"a person waves\" --from walk.bvh --keep legs -o out.bvh
  physique generate \"a person walks\" -o out.bvh --model run/model
  physique generate \"a person kicks\" -o out.glb --model humanml/model000475000.pt \\
    --mean Mean.npy --std Std.npy --text clip/ViT-B-32.pt
  physique generate \"a person sits down\" -o out.glb --model dip/model.pt --guidance 7.5 \\
    --mean Mean.npy --std Std.npy --text distilbert-base-uncased/ --after walk.bvh";

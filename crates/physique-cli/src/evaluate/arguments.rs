//! Flags of `physique evaluate`.

use std::path::PathBuf;

use clap::{Args, ValueEnum};
use physique_data::Split;

use crate::body_choice::BodyArguments;
use crate::device::DeviceArguments;
use crate::generate::arguments::SamplingArguments;

#[derive(Debug, Args)]
pub(crate) struct EvaluateArguments {
    /// A network inside the program (`mdm-small`, `mdm-small-free`), a folder of `physique train`, or a
    /// published checkpoint (.pt) of the data set with args.json beside it; may be given more than once.
    /// Without one, only the real motions' row is made.
    #[arg(long = "model", value_name = "NAME|FOLDER|FILE")]
    pub(crate) models: Vec<PathBuf>,
    /// Text encoder of networks that were not trained with the embedded one: a folder in the layout of
    /// Hugging Face, or OpenAI's ViT-B-32.pt; may be given more than once, each network takes its own.
    #[arg(long, value_name = "FOLDER|FILE", requires = "models")]
    pub(crate) text: Vec<String>,
    /// Data file, of `physique data build`.
    #[arg(long, value_name = "FILE")]
    pub(crate) data: PathBuf,
    /// Clips to compare with.
    #[arg(long, value_enum, default_value_t = SplitName::Test)]
    pub(crate) split: SplitName,
    /// What all random numbers depend on.
    #[arg(long, value_name = "N", default_value_t = 10)]
    pub(crate) seed: u64,
    /// Write what was found as JSON. Repetitions are kept in FILE.partial on the way: an evaluation
    /// that was killed goes on where it was.
    #[arg(long, value_name = "FILE")]
    pub(crate) json: Option<PathBuf>,
    #[command(flatten)]
    pub(crate) evaluator: EvaluatorArguments,
    #[command(flatten)]
    pub(crate) protocol: ProtocolArguments,
    #[command(flatten)]
    pub(crate) judge: JudgeArguments,
    #[command(flatten)]
    pub(crate) sampling: SamplingArguments,
    #[command(flatten)]
    pub(crate) device: DeviceArguments,
    #[command(flatten)]
    pub(crate) body: BodyArguments,
}

#[derive(Debug, Args)]
#[command(next_help_heading = "Evaluator")]
pub(crate) struct EvaluatorArguments {
    /// Folder of `physique train evaluator`, or a published checkpoint
    /// (text_mot_match/model/finest.tar), which needs --glove, --mean and --std.
    #[arg(long, value_name = "FOLDER|FILE", required_unless_present = "judge")]
    pub(crate) evaluator: Option<PathBuf>,
    /// Folder of the word vectors: our_vab_data.npy, our_vab_words.pkl, our_vab_idx.pkl.
    #[arg(long, value_name = "FOLDER", requires = "evaluator")]
    pub(crate) glove: Option<PathBuf>,
    /// Mean that the published evaluator was trained with (meta/mean.npy).
    #[arg(long, value_name = "FILE", requires = "std")]
    pub(crate) mean: Option<PathBuf>,
    /// Deviation that the published evaluator was trained with (meta/std.npy).
    #[arg(long, value_name = "FILE", requires = "mean")]
    pub(crate) std: Option<PathBuf>,
}

#[derive(Debug, Args)]
#[command(next_help_heading = "Protocol")]
pub(crate) struct ProtocolArguments {
    /// How often all is done.
    #[arg(long, value_name = "N", default_value_t = 20)]
    pub(crate) repetitions: usize,
    /// Most motions to generate for a repetition, in whole batches of 32.
    #[arg(long, value_name = "N", default_value_t = 1024)]
    pub(crate) motions: usize,
    /// Repetitions that multimodality is measured in, with 30 motions a caption; 0 for none.
    #[arg(long, value_name = "N", default_value_t = 5)]
    pub(crate) multimodality: usize,
    /// Leave self-intersection out.
    #[arg(long)]
    pub(crate) no_self_intersection: bool,
    /// Read the captions of generated motions over their padding, as all published before January
    /// 2024 did (issue 182 of MDM): for comparison with those numbers; published evaluators only.
    #[arg(long)]
    pub(crate) caption_length_bug: bool,
}

#[derive(Debug, Args)]
#[command(next_help_heading = "Judge")]
pub(crate) struct JudgeArguments {
    /// Ask which value of this label, such as `content`, each generated motion is taken for, by its
    /// nearest training clips; with training wordings and with held-out ones.
    #[arg(long, value_name = "LABEL")]
    pub(crate) judge: Option<String>,
    /// Motions for each value.
    #[arg(long, value_name = "N", default_value_t = 20, requires = "judge")]
    pub(crate) samples: usize,
    /// How many values: those with most seconds to train with.
    #[arg(long, value_name = "N", default_value_t = 10, requires = "judge")]
    pub(crate) values: usize,
}

#[derive(Clone, Copy, Debug, ValueEnum)]
pub(crate) enum SplitName {
    Train,
    Validation,
    Test,
}

impl From<SplitName> for Split {
    fn from(name: SplitName) -> Self {
        match name {
            SplitName::Train => Self::Train,
            SplitName::Validation => Self::Validation,
            SplitName::Test => Self::Test,
        }
    }
}

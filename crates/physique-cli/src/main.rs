//! `physique`: human motion that a body could really perform, from the command line.

mod arguments;
mod batch;
mod body_choice;
mod convert;
mod data;
mod demo;
#[cfg(feature = "learn")]
mod device;
#[cfg(feature = "learn")]
mod evaluate;
mod exclude;
mod exit;
mod files;
#[cfg(feature = "learn")]
mod generate;
mod inspect;
mod journal;
mod names;
#[cfg(feature = "learn")]
mod network;
mod parquet;
mod progress;
mod proxy;
mod repair;
mod scan;
mod score;
mod table;
#[cfg(feature = "learn")]
mod text_encoder;
mod text_table;
#[cfg(feature = "learn")]
mod train;
mod view;

use std::process::ExitCode;

use clap::{CommandFactory, Parser};

use arguments::{Arguments, Verb};
use exit::Exit;

fn main() -> ExitCode {
    let arguments = Arguments::parse();
    if let Some(threads) = arguments.threads
        && let Err(problem) = rayon::ThreadPoolBuilder::new()
            .num_threads(threads.get())
            .build_global()
    {
        eprintln!("physique: cannot start {threads} threads: {problem}");
        return Exit::Failed.into();
    }
    let outcome = match &arguments.verb {
        Verb::Score(arguments) => score::run(arguments),
        Verb::Scan(arguments) => scan::run(arguments),
        Verb::View(arguments) => view::run(arguments),
        Verb::Inspect(arguments) => inspect::run(arguments),
        Verb::Convert(arguments) => convert::run(arguments),
        Verb::Repair(arguments) => repair::run(arguments),
        Verb::Demo(arguments) => demo::run(arguments),
        Verb::Proxy(verb) => proxy::run(verb),
        Verb::Data(verb) => data::run(verb),
        #[cfg(feature = "learn")]
        Verb::Generate(arguments) => generate::run(arguments),
        #[cfg(feature = "learn")]
        Verb::Evaluate(arguments) => evaluate::run(arguments),
        #[cfg(feature = "learn")]
        Verb::Train(verb) => train::run(verb),
        Verb::Completions { shell } => {
            let mut command = Arguments::command();
            clap_complete::generate(*shell, &mut command, "physique", &mut std::io::stdout());
            Ok(Exit::Done)
        }
    };
    match outcome {
        Ok(exit) => exit.into(),
        Err(problem) => {
            eprintln!("physique: {problem:#}");
            Exit::Failed.into()
        }
    }
}

//! Developer tasks: `cargo xtask test | bench | assets`.

mod assets;
mod bench;
mod cards;
mod python;
mod shell;
mod test;

use clap::{Parser, Subcommand};

/// Developer tasks of Physique.
#[derive(Parser)]
struct Arguments {
    #[command(subcommand)]
    task: Task,
}

#[derive(Subcommand)]
enum Task {
    /// Format, lints, documentation, tests and asset cards: everything that CI demands.
    Test,
    /// Run the benchmarks and print one table.
    Bench {
        /// Also time the usual PyTorch formulations (installs PyTorch below target/).
        #[arg(long)]
        peers: bool,
    },
    /// Rebuild every embedded asset from its public source and compare hashes.
    Assets {
        /// Keep what was built in place of the embedded files, for a reviewed change.
        #[arg(long)]
        write: bool,
    },
}

fn main() -> anyhow::Result<()> {
    match Arguments::parse().task {
        Task::Test => test::run(),
        Task::Bench { peers } => bench::run(peers),
        Task::Assets { write } => assets::run(write),
    }
}

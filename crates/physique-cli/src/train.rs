//! `physique train`: networks that generate motions.

pub(crate) mod arguments;
mod evaluator;
mod mdm;
mod pack;
mod plan;
mod samples;
mod start;
mod watch;

use anyhow::Result;

use crate::exit::Exit;
use arguments::TrainVerb;

pub(crate) fn run(verb: &TrainVerb) -> Result<Exit> {
    match verb {
        TrainVerb::Mdm(arguments) => mdm::run(arguments),
        TrainVerb::Evaluator(arguments) => evaluator::run(arguments),
        TrainVerb::Pack(arguments) => pack::run(arguments),
    }
}

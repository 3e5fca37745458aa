//! `physique train evaluator`.

use anyhow::Result;
use physique_data::{DataLimits, Dataset};
use physique_learn::evaluation::sentence::{EvaluatorRun, train_evaluator};

use super::arguments::EvaluatorArguments;
use super::watch::Watch;
use crate::exit::Exit;

pub(super) fn run(arguments: &EvaluatorArguments) -> Result<Exit> {
    let device = arguments.device.device.open()?;
    let dataset = Dataset::open(&arguments.data, &DataLimits::default())?;
    let mut run = EvaluatorRun::default();
    if let Some(steps) = arguments.steps {
        run.trainer.steps = steps;
    }
    if let Some(batch) = arguments.batch {
        run.training.batch = batch;
    }
    if let Some(seed) = arguments.seed {
        run.trainer.seed = seed;
    }
    let mut watch: Option<Watch> = None;
    eprintln!("note: reading the captions");
    train_evaluator(&dataset, &run, &arguments.output, &device, |report| {
        let begin = || Watch::new(report.step - 1, report.steps);
        watch.get_or_insert_with(begin).step(report);
        true
    })?;
    if let Some(watch) = watch {
        watch.finish();
    }
    println!("{}", arguments.output.display());
    Ok(Exit::Done)
}

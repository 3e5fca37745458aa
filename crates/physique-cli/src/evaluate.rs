//! `physique evaluate`: the published table for generated motions, and the judge.

pub(crate) mod arguments;
mod evaluators;
mod journal;
mod judge;
mod model;
mod report;
mod rows;
mod table;

use anyhow::Result;
use physique_data::{DataLimits, Dataset};

use crate::exit::Exit;
use arguments::EvaluateArguments;

pub(crate) fn run(arguments: &EvaluateArguments) -> Result<Exit> {
    let dataset = Dataset::open(&arguments.data, &DataLimits::default())?;
    let evaluator = evaluators::open(&arguments.evaluator, arguments.device.device)?;
    let models = model::open_all(arguments, &dataset)?;
    let mut report = report::EvaluationReport::new(arguments, &dataset);
    if let Some(evaluator) = &evaluator {
        let found = rows::measure(arguments, &dataset, evaluator.as_ref(), &models)?;
        table::print(&found.rows);
        report.evaluation = Some(found);
    }
    if arguments.judge.judge.is_some() {
        report.judge = judge::judge(arguments, &dataset, &models)?;
        judge::print(&report.judge);
    }
    if let Some(file) = &arguments.json {
        report.write(file)?;
        journal::remove(file)?;
    }
    Ok(Exit::Done)
}

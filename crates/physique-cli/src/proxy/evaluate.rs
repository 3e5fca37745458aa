//! `physique proxy evaluate`.

use anyhow::Result;
use physique::proxy::evaluate::{DistanceSummary, Evaluation, evaluate};

use super::arguments::EvaluateArguments;
use super::picture;
use crate::body_choice::model;
use crate::exit::Exit;
use crate::text_table::{Column, render};

pub(crate) fn run(arguments: &EvaluateArguments) -> Result<Exit> {
    let model = model(&arguments.body)?;
    let (name, proxy) = arguments.proxy.load()?;
    let evaluation = evaluate(
        &proxy,
        &model,
        arguments.bodies,
        arguments.beta_range,
        arguments.seed,
    )?;
    if arguments.json {
        println!("{}", serde_json::to_string_pretty(&evaluation)?);
    } else {
        print_table(&name, &evaluation);
    }
    if let Some(path) = &arguments.png {
        picture::draw(path, &proxy, &model)?;
        eprintln!("{}", path.display());
    }
    Ok(Exit::Done)
}

fn print_table(name: &str, evaluation: &Evaluation) {
    println!(
        "{name}: {} spheres, {} pairs compared; {} held-out bodies, betas within {}",
        evaluation.spheres, evaluation.pairs, evaluation.bodies, evaluation.beta_range
    );
    let columns = [
        Column::words(&["distance, cm"]),
        Column::number("", &["mean"]),
        Column::number("", &["95 %"]),
        Column::number("", &["greatest"]),
    ];
    let row = |name: String, summary: &DistanceSummary| {
        let figures = [summary.mean_cm, summary.p95_cm, summary.max_cm];
        let mut row = vec![name];
        row.extend(figures.map(|figure| format!("{figure:.2}")));
        row
    };
    let mut rows = vec![row("all vertices".into(), &evaluation.vertices)];
    for part in &evaluation.by_joint {
        rows.push(row(format!("  {}", part.joint), &part.vertices));
    }
    rows.push(row("regressed joints".into(), &evaluation.joints));
    print!("{}", render(&columns, &rows));
    println!(
        "spheres of a shape: {:.2} ms on one thread; regressors: {:.1} MB",
        evaluation.regress_ms,
        evaluation.parameter_bytes as f64 / 1e6
    );
}

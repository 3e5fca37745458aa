//! Which plan a run follows.

use std::fs;
use std::path::Path;

use anyhow::{Context, Result, bail};
use physique_files::write_file;
use physique_learn::mdm::{MdmPlan, PLANS, StartingNetwork};

use super::arguments::{ChangeArguments, MdmArguments};

/// Where a run keeps its plan.
const FILE: &str = "plan.json";

/// The plan of the flags, or of the run that is in the folder, with what the flags change.
pub(super) fn plan(
    arguments: &MdmArguments,
    kept: Option<MdmPlan>,
    start: Option<&StartingNetwork>,
) -> Result<MdmPlan> {
    let origin = kept.as_ref().and_then(|kept| kept.started_from.clone());
    let mut plan = match (&arguments.plan, kept) {
        (Some(name), _) => named(name)?,
        (None, Some(kept)) => kept,
        (None, None) => {
            let mut plan = named("small")?;
            if let Some(start) = start {
                plan.network = start.network.config().clone();
                plan.training.diffusion_steps = start.diffusion_steps;
                plan.training.signal = start.signal;
            }
            plan
        }
    };
    plan.started_from = start.map(|start| start.origin.clone()).or(origin);
    change(&mut plan, &arguments.change);
    Ok(plan)
}

/// Keeps the plan with the run. A folder with another run is refused: its network would be lost.
pub(super) fn keep(folder: &Path, plan: &MdmPlan) -> Result<()> {
    if let Some(kept) = kept(folder)?
        && (&kept.network, &kept.training, &kept.windows)
            != (&plan.network, &plan.training, &plan.windows)
    {
        bail!(
            "{}: holds a run with another plan; give it another folder, or leave out --plan to go on with that run",
            folder.display()
        );
    }
    fs::create_dir_all(folder).with_context(|| folder.display().to_string())?;
    let text = serde_json::to_string_pretty(plan)? + "\n";
    Ok(write_file(&folder.join(FILE), text.as_bytes())?)
}

/// The plan of the run that is in a folder.
pub(super) fn kept(folder: &Path) -> Result<Option<MdmPlan>> {
    let path = folder.join(FILE);
    if !path.exists() {
        return Ok(None);
    }
    let text = fs::read_to_string(&path).with_context(|| path.display().to_string())?;
    let plan = serde_json::from_str(&text).with_context(|| path.display().to_string())?;
    Ok(Some(plan))
}

fn named(name: &str) -> Result<MdmPlan> {
    if let Some(plan) = MdmPlan::named(name) {
        return Ok(plan);
    }
    let path = Path::new(name);
    if !path.exists() {
        let names = PLANS.map(|(name, _)| name).join(", ");
        bail!("{name}: no such plan file, nor a plan that is known: {names}");
    }
    let text = fs::read_to_string(path).with_context(|| name.to_owned())?;
    toml::from_str(&text).with_context(|| name.to_owned())
}

fn change(plan: &mut MdmPlan, by: &ChangeArguments) {
    fn set<T: Copy>(setting: &mut T, by: Option<T>) {
        if let Some(value) = by {
            *setting = value;
        }
    }
    set(&mut plan.run.steps, by.steps);
    set(&mut plan.training.batch, by.batch);
    set(&mut plan.run.optimiser.rate, by.rate);
    set(&mut plan.run.seed, by.seed);
    set(
        &mut plan.training.self_intersection_weight,
        by.self_intersection,
    );
    set(&mut plan.run.save_every, by.save_every);
}

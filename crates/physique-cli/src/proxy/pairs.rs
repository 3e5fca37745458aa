//! `physique proxy pairs`.

use std::path::Path;

use anyhow::{Context, Result, bail};
use indicatif::{ProgressBar, ProgressStyle};
use physique::body::{Body, Joint};
use physique::load::{LoadOptions, load_each};
use physique::proxy::files::write_proxy;
use physique::proxy::{PairStatistics, PoseMatrices, SphereBody, pose_matrices};
use rayon::prelude::*;

use super::arguments::PairsArguments;
use crate::body_choice::model;
use crate::exit::Exit;
use crate::files::motion_files;
use crate::view::load_options;

/// Files whose counts are added up at a time: bounds memory, and keeps the threads busy.
const BATCH: usize = 64;
/// Files left out that are named one by one.
const NAMED: usize = 10;

pub(crate) fn run(arguments: &PairsArguments) -> Result<Exit> {
    let body = Body::new(model(&arguments.body)?, &[])?;
    let mut proxies = Vec::new();
    let mut spheres = Vec::new();
    let mut statistics = Vec::new();
    for path in &arguments.proxy {
        let proxy = super::read(path)?;
        spheres.push(proxy.of_body(&body)?);
        statistics.push(PairStatistics::new(proxy.sphere_count())?);
        proxies.push(proxy);
    }
    let options = load_options(&arguments.read)?;
    let files = motion_files(&arguments.motions)?;
    let bar = ProgressBar::new(files.len() as u64);
    // A constant template; were it wrong, indicatif's own style would show.
    if let Ok(style) =
        ProgressStyle::with_template("{bar:40} {pos}/{len} files, {elapsed} (left: {eta})")
    {
        bar.set_style(style);
    }

    let mut left_out = Vec::new();
    let every = arguments.every.get();
    for batch in files.chunks(BATCH) {
        let counted: Vec<_> = batch
            .par_iter()
            .map(|file| {
                let counted = count(file, &body, &spheres, &options, every);
                bar.inc(1);
                counted
            })
            .collect();
        for (file, counted) in batch.iter().zip(counted) {
            match counted {
                Ok(counted) => {
                    for (sum, counted) in statistics.iter_mut().zip(&counted) {
                        sum.merge(counted)?;
                    }
                }
                Err(problem) => left_out.push(format!("{}: {problem:#}", file.display())),
            }
        }
    }
    bar.finish_and_clear();
    for problem in left_out.iter().take(NAMED) {
        eprintln!("note: left out {problem}");
    }
    if left_out.len() > NAMED {
        eprintln!("note: left out {} more files", left_out.len() - NAMED);
    }

    let motions = files.len() - left_out.len();
    let renewed = proxies.into_iter().zip(statistics);
    for (path, (proxy, statistics)) in arguments.proxy.iter().zip(renewed) {
        let poses = statistics.poses();
        if poses == 0 {
            bail!("no motion could be read: nothing was counted");
        }
        let mut proxy = proxy.with_statistics(statistics)?;
        let told = format!("{poses} poses of {motions} files on the body of betas 0");
        proxy.note("pairs", told);
        write_proxy(path, &proxy, arguments.precision.into())?;
        eprintln!(
            "{poses} poses of {motions} files: the loss compares {} of {} pairs",
            proxy.pairs()?.len(),
            proxy.sphere_count() * (proxy.sphere_count() - 1) / 2
        );
        println!("{}", path.display());
    }
    Ok(Exit::Done)
}

/// Counts the poses of one file for each of some proxies.
fn count(
    file: &Path,
    body: &Body,
    spheres: &[SphereBody],
    options: &LoadOptions,
    every: usize,
) -> Result<Vec<PairStatistics>> {
    let mut statistics = Vec::new();
    for spheres in spheres {
        statistics.push(PairStatistics::new(spheres.sphere_count())?);
    }
    for (name, loaded) in load_each(file, body, options)? {
        let motion = loaded.context(name)?.motion;
        let poses: Vec<PoseMatrices> = motion
            .rotations()
            .chunks_exact(Joint::COUNT)
            .step_by(every)
            .map(pose_matrices)
            .collect();
        for (statistics, spheres) in statistics.iter_mut().zip(spheres) {
            statistics.add(spheres, &poses)?;
        }
    }
    Ok(statistics)
}

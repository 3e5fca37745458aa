//! Parts of a job put together as one run would have written them.

use std::path::{Path, PathBuf};

use anyhow::{Result, bail, ensure};
use physique::Report;
use physique::report::{MotionReport, ReportHead};

use super::format::{LinesHead, read_lines};
use crate::batch::{JobIdentity, Shard};

/// A part, its motions by file.
struct Part {
    path: PathBuf,
    job: JobIdentity,
    shard: Shard,
    files: Vec<Vec<MotionReport>>,
}

/// Reads parts and puts their motions into the order of the whole job.
pub(crate) fn merge(paths: &[PathBuf]) -> Result<Report> {
    let mut head: Option<ReportHead> = None;
    let mut parts = Vec::new();
    for path in paths {
        let (of_part, part) = read(path)?;
        match &head {
            None => head = Some(of_part),
            Some(head) => ensure!(
                *head == of_part,
                "{}: was scored otherwise than {}: another body, version, protocol or floor",
                path.display(),
                paths[0].display()
            ),
        }
        parts.push(part);
    }
    parts.sort_by_key(|part| part.shard.index);
    check(&parts)?;
    let Some(head) = head else {
        bail!("there are no parts to merge");
    };
    let mut files: Vec<_> = parts
        .into_iter()
        .map(|part| part.files.into_iter())
        .collect();
    let mut motions = Vec::new();
    // Every nth file was a part's: taking turns restores the order.
    'files: loop {
        for part in &mut files {
            match part.next() {
                Some(file) => motions.extend(file),
                None => break 'files,
            }
        }
    }
    Ok(Report { head, motions })
}

fn read(path: &Path) -> Result<(ReportHead, Part)> {
    let (LinesHead { head, part }, motions) = read_lines(path)?;
    let Some((job, shard)) = part.and_then(|job| Some((job.clone(), job.shard?))) else {
        bail!("{}: is a whole job, not a part of one", path.display());
    };
    let mut files: Vec<Vec<MotionReport>> = Vec::new();
    for motion in motions {
        match files.last_mut() {
            Some(file) if file.last().is_some_and(|last| last.file == motion.file) => {
                file.push(motion);
            }
            _ => files.push(vec![motion]),
        }
    }
    let part = Part {
        path: path.to_owned(),
        job,
        shard,
        files,
    };
    Ok((head, part))
}

/// All parts of one job, each once, each complete.
fn check(parts: &[Part]) -> Result<()> {
    for (number, part) in parts.iter().enumerate() {
        let (first, path) = (&parts[0], part.path.display());
        ensure!(
            part.job.files_sha256 == first.job.files_sha256
                && part.shard.count == first.shard.count,
            "{path}: is a part of another job than {}: their lists of files differ",
            first.path.display()
        );
        let Shard { index, count } = part.shard;
        let expected = number + 1;
        ensure!(
            index >= expected,
            "{path}: part {index}/{count} is given twice"
        );
        ensure!(index == expected, "part {expected}/{count} is missing");
        let share = (part.job.files + count - index) / count;
        ensure!(
            part.files.len() == share,
            "{path}: expected {share} files, found {}",
            part.files.len()
        );
    }
    if let Some(last) = parts.last() {
        let Shard { index, count } = last.shard;
        ensure!(index == count, "part {}/{count} is missing", index + 1);
    }
    Ok(())
}

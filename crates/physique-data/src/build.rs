//! From a folder to a data file.

mod assemble;

use std::path::Path;

use physique::motion::features::StatisticsGatherer;
use rayon::prelude::*;

use crate::file::Writer;
use crate::source::{Outcome, Work};
use crate::{BuildReport, DataLimits, Error, LeftOut, Source};
use assemble::Assembly;

/// Files that are looked at together; memory holds no more of them at a time.
const FILES_AT_ONCE: usize = 64;

/// Hears how far a build is.
pub trait BuildObserver: Sync {
    /// So many files are going to be looked at.
    fn begin(&self, files: usize) {
        let _ = files;
    }

    /// One more file was looked at.
    fn file(&self) {}
}

/// Nobody listens.
impl BuildObserver for () {}

/// Builds a data file of all motions that a source finds in a folder, and says what was found, kept
/// and left out. The file appears whole or not at all, over an older one of its name.
///
/// The same folder gives the same bytes, for any number of threads. Cost: reading the motions, and
/// some 30 microseconds a frame for mapping and features; memory for 64 files at a time.
///
/// # Errors
/// [`Error::Folder`] where the folder holds nothing of the sort; [`Error::NothingLeft`]; those of
/// reading lists and tables, and of writing. A motion that cannot be used is no error: it is listed
/// in the report.
pub fn build(
    source: &Source,
    folder: &Path,
    output: &Path,
    limits: &DataLimits,
    observer: &dyn BuildObserver,
) -> Result<BuildReport, Error> {
    let Work {
        about,
        plan,
        look,
        statistics,
    } = source.work(folder, limits)?;
    observer.begin(plan.jobs);
    let jobs = plan.jobs;
    let mut assembly = Assembly::new(about, plan);
    let mut gatherer = StatisticsGatherer::new(assembly.skeleton());
    let mut writer = Writer::create(output, assembly.columns())?;
    for first in (0..jobs).step_by(FILES_AT_ONCE) {
        let batch = first..(first + FILES_AT_ONCE).min(jobs);
        let looked = batch.into_par_iter().map(|job| {
            let outcomes = look(job);
            observer.file();
            outcomes
        });
        for outcome in looked.collect::<Vec<_>>().into_iter().flatten() {
            match outcome {
                Outcome::LeftOut(left_out) => assembly.leave_out(left_out),
                Outcome::Kept(draft) => {
                    for features in &draft.features {
                        gatherer.add(features)?;
                    }
                    let first_row = writer.rows();
                    writer.append(&draft.rows)?;
                    assembly.keep(first_row, draft);
                }
            }
        }
    }
    if assembly.is_empty() {
        return Err(Error::NothingLeft {
            found: assembly.found(),
            first: assembly.first_left_out().map_or_else(
                || "there was none.".to_owned(),
                |LeftOut { name, message, .. }| format!("{name}: {message}"),
            ),
        });
    }
    let statistics = match statistics {
        Some(statistics) => statistics,
        None => gatherer.finish()?,
    };
    let rule = match source {
        Source::Recipe(recipe) => Some(&recipe.split),
        Source::Published(_) => None,
    };
    let index = assembly.finish(&statistics, rule)?;
    writer.finish(&index)?;
    Ok(index.report)
}

//! What all folders of networks have: a configuration, and what motions are normalised by.

use std::path::Path;

use physique_files::npz::npy_f32;
use physique_files::{FileError, write_file};
use physique_motion::features::FeatureStatistics;
use serde::Serialize;

use crate::Error;

pub(crate) const CONFIG: &str = "config.json";
pub(crate) const MEAN: &str = "mean.npy";
pub(crate) const DEVIATION: &str = "std.npy";

/// Makes a folder, unless there is one.
pub(crate) fn make(folder: &Path) -> Result<(), Error> {
    std::fs::create_dir_all(folder).map_err(|problem| io(folder, problem))
}

/// Writes `mean.npy` and `std.npy`, each whole or not at all.
pub(crate) fn write_statistics(folder: &Path, statistics: &FeatureStatistics) -> Result<(), Error> {
    for (name, values) in [
        (MEAN, statistics.mean()),
        (DEVIATION, statistics.deviation()),
    ] {
        let path = folder.join(name);
        let file = npy_f32(&[values.len()], values).map_err(|problem| Error::Content {
            file: path.clone(),
            problem: Box::new(problem.into()),
        })?;
        write_file(&path, &file)?;
    }
    Ok(())
}

/// Writes `config.json`, which goes last: a folder that has one is whole.
pub(crate) fn write_config(folder: &Path, config: &impl Serialize) -> Result<(), Error> {
    let path = folder.join(CONFIG);
    let text = serde_json::to_vec_pretty(config).map_err(|problem| io(&path, problem.into()))?;
    Ok(write_file(&path, &text)?)
}

fn io(path: &Path, problem: std::io::Error) -> Error {
    let path = path.into();
    FileError::Io { path, problem }.into()
}

//! Many files as one job, shared out among machines, continued where it was stopped.

use std::fmt::Write as _;
use std::path::{Path, PathBuf};
use std::str::FromStr;

use anyhow::{Result, bail};
use rayon::prelude::*;
use serde::de::DeserializeOwned;
use serde::{Deserialize, Serialize};
use sha2::{Digest, Sha256};

use crate::exclude::Excluded;
use crate::journal::Journal;
use crate::progress::Progress;

/// Which part of a job a run does: `2/8` is the second of eight.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub(crate) struct Shard {
    /// From 1.
    pub(crate) index: usize,
    pub(crate) count: usize,
}

impl FromStr for Shard {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        let expected = || format!("expected I/N with I from 1 to N, such as 2/8, found `{text}`");
        let (index, count) = text.split_once('/').ok_or_else(expected)?;
        let number = |text: &str| text.trim().parse::<usize>().map_err(|_| expected());
        let shard = Self {
            index: number(index)?,
            count: number(count)?,
        };
        match (1..=shard.count).contains(&shard.index) {
            true => Ok(shard),
            false => Err(expected()),
        }
    }
}

/// The files of a whole job, and which of them this run looks at.
#[derive(Clone, Debug)]
pub(crate) struct Job {
    /// This run's share, in the order of the whole.
    pub(crate) files: Vec<PathBuf>,
    pub(crate) excluded: Excluded,
    pub(crate) identity: JobIdentity,
}

/// What tells a job from others: runs of one job fit together.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub(crate) struct JobIdentity {
    /// Which part of it this run does.
    pub(crate) shard: Option<Shard>,
    /// Files of the whole job.
    pub(crate) files: usize,
    /// SHA-256 over names and sizes of the files of the whole job, in order, and over the motions
    /// that are left out.
    pub(crate) files_sha256: String,
}

impl Job {
    /// Every `count`th file is this shard's: long and short clips, which are often neighbours,
    /// spread evenly, and merged parts are in order again.
    pub(crate) fn new(all: Vec<PathBuf>, excluded: Excluded, shard: Option<Shard>) -> Self {
        let identity = JobIdentity {
            shard,
            files: all.len(),
            files_sha256: hash(&all, &excluded),
        };
        let files = match shard {
            None => all,
            Some(Shard { index, count }) => {
                all.into_iter().skip(index - 1).step_by(count).collect()
            }
        };
        Self {
            files,
            excluded,
            identity,
        }
    }

    /// Looks at every file, several at a time, in order. `work` gives the rows of a file; those
    /// that the journal already has are not looked at again.
    pub(crate) fn run<Row>(
        &self,
        mut journal: Option<Journal<Row>>,
        work: impl Fn(&Path, &Progress) -> Vec<Row> + Sync,
    ) -> Result<(Vec<Row>, Option<Journal<Row>>)>
    where
        Row: Serialize + DeserializeOwned + Send,
    {
        let mut rows: Vec<Row> = Vec::new();
        let mut done = 0;
        if let Some(journal) = &mut journal {
            for of_file in journal.take_done() {
                done += 1;
                rows.extend(of_file);
            }
        }
        if done > self.files.len() {
            bail!("the unfinished output holds more files than this run has");
        }
        if done > 0 {
            eprintln!(
                "{done} of {} files are already done: continuing",
                self.files.len()
            );
        }
        let progress = Progress::new(self.files.len());
        progress.skip(done);
        // Few at a time: what is done is kept soon, and the frames of a file run in parallel, too.
        for files in self.files[done..].chunks(rayon::current_num_threads()) {
            let found: Vec<Vec<Row>> = files
                .par_iter()
                .map(|file| {
                    let rows = work(file, &progress);
                    progress.motion();
                    rows
                })
                .collect();
            if let Some(journal) = &mut journal {
                journal.append(&found)?;
            }
            rows.extend(found.into_iter().flatten());
        }
        progress.finish();
        Ok((rows, journal))
    }
}

/// Over names and sizes: a file that cannot be asked for its size counts as empty.
fn hash(files: &[PathBuf], excluded: &Excluded) -> String {
    let mut hash = Sha256::new();
    for file in files {
        let size = std::fs::metadata(file).map_or(0, |metadata| metadata.len());
        hash.update(file.as_os_str().as_encoded_bytes());
        hash.update([0]);
        hash.update(size.to_le_bytes());
    }
    for motion in excluded.motions() {
        hash.update(motion.as_os_str().as_encoded_bytes());
        hash.update([0]);
    }
    let mut text = String::new();
    for byte in hash.finalize() {
        // Writing to a string cannot fail.
        let _ = write!(text, "{byte:02x}");
    }
    text
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn shards_are_read_and_refused() {
        let shard = "2/8".parse::<Shard>().unwrap();
        assert_eq!((shard.index, shard.count), (2, 8));
        for wrong in ["", "2", "0/8", "9/8", "1/0", "a/b", "1/2/3", "-1/2"] {
            let error = wrong.parse::<Shard>().unwrap_err();
            assert!(error.contains("such as 2/8"), "{wrong}");
        }
    }

    #[test]
    fn shards_share_out_every_file_once() {
        let all: Vec<PathBuf> = (0..11).map(|i| PathBuf::from(format!("{i:02}"))).collect();
        let parts = (1..=4).map(|index| {
            Job::new(
                all.clone(),
                Excluded::default(),
                Some(Shard { index, count: 4 }),
            )
        });
        let parts: Vec<_> = parts.collect();
        assert!(
            parts
                .iter()
                .all(|part| part.files.len().abs_diff(11 / 4) <= 1)
        );
        let mut together: Vec<_> = parts.iter().flat_map(|part| part.files.clone()).collect();
        together.sort();
        assert_eq!(together, all);
        let whole = Job::new(all, Excluded::default(), None).identity;
        assert!(
            parts
                .iter()
                .all(|part| part.identity.files_sha256 == whole.files_sha256)
        );
    }
}

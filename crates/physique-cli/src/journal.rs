//! What an unfinished run has done so far, beside its output.

use std::fs::{self, File, OpenOptions, TryLockError};
use std::io::{Read, Seek, SeekFrom, Write};
use std::path::{Path, PathBuf};

use anyhow::{Context, Result, bail};
use serde::Serialize;
use serde::de::DeserializeOwned;

/// JSON Lines in `OUTPUT.partial`: what the run is, then the rows of each file that is done. Read
/// again when a run is started anew, removed when its output stands.
pub(crate) struct Journal<Row> {
    path: PathBuf,
    file: File,
    done: Vec<Vec<Row>>,
}

impl<Row: Serialize + DeserializeOwned> Journal<Row> {
    /// Opens the journal of an output; `head` says what the run is.
    ///
    /// Fails when another run is writing it, or when it is of a run with other options or files.
    pub(crate) fn open(output: &Path, head: &impl Serialize) -> Result<Self> {
        let mut path = output.as_os_str().to_owned();
        path.push(".partial");
        let path = PathBuf::from(path);
        let head = serde_json::to_string(head)? + "\n";
        let mut file = OpenOptions::new()
            .read(true)
            .write(true)
            .create(true)
            .truncate(false)
            .open(&path)
            .with_context(|| path.display().to_string())?;
        match file.try_lock() {
            Ok(()) => {}
            Err(TryLockError::WouldBlock) => {
                bail!("{}: another run is writing it", path.display())
            }
            // Some file systems know no locks; then nothing keeps two runs apart.
            Err(TryLockError::Error(_)) => {}
        }
        let mut text = String::new();
        file.read_to_string(&mut text)
            .with_context(|| path.display().to_string())?;
        // A line that was cut off by the end of the run does not count.
        let whole = text.rfind('\n').map_or(0, |end| end + 1);
        let (mut done, mut end) = (Vec::new(), 0);
        for line in text[..whole].split_inclusive('\n') {
            if end == 0 {
                if line != head {
                    bail!(
                        "{} is of a run with other options or files: remove it, or choose another \
                         output",
                        path.display()
                    );
                }
            } else {
                match serde_json::from_str(line) {
                    Ok(rows) => done.push(rows),
                    Err(problem) => bail!("{}: {problem}; remove it", path.display()),
                }
            }
            end += line.len();
        }
        file.set_len(end as u64)?;
        file.seek(SeekFrom::End(0))?;
        if end == 0 {
            file.write_all(head.as_bytes())
                .with_context(|| path.display().to_string())?;
        }
        Ok(Self { path, file, done })
    }

    /// The rows of the files that are done, in order.
    pub(crate) fn take_done(&mut self) -> Vec<Vec<Row>> {
        std::mem::take(&mut self.done)
    }

    /// Adds the rows of more files.
    pub(crate) fn append(&mut self, files: &[Vec<Row>]) -> Result<()> {
        let mut text = String::new();
        for rows in files {
            text += &serde_json::to_string(rows)?;
            text.push('\n');
        }
        self.file
            .write_all(text.as_bytes())
            .with_context(|| self.path.display().to_string())
    }

    /// The output stands: nothing is left to continue.
    pub(crate) fn finish(self) -> Result<()> {
        fs::remove_file(&self.path).with_context(|| self.path.display().to_string())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_torn_line_is_done_again() {
        let folder = tempfile::tempdir().unwrap();
        let output = folder.path().join("scores.jsonl");
        let mut journal = Journal::<u32>::open(&output, &"this run").unwrap();
        journal.append(&[vec![1, 2], vec![3]]).unwrap();
        drop(journal);
        let partial = folder.path().join("scores.jsonl.partial");
        let mut torn = fs::read(&partial).unwrap();
        torn.extend(b"[4,");
        fs::write(&partial, &torn).unwrap();

        let mut journal = Journal::<u32>::open(&output, &"this run").unwrap();
        assert_eq!(journal.take_done(), [vec![1, 2], vec![3]]);
        journal.append(&[vec![4, 5]]).unwrap();
        assert_eq!(
            fs::read_to_string(&partial).unwrap(),
            "\"this run\"\n[1,2]\n[3]\n[4,5]\n"
        );
        journal.finish().unwrap();
        assert!(!partial.exists());
    }

    #[test]
    fn other_runs_are_not_continued() {
        let folder = tempfile::tempdir().unwrap();
        let output = folder.path().join("scores.csv");
        let journal = Journal::<u32>::open(&output, &"one run").unwrap();
        let error = |head: &str| match Journal::<u32>::open(&output, &head) {
            Ok(_) => panic!("it is refused"),
            Err(error) => error.to_string(),
        };
        assert!(error("one run").contains("another run is writing"));
        drop(journal);
        assert!(error("another run").contains("other options"));
    }
}

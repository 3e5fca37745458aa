//! Labels that a table beside the files knows.

use std::collections::{BTreeMap, HashMap};
use std::path::Path;

use physique_files::read_file;
use serde::Deserialize;

use super::{Labels, pattern::Pattern};
use crate::{DataLimits, Error};

/// A table of comma-separated values with a head line.
#[derive(Clone, Debug, PartialEq, Eq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Table {
    /// Pattern of the file below the folder, as of clips; the first one that matches is read.
    pub file: String,
    /// Columns that tell a clip, by the label they equal. Numbers compare as numbers: 007 is 7.
    pub key: BTreeMap<String, String>,
    /// Columns that become labels, by the label.
    pub take: BTreeMap<String, String>,
}

/// A table in memory.
#[derive(Clone, Debug, Default)]
pub(crate) struct LoadedTable {
    keys: Vec<String>,
    rows: HashMap<Vec<String>, Labels>,
}

impl Table {
    /// Reads the table; `files` are all names below the folder, sorted.
    pub(crate) fn load(
        &self,
        folder: &Path,
        files: &[String],
        limits: &DataLimits,
    ) -> Result<LoadedTable, Error> {
        let path = folder.join(self.name_among(files).ok_or_else(|| Error::Folder {
            folder: folder.into(),
            expected: format!("a table {:?}", self.file),
            found: "none".into(),
        })?);
        let bytes = read_file(&path, limits.text_bytes)?;
        let broken = |problem: csv::Error| Error::Table {
            path: path.clone(),
            place: problem.position().map_or_else(
                || "the table".to_owned(),
                |at| format!("line {}", at.line()),
            ),
            expected: "comma-separated values",
            found: problem.to_string(),
        };
        let mut reader = csv::ReaderBuilder::new()
            .flexible(true)
            .from_reader(bytes.as_slice());
        let head = reader.headers().map_err(broken)?.clone();
        let column = |name: &String| {
            let found = head.iter().position(|column| column.trim() == name);
            found.ok_or_else(|| Error::Table {
                path: path.clone(),
                place: "the head line".into(),
                expected: "every column that the recipe names",
                found: format!("none called {name:?}"),
            })
        };
        let keys = self
            .key
            .values()
            .map(column)
            .collect::<Result<Vec<_>, _>>()?;
        let take = self
            .take
            .iter()
            .map(|(label, name)| Ok((label, column(name)?)));
        let take = take.collect::<Result<Vec<_>, Error>>()?;
        let mut rows = HashMap::new();
        for record in reader.records() {
            let record = record.map_err(broken)?;
            let cell = |index: usize| record.get(index).unwrap_or_default().trim();
            let key = keys.iter().map(|&index| plain(cell(index))).collect();
            let labels = take
                .iter()
                .filter(|(_, index)| !cell(*index).is_empty())
                .map(|&(label, index)| (label.clone(), cell(index).to_owned()));
            rows.insert(key, labels.collect());
        }
        Ok(LoadedTable {
            keys: self.key.keys().cloned().collect(),
            rows,
        })
    }
}

impl Table {
    fn name_among<'a>(&self, files: &'a [String]) -> Option<&'a String> {
        let pattern = Pattern::parse(&self.file).ok()?;
        files.iter().find(|name| pattern.labels(name).is_some())
    }
}

impl LoadedTable {
    /// Adds what the table knows of a clip; labels from its name stay.
    pub(crate) fn add_to(&self, labels: &mut Labels) {
        let key = self
            .keys
            .iter()
            .map(|label| labels.get(label).map(|value| plain(value)));
        let Some(row) = key
            .collect::<Option<Vec<_>>>()
            .and_then(|key| self.rows.get(&key))
        else {
            return;
        };
        for (label, value) in row {
            labels.entry(label.clone()).or_insert_with(|| value.clone());
        }
    }
}

/// A number without zeros before it; other text as it is.
pub(crate) fn plain(text: &str) -> String {
    let number = text.parse::<u64>();
    number.map_or_else(|_| text.to_owned(), |number| number.to_string())
}

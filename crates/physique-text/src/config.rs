//! `config.json` of a folder.

use std::path::{Path, PathBuf};

use physique_files::read_file;
use serde_json::Value;

use crate::{Error, TextLimits};

/// What a folder says of its model.
#[derive(Clone, Debug)]
pub(crate) struct Config {
    path: PathBuf,
    value: Value,
}

impl Config {
    pub(crate) fn read(folder: &Path, limits: &TextLimits) -> Result<Self, Error> {
        let path = folder.join("config.json");
        let bytes = read_file(&path, limits.text_bytes)?;
        let value = serde_json::from_slice(&bytes).map_err(|problem| Error::Format {
            path: path.clone(),
            place: format!("line {}", problem.line()),
            expected: "JSON".into(),
            found: problem.to_string(),
        })?;
        Ok(Self { path, value })
    }

    /// The kind of model; empty where the file does not say.
    pub(crate) fn kind(&self) -> &str {
        self.value["model_type"].as_str().unwrap_or_default()
    }

    /// The part of a model of two towers that is about text; the whole otherwise.
    pub(crate) fn text_part(mut self) -> Self {
        if let Some(part) = self.value.get_mut("text_config") {
            self.value = part.take();
        }
        self
    }

    /// A count, or what it is where the file is silent.
    pub(crate) fn count(&self, key: &str, otherwise: usize) -> Result<usize, Error> {
        match &self.value[key] {
            Value::Null => Ok(otherwise),
            value => {
                let count = value.as_u64().filter(|&count| count > 0 && count < 1 << 24);
                let count =
                    count.ok_or_else(|| self.wrong(key, "a count above 0", &value.to_string()))?;
                Ok(count as usize)
            }
        }
    }

    /// An error of one of the file's keys.
    pub(crate) fn wrong(&self, key: &str, expected: &str, found: &str) -> Error {
        Error::Format {
            path: self.path.clone(),
            place: key.to_owned(),
            expected: expected.to_owned(),
            found: format!("{found:?}"),
        }
    }
}

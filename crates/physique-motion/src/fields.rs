//! The arrays and texts of a file by name, for readers that know what they want.

use std::path::Path;

use physique_files::Data;

use crate::npz::{Archive, Array, ArrayError};
use crate::{Error, ReadOptions};

/// A dictionary of a file: an archive, read array by array when asked, or a tree already read.
pub(crate) struct Fields<'a> {
    pub(crate) path: &'a Path,
    pub(crate) options: &'a ReadOptions,
    /// Where in the file the dictionary is, such as `people.0`; empty for all of it.
    place: String,
    source: Source<'a>,
}

enum Source<'a> {
    Archive(&'a mut Archive),
    Tree(&'a Data),
}

/// Finite numbers in rows, one a frame.
pub(crate) struct Matrix {
    /// `[rows][columns]`.
    pub(crate) values: Vec<f64>,
    pub(crate) columns: usize,
}

impl Matrix {
    pub(crate) fn rows(&self) -> usize {
        self.values.len() / self.columns
    }
}

impl<'a> Fields<'a> {
    pub(crate) const fn of_archive(
        archive: &'a mut Archive,
        path: &'a Path,
        options: &'a ReadOptions,
    ) -> Self {
        Self {
            path,
            options,
            place: String::new(),
            source: Source::Archive(archive),
        }
    }

    pub(crate) fn of_tree(
        data: &'a Data,
        place: &str,
        path: &'a Path,
        options: &'a ReadOptions,
    ) -> Self {
        Self {
            path,
            options,
            place: place.to_owned(),
            source: Source::Tree(data),
        }
    }

    pub(crate) fn contains(&self, key: &str) -> bool {
        match &self.source {
            Source::Archive(archive) => archive.contains(key),
            Source::Tree(data) => data.get(key).is_some(),
        }
    }

    pub(crate) fn contains_all(&self, keys: &[&str]) -> bool {
        keys.iter().all(|key| self.contains(key))
    }

    pub(crate) fn keys(&self) -> Vec<String> {
        match &self.source {
            Source::Archive(archive) => archive.keys().to_vec(),
            Source::Tree(data) => data.entries().iter().map(|(key, _)| key.clone()).collect(),
        }
    }

    /// A dictionary within a tree.
    pub(crate) fn child(&self, key: &str) -> Option<Fields<'a>> {
        let Source::Tree(data) = self.source else {
            return None;
        };
        let child = data.get(key)?;
        matches!(child, Data::Dict(_)).then(|| {
            let place = self.name(key);
            Fields::of_tree(child, &place, self.path, self.options)
        })
    }

    /// An array, or one number as an array without dimensions.
    ///
    /// # Errors
    /// [`Error::Array`] where it is missing or broken; [`Error::Format`] for other values.
    pub(crate) fn array(&mut self, key: &str) -> Result<Array, Error> {
        let path = self.path;
        let broken = |problem| Error::Array {
            path: path.into(),
            problem,
        };
        match &mut self.source {
            Source::Archive(archive) => archive.array(key).map_err(broken),
            Source::Tree(data) => match data.get(key) {
                Some(Data::Array(array)) => Ok(array.clone()),
                Some(other) => {
                    let found = other.kind();
                    Err(self.format(key, "an array", &found))
                }
                None => Err(broken(ArrayError::Missing {
                    key: self.name(key),
                    keys: self.keys(),
                })),
            },
        }
    }

    /// One number.
    ///
    /// # Errors
    /// As [`Fields::array`], and for more than one number.
    pub(crate) fn number(&mut self, key: &str) -> Result<f64, Error> {
        if let Source::Tree(data) = self.source
            && let Some(number) = data.get(key).and_then(Data::number)
        {
            return Ok(number);
        }
        let array = self.array(key)?;
        array.number().map_err(|source| self.broken(source))
    }

    /// Numbers of any shape, and the shape.
    ///
    /// # Errors
    /// As [`Fields::array`].
    pub(crate) fn numbers(&mut self, key: &str) -> Result<(Vec<f32>, Vec<usize>), Error> {
        let array = self.array(key)?;
        let values = array.to_f32().map_err(|source| self.broken(source))?;
        Ok((values, array.shape().to_vec()))
    }

    /// One text.
    ///
    /// # Errors
    /// As [`Fields::array`], and for anything but text.
    pub(crate) fn text(&mut self, key: &str) -> Result<String, Error> {
        if let Source::Tree(data) = self.source
            && let Some(text) = data.get(key).and_then(Data::text)
        {
            return Ok(text);
        }
        let array = self.array(key)?;
        array.text().map_err(|source| self.broken(source))
    }

    /// A text that files may lack, or that they may hold in a way that is not read: then the
    /// second value is a note that says so.
    ///
    /// # Errors
    /// As [`Fields::array`] for broken archives.
    pub(crate) fn optional_text(
        &mut self,
        key: &str,
    ) -> Result<(Option<String>, Option<String>), Error> {
        if !self.contains(key) {
            return Ok((None, None));
        }
        match self.text(key) {
            Ok(text) => {
                // Python 2 left the mark of its byte strings in some files: b'female'.
                let inner = text
                    .strip_prefix("b'")
                    .and_then(|rest| rest.strip_suffix('\''));
                Ok((Some(inner.unwrap_or(&text).to_owned()), None))
            }
            Err(Error::Array {
                problem: source @ (ArrayError::ElementType { .. } | ArrayError::Content { .. }),
                ..
            }) => Ok((None, Some(format!("`{key}` was left out. {source}")))),
            Err(Error::Format { found, .. }) => {
                let note = format!("`{key}` was left out: expected text, found {found}.");
                Ok((None, Some(note)))
            }
            Err(error) => Err(error),
        }
    }

    /// `[frames][columns]` finite numbers; further dimensions are flattened into the second.
    ///
    /// # Errors
    /// [`Error::Format`] for other shapes, for no frames, and with frame and column for numbers
    /// that are not finite; [`Error::Limit`] for too many frames.
    pub(crate) fn matrix(&mut self, key: &str, columns_known: &[usize]) -> Result<Matrix, Error> {
        let array = self.array(key)?;
        let shape = array.shape();
        let columns: usize = match shape {
            [] | [_] => 0,
            // The array is in memory, so the product of its shape cannot overflow.
            [_, inner @ ..] => inner.iter().product(),
        };
        if !columns_known.contains(&columns) {
            let expected = format!("[frames][{columns_known:?}]");
            return Err(self.format(key, &expected, &format!("{shape:?}")));
        }
        if shape[0] == 0 {
            return Err(self.format(key, "at least one frame", "none"));
        }
        self.check_frames(shape[0])?;
        let values = array.to_f64().map_err(|source| self.broken(source))?;
        if let Some(bad) = values.iter().position(|value| !value.is_finite()) {
            let name = self.name(key);
            let place = format!(
                "`{name}`, frame {}, column {}",
                bad / columns,
                bad % columns
            );
            return Err(Error::Format {
                path: self.path.into(),
                place,
                expected: "a finite number".into(),
                found: values[bad].to_string(),
            });
        }
        Ok(Matrix { values, columns })
    }

    pub(crate) fn check_frames(&self, frames: usize) -> Result<(), Error> {
        self.options.limits.check_frames(self.path, frames)
    }

    /// The error that a value is not what its format demands.
    pub(crate) fn format(&self, key: &str, expected: &str, found: &str) -> Error {
        self.format_at(&format!("`{}`", self.name(key)), expected, found)
    }

    /// The error that the content of a place is not what its format demands.
    pub(crate) fn format_at(&self, place: &str, expected: &str, found: &str) -> Error {
        Error::Format {
            path: self.path.into(),
            place: place.into(),
            expected: expected.into(),
            found: found.into(),
        }
    }

    /// The error that a part of the file is none.
    pub(crate) fn inside(&self, place: &str, problem: Error) -> Error {
        Error::Inside {
            path: self.path.into(),
            place: place.into(),
            problem: Box::new(problem),
        }
    }

    /// A key with the place of its dictionary.
    fn name(&self, key: &str) -> String {
        match self.place.as_str() {
            "" => key.to_owned(),
            place => format!("{place}.{key}"),
        }
    }

    fn broken(&self, problem: ArrayError) -> Error {
        Error::Array {
            path: self.path.into(),
            problem,
        }
    }
}

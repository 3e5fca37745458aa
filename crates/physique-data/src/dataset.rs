//! A data file that is open.

use std::path::{Path, PathBuf};

use glam::Vec3;
use physique::motion::FrameRate;
use physique::motion::features::{
    FeatureSkeleton, FeatureStatistics, JointPositions, MotionFeatures, extract_window,
};
use rayon::prelude::*;

use crate::file::{self, Rows};
use crate::{Batch, Clip, DataLimits, Error, Index, Split, Storage, Window};

/// A data set on disk. Opening it reads the index; rows are mapped into memory and come when they
/// are looked at.
#[derive(Debug)]
pub struct Dataset {
    path: PathBuf,
    index: Index,
    rows: Rows,
    statistics: FeatureStatistics,
    frame_rate: FrameRate,
}

impl Dataset {
    /// Opens a file. It must not be written to while it is open; [`crate::build()`] never does: it
    /// puts a new file in the place of an old one.
    ///
    /// # Errors
    /// [`Error::Io`]; [`Error::Format`] with the place for a file that is none, broken or shortened;
    /// [`Error::Limit`].
    pub fn open(path: impl AsRef<Path>, limits: &DataLimits) -> Result<Self, Error> {
        let path = path.as_ref();
        Self::new(path, file::open(path, limits)?)
    }

    /// Takes the bytes of a file; `path` only names it in errors. The rows are copied.
    ///
    /// # Errors
    /// As [`Self::open`], without [`Error::Io`].
    pub fn from_bytes(
        bytes: &[u8],
        path: impl AsRef<Path>,
        limits: &DataLimits,
    ) -> Result<Self, Error> {
        let path = path.as_ref();
        Self::new(path, file::from_bytes(bytes, path, limits)?)
    }

    fn new(path: &Path, (index, rows): (Index, Rows)) -> Result<Self, Error> {
        let statistics = FeatureStatistics::new(
            index.skeleton.into(),
            index.mean.clone(),
            index.deviation.clone(),
        )?;
        Ok(Self {
            path: path.into(),
            frame_rate: FrameRate::new(index.frame_rate)?,
            index,
            rows,
            statistics,
        })
    }

    /// Reads every row once and holds them against the checksum of the file.
    ///
    /// # Errors
    /// [`Error::Format`] for a file that was damaged.
    pub fn verify(&self) -> Result<(), Error> {
        self.rows
            .verify()
            .map_err(|(expected, found)| Error::Format {
                path: self.path.clone(),
                place: "rows".into(),
                expected: format!("checksum {expected:016x}"),
                found: format!("{found:016x}"),
            })
    }

    /// What the file knows of its clips.
    pub const fn index(&self) -> &Index {
        &self.index
    }

    /// Mean and deviation of the features.
    pub const fn statistics(&self) -> &FeatureStatistics {
        &self.statistics
    }

    /// Frames a second.
    pub const fn frame_rate(&self) -> FrameRate {
        self.frame_rate
    }

    /// Whose features these are.
    pub fn skeleton(&self) -> FeatureSkeleton {
        self.index.skeleton.into()
    }

    /// Numbers of the clips of a split.
    pub fn clips_of(&self, split: Split) -> impl Iterator<Item = usize> + '_ {
        let clips = self.index.clips.iter().enumerate();
        clips
            .filter(move |(_, clip)| clip.split == split)
            .map(|(number, _)| number)
    }

    /// The rows of a recording as they lie in the file, nothing copied: positions `[rows][22][3]` or
    /// features `[rows][263]`; see [`Index::storage`].
    ///
    /// # Errors
    /// [`Error::Window`] when there is no such recording.
    pub fn recording_rows(&self, recording: usize) -> Result<&[f32], Error> {
        let of = self.index.recordings.get(recording).ok_or(Error::Window {
            clip: recording,
            clips: self.index.recordings.len(),
            frames: 0,
            start: 0,
            length: 0,
        })?;
        Ok(self.rows.range(of.first_row as usize, of.rows))
    }

    /// All rows of a clip as a window.
    ///
    /// # Errors
    /// [`Error::Window`] when there is no such clip.
    pub fn whole(&self, clip: usize) -> Result<Window, Error> {
        let of = self.index.clips.get(clip);
        let frames = of.map(|clip| clip.frames);
        let frames = frames.ok_or_else(|| {
            self.no_window(Window {
                clip,
                start: 0,
                frames: 0,
            })
        })?;
        Ok(Window {
            clip,
            start: 0,
            frames,
        })
    }

    /// Features of a window, not normalised: `[frames][263]` or `[frames][251]`.
    ///
    /// Of stored positions they are those of the window as a motion of its own, which begins at the
    /// origin facing +Z. Cost: some 2 microseconds a row then, a copy otherwise.
    ///
    /// # Errors
    /// [`Error::Window`] for rows that the clip does not have; [`Error::Motion`] for rows that were
    /// damaged since the file was built.
    pub fn features(&self, window: Window) -> Result<MotionFeatures, Error> {
        let clip = self.clip_with(window)?;
        let recording = &self.index.recordings[clip.recording];
        let first = recording.first_row as usize + clip.start + window.start;
        match self.index.storage {
            Storage::Positions => {
                // Steps need a next frame.
                let numbers = self.rows.range(first, window.frames + 1).as_chunks::<3>().0;
                let positions = numbers.iter().copied().map(Vec3::from_array).collect();
                let positions = JointPositions::new(self.frame_rate, self.skeleton(), positions)?;
                let positions = if clip.mirrored {
                    positions.mirrored()
                } else {
                    positions
                };
                Ok(extract_window(&positions)?)
            }
            Storage::Features => {
                let rows = self.rows.range(first, window.frames).to_vec();
                let features = MotionFeatures::new(self.frame_rate, self.skeleton(), rows)?;
                Ok(if clip.mirrored {
                    features.mirrored()
                } else {
                    features
                })
            }
        }
    }

    /// Normalised features of windows, padded with zeros to the longest, or to `frames` rows if that
    /// is more. Windows are worked on by all threads; the result does not depend on their number.
    ///
    /// # Errors
    /// As [`Self::features`].
    pub fn batch(&self, windows: &[Window], frames: usize) -> Result<Batch, Error> {
        let lengths: Vec<usize> = windows.iter().map(|window| window.frames).collect();
        let frames = lengths.iter().copied().fold(frames, usize::max);
        let columns = self.skeleton().feature_count();
        let made = windows.par_iter().map(|&window| {
            let mut rows = self.features(window)?.values().to_vec();
            self.statistics.normalise(&mut rows);
            // Padding is the mean pose: zeros after normalising.
            rows.resize(frames * columns, 0.0);
            Ok(rows)
        });
        let made = made.collect::<Vec<Result<Vec<f32>, Error>>>();
        let made = made.into_iter().collect::<Result<Vec<_>, _>>()?;
        Ok(Batch {
            values: made.concat(),
            lengths,
            frames,
            columns,
        })
    }

    fn clip_with(&self, window: Window) -> Result<&Clip, Error> {
        let clip = self.index.clips.get(window.clip);
        let end = window.start.checked_add(window.frames);
        clip.filter(|clip| window.frames > 0 && end.is_some_and(|end| end <= clip.frames))
            .ok_or_else(|| self.no_window(window))
    }

    fn no_window(&self, window: Window) -> Error {
        Error::Window {
            clip: window.clip,
            clips: self.index.clips.len(),
            frames: self
                .index
                .clips
                .get(window.clip)
                .map_or(0, |clip| clip.frames),
            start: window.start,
            length: window.frames,
        }
    }
}

//! Samples in blocks of what one step shows, and their files.

use std::fs::File;
use std::io::{Read as _, Seek as _, SeekFrom};
use std::path::{Path, PathBuf};

use glam::Vec3;
use physique_files::{FileError, write_file};

use super::samples::BodySamples;
use super::sphere_losses::SamplePoints;
use crate::Error;
use crate::random::Random;

/// A unit of a stored coordinate: samples reach 1.6 radii from the middle.
const PLACE_STEP: f32 = 1.6 / i16::MAX as f32;
/// A unit of a stored distance, at most 2 radii: rounding moves it by 3e-5 at most.
const DISTANCE_STEP: f32 = 2.0 / i16::MAX as f32;

/// The nearest place that can be stored. Distances are measured there, so that storing moves none.
pub(crate) fn quantised(place: Vec3) -> Vec3 {
    Vec3::from_array(
        place
            .to_array()
            .map(|x| f32::from(stored(x, PLACE_STEP)) * PLACE_STEP),
    )
}

fn stored(value: f32, step: f32) -> i16 {
    // To the nearest, halves away from 0; the conversion cuts off, and saturates.
    (value / step + 0.5_f32.copysign(value)) as i16
}

/// Points of one kind, cut into blocks of equal length.
pub(crate) struct Blocks {
    pub(crate) share: usize,
    pub(crate) blocks: Vec<Block>,
}

/// Points of a block of each kind together, at most what a step of the paper shows of one body.
pub(crate) const BLOCK_POINTS: usize = 16_384;

/// Points of one block: x, y, z and distance, structure of arrays.
#[derive(Clone)]
pub(crate) struct Block {
    arrays: [Vec<i16>; 4],
}

impl Block {
    pub(crate) fn with_capacity(points: usize) -> Self {
        Self {
            arrays: std::array::from_fn(|_| Vec::with_capacity(points)),
        }
    }

    pub(crate) fn push(&mut self, place: Vec3, distance: f32) {
        let [x, y, z] = place.to_array().map(|x| stored(x, PLACE_STEP));
        let values = [x, y, z, stored(distance, DISTANCE_STEP)];
        for (array, value) in self.arrays.iter_mut().zip(values) {
            array.push(value);
        }
    }
}

const MAGIC: [u8; 8] = *b"PHYSDF01";
/// Magic, then share and number of blocks of the four kinds.
const HEADER: usize = 8 + 4 * 8;
/// Bytes of a stored point.
const POINT: usize = 8;

/// A body's samples on disk; steps read the blocks that they show.
#[derive(Clone, Debug)]
pub(crate) struct SampleFile {
    path: PathBuf,
    /// Share and number of blocks of each kind.
    kinds: [(usize, usize); 4],
}

impl SampleFile {
    /// Writes the samples, whole or not at all.
    pub(crate) fn write(path: &Path, samples: &BodySamples) -> Result<Self, Error> {
        let kinds = samples
            .kinds
            .each_ref()
            .map(|kind| (kind.share, kind.blocks.len()));
        let mut bytes = MAGIC.to_vec();
        for (share, count) in kinds {
            bytes.extend((share as u32).to_le_bytes());
            bytes.extend((count as u32).to_le_bytes());
        }
        let blocks = samples.kinds.iter().flat_map(|kind| &kind.blocks);
        for value in blocks.flat_map(|block| block.arrays.as_flattened_values()) {
            bytes.extend(value.to_le_bytes());
        }
        write_file(path, &bytes)?;
        let path = path.into();
        Ok(Self { path, kinds })
    }

    /// Opens samples that an earlier run wrote; none if the file is not there, or not whole.
    pub(crate) fn open(path: &Path) -> Option<Self> {
        let mut file = File::open(path).ok()?;
        let mut header = [0; HEADER];
        file.read_exact(&mut header).ok()?;
        let (magic, numbers) = header.split_first_chunk::<8>()?;
        let mut kinds = [(0, 0); 4];
        for (kind, bytes) in kinds.iter_mut().zip(numbers.as_chunks::<8>().0) {
            let [a, b, c, d, rest @ ..] = *bytes;
            let number = |bytes| u32::from_le_bytes(bytes) as usize;
            *kind = (number([a, b, c, d]), number(rest));
        }
        let points: usize = kinds.iter().map(|(share, count)| share * count).sum();
        let whole = file.metadata().ok()?.len() == (HEADER + POINT * points) as u64;
        (*magic == MAGIC && whole).then(|| Self {
            path: path.into(),
            kinds,
        })
    }

    /// Reads every `thinning`-th point of a random block of each kind into `points`; `bytes` is
    /// scratch space.
    pub(crate) fn read(
        &self,
        thinning: usize,
        random: &mut Random,
        points: &mut SamplePoints,
        bytes: &mut Vec<u8>,
    ) -> Result<(), Error> {
        let io = |problem| FileError::Io {
            path: self.path.clone(),
            problem,
        };
        points.clear();
        let mut file = File::open(&self.path).map_err(io)?;
        let mut start = HEADER;
        for (share, count) in self.kinds {
            if count > 0 {
                let block = random.below(count);
                let place = start + block * share * POINT;
                bytes.resize(share * POINT, 0);
                file.seek(SeekFrom::Start(place as u64)).map_err(io)?;
                file.read_exact(bytes).map_err(io)?;
                append(points, bytes, random.below(thinning), thinning);
            }
            start += share * count * POINT;
        }
        Ok(())
    }
}

/// Unpacks every `thinning`-th point of one block from number `first` on.
fn append(points: &mut SamplePoints, bytes: &[u8], first: usize, thinning: usize) {
    let arrays = [
        (&mut points.x, PLACE_STEP),
        (&mut points.y, PLACE_STEP),
        (&mut points.z, PLACE_STEP),
        (&mut points.distance, DISTANCE_STEP),
    ];
    let share = bytes.len() / POINT;
    for ((values, step), bytes) in arrays
        .into_iter()
        .zip(bytes.chunks_exact((2 * share).max(1)))
    {
        let stored = bytes.as_chunks::<2>().0.iter();
        let stored = stored.skip(first).step_by(thinning);
        values.extend(stored.map(|&value| f32::from(i16::from_le_bytes(value)) * step));
    }
    points.stretches.push(points.x.len());
}

trait Flattened {
    fn as_flattened_values(&self) -> impl Iterator<Item = i16> + '_;
}

impl Flattened for [Vec<i16>; 4] {
    fn as_flattened_values(&self) -> impl Iterator<Item = i16> + '_ {
        self.iter().flatten().copied()
    }
}

//! The self-intersection loss on graphics processors: as four kernels, without the processor waiting.
//!
//! ```text
//! features ──pose──▶ joints, swings, transforms        a frame a unit
//!   ──intersect──▶ spheres ──▶ pairs ──▶ loss          a frame a cube
//!     ──▶ pushes ──▶ derivatives by transforms
//!   ──pose_back──▶ by swings, joints, features         a frame a unit
//!   ──gather──▶ losses of motions, by the root's turn  a motion a unit
//! ```
//!
//! The equations are those of [`FeatureLoss`], which the tests compare with; sums are in 32 bits, and in
//! one order. Frames behind the ends of motions cost nothing.

mod memory;
mod motions;
mod poses;
mod poses_back;
mod skeleton;
mod spheres;
mod swing;
mod tables;
mod vectors;

use std::fmt;

use burn::tensor::{DType, Shape};
use burn_cubecl::kernel::into_contiguous;
use burn_cubecl::ops::numeric::zeros;
use burn_cubecl::tensor::CubeTensor;
use cubecl::client::Client;
use cubecl::prelude::{BufferArg, CubeCount, CubeDim};
use cubecl::server::Handle;
use physique_motion::features::FeatureStatistics;
use physique_proxy::FeatureLoss;

use tables::Tables;

/// Units of a cube, where each has a frame or a motion of its own.
const UNITS: usize = 64;

/// Most frames that are worked on at once, in 90 MB: fewer than the least that WebGPU lets a kernel
/// have of cubes, and of memory in one piece.
const MOST_FRAMES: usize = 1 << 14;

/// Most bytes that units share: the least that WebGPU grants.
const MOST_SHARED_BYTES: usize = 1 << 14;

/// The self-intersection loss as kernels.
pub struct GpuSelfIntersection {
    tables: Tables,
}

/// Motions that are worked on at once.
struct Chunk {
    /// The first motion of the batch that it has.
    first: usize,
    frames: usize,
    /// By frame, its row and the length of its motion.
    rows: Vec<u32>,
    /// By motion, its first frame, how many it has, and the row of the first.
    motions: Vec<u32>,
}

impl GpuSelfIntersection {
    /// Lays a loss out for kernels.
    pub(super) fn new(loss: &FeatureLoss, statistics: &FeatureStatistics) -> Self {
        let tables = Tables::new(loss, statistics);
        Self { tables }
    }

    /// Whether the kernels can evaluate it: up to 512 spheres, in motions of up to 16,384 frames each.
    pub(super) fn fits(&self, motions: &CubeTensor, lengths: &[usize]) -> bool {
        let shape = motions.meta.shape();
        let (batch, frames, columns) = (shape[0], shape[1], shape[2]);
        let most = frames.min(MOST_FRAMES);
        motions.dtype == DType::F32
            && u32::try_from(batch * frames).is_ok()
            && batch == lengths.len()
            && columns == self.columns()
            && lengths.iter().all(|length| (1..=most).contains(length))
            && self.tables.counts.spheres > 0
            && self.tables.counts.shared_bytes() <= MOST_SHARED_BYTES
    }

    fn columns(&self) -> usize {
        self.tables.statistics.len() / 2
    }

    /// The loss of each motion, and the gradient of their sum; they must fit.
    pub(super) fn evaluate(
        &self,
        motions: CubeTensor,
        lengths: &[usize],
    ) -> (CubeTensor, CubeTensor) {
        let features = into_contiguous(motions);
        let shape = features.meta.shape().clone();
        let (client, device) = (features.client.clone(), features.device.clone());
        let zeros = |shape: Shape| zeros(device.clone(), shape, DType::F32);
        let (losses, gradient) = (zeros(Shape::new([lengths.len()])), zeros(shape.clone()));
        for chunk in chunks(lengths, shape[1]) {
            self.launch(&client, &features, &gradient, &losses, &chunk);
        }
        (losses, gradient)
    }

    fn launch(
        &self,
        client: &Client,
        features: &CubeTensor,
        gradient: &CubeTensor,
        losses: &CubeTensor,
        chunk: &Chunk,
    ) {
        let (tables, columns, frames) = (&self.tables, self.columns(), chunk.frames);
        let floats = |numbers: &[f32]| Uploaded::new(client, numbers);
        let words = |numbers: &[u32]| Uploaded::new(client, numbers);
        let statistics = floats(&tables.statistics);
        let skeleton = floats(&tables.skeleton);
        let hierarchy = words(&tables.hierarchy);
        let rows = words(&chunk.rows);
        let work = Uploaded {
            handle: client.empty(4 * frames * memory::ENTRIES),
            length: frames * memory::ENTRIES,
        };
        let units = |count: usize| CubeCount::Static(count.div_ceil(UNITS) as u32, 1, 1);
        let cube = CubeDim::new_1d(UNITS as u32);
        poses::pose::launch(
            client,
            units(frames),
            cube,
            features.clone().into_buffer_arg(),
            statistics.argument(),
            rows.argument(),
            skeleton.argument(),
            hierarchy.argument(),
            work.argument(),
            frames,
            columns,
            tables.handed,
        );
        spheres::intersect::launch(
            client,
            CubeCount::Static(frames as u32, 1, 1),
            CubeDim::new_1d(spheres::UNITS as u32),
            floats(&tables.numbers).argument(),
            words(&tables.indices).argument(),
            work.argument(),
            frames,
            tables.counts,
        );
        poses_back::pose_back::launch(
            client,
            units(frames),
            cube,
            statistics.argument(),
            rows.argument(),
            skeleton.argument(),
            hierarchy.argument(),
            work.argument(),
            gradient.clone().into_buffer_arg(),
            frames,
            columns,
            tables.handed,
            tables.full,
        );
        let count = chunk.motions.len() / 3;
        motions::gather::launch(
            client,
            units(count),
            cube,
            statistics.argument(),
            words(&chunk.motions).argument(),
            work.argument(),
            gradient.clone().into_buffer_arg(),
            losses.clone().into_buffer_arg(),
            count,
            frames,
            columns,
            chunk.first,
            tables.full,
        );
    }
}

impl fmt::Debug for GpuSelfIntersection {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        formatter
            .debug_struct("GpuSelfIntersection")
            .field("counts", &self.tables.counts)
            .finish_non_exhaustive()
    }
}

/// Whole motions, padded to `frames`, as many at once as [`MOST_FRAMES`] allow.
fn chunks(lengths: &[usize], frames: usize) -> Vec<Chunk> {
    let mut chunks: Vec<Chunk> = Vec::new();
    for (motion, &length) in lengths.iter().enumerate() {
        let fits = |chunk: &Chunk| chunk.frames + length <= MOST_FRAMES;
        if !chunks.last().is_some_and(fits) {
            chunks.push(Chunk {
                first: motion,
                frames: 0,
                rows: Vec::new(),
                motions: Vec::new(),
            });
        }
        let Some(chunk) = chunks.last_mut() else {
            break;
        };
        let row = motion * frames;
        chunk
            .motions
            .extend([chunk.frames, length, row].map(|number| number as u32));
        let rows = (row..row + length).flat_map(|row| [row as u32, length as u32]);
        chunk.rows.extend(rows);
        chunk.frames += length;
    }
    chunks
}

/// Numbers in the device's memory.
struct Uploaded {
    handle: Handle,
    length: usize,
}

impl Uploaded {
    fn new<T: bytemuck::NoUninit>(client: &Client, numbers: &[T]) -> Self {
        Self {
            handle: client.create_from_slice(bytemuck::cast_slice(numbers)),
            length: numbers.len(),
        }
    }

    fn argument(&self) -> BufferArg {
        // SAFETY: the memory was made for as many numbers of 32 bits.
        unsafe { BufferArg::from_raw_parts(self.handle.clone(), self.length) }
    }
}

#[cfg(test)]
mod tests {
    use super::{MOST_FRAMES, chunks};

    #[test]
    fn chunks_hold_whole_motions() {
        let lengths = [MOST_FRAMES - 1, 1, 1, MOST_FRAMES];
        let chunks = chunks(&lengths, MOST_FRAMES);
        let frames: Vec<_> = chunks.iter().map(|chunk| chunk.frames).collect();
        let firsts: Vec<_> = chunks.iter().map(|chunk| chunk.first).collect();
        assert_eq!(frames, [MOST_FRAMES, 1, MOST_FRAMES]);
        assert_eq!(firsts, [0, 2, 3]);
        let size = MOST_FRAMES as u32;
        assert_eq!(chunks[0].motions, [0, size - 1, 0, size - 1, 1, size]);
        assert_eq!(chunks[0].rows[2 * (MOST_FRAMES - 1)..], [size, 1]);
        assert_eq!(chunks[1].rows, [2 * size, 1]);
    }
}

//! Closed triangle meshes and how much they pass through themselves.
//!
//! Floor 0 of Physique: it knows triangles, lines and volumes, nothing about humans, files or time.
//!
//! * [`Triangles`]: the faces of a mesh, checked once.
//! * [`ColumnScanner`]: volume that a closed surface covers once, twice or more often, exact along
//!   parallel lines, told apart by pair of labels (body parts, to the floors above).
//! * [`TrianglePairs`]: which triangles intersect, exactly.
//! * [`ConicField`]: what intersecting triangles cost, with derivatives.
//! * [`sia`]: the voxel protocol of the published self-intersection metric, and where it misleads.
//! * [`shapes`]: spheres, boxes and tori with known volumes.
//!
//! Positions are `&[Vec3]` in metres; volumes are `f64` in cubic metres. Surfaces are oriented
//! outwards: seen from outside, the corners of a triangle run counter-clockwise.

mod column_scan;
mod conic_field;
mod error;
pub mod exact;
mod measure;
pub mod reference;
pub mod shapes;
pub mod sia;
mod signed_distance;
mod triangle_pairs;
mod triangles;

pub use column_scan::{
    Axis, ColumnScanner, CoveredVolumes, LabelDistances, Overlap, PairOverlap, PairOverlaps, Scan,
    ScanOptions, Solid, TriangleLabels,
};
pub use conic_field::{ConicField, PairGradient};
pub use error::Error;
pub use measure::{signed_volume, vertex_normals};
pub use shapes::Mesh;
pub use signed_distance::{NearestSurface, SignedDistances, space_filling_order};
pub use triangle_pairs::{SharedVertices, TrianglePairs};
pub use triangles::Triangles;

use glam::Vec3;

/// Everything that this crate refuses, with the place, what it expected and what it found.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum Error {
    /// A triangle names a vertex that the mesh does not have.
    #[error(
        "triangle {triangle} names vertex {vertex}, but the mesh has only {vertex_count} vertices"
    )]
    VertexOutOfRange {
        /// Position of the triangle in the list.
        triangle: usize,
        /// The vertex it names.
        vertex: u32,
        /// Number of vertices of the mesh.
        vertex_count: usize,
    },

    /// A triangle names the same vertex at two corners.
    #[error("triangle {triangle} names vertex {vertex} twice; its three corners must differ")]
    RepeatedVertex {
        /// Position of the triangle in the list.
        triangle: usize,
        /// The vertex it names twice.
        vertex: u32,
    },

    /// The mesh has more triangles or vertices than 31-bit indices can name.
    #[error("the mesh has {found} {what}, expected at most {limit}")]
    MeshTooLarge {
        /// "triangles" or "vertices".
        what: &'static str,
        /// How many there are.
        found: usize,
        /// How many are allowed.
        limit: usize,
    },

    /// The surface has a boundary, or neighbouring triangles disagree about the outside.
    #[error(
        "the surface is not closed: the edge from vertex {from} to vertex {to} is used by {forward} \
         triangles in this direction and by {backward} in the other, expected the same number"
    )]
    OpenEdge {
        /// First vertex of the edge.
        from: u32,
        /// Second vertex of the edge.
        to: u32,
        /// Triangles that run along the edge in this direction.
        forward: usize,
        /// Triangles that run along the edge in the other direction.
        backward: usize,
    },

    /// The positions do not belong to this mesh.
    #[error("the mesh has {expected} vertices, but {found} positions were given")]
    PositionCount {
        /// Number of vertices of the mesh.
        expected: usize,
        /// Number of positions given.
        found: usize,
    },

    /// A position is NaN or infinite.
    #[error("the position of vertex {vertex} is {position}, expected finite numbers")]
    NotFinite {
        /// The vertex.
        vertex: usize,
        /// Its position.
        position: Vec3,
    },

    /// The spacing of the lines is not a usable length.
    #[error("the line spacing is {found} m, expected a number from {least} m to {most} m")]
    Spacing {
        /// The spacing that was asked for, in metres.
        found: f32,
        /// The least spacing allowed, in metres.
        least: f32,
        /// The greatest spacing allowed, in metres.
        most: f32,
    },

    /// The mesh is so large, for this spacing, that it would need too many lines.
    #[error(
        "the mesh is {extent} m wide, which at a line spacing of {spacing} m needs {lines} lines side \
         by side, expected at most {limit}"
    )]
    TooManyLines {
        /// Extent of the mesh across the lines (or along them, if that is the longer), in metres.
        extent: f64,
        /// Line spacing in metres.
        spacing: f32,
        /// Lines that it would take.
        lines: f64,
        /// Lines side by side that are allowed.
        limit: usize,
    },

    /// The mesh is so far from the origin, for this spacing, that single precision is too coarse.
    #[error(
        "the mesh reaches {distance} m away from the origin, expected at most {limit} m at a line \
         spacing of {spacing} m: move it closer"
    )]
    TooFarAway {
        /// Greatest distance from the origin along an axis, in metres.
        distance: f64,
        /// The distance allowed, in metres.
        limit: f64,
        /// Line spacing in metres.
        spacing: f32,
    },

    /// A position is so far from the origin that squares and cubes of it overflow.
    #[error("a vertex is {distance} m away from the origin, expected at most {limit} m")]
    TooFarForPairs {
        /// Distance from the origin along an axis, in metres.
        distance: f32,
        /// The distance allowed, in metres.
        limit: f32,
    },

    /// All positions coincide or are too far apart, so that no ball around them has a usable radius.
    #[error(
        "the positions extend {radius} m around their middle, expected a finite extent above zero"
    )]
    NoExtent {
        /// Greatest distance from the middle, in metres.
        radius: f32,
    },

    /// A position is nowhere near the unit ball.
    #[error(
        "a vertex is {distance} away from the centre of the unit ball, expected at most {limit}: was \
         the body moved into the ball, without its translation?"
    )]
    OutsideUnitBall {
        /// Distance from the centre along an axis, in radii.
        distance: f32,
        /// The distance allowed, in radii.
        limit: f32,
    },

    /// A surface winds around a point more often than can be counted.
    #[error("the surface covers a point more than 32767 times, expected fewer")]
    TooManyCoverings,

    /// The triangles together span more grid lines than allowed.
    #[error(
        "the triangles' boxes hold {found} line positions, expected at most {limit}: the spacing is \
         too fine for the size and number of the triangles"
    )]
    TooManyCrossings {
        /// Line positions in the triangles' boxes, summed over the triangles.
        found: u64,
        /// How many are allowed.
        limit: u64,
    },

    /// The labels do not belong to this mesh.
    #[error("{found} labels were given for {expected} triangles, expected one each")]
    LabelCount {
        /// Number of triangles.
        expected: usize,
        /// Number of labels given.
        found: usize,
    },

    /// A triangle's label is not in the table of distances.
    #[error(
        "triangle {triangle} has label {label}, but the distances know only {label_count} labels"
    )]
    LabelOutOfRange {
        /// Position of the triangle in the list.
        triangle: usize,
        /// Its label.
        label: u8,
        /// Number of labels of the table of distances.
        label_count: usize,
    },

    /// A table of label distances is not square, not symmetric, or not zero on its diagonal.
    #[error("the distance from label {row} to label {column} is {found}, expected {expected}")]
    LabelDistance {
        /// Row of the table.
        row: usize,
        /// Column of the table.
        column: usize,
        /// What the table says there.
        found: u8,
        /// What it should say.
        expected: u8,
    },

    /// A table of label distances has the wrong number of entries.
    #[error(
        "the table of label distances has {found} entries, expected the square of a number from 1 to 256"
    )]
    LabelTableSize {
        /// Number of entries given.
        found: usize,
    },

    /// A mesh without triangles, where a surface is needed.
    #[error("the mesh has no triangles, expected a closed surface")]
    NoTriangles,
}

//! Flat drawing with soft edges: rectangles, lines, filled curves and words.

mod shapes;
mod text;

pub(crate) use self::shapes::segment_coverage;
pub(crate) use self::text::fit;
pub use self::text::{Align, TextStyle, Weight, text_width};

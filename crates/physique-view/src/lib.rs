//! Pictures of posed bodies, without a GPU or a browser.
//!
//! Three things, each on top of the one before:
//!
//! * [`Scene::render`] draws triangle meshes, lines and a floor as a [`Camera`] sees them: a small
//!   software rasteriser with eight samples a pixel, smooth shading in linear light and soft
//!   ground shadows. Highlighted triangles (surface that passes through other surface) are red
//!   and shine through the body.
//! * [`ContactSheet`] shows moments of a motion side by side from several views, with times, a
//!   title and a chart; [`MotionStrip`] shows them in one picture along the path.
//! * [`Image::write_png`] writes the result.
//!
//! Input is plain data: positions `[V]` and triangles `[T]`, metres, right-handed, Y up, a body
//! faces +Z and its left is +X. Pictures are the same for any number of threads, and no input
//! panics: what cannot be drawn is a [`ViewError`].

mod axes;
mod bounds;
mod camera;
mod chart;
mod colour;
mod error;
mod image;
mod mesh;
mod motion_sheet;
mod paint;
mod render;
mod scene;
mod sheet;
mod strip;
mod write_png;

pub use self::bounds::Bounds;
pub use self::camera::{Camera, Projection, View};
pub use self::chart::Chart;
pub use self::colour::{Colour, palette};
pub use self::error::ViewError;
pub use self::image::{Image, MAX_PIXELS};
pub use self::mesh::{Colours, MAX_COORDINATE, Mesh, Shading};
pub use self::motion_sheet::{MotionSheet, side_colours};
pub use self::paint::{Align, TextStyle, Weight, text_width};
pub use self::render::Ground;
pub use self::scene::{Dot, Polyline, Scene};
pub use self::sheet::{ContactSheet, Frame, body_legend};
pub use self::strip::MotionStrip;

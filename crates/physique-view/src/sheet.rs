//! Contact sheets: moments of a motion, from several views.

mod cells;
mod header;
mod layout;

use glam::Vec3;

use self::cells::draw_cells;
use self::header::draw_header;
use self::layout::Layout;
use crate::chart::draw_chart;
use crate::{Chart, Colour, Colours, Image, View, ViewError, palette};

/// One moment of a motion.
#[derive(Clone, Debug)]
pub struct Frame<'a> {
    /// When, in seconds from the motion's beginning.
    pub seconds: f32,
    /// `[V]` vertex positions in metres.
    pub positions: &'a [Vec3],
    /// `[T]` triangles to draw in red, shining through the body; empty for none.
    pub highlighted: &'a [bool],
    /// A short finding shown beside the time, such as "312 cm³"; may be empty.
    pub note: String,
}

/// Moments of a motion side by side: a row for each view, a column for each moment.
///
/// All cells have one scale and one height range, so that sizes and jumps can be compared; the
/// camera follows the body over the floor, whose grid stays with the world. Many moments wrap
/// into several blocks of rows; one or two moments have a row each and a column for each view.
///
/// ```
/// use glam::vec3;
/// use physique_view::{Colours, ContactSheet, Frame, View, palette};
/// let moments = [0.0, 0.1, 0.3].map(|height| {
///     [vec3(-0.3, height, 0.), vec3(0.3, height, 0.), vec3(0., height + 1., 0.)]
/// });
/// let mut sheet = ContactSheet::new(&[[0, 1, 2]], Colours::Uniform(palette::CENTRE));
/// sheet.title = "A triangle rises".into();
/// sheet.views = vec![View::FRONT, View::TOP];
/// sheet.cell = [60, 80];
/// for (index, positions) in moments.iter().enumerate() {
///     sheet.frames.push(Frame { seconds: index as f32, positions, highlighted: &[], note: String::new() });
/// }
/// let image = sheet.render()?;
/// assert!(image.width() >= 3 * 60 && image.height() >= 2 * 80);
/// # Ok::<(), physique_view::ViewError>(())
/// ```
#[derive(Clone, Debug)]
pub struct ContactSheet<'a> {
    /// The first line.
    pub title: String,
    /// The second line: what file, which body.
    pub subtitle: String,
    /// Further lines under the pictures: figures, remarks, sources.
    pub captions: Vec<String>,
    /// Names of colours, shown at the head's right.
    pub legend: Vec<(String, Colour)>,
    /// `[T]` the triangles of all moments.
    pub triangles: &'a [[u32; 3]],
    /// The body's colours.
    pub colours: Colours<'a>,
    /// The moments, in the order shown.
    pub frames: Vec<Frame<'a>>,
    /// The views.
    pub views: Vec<View>,
    /// Width and height of one picture in pixels.
    pub cell: [u32; 2],
    /// The most moments side by side.
    pub most_columns: usize,
    /// The floor's height in metres, `None` for no floor.
    pub ground_height: Option<f32>,
    /// The path of the body, drawn on the floor; empty for none.
    pub trajectory: Vec<Vec3>,
    /// A value over time, drawn beneath, with the moments marked.
    pub chart: Option<Chart>,
}

impl<'a> ContactSheet<'a> {
    /// An empty sheet with the usual four views and a floor at y = 0.
    #[must_use]
    pub fn new(triangles: &'a [[u32; 3]], colours: Colours<'a>) -> Self {
        Self {
            title: String::new(),
            subtitle: String::new(),
            captions: Vec::new(),
            legend: Vec::new(),
            triangles,
            colours,
            frames: Vec::new(),
            views: vec![View::FRONT, View::SIDE, View::THREE_QUARTER, View::TOP],
            cell: [220, 280],
            most_columns: 8,
            ground_height: Some(0.0),
            trajectory: Vec::new(),
            chart: None,
        }
    }

    /// Draw the sheet. Cells are drawn in parallel; the picture is the same for any number of threads.
    ///
    /// # Errors
    /// [`ViewError::Empty`] without frames or views, [`ViewError::BadSize`] if the sheet would
    /// be too large, and what [`Mesh::check`](crate::Mesh::check) finds wrong with a frame.
    pub fn render(&self) -> Result<Image, ViewError> {
        if self.frames.is_empty() {
            return Err(ViewError::Empty {
                what: "the contact sheet has no frames",
            });
        }
        if self.views.is_empty() {
            return Err(ViewError::Empty {
                what: "the contact sheet has no views",
            });
        }
        let layout = Layout::new(self)?;
        let mut image = Image::new(layout.width, layout.height, palette::PAPER)?;
        draw_header(self, &layout, &mut image);
        draw_cells(self, &layout, &mut image)?;
        if let Some(chart) = &self.chart {
            let marks: Vec<f32> = self.frames.iter().map(|frame| frame.seconds).collect();
            draw_chart(chart, &marks, layout.chart, &mut image);
        }
        Ok(image)
    }
}

/// The body's two sides and the highlight, as a legend.
#[must_use]
pub fn body_legend() -> Vec<(String, Colour)> {
    vec![
        ("left".into(), palette::LEFT),
        ("right".into(), palette::RIGHT),
        ("self-intersection".into(), palette::INTERSECTION),
    ]
}

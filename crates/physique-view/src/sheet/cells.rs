//! The pictures of a contact sheet.

use glam::Vec3;
use rayon::prelude::*;

use super::layout::{Layout, TEXT_SIZE};
use super::{ContactSheet, Frame};
use crate::axes::draw_axes;
use crate::paint::fit;
use crate::{
    Align, Bounds, Camera, Ground, Image, Mesh, Polyline, Scene, Shading, TextStyle, ViewError,
    Weight, palette, text_width,
};

/// The share of a picture left free on each side.
const CELL_MARGIN: f32 = 0.07;

/// The space that every moment's picture shows, around its own place on the floor.
struct Stage {
    size: Vec3,
    low: f32,
}

impl Stage {
    fn new(sheet: &ContactSheet<'_>, bounds: &[Bounds]) -> Self {
        let size = bounds.iter().map(Bounds::size).fold(Vec3::ZERO, Vec3::max);
        let lowest = bounds.iter().map(|b| b.min.y).fold(f32::INFINITY, f32::min);
        let high = bounds
            .iter()
            .map(|b| b.max.y)
            .fold(f32::NEG_INFINITY, f32::max);
        let low = sheet
            .ground_height
            .map_or(lowest, |ground| ground.min(lowest));
        Self {
            size: Vec3::new(size.x, high - low, size.z),
            low,
        }
    }

    fn around(&self, centre: Vec3) -> Bounds {
        let min = Vec3::new(
            centre.x - self.size.x * 0.5,
            self.low,
            centre.z - self.size.z * 0.5,
        );
        Bounds {
            min,
            max: min + self.size,
        }
    }
}

pub(super) fn draw_cells(
    sheet: &ContactSheet<'_>,
    layout: &Layout,
    image: &mut Image,
) -> Result<(), ViewError> {
    // All frames are checked before any is drawn: bounds of broken positions would mislead.
    for frame in &sheet.frames {
        mesh(sheet, frame).check()?;
    }
    let bounds = sheet
        .frames
        .iter()
        .map(|frame| {
            Bounds::around(frame.positions).ok_or(ViewError::Empty {
                what: "a frame has no vertices",
            })
        })
        .collect::<Result<Vec<_>, _>>()?;
    let stage = Stage::new(sheet, &bounds);
    let pictures = sheet
        .frames
        .par_iter()
        .zip(&bounds)
        .map(|(frame, bounds)| draw_frame(sheet, frame, &stage.around(bounds.centre())))
        .collect::<Result<Vec<_>, _>>()?;
    for (frame, pictures) in pictures.iter().enumerate() {
        for (view, picture) in pictures.iter().enumerate() {
            let (x, y) = layout.corner(frame, view);
            image.paste(picture, x, y);
            label(sheet, layout, frame, view, image);
        }
    }
    Ok(())
}

fn mesh<'a>(sheet: &ContactSheet<'a>, frame: &Frame<'a>) -> Mesh<'a> {
    Mesh {
        positions: frame.positions,
        triangles: sheet.triangles,
        colours: sheet.colours,
        highlighted: frame.highlighted,
        shading: Shading::Smooth,
    }
}

/// One moment from all views.
fn draw_frame(
    sheet: &ContactSheet<'_>,
    frame: &Frame<'_>,
    stage: &Bounds,
) -> Result<Vec<Image>, ViewError> {
    let [width, height] = sheet.cell;
    let centre = stage.centre();
    let mut scene = Scene::new();
    scene.add_mesh(mesh(sheet, frame))?;
    if let Some(ground) = sheet.ground_height {
        let radius = stage.size().max_element().max(0.5) * 1.4;
        scene.set_ground(Ground {
            height: ground,
            centre: [centre.x, centre.z],
            radius,
        })?;
    }
    let floor = sheet.ground_height.unwrap_or(stage.min.y);
    let points = sheet
        .trajectory
        .iter()
        .map(|p| Vec3::new(p.x, floor, p.z))
        .collect();
    scene.add_polyline(Polyline {
        points,
        colour: palette::TRAJECTORY,
        width: 1.6,
        hidden_opacity: 0.0,
    })?;
    let aspect = width as f32 / height as f32;
    sheet
        .views
        .par_iter()
        .map(|view| {
            scene.render(
                &Camera::framing(stage, view, aspect, CELL_MARGIN),
                width,
                height,
            )
        })
        .collect()
}

/// Time and finding above the columns, views and axes at the rows' heads.
fn label(sheet: &ContactSheet<'_>, layout: &Layout, frame: usize, view: usize, image: &mut Image) {
    let (heads_column, heads_row) = layout.leads(frame, view);
    let (x, y) = layout.corner(frame, view);
    let (x, y) = (x as f32, y as f32);
    let width = sheet.cell[0] as f32;
    let ink = TextStyle {
        size: TEXT_SIZE,
        weight: Weight::SemiBold,
        colour: palette::INK,
        align: Align::Left,
    };
    let faint = TextStyle {
        size: 12.0,
        weight: Weight::Regular,
        colour: palette::FAINT_INK,
        ..ink
    };
    let moment = &sheet.frames[frame];
    let time = format!("{:.2} s", moment.seconds);
    let name = sheet.views[view].name;
    if heads_column && layout.transposed {
        image.write_text(
            &fit(name, ink.size, ink.weight, width),
            x + 1.0,
            y - 8.0,
            &ink,
        );
    } else if heads_column {
        let time = fit(&time, ink.size, ink.weight, width);
        image.write_text(&time, x + 1.0, y - 8.0, &ink);
        let room = width - text_width(&time, ink.size, ink.weight) - 12.0;
        let note = fit(&moment.note, 13.0, Weight::Regular, room);
        let red = TextStyle {
            size: 13.0,
            weight: Weight::Regular,
            colour: palette::INTERSECTION,
            align: Align::Right,
        };
        image.write_text(&note, x + width - 1.0, y - 8.0, &red);
    }
    if heads_row {
        let text = if layout.transposed {
            time
        } else {
            name.to_owned()
        };
        image.write_text(
            &fit(&text, faint.size, faint.weight, width - 16.0),
            x + 8.0,
            y + 18.0,
            &faint,
        );
        draw_axes(
            &sheet.views[view],
            x + 26.0,
            y + sheet.cell[1] as f32 - 22.0,
            image,
        );
    }
}

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
const CELL_MARGIN: f32 = 0.06;

/// What all pictures share: the camera of each view, as if every moment stood over the origin.
struct Stage {
    cameras: Vec<Camera>,
    /// Where each moment stands on the floor.
    places: Vec<Vec3>,
    ground_radius: f32,
    floor: f32,
}

impl Stage {
    fn new(sheet: &ContactSheet<'_>) -> Result<Self, ViewError> {
        let bounds = sheet
            .frames
            .iter()
            .map(|frame| Bounds::around(frame.positions))
            .collect::<Option<Vec<_>>>()
            .ok_or(ViewError::Empty {
                what: "a frame has no vertices",
            })?;
        let places: Vec<_> = bounds
            .iter()
            .map(|b| Vec3::new(b.centre().x, 0.0, b.centre().z))
            .collect();
        let lowest = bounds.iter().map(|b| b.min.y).fold(f32::INFINITY, f32::min);
        let aspect = sheet.cell[0] as f32 / sheet.cell[1] as f32;
        let cameras = sheet
            .views
            .iter()
            .map(|view| {
                let points = sheet
                    .frames
                    .iter()
                    .zip(&places)
                    .flat_map(|(frame, &place)| {
                        // What hovers keeps its distance from the floor in the picture.
                        let feet = sheet.ground_height.map(|height| Vec3::Y * height);
                        frame.positions.iter().map(move |&p| p - place).chain(feet)
                    });
                Camera::framing_points(points, view, aspect, CELL_MARGIN)
            })
            .collect();
        let widest = bounds
            .iter()
            .map(|b| b.size().max_element())
            .fold(0.5, f32::max);
        let floor = sheet.ground_height.unwrap_or(lowest);
        Ok(Self {
            cameras,
            places,
            ground_radius: widest * 1.5,
            floor,
        })
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
    let stage = Stage::new(sheet)?;
    let pictures = sheet
        .frames
        .par_iter()
        .zip(&stage.places)
        .map(|(frame, &place)| draw_frame(sheet, frame, &stage, place))
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
    stage: &Stage,
    place: Vec3,
) -> Result<Vec<Image>, ViewError> {
    let [width, height] = sheet.cell;
    let mut scene = Scene::new();
    scene.add_mesh(mesh(sheet, frame))?;
    if let Some(height) = sheet.ground_height {
        scene.set_ground(Ground {
            height,
            centre: [place.x, place.z],
            radius: stage.ground_radius,
        })?;
    }
    let points = sheet
        .trajectory
        .iter()
        .map(|p| Vec3::new(p.x, stage.floor, p.z))
        .collect();
    scene.add_polyline(Polyline {
        points,
        colour: palette::TRAJECTORY,
        width: 1.4,
        hidden_opacity: 0.0,
    })?;
    stage
        .cameras
        .par_iter()
        .map(|camera| scene.render(&camera.moved_by(place), width, height))
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
    let red = TextStyle {
        weight: Weight::Regular,
        colour: palette::INTERSECTION,
        ..ink
    };
    let moment = &sheet.frames[frame];
    let time = format!("{:.2} s", moment.seconds);
    let name = sheet.views[view].name;
    let (column_head, row_head) = if layout.transposed {
        (name, &*time)
    } else {
        (&*time, name)
    };
    if heads_column {
        let head = fit(column_head, ink.size, ink.weight, width);
        image.write_text(&head, x + 1.0, y - 8.0, &ink);
        if !layout.transposed {
            let after = text_width(&head, ink.size, ink.weight) + 10.0;
            let note = fit(&moment.note, red.size, red.weight, width - after);
            image.write_text(&note, x + after, y - 8.0, &red);
        }
    }
    if heads_row {
        let head = fit(row_head, faint.size, faint.weight, width - 16.0);
        image.write_text(&head, x + 8.0, y + 18.0, &faint);
        if layout.transposed {
            let after = text_width(&head, faint.size, faint.weight) + 18.0;
            let note = fit(&moment.note, faint.size, faint.weight, width - after);
            image.write_text(
                &note,
                x + after,
                y + 18.0,
                &TextStyle {
                    size: faint.size,
                    ..red
                },
            );
        }
    }
    if heads_row || (layout.transposed && frame == 0) {
        draw_axes(
            &sheet.views[view],
            x + 8.0,
            y + sheet.cell[1] as f32 - 8.0,
            image,
        );
    }
}

//! Motion strips: moments of a motion in one wide picture, along its path.

use glam::Vec3;

use crate::paint::fit;
use crate::sheet::Frame;
use crate::{
    Align, Bounds, Camera, Colours, Ground, Image, Mesh, Polyline, Scene, Shading, TextStyle, View,
    ViewError, Weight, palette, text_width,
};

/// Pixels around the picture, for the title above it and for the times below.
const MARGIN: u32 = 28;
const TITLE: u32 = 36;
const LABELS: u32 = 44;
/// Below this travel, in metres, a motion counts as staying on its spot and is seen from before.
const LEAST_TRAVEL: f32 = 0.8;
/// Room between the boxes of two neighbours, as a share of the wider one's width.
const ROOM: f32 = 0.12;

/// Several moments of a motion in one picture, as in a chronophotograph.
///
/// The camera looks across the path, so that the motion goes from left to right. Moments that
/// would overlap are moved apart along the path; the rest of each pose stays as it is.
///
/// ```
/// use glam::vec3;
/// use physique_view::{Colours, Frame, MotionStrip, palette};
/// let moments = [0.0, 0.5, 1.0].map(|z| [vec3(0., 0., z - 0.2), vec3(0., 0., z + 0.2), vec3(0., 1.7, z)]);
/// let mut strip = MotionStrip::new(&[[0, 1, 2]], Colours::Uniform(palette::CENTRE));
/// strip.width = 320;
/// for (index, positions) in moments.iter().enumerate() {
///     strip.frames.push(Frame { seconds: index as f32, positions, highlighted: &[], note: String::new() });
/// }
/// assert_eq!(strip.render()?.width(), 320);
/// # Ok::<(), physique_view::ViewError>(())
/// ```
#[derive(Clone, Debug)]
pub struct MotionStrip<'a> {
    /// Written at the top left; may be empty.
    pub title: String,
    /// `[T]` the triangles of all moments.
    pub triangles: &'a [[u32; 3]],
    /// The body's colours.
    pub colours: Colours<'a>,
    /// The moments, in order.
    pub frames: Vec<Frame<'a>>,
    /// The picture's width in pixels; its height follows from what there is to see.
    pub width: u32,
    /// The floor's height in metres, `None` for no floor.
    pub ground_height: Option<f32>,
    /// The path of the body, drawn on the floor if no moment had to be moved; empty for none.
    pub trajectory: Vec<Vec3>,
}

impl<'a> MotionStrip<'a> {
    /// An empty strip, 1600 pixels wide, with a floor at y = 0.
    #[must_use]
    pub fn new(triangles: &'a [[u32; 3]], colours: Colours<'a>) -> Self {
        Self {
            title: String::new(),
            triangles,
            colours,
            frames: Vec::new(),
            width: 1600,
            ground_height: Some(0.0),
            trajectory: Vec::new(),
        }
    }

    /// Draw the strip.
    ///
    /// # Errors
    /// [`ViewError::Empty`] without frames, [`ViewError::BadSize`] if the width is zero or too
    /// large, and what [`Mesh::check`] finds wrong with a frame.
    pub fn render(&self) -> Result<Image, ViewError> {
        if self.frames.is_empty() {
            return Err(ViewError::Empty {
                what: "the motion strip has no frames",
            });
        }
        if self.width <= 2 * MARGIN {
            return Err(ViewError::BadSize {
                width: self.width.into(),
                height: 0,
            });
        }
        for frame in &self.frames {
            self.mesh(frame, frame.positions).check()?;
        }
        let bounds = self
            .frames
            .iter()
            .map(|frame| Bounds::around(frame.positions))
            .collect::<Option<Vec<_>>>()
            .ok_or(ViewError::Empty {
                what: "a frame has no vertices",
            })?;
        let direction = direction_of_travel(&bounds);
        let shifts = shifts_apart(&bounds, direction);
        let moved: Vec<Vec<Vec3>> = self
            .frames
            .iter()
            .zip(&shifts)
            .map(|(frame, &shift)| {
                frame
                    .positions
                    .iter()
                    .map(|&p| p + direction * shift)
                    .collect()
            })
            .collect();
        let all = moved
            .iter()
            .filter_map(|positions| Bounds::around(positions))
            .reduce(Bounds::union);
        let all = all.ok_or(ViewError::Empty {
            what: "the motion strip has no vertices",
        })?;
        let mut scene = self.scene(&moved, &all)?;
        if shifts.iter().all(|&shift| shift == 0.0) {
            let floor = self.ground_height.unwrap_or(all.min.y);
            let points = self
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
        }
        let (camera, height) = self.camera(&moved, direction);
        let picture = scene.render(&camera, self.width - 2 * MARGIN, height)?;
        let head = if self.title.is_empty() {
            MARGIN
        } else {
            MARGIN + TITLE
        };
        let mut image = Image::new(self.width, head + height + LABELS, palette::PAPER)?;
        image.paste(&picture, MARGIN.into(), head.into());
        self.label(&moved, &all, &camera, (head, height), &mut image);
        Ok(image)
    }

    fn mesh<'p>(&'p self, frame: &'p Frame<'_>, positions: &'p [Vec3]) -> Mesh<'p> {
        Mesh {
            positions,
            triangles: self.triangles,
            colours: self.colours,
            highlighted: frame.highlighted,
            shading: Shading::Smooth,
        }
    }

    fn scene<'p>(&'p self, moved: &'p [Vec<Vec3>], all: &Bounds) -> Result<Scene<'p>, ViewError> {
        let mut scene = Scene::new();
        if let Some(height) = self.ground_height {
            let centre = all.centre();
            let radius = all.size().x.max(all.size().z) * 0.5 + 2.5;
            scene.set_ground(Ground {
                height,
                centre: [centre.x, centre.z],
                radius,
            })?;
        }
        scene.add_meshes(
            self.frames
                .iter()
                .zip(moved)
                .map(|(frame, positions)| self.mesh(frame, positions)),
        )?;
        Ok(scene)
    }

    /// A camera across the path, and the picture's height at which the poses fill its width.
    fn camera(&self, moved: &[Vec<Vec3>], direction: Vec3) -> (Camera, u32) {
        let towards_eye = direction.cross(Vec3::Y);
        let view = View {
            name: "Along the path",
            azimuth: towards_eye.x.atan2(towards_eye.z),
            elevation: 0.2,
            field_of_view: Some(0.2),
        };
        let margin = 0.04;
        let points = || moved.iter().flatten().copied();
        // Wide pictures of the same poses need less height: take the widest that they still fill.
        let (mut low, mut high) = (0.4, 8.0);
        for _ in 0..12 {
            let middle = 0.5 * (low + high);
            let camera = Camera::framing_points(points(), &view, middle, margin);
            if self.spans_width(&camera, points(), middle) {
                low = middle
            } else {
                high = middle
            }
        }
        let height = ((self.width - 2 * MARGIN) as f32 / low).round().max(1.0) as u32;
        (Camera::framing_points(points(), &view, low, margin), height)
    }

    /// Whether points in a picture of some shape come nearer to its sides than to its top.
    fn spans_width(
        &self,
        camera: &Camera,
        points: impl Iterator<Item = Vec3>,
        aspect: f32,
    ) -> bool {
        let (width, height) = ((1000.0 * aspect) as u32, 1000);
        let (mut across, mut upwards) = (0.0_f32, 0.0_f32);
        for point in points.step_by(7) {
            let Some([x, y]) = camera.project(point, width, height) else {
                continue;
            };
            across = across.max((x / width as f32 - 0.5).abs());
            upwards = upwards.max((y / height as f32 - 0.5).abs());
        }
        across > upwards
    }

    /// The title, and under each pose its time. The picture begins at `head` and is `height` high.
    fn label(
        &self,
        moved: &[Vec<Vec3>],
        all: &Bounds,
        camera: &Camera,
        (head, height): (u32, u32),
        image: &mut Image,
    ) {
        let left = MARGIN as f32;
        let width = image.width() - 2 * MARGIN;
        let title = TextStyle {
            size: 24.0,
            weight: Weight::SemiBold,
            colour: palette::INK,
            align: Align::Left,
        };
        let text = fit(&self.title, title.size, title.weight, width as f32);
        image.write_text(&text, left, left + 19.0, &title);
        let time = TextStyle {
            size: 14.0,
            align: Align::Left,
            ..title
        };
        let note = TextStyle {
            weight: Weight::Regular,
            colour: palette::INTERSECTION,
            ..time
        };
        let baseline = (head + height) as f32 + 22.0;
        let floor = self.ground_height.unwrap_or(all.min.y);
        let mut free_from = 0.0;
        for (frame, positions) in self.frames.iter().zip(moved) {
            let Some(bounds) = Bounds::around(positions) else {
                continue;
            };
            let feet = Vec3::new(bounds.centre().x, floor, bounds.centre().z);
            let Some([middle, _]) = camera.project(feet, width, height) else {
                continue;
            };
            let seconds = format!("{:.2} s", frame.seconds);
            let first = text_width(&seconds, time.size, time.weight);
            let gap = if frame.note.is_empty() { 0.0 } else { 10.0 };
            let words = fit(&frame.note, note.size, note.weight, width as f32 * 0.5);
            let second = text_width(&words, note.size, note.weight);
            // Where poses stand close, the time is worth more than the note.
            let centred = |width: f32| left + middle - 0.5 * width;
            let with_note = centred(first + gap + second) >= free_from;
            let x = if with_note {
                centred(first + gap + second)
            } else {
                centred(first)
            };
            if x < free_from {
                continue;
            }
            image.write_text(&seconds, x, baseline, &time);
            free_from = x + first + 12.0;
            if with_note {
                image.write_text(&words, x + first + gap, baseline, &note);
                free_from += gap + second;
            }
        }
    }
}

/// The level direction from the first place to the last; +X if the body stays where it is.
fn direction_of_travel(bounds: &[Bounds]) -> Vec3 {
    let (Some(first), Some(last)) = (bounds.first(), bounds.last()) else {
        return Vec3::X;
    };
    let travel = (last.centre() - first.centre()) * Vec3::new(1.0, 0.0, 1.0);
    if travel.length() < LEAST_TRAVEL {
        Vec3::X
    } else {
        travel.normalize()
    }
}

/// How far each moment is moved along the path so that neighbours do not overlap.
fn shifts_apart(bounds: &[Bounds], direction: Vec3) -> Vec<f32> {
    // The interval that a box takes along the path.
    let interval = |b: &Bounds| {
        let middle = b.centre().dot(direction);
        let half = 0.5 * b.size().dot(direction.abs());
        (middle - half, middle + half)
    };
    let mut free_from = f32::NEG_INFINITY;
    bounds
        .iter()
        .map(|b| {
            let (low, high) = interval(b);
            let shift = (free_from - low).max(0.0);
            free_from = high + shift + ROOM * (high - low);
            shift
        })
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn box_at(x: f32) -> Bounds {
        Bounds {
            min: Vec3::new(x - 0.5, 0.0, -0.2),
            max: Vec3::new(x + 0.5, 1.8, 0.2),
        }
    }

    #[test]
    fn poses_on_one_spot_are_moved_apart_and_others_stay() {
        let shifts = shifts_apart(&[box_at(0.0), box_at(0.0), box_at(5.0)], Vec3::X);
        assert_eq!(shifts[0], 0.0);
        assert!((shifts[1] - 1.12).abs() < 1e-5);
        assert_eq!(shifts[2], 0.0);
    }

    #[test]
    fn the_path_leads_from_the_first_place_to_the_last() {
        assert_eq!(
            direction_of_travel(&[box_at(0.0), box_at(-3.0)]),
            Vec3::NEG_X
        );
        assert_eq!(direction_of_travel(&[box_at(0.0), box_at(0.1)]), Vec3::X);
    }
}

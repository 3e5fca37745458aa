//! Two balls pass through each other: a contact sheet and a motion strip.
//!
//! `cargo run -p physique-view --example sheet` writes `sheet.png` and `strip.png` into the
//! folder given as argument (the current one by default). The chart shows the exact volume
//! that both balls share.

use std::path::PathBuf;

use glam::{Vec3, vec3};
use physique_view::{Chart, Colour, Colours, ContactSheet, Frame, MotionStrip, palette};

const RADIUS: f32 = 0.3;
const FRAMES: usize = 61;
const FRAMES_PER_SECOND: f32 = 30.0;

fn main() -> Result<(), physique_view::ViewError> {
    let folder = PathBuf::from(std::env::args().nth(1).unwrap_or_else(|| ".".into()));
    let (ball, ball_triangles) = ball();
    let vertices = ball.len() as u32;
    // The right ball's triangles follow the left one's.
    let triangles: Vec<[u32; 3]> = ball_triangles
        .iter()
        .copied()
        .chain(
            ball_triangles
                .iter()
                .map(|corners| corners.map(|index| index + vertices)),
        )
        .collect();
    let colours: Vec<Colour> = [palette::LEFT, palette::RIGHT]
        .into_iter()
        .flat_map(|c| std::iter::repeat_n(c, ball.len()))
        .collect();

    let moments: Vec<Moment> = (0..FRAMES)
        .map(|frame| Moment::new(frame, &ball, &triangles))
        .collect();
    let frames: Vec<Frame<'_>> = (0..FRAMES)
        .step_by(10)
        .map(|frame| Frame {
            seconds: frame as f32 / FRAMES_PER_SECOND,
            positions: &moments[frame].positions,
            highlighted: &moments[frame].inside,
            note: format!("{:.0} cm³", moments[frame].shared_volume * 1e6),
        })
        .collect();

    let mut sheet = ContactSheet::new(&triangles, Colours::PerVertex(&colours));
    sheet.title = "Two balls pass through each other".into();
    sheet.subtitle = "radius 0.30 m · 61 frames at 30 fps".into();
    sheet.legend = physique_view::body_legend();
    sheet.captions = vec!["The volume is exact: V = π (2r − d)² (d² + 4dr) / 12d.".into()];
    sheet.frames = frames.clone();
    sheet.chart = Some(Chart {
        label: "Shared volume (cm³)".into(),
        seconds_per_value: 1.0 / FRAMES_PER_SECOND,
        values: moments
            .iter()
            .map(|moment| moment.shared_volume * 1e6)
            .collect(),
        colour: palette::INTERSECTION,
    });
    sheet.render()?.write_png(folder.join("sheet.png"))?;

    let mut strip = MotionStrip::new(&triangles, Colours::PerVertex(&colours));
    strip.title = "Two balls pass through each other".into();
    strip.frames = frames;
    strip.render()?.write_png(folder.join("strip.png"))
}

/// Both balls at one time.
struct Moment {
    positions: Vec<Vec3>,
    /// Triangles whose corners all lie in the other ball.
    inside: Vec<bool>,
    shared_volume: f32,
}

impl Moment {
    fn new(frame: usize, ball: &[Vec3], triangles: &[[u32; 3]]) -> Self {
        let phase = frame as f32 / (FRAMES - 1) as f32;
        let left = vec3(0.55 - 0.75 * phase, RADIUS + 0.1 * phase, 0.0);
        let right = vec3(-0.55 + 0.75 * phase, RADIUS, 0.1);
        let positions: Vec<Vec3> = [left, right]
            .into_iter()
            .flat_map(|centre| ball.iter().map(move |&p| p + centre))
            .collect();
        let inside = triangles
            .iter()
            .enumerate()
            .map(|(triangle, corners)| {
                let other = if triangle < triangles.len() / 2 {
                    right
                } else {
                    left
                };
                corners
                    .iter()
                    .all(|&corner| positions[corner as usize].distance(other) < RADIUS)
            })
            .collect();
        Self {
            positions,
            inside,
            shared_volume: lens_volume(left.distance(right)),
        }
    }
}

/// The volume that two balls share at a distance of their centres.
fn lens_volume(distance: f32) -> f32 {
    let overlap = (2.0 * RADIUS - distance).max(0.0);
    std::f32::consts::PI * overlap.powi(2) * (distance.powi(2) + 4.0 * distance * RADIUS)
        / (12.0 * distance)
}

/// A ball of quadrilaterals between circles of latitude, each cut in two.
fn ball() -> (Vec<Vec3>, Vec<[u32; 3]>) {
    const RINGS: u32 = 48;
    const SPOKES: u32 = 64;
    let mut positions = Vec::new();
    for ring in 0..=RINGS {
        let (sin, cos) = (std::f32::consts::PI * ring as f32 / RINGS as f32).sin_cos();
        for spoke in 0..SPOKES {
            let (east, north) = (std::f32::consts::TAU * spoke as f32 / SPOKES as f32).sin_cos();
            positions.push(RADIUS * vec3(sin * east, cos, sin * north));
        }
    }
    let mut triangles = Vec::new();
    for ring in 0..RINGS {
        for spoke in 0..SPOKES {
            let next = (spoke + 1) % SPOKES;
            let [a, b, c, d] = [
                ring * SPOKES + spoke,
                (ring + 1) * SPOKES + spoke,
                (ring + 1) * SPOKES + next,
                ring * SPOKES + next,
            ];
            triangles.extend([[a, b, c], [a, c, d]]);
        }
    }
    (positions, triangles)
}

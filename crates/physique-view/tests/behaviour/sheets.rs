//! Contact sheets and strips, from one moment to many.

use glam::Vec3;
use physique_view::{
    Chart, Colour, Colours, ContactSheet, Frame, Image, MotionStrip, View, body_legend, palette,
};

use crate::support::sphere;

/// A ball that rolls along +Z.
struct Ball {
    triangles: Vec<[u32; 3]>,
    moments: Vec<Vec<Vec3>>,
}

impl Ball {
    fn new(count: usize) -> Self {
        let (positions, triangles) = sphere(0.5, 2);
        let moments = (0..count)
            .map(|step| {
                positions
                    .iter()
                    .map(|p| *p + Vec3::new(0.0, 0.5, step as f32 * 0.3))
                    .collect()
            })
            .collect();
        Self { triangles, moments }
    }

    fn sheet(&self) -> ContactSheet<'_> {
        let mut sheet = ContactSheet::new(&self.triangles, Colours::Uniform(palette::RIGHT));
        sheet.cell = [40, 48];
        sheet.frames = self.frames();
        sheet
    }

    fn frames(&self) -> Vec<Frame<'_>> {
        let moments = self.moments.iter().enumerate();
        moments
            .map(|(step, positions)| Frame {
                seconds: step as f32 * 0.1,
                positions,
                highlighted: &[],
                note: "12 cm³".into(),
            })
            .collect()
    }
}

/// How many pixels have the body's hue: clearly more red than blue, yet not the red of notes.
fn body_pixels(image: &Image) -> usize {
    let is_body = |colour: &&Colour| {
        let [r, g, b] = colour.srgb().map(i32::from);
        r > b + 50 && g > b + 15 && r - g < 90
    };
    image.pixels().iter().filter(is_body).count()
}

#[test]
fn every_number_of_moments_fills_its_cells() {
    let one_cell = {
        let ball = Ball::new(1);
        let mut sheet = ball.sheet();
        sheet.views = vec![View::FRONT];
        body_pixels(&sheet.render().expect("a sheet"))
    };
    assert!(one_cell > 200, "{one_cell}");
    for count in [1, 2, 3, 8, 9, 17, 64] {
        let ball = Ball::new(count);
        let mut sheet = ball.sheet();
        sheet.views = vec![View::FRONT, View::BACK];
        let image = sheet.render().expect("a sheet");
        let pixels = body_pixels(&image);
        let expected = one_cell * 2 * count;
        let ratio = pixels as f32 / expected as f32;
        assert!(
            (0.8..1.25).contains(&ratio),
            "{count} moments: {pixels} pixels of body for {expected}"
        );
    }
}

#[test]
fn all_parts_take_their_room() {
    let ball = Ball::new(3);
    let plain = ball.sheet().render().expect("a sheet");
    let mut sheet = ball.sheet();
    sheet.title = "A ball rolls".into();
    sheet.subtitle = "towards +Z".into();
    sheet.legend = body_legend();
    sheet.captions = vec!["first".into(), "second".into()];
    sheet.chart = Some(Chart {
        label: "Height (m)".into(),
        seconds_per_value: 0.05,
        values: vec![0.0, 1.0, f32::NAN, -2.0, f32::INFINITY, 0.5, 3e38],
        colour: palette::INTERSECTION,
    });
    let full = sheet.render().expect("a sheet");
    assert_eq!(full.width(), plain.width());
    assert!(full.height() > plain.height() + 200);
}

#[test]
fn all_moments_have_one_scale() {
    // A ball twice as large in the second moment: the first is drawn a quarter as large in area.
    let (positions, triangles) = sphere(0.5, 3);
    let large: Vec<Vec3> = positions.iter().map(|p| *p * 2.0).collect();
    let picture = |second: &[Vec3]| {
        let mut sheet = ContactSheet::new(&triangles, Colours::Uniform(palette::RIGHT));
        sheet.cell = [100, 100];
        sheet.views = vec![View {
            field_of_view: None,
            ..View::FRONT
        }];
        sheet.ground_height = None;
        for positions in [&positions, second] {
            sheet.frames.push(Frame {
                seconds: 0.0,
                positions,
                highlighted: &[],
                note: String::new(),
            });
        }
        body_pixels(&sheet.render().expect("a sheet")) as f32
    };
    let (same, different) = (picture(&positions), picture(&large));
    assert!(
        (different / same - 0.625).abs() < 0.04,
        "(1 + 1/4) / 2 is 0.625, found {}",
        different / same
    );
}

#[test]
fn a_strip_shows_every_pose_once() {
    let ball = Ball::new(5);
    let mut strip = MotionStrip::new(&ball.triangles, Colours::Uniform(palette::RIGHT));
    strip.width = 900;
    strip.title = "A ball rolls".into();
    strip.frames = ball.frames();
    let image = strip.render().expect("a strip");
    assert_eq!(image.width(), 900);
    // Along a row through the balls' middles there are five runs of body.
    let runs = |y: u32| {
        let body = |x: u32| {
            let [r, _, b] = image.pixel(x, y).expect("inside").srgb();
            i32::from(r) > i32::from(b) + 40
        };
        (1..image.width())
            .filter(|&x| body(x) && !body(x - 1))
            .count()
    };
    let most = (40..image.height() - 50).map(runs).max();
    assert_eq!(most, Some(5));
}

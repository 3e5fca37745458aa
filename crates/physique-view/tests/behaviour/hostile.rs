//! Bad input is an error that says where; odd input is drawn; nothing panics.

use glam::{Vec3, vec3};
use physique_view::{
    Bounds, Camera, Chart, Colour, Colours, ContactSheet, Dot, Frame, Ground, Image, MAX_PIXELS,
    Mesh, MotionStrip, Polyline, Projection, Scene, Shading, View, ViewError, palette,
};
use proptest::prelude::*;

use crate::support::{mesh, pixel_camera};

const TRIANGLE: [Vec3; 3] = [Vec3::ZERO, Vec3::X, Vec3::Y];

#[test]
fn an_index_out_of_range_is_named() {
    let error = mesh(&TRIANGLE, &[[0, 1, 2], [0, 3, 1]], palette::LEFT)
        .check()
        .expect_err("no vertex 3");
    assert!(matches!(
        error,
        ViewError::IndexOutOfRange {
            triangle: 1,
            index: 3,
            vertices: 3
        }
    ));
    assert_eq!(
        error.to_string(),
        "triangle 1 names vertex 3, but the mesh has 3 vertices (0 to 2)"
    );
    assert!(mesh(&[], &[[0, 0, 0]], palette::LEFT).check().is_err());
}

#[test]
fn positions_that_are_no_places_are_named() {
    for bad in [f32::NAN, f32::INFINITY, f32::NEG_INFINITY, 1e20] {
        let positions = [Vec3::ZERO, vec3(0.0, bad, 0.0), Vec3::Y];
        let error = mesh(&positions, &[[0, 1, 2]], palette::LEFT)
            .check()
            .expect_err("not a place");
        assert!(
            matches!(error, ViewError::BadPosition { index: 1, .. }),
            "{error}"
        );
    }
    let mut scene = Scene::new();
    let line = Polyline {
        points: vec![Vec3::NAN],
        colour: Colour::BLACK,
        width: 1.0,
        hidden_opacity: 0.0,
    };
    assert!(scene.add_polyline(line).is_err());
    let dot = Dot {
        position: Vec3::NAN,
        colour: Colour::BLACK,
        diameter: 1.0,
        hidden_opacity: 0.0,
    };
    assert!(scene.add_dot(dot).is_err());
    assert!(
        scene
            .set_ground(Ground {
                height: f32::NAN,
                ..Ground::new()
            })
            .is_err()
    );
}

#[test]
fn lists_of_the_wrong_length_are_named() {
    let triangles = [[0, 1, 2]];
    let sound = mesh(&TRIANGLE, &triangles, palette::LEFT);
    let two = [palette::LEFT; 2];
    for (broken, what) in [
        (
            Mesh {
                colours: Colours::PerVertex(&two),
                ..sound
            },
            "colours by vertex",
        ),
        (
            Mesh {
                colours: Colours::PerTriangle(&two),
                ..sound
            },
            "colours by triangle",
        ),
        (
            Mesh {
                highlighted: &[true, false],
                ..sound
            },
            "highlighted triangles",
        ),
    ] {
        let error = broken.check().expect_err("a wrong length").to_string();
        assert!(
            error.starts_with(what) && error.ends_with("found 2"),
            "{error}"
        );
    }
}

#[test]
fn pictures_of_no_or_too_many_pixels_are_refused() {
    let scene = Scene::new();
    for (width, height) in [
        (0, 5),
        (5, 0),
        (u32::MAX, u32::MAX),
        (1, MAX_PIXELS as u32 + 1),
    ] {
        let camera = pixel_camera(8, 8);
        assert!(matches!(
            scene.render(&camera, width, height),
            Err(ViewError::BadSize { .. })
        ));
        assert!(Image::new(width, height, Colour::BLACK).is_err());
    }
}

#[test]
fn cameras_that_see_nothing_are_refused() {
    let sound = pixel_camera(8, 8);
    let perspective = |vertical_field_of_view| Projection::Perspective {
        vertical_field_of_view,
    };
    for broken in [
        Camera {
            eye: sound.target,
            ..sound
        },
        Camera {
            eye: Vec3::NAN,
            ..sound
        },
        Camera {
            up: Vec3::Z,
            ..sound
        },
        Camera {
            up: Vec3::ZERO,
            ..sound
        },
        Camera {
            projection: perspective(0.0),
            ..sound
        },
        Camera {
            projection: perspective(f32::NAN),
            ..sound
        },
        Camera {
            projection: perspective(4.0),
            ..sound
        },
        Camera {
            projection: perspective(1.0),
            near: 0.0,
            ..sound
        },
        Camera {
            projection: Projection::Orthographic { half_height: -1.0 },
            ..sound
        },
    ] {
        let result = Scene::new().render(&broken, 8, 8);
        assert!(
            matches!(result, Err(ViewError::BadCamera { .. })),
            "{broken:?}"
        );
        assert_eq!(broken.project(Vec3::ZERO, 8, 8), None);
    }
}

#[test]
fn sheets_without_content_or_room_are_refused() {
    let triangles = [[0, 1, 2]];
    let mut sheet = ContactSheet::new(&triangles, Colours::Uniform(palette::LEFT));
    assert!(matches!(sheet.render(), Err(ViewError::Empty { .. })));
    sheet.frames.push(Frame {
        seconds: 0.0,
        positions: &TRIANGLE,
        highlighted: &[],
        note: String::new(),
    });
    sheet.cell = [0, 10];
    assert!(matches!(sheet.render(), Err(ViewError::BadSize { .. })));
    sheet.cell = [u32::MAX, u32::MAX];
    assert!(matches!(sheet.render(), Err(ViewError::BadSize { .. })));
    sheet.cell = [10, 10];
    sheet.views.clear();
    assert!(matches!(sheet.render(), Err(ViewError::Empty { .. })));
    let strip = MotionStrip::new(&triangles, Colours::Uniform(palette::LEFT));
    assert!(matches!(strip.render(), Err(ViewError::Empty { .. })));
}

#[test]
fn a_broken_frame_spoils_the_sheet_with_an_error() {
    let triangles = [[0, 1, 2]];
    let broken = [Vec3::ZERO, Vec3::NAN, Vec3::Y];
    let frames = |positions| {
        [&TRIANGLE[..], positions].map(|positions| Frame {
            seconds: f32::NAN,
            positions,
            highlighted: &[],
            note: "a very long note ".repeat(100),
        })
    };
    for positions in [&broken[..], &TRIANGLE[..2], &[]] {
        let mut sheet = ContactSheet::new(&triangles, Colours::Uniform(palette::LEFT));
        sheet.frames = frames(positions).to_vec();
        assert!(sheet.render().is_err());
        let mut strip = MotionStrip::new(&triangles, Colours::Uniform(palette::LEFT));
        strip.frames = frames(positions).to_vec();
        assert!(strip.render().is_err());
    }
}

#[test]
fn odd_sheets_are_drawn() {
    let triangles = [[0, 1, 2], [0, 0, 0], [1, 1, 2]];
    let chart = |seconds_per_value, values| Chart {
        label: "x".repeat(5000),
        seconds_per_value,
        values,
        colour: Colour::BLACK,
    };
    for chart in [
        chart(0.0, vec![]),
        chart(f32::NAN, vec![f32::NAN]),
        chart(-1.0, vec![1.0, 2.0]),
        chart(1e38, vec![3e38, -3e38, 0.0]),
        chart(1e-45, vec![1e-45, 0.0]),
        chart(f32::INFINITY, vec![f32::INFINITY, f32::NEG_INFINITY]),
    ] {
        let mut sheet = ContactSheet::new(&triangles, Colours::Uniform(palette::LEFT));
        sheet.title = "long ".repeat(10_000);
        sheet.captions = vec![String::new(), "\u{0}\u{202e}漢字".into()];
        sheet.cell = [1, 1];
        sheet.most_columns = 0;
        sheet.chart = Some(chart);
        for seconds in [0.0, f32::NAN, f32::INFINITY, f32::MAX] {
            sheet.frames.push(Frame {
                seconds,
                positions: &TRIANGLE,
                highlighted: &[],
                note: String::new(),
            });
        }
        sheet.render().expect("a sheet");
    }
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(96))]

    /// Any finite soup from any camera gives a picture: nothing overflows, divides by zero or hangs.
    #[test]
    fn any_soup_is_drawn(
        points in prop::collection::vec(prop::array::uniform3(coordinate()), 3..20),
        picks in prop::collection::vec(prop::array::uniform3(0_usize..100), 1..30),
        eye in prop::array::uniform3(coordinate()),
        perspective in any::<bool>(),
        smooth in any::<bool>(),
    ) {
        let positions: Vec<Vec3> = points.into_iter().map(Vec3::from).collect();
        let triangles: Vec<[u32; 3]> =
            picks.iter().map(|pick| pick.map(|i| (i % positions.len()) as u32)).collect();
        let highlighted: Vec<bool> = (0..triangles.len()).map(|i| i % 3 == 0).collect();
        let mut scene = Scene::new();
        scene.add_mesh(Mesh {
            positions: &positions,
            triangles: &triangles,
            colours: Colours::Uniform(palette::CENTRE),
            highlighted: &highlighted,
            shading: if smooth { Shading::Smooth } else { Shading::Flat },
        }).expect("finite positions");
        scene.set_ground(Ground::new()).expect("a floor");
        scene.add_polyline(Polyline {
            points: positions.clone(), colour: Colour::BLACK, width: 2.0, hidden_opacity: 0.5,
        }).expect("a line");
        let projection = if perspective {
            Projection::Perspective { vertical_field_of_view: 0.8 }
        } else {
            Projection::Orthographic { half_height: 1.0 }
        };
        let camera =
            Camera { eye: Vec3::from(eye), target: vec3(0.1, 0.9, 0.2), up: Vec3::Y, projection, near: 0.02 };
        match scene.render(&camera, 24, 24) {
            Ok(image) => prop_assert_eq!(image.pixels().len(), 24 * 24),
            Err(error) => prop_assert!(matches!(error, ViewError::BadCamera { .. }), "{}", error),
        }
        let bounds = Bounds::around(&positions).expect("points");
        for view in [View::FRONT, View::TOP] {
            scene.render(&Camera::framing(&bounds, &view, 1.0, 0.05), 24, 24).expect("a framed picture");
        }
    }
}

/// Ordinary, tiny and huge coordinates, and repeats.
fn coordinate() -> impl Strategy<Value = f32> {
    prop_oneof![
        4 => -2.0_f32..2.0,
        1 => Just(0.0_f32),
        1 => Just(1e-30_f32),
        1 => -9.9e4_f32..9.9e4,
    ]
}

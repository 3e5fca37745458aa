//! What is nearer hides what is farther; highlights shine through.

use glam::{Vec3, vec3};
use physique_view::{Camera, Colour, Colours, Ground, Mesh, Projection, Scene, Shading, palette};

use crate::support::{at, draw, mesh, pixel_camera, red, sphere};

const RED: Colour = Colour::hex(0xff_00_00);
const BLUE: Colour = Colour::hex(0x00_00_ff);

fn square(z: f32) -> [Vec3; 4] {
    [at(0., 0., z), at(8., 0., z), at(8., 8., z), at(0., 8., z)]
}
const SQUARE: [[u32; 3]; 2] = [[0, 1, 2], [0, 2, 3]];

#[test]
fn the_nearer_surface_is_seen_in_any_order() {
    let (near, far) = (square(1.0), square(-1.0));
    let (red_near, blue_far) = (mesh(&near, &SQUARE, RED), mesh(&far, &SQUARE, BLUE));
    for order in [[red_near, blue_far], [blue_far, red_near]] {
        let colour = draw(&order, 8, 8).pixel(4, 4).expect("inside").linear();
        assert!(colour.x > 0.3 && colour.z < 0.2, "{colour}");
    }
}

#[test]
fn surfaces_that_cross_are_parted_where_they_meet() {
    // Red leans towards the camera on the left, blue on the right; they meet at x = 8.
    let lean = |tilt: f32| {
        [
            at(0., 0., tilt),
            at(16., 0., -tilt),
            at(16., 16., -tilt),
            at(0., 16., tilt),
        ]
    };
    let (left, right) = (lean(4.0), lean(-4.0));
    let image = draw(
        &[mesh(&left, &SQUARE, RED), mesh(&right, &SQUARE, BLUE)],
        16,
        16,
    );
    for x in 0..16 {
        let colour = image.pixel(x, 8).expect("inside").linear();
        assert_eq!(colour.x > colour.z, x < 8, "column {x}: {colour}");
    }
}

#[test]
fn depth_is_right_in_perspective() {
    // A floor that rises to the horizon passes behind a wall: the wall stands at z = -5.
    let floor = [
        vec3(-50., -1., -50.),
        vec3(50., -1., -50.),
        vec3(50., -1., 50.),
        vec3(-50., -1., 50.),
    ];
    let wall = [
        vec3(-50., -1.5, -5.),
        vec3(50., -1.5, -5.),
        vec3(50., 3., -5.),
        vec3(-50., 3., -5.),
    ];
    let mut scene = Scene::new();
    scene.set_background(Colour::BLACK);
    scene
        .add_meshes([mesh(&floor, &SQUARE, RED), mesh(&wall, &SQUARE, BLUE)])
        .expect("sound meshes");
    let camera = Camera {
        eye: Vec3::ZERO,
        target: Vec3::NEG_Z,
        up: Vec3::Y,
        projection: Projection::Perspective {
            vertical_field_of_view: std::f32::consts::FRAC_PI_2,
        },
        near: 0.1,
    };
    // The floor reaches behind the camera and is cut at the near plane.
    let image = scene.render(&camera, 100, 100).expect("a picture");
    for y in 51..100 {
        // Below the horizon by tangent t the floor is 1 / t metres away.
        let tangent = (y as f32 + 0.5 - 50.0) / 50.0;
        let floor_is_nearer = 1.0 / tangent < 5.0;
        let colour = image.pixel(50, y).expect("inside").linear();
        if (1.0 / tangent - 5.0).abs() > 0.3 {
            assert_eq!(colour.x > colour.z, floor_is_nearer, "row {y}: {colour}");
        }
    }
}

#[test]
fn highlights_shine_through_and_others_do_not() {
    let (front, inside) = (square(1.0), square(-1.0));
    let skin = mesh(&front, &SQUARE, BLUE);
    let plain = mesh(&inside, &SQUARE, RED);
    let marked = Mesh {
        highlighted: &[true, true],
        ..plain
    };
    let hidden = red(&draw(&[skin, plain], 8, 8), 4, 4);
    let through = red(&draw(&[skin, marked], 8, 8), 4, 4);
    let open = red(&draw(&[marked], 8, 8), 4, 4);
    assert!(through > hidden + 0.2, "{through} against {hidden}");
    assert!(open > 0.4);
    // The highlight's colour is its own, whatever the surface's.
    let other = Mesh {
        colours: Colours::Uniform(Colour::hex(0x00_ff_00)),
        ..marked
    };
    assert_eq!(red(&draw(&[other], 8, 8), 4, 4), open);
}

#[test]
fn feet_in_the_floor_are_paler_than_feet_above() {
    let (positions, triangles) = sphere(0.5, 3);
    let view = |height: f32| {
        let moved: Vec<Vec3> = positions.iter().map(|p| *p + Vec3::Y * height).collect();
        let mut scene = Scene::new();
        scene
            .add_mesh(mesh(&moved, &triangles, BLUE))
            .expect("a sphere");
        scene.set_ground(Ground::new()).expect("a floor");
        let camera = Camera {
            eye: vec3(0., 1.5, 4.0),
            target: Vec3::ZERO,
            up: Vec3::Y,
            projection: Projection::Orthographic { half_height: 1.0 },
            near: 0.1,
        };
        let image = scene.render(&camera, 64, 64).expect("a picture");
        image.pixel(32, 32).expect("inside").linear()
    };
    let (above, sunk) = (view(0.2), view(-0.6));
    assert!(
        above.x < 0.3 && sunk.x > above.x + 0.1,
        "{above} and {sunk}"
    );
    assert!(sunk.z > sunk.x, "what has sunk can still be seen: {sunk}");
}

#[test]
fn lines_are_faint_behind_a_body() {
    let front = square(1.0);
    let image = |z: f32| {
        let mut scene = Scene::new();
        scene
            .add_mesh(mesh(&front, &SQUARE, BLUE))
            .expect("a square");
        scene
            .add_polyline(physique_view::Polyline {
                points: vec![at(0., 4., z), at(8., 4., z)],
                colour: RED,
                width: 2.0,
                hidden_opacity: 0.25,
            })
            .expect("a line");
        scene.render(&pixel_camera(8, 8), 8, 8).expect("a picture")
    };
    assert_eq!(image(2.0).pixel(4, 4), Some(RED));
    let hidden = red(&image(0.0), 4, 4);
    assert!((hidden - 0.25).abs() < 0.1, "{hidden}");
}

#[test]
fn smooth_shading_has_no_facets() {
    let (positions, triangles) = sphere(0.5, 1);
    let flat = mesh(&positions, &triangles, palette::CENTRE);
    let smooth = Mesh {
        shading: Shading::Smooth,
        ..flat
    };
    let draw = |mesh| {
        let mut scene = Scene::new();
        scene.add_mesh(mesh).expect("a sphere");
        let camera = Camera {
            eye: Vec3::Z,
            target: Vec3::ZERO,
            up: Vec3::Y,
            projection: Projection::Orthographic { half_height: 0.8 },
            near: 0.1,
        };
        scene.render(&camera, 128, 128).expect("a picture")
    };
    // Within a row through the middle, the greatest step from pixel to pixel.
    let roughness = |image: &physique_view::Image| {
        (44..84)
            .map(|x| (red(image, x + 1, 64) - red(image, x, 64)).abs())
            .fold(0.0, f32::max)
    };
    let (flat, smooth) = (roughness(&draw(flat)), roughness(&draw(smooth)));
    assert!(smooth < flat * 0.5, "steps of {smooth} against {flat}");
}

#[test]
fn outlines_part_limbs_of_one_colour() {
    let back = square(0.0);
    let limb = [
        at(3., 0., 0.3),
        at(5., 0., 0.3),
        at(5., 8., 0.3),
        at(3., 8., 0.3),
    ];
    let alone = red(&draw(&[mesh(&back, &SQUARE, RED)], 8, 8), 2, 4);
    let beside = red(
        &draw(
            &[mesh(&back, &SQUARE, RED), mesh(&limb, &SQUARE, RED)],
            8,
            8,
        ),
        2,
        4,
    );
    assert!(beside < alone * 0.9, "{beside} against {alone}");
}

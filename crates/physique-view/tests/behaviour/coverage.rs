//! Triangles cover the pixels that geometry says they cover.

use physique_view::Colour;
use proptest::prelude::*;

use crate::support::{at, draw, mesh, red};

/// What a surface that faces the camera looks like.
fn full() -> f32 {
    let positions = [at(-50., -50., 0.), at(-50., 150., 0.), at(150., -50., 0.)];
    red(
        &draw(
            &[mesh(&positions, &[[0, 1, 2]], Colour::hex(0xa0_a0_a0))],
            4,
            4,
        ),
        1,
        1,
    )
}

fn grey<'a>(positions: &'a [glam::Vec3], triangles: &'a [[u32; 3]]) -> physique_view::Mesh<'a> {
    mesh(positions, triangles, Colour::hex(0xa0_a0_a0))
}

#[test]
fn a_rectangle_on_pixel_borders_fills_them_and_no_others() {
    let positions = [
        at(2., 3., 0.),
        at(9., 3., 0.),
        at(9., 7., 0.),
        at(2., 7., 0.),
    ];
    let image = draw(&[grey(&positions, &[[0, 1, 2], [0, 2, 3]])], 12, 10);
    let full = full();
    assert!(full > 0.2);
    for y in 0..10 {
        for x in 0..12 {
            let expected = if (2..9).contains(&x) && (3..7).contains(&y) {
                full
            } else {
                0.0
            };
            assert_eq!(red(&image, x, y), expected, "pixel {x}, {y}");
        }
    }
}

#[test]
fn a_right_triangle_covers_its_side_of_the_diagonal() {
    let positions = [at(0., 0., 0.), at(0., 16., 0.), at(16., 16., 0.)];
    let image = draw(&[grey(&positions, &[[0, 1, 2]])], 16, 16);
    let full = full();
    for y in 0..16 {
        for x in 0..16 {
            let share = red(&image, x, y) / full;
            match x.cmp(&y) {
                std::cmp::Ordering::Less => assert_eq!(share, 1.0, "pixel {x}, {y}"),
                std::cmp::Ordering::Greater => assert_eq!(share, 0.0, "pixel {x}, {y}"),
                // Cut in half by the edge.
                std::cmp::Ordering::Equal => {
                    assert!((share - 0.5).abs() < 0.13, "pixel {x}, {y}: {share}")
                }
            }
        }
    }
}

#[test]
fn upright_edges_have_eight_steps() {
    let full = full();
    for eighths in 0..=8 {
        let right = 3.0 + eighths as f32 / 8.0;
        let positions = [
            at(0., 0., 0.),
            at(right, 0., 0.),
            at(right, 8., 0.),
            at(0., 8., 0.),
        ];
        let image = draw(&[grey(&positions, &[[0, 1, 2], [0, 2, 3]])], 8, 8);
        let share = red(&image, 3, 4) / full;
        assert!(
            (share - eighths as f32 / 8.0).abs() < 0.01,
            "{eighths} eighths look like {share}"
        );
    }
}

#[test]
fn both_sides_are_drawn() {
    let positions = [at(0., 0., 0.), at(0., 16., 0.), at(16., 16., 0.)];
    let front = draw(&[grey(&positions, &[[0, 1, 2]])], 16, 16);
    let back = draw(&[grey(&positions, &[[0, 2, 1]])], 16, 16);
    assert_eq!(front, back);
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(64))]

    /// The shares of all pixels add up to the triangle's area.
    #[test]
    fn coverage_sums_to_the_area(
        points in prop::array::uniform3((1.0_f32..31.0, 1.0_f32..31.0)),
    ) {
        let positions = points.map(|(x, y)| at(x, y, 0.0));
        let image = draw(&[grey(&positions, &[[0, 1, 2]])], 32, 32);
        let full = full();
        let sum: f32 = image.pixels().iter().map(|colour| colour.linear().x / full).sum();
        let [a, b, c] = positions;
        let area = 0.5 * (b - a).cross(c - a).length();
        // Each pixel that an edge crosses is off by at most two of eight samples, and errors cancel.
        let edge_pixels = a.distance(b) + b.distance(c) + c.distance(a);
        prop_assert!((sum - area).abs() <= 0.05 * edge_pixels + 0.3, "area {area}, covered {sum}");
    }

    /// Triangles that share edges leave no gap: a fan covers exactly what its outline covers.
    #[test]
    fn a_fan_around_any_point_is_seamless(x in 4.0_f32..28.0, y in 4.0_f32..28.0) {
        let corners = [at(2., 2., 0.), at(30., 2., 0.), at(30., 30., 0.), at(2., 30., 0.)];
        let mut positions = corners.to_vec();
        positions.push(at(x, y, 0.0));
        let fan = draw(&[grey(&positions, &[[0, 1, 4], [1, 2, 4], [2, 3, 4], [3, 0, 4]])], 32, 32);
        let whole = draw(&[grey(&corners, &[[0, 1, 2], [0, 2, 3]])], 32, 32);
        prop_assert!(fan == whole);
    }
}

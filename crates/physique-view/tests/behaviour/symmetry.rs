//! A mirrored scene gives the mirrored picture.

use glam::Vec3;
use physique_view::Colour;
use proptest::prelude::*;

use crate::support::{at, draw, mesh};

const SIZE: u32 = 48;

proptest! {
    #![proptest_config(ProptestConfig::with_cases(256))]

    #[test]
    fn mirrored_triangles_give_the_mirrored_picture(
        layers in prop::collection::vec(
            // On a grid of 1/64 pixel, so that mirroring is exact in floating point.
            (prop::array::uniform6(0_i32..(64 * SIZE as i32)), 0_u8..200),
            1..6,
        ),
    ) {
        // Level layers, so that the light, which is not symmetric, is the same on both sides.
        let corners = layers.clone();
        let layers: Vec<(Vec<Vec3>, Colour)> = layers
            .iter()
            .enumerate()
            .map(|(depth, (points, shade))| {
                let corner = |i: usize| {
                    at(points[2 * i] as f32 / 64.0, points[2 * i + 1] as f32 / 64.0, depth as f32 * 0.25)
                };
                (vec![corner(0), corner(1), corner(2)], Colour::hex(0x01_02_01 * u32::from(*shade)))
            })
            .collect();
        let mirrored: Vec<(Vec<Vec3>, Colour)> = layers
            .iter()
            .map(|(points, colour)| {
                (points.iter().map(|p| Vec3::new(SIZE as f32 - p.x, p.y, p.z)).collect(), *colour)
            })
            .collect();
        let picture = |layers: &[(Vec<Vec3>, Colour)]| {
            let meshes: Vec<_> = layers.iter().map(|(p, colour)| mesh(p, &[[0, 1, 2]], *colour)).collect();
            draw(&meshes, SIZE, SIZE)
        };
        let (one, other) = (picture(&layers), picture(&mirrored));
        for y in 0..SIZE {
            for x in 0..SIZE {
                let a = one.pixel(x, y).expect("inside").srgb();
                let b = other.pixel(SIZE - 1 - x, y).expect("inside").srgb();
                let same = a.iter().zip(b).all(|(a, b)| a.abs_diff(b) <= 2);
                prop_assert!(
                    same || corners.iter().any(|(points, _)| is_tied(points, x as i32, y as i32)),
                    "pixel {}, {}: {:?} and {:?}", x, y, a, b
                );
            }
        }
    }
}

/// Whether an edge runs exactly through a place in or beside a pixel where a sample may lie (on
/// sixteenths of pixels): such samples belong to the edge's left in both pictures.
fn is_tied(points: &[i32; 6], x: i32, y: i32) -> bool {
    let corner = |i: usize| {
        (
            i64::from(points[2 * i % 6]),
            i64::from(points[(2 * i + 1) % 6]),
        )
    };
    let lattice = |pixel: i32| ((pixel - 1) * 16..(pixel + 2) * 16).map(|step| i64::from(step) * 4);
    (0..3).any(|i| {
        let ((ax, ay), (bx, by)) = (corner(i), corner(i + 1));
        lattice(y).any(|sy| lattice(x).any(|sx| (bx - ax) * (sy - ay) == (by - ay) * (sx - ax)))
    })
}

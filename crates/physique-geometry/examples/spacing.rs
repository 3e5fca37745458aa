//! How the column scan's error falls with the spacing, on overlaps whose volume geometry knows:
//! `cargo run --release -p physique-geometry --example spacing`.
//!
//! For every shape and spacing, the overlap is placed at 64 offsets against the lattice; the table
//! shows the mean error (bias) and the root mean square error, in percent of the true volume.

use std::f64::consts::PI;

use glam::Vec3;
use physique_geometry::shapes::{Torus, cuboid, icosphere, torus};
use physique_geometry::{ColumnScanner, Error, Mesh, ScanOptions};

const SPACINGS_CM: [f32; 5] = [6.0, 3.0, 2.0, 1.0, 0.5];

fn main() -> Result<(), Error> {
    println!("root mean square error (bias) in percent of the doubly covered volume\n");
    print!("{:<44}{:>10}", "overlap", "cm³");
    SPACINGS_CM
        .iter()
        .for_each(|spacing| print!("{:>18}", format!("{spacing} cm")));
    println!();
    for (name, mesh, volume) in scenes()? {
        print!("{name:<44}{:>10.1}", volume * 1e6);
        for spacing in SPACINGS_CM {
            let (rms, bias) = errors(&mesh, volume, spacing / 100.0)?;
            print!(
                "{:>18}",
                format!("{:.2} ({:+.2})", 100.0 * rms, 100.0 * bias)
            );
        }
        println!();
    }
    Ok(())
}

/// Pairs of solids, and the volume that they share in cubic metres.
fn scenes() -> Result<Vec<(&'static str, Mesh, f64)>, Error> {
    let spheres = |radius: f32, distance: f32| -> Result<(Mesh, f64), Error> {
        let ball = icosphere(radius, 6);
        let shifted = ball.clone().translated(Vec3::new(0.6, 0.0, 0.8) * distance);
        let (r, d) = (f64::from(radius), f64::from(distance));
        Ok((
            Mesh::joined([&ball, &shifted])?,
            PI * (4.0 * r + d) * (2.0 * r - d).powi(2) / 12.0,
        ))
    };
    let (large, large_lens) = spheres(0.15, 0.2)?;
    let (small, small_lens) = spheres(0.05, 0.08)?;
    let boxes = |size: Vec3, offset: Vec3| -> Result<(Mesh, f64), Error> {
        let brick = cuboid(size);
        let shared = (size - offset).as_dvec3();
        Ok((
            Mesh::joined([&brick, &brick.clone().translated(offset)])?,
            shared.x * shared.y * shared.z,
        ))
    };
    let (slab, slab_volume) = boxes(Vec3::new(0.307, 0.411, 0.2), Vec3::new(0.053, 0.0, 0.19))?;
    let (beam, beam_volume) = boxes(Vec3::new(0.307, 0.411, 0.2), Vec3::new(0.264, 0.338, 0.0))?;
    let measures = Torus {
        ring_radius: 0.1,
        tube_radius: 0.04,
        ring_segments: 512,
        tube_segments: 256,
    };
    let ring = torus(measures);
    let sheath = cuboid(Vec3::new(1.0, 1.0, 1.0));
    let ring_volume = 2.0 * PI * PI * 0.1 * 0.04 * 0.04;
    Ok(vec![
        ("lens of two 15 cm spheres, 20 cm apart", large, large_lens),
        ("lens of two 5 cm spheres, 8 cm apart", small, small_lens),
        (
            "slab of two boxes, 1 cm thick along the lines",
            slab,
            slab_volume,
        ),
        (
            "beam of two boxes, 4.3 by 7.3 cm, along the lines",
            beam,
            beam_volume,
        ),
        (
            "torus of 10 and 4 cm in a box",
            Mesh::joined([&ring, &sheath])?,
            ring_volume,
        ),
    ])
}

/// Root mean square and mean of the relative error over 64 offsets against the lattice.
fn errors(mesh: &Mesh, volume: f64, spacing: f32) -> Result<(f64, f64), Error> {
    let mut scanner = ColumnScanner::new(
        &mesh.triangles,
        ScanOptions {
            spacing,
            ..ScanOptions::default()
        },
    )?;
    let (mut sum, mut squares, mut count) = (0.0, 0.0, 0.0);
    for step in 0..64_u8 {
        let (x, y) = (f32::from(step % 8) / 8.0, f32::from(step / 8) / 8.0);
        let offset = Vec3::new(x, y, 0.0) * spacing;
        let moved: Vec<Vec3> = mesh.positions.iter().map(|p| *p + offset).collect();
        let error = scanner.scan(&moved)?.volumes().doubly_covered / volume - 1.0;
        sum += error;
        squares += error * error;
        count += 1.0;
    }
    Ok((f64::sqrt(squares / count), sum / count))
}

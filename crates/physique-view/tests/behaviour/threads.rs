//! Pictures are the same for any number of threads.

use glam::Vec3;
use physique_view::{Colours, ContactSheet, Frame, Image, palette};

use crate::support::sphere;

fn sheet(threads: usize) -> Image {
    let (positions, triangles) = sphere(0.5, 3);
    let highlighted: Vec<bool> = (0..triangles.len())
        .map(|triangle| triangle % 7 == 0)
        .collect();
    let moments: Vec<Vec<Vec3>> = (0..3)
        .map(|step| {
            positions
                .iter()
                .map(|p| *p + Vec3::new(0.0, 0.5, step as f32 * 0.4))
                .collect()
        })
        .collect();
    let mut sheet = ContactSheet::new(&triangles, Colours::Uniform(palette::LEFT));
    sheet.cell = [90, 70];
    sheet.frames = moments
        .iter()
        .map(|positions| Frame {
            seconds: 0.0,
            positions,
            highlighted: &highlighted,
            note: String::new(),
        })
        .collect();
    let pool = rayon::ThreadPoolBuilder::new()
        .num_threads(threads)
        .build()
        .expect("threads");
    pool.install(|| sheet.render()).expect("a sheet")
}

#[test]
fn one_two_and_seven_threads_draw_the_same() {
    let one = sheet(1);
    assert!(one == sheet(2));
    assert!(one == sheet(7));
}

//! Milliseconds for a picture and for a sheet of a body-sized mesh.

use divan::{Bencher, black_box};
use glam::{Vec3, vec3};
use physique_view::{
    Camera, Colours, ContactSheet, Frame, Ground, Mesh, MotionStrip, Scene, Shading, View, palette,
};

fn main() {
    divan::main();
}

/// A closed surface of 13,778 triangles, about as tall and wide as a body.
fn body() -> (Vec<Vec3>, Vec<[u32; 3]>) {
    const RINGS: u32 = 83;
    const SPOKES: u32 = 84;
    let mut positions = Vec::new();
    for ring in 0..RINGS {
        let along = ring as f32 / (RINGS - 1) as f32;
        let radius =
            0.02 + 0.25 * (std::f32::consts::PI * along).sin() * (1.0 + 0.3 * (9.0 * along).cos());
        for spoke in 0..SPOKES {
            let (sin, cos) = (std::f32::consts::TAU * spoke as f32 / SPOKES as f32).sin_cos();
            positions.push(vec3(radius * cos, 1.75 * along, 0.7 * radius * sin));
        }
    }
    let mut triangles = Vec::new();
    for ring in 0..RINGS - 1 {
        for spoke in 0..SPOKES {
            let next = (spoke + 1) % SPOKES;
            let [a, b] = [ring * SPOKES + spoke, ring * SPOKES + next];
            triangles.extend([[a, a + SPOKES, b], [b, a + SPOKES, b + SPOKES]]);
        }
    }
    (positions, triangles)
}

fn mesh<'a>(positions: &'a [Vec3], triangles: &'a [[u32; 3]]) -> Mesh<'a> {
    Mesh {
        positions,
        triangles,
        colours: Colours::Uniform(palette::CENTRE),
        highlighted: &[],
        shading: Shading::Smooth,
    }
}

/// Normals and ground shadow: once for each moment, whatever the number of views.
#[divan::bench]
fn prepare_body(bencher: Bencher) {
    let (positions, triangles) = body();
    bencher.bench(|| {
        let mut scene = Scene::new();
        scene
            .set_ground(Ground::new())
            .map(|_| ())
            .expect("a floor");
        scene
            .add_mesh(mesh(black_box(&positions), &triangles))
            .map(|_| ())
            .expect("a body");
        scene.bounds()
    });
}

/// One picture of a prepared body on the floor, 512 x 512 pixels.
#[divan::bench(args = [1, 2])]
fn body_512(bencher: Bencher, threads: usize) {
    let (positions, triangles) = body();
    let mut scene = Scene::new();
    scene.set_ground(Ground::new()).expect("a floor");
    scene
        .add_mesh(mesh(&positions, &triangles))
        .expect("a body");
    let bounds = scene.bounds().expect("a body");
    let camera = Camera::framing(&bounds, &View::THREE_QUARTER, 1.0, 0.06);
    let pool = rayon::ThreadPoolBuilder::new()
        .num_threads(threads)
        .build()
        .expect("threads");
    bencher.bench(|| pool.install(|| scene.render(black_box(&camera), 512, 512)));
}

/// A sheet of 4 views and 8 moments with the usual cells of 220 x 280 pixels.
#[divan::bench(sample_count = 10)]
fn sheet_4_by_8(bencher: Bencher) {
    let (positions, triangles) = body();
    let mut sheet = ContactSheet::new(&triangles, Colours::Uniform(palette::CENTRE));
    for step in 0..8 {
        sheet.frames.push(Frame {
            seconds: step as f32 * 0.25,
            positions: &positions,
            highlighted: &[],
            note: String::new(),
        });
    }
    bencher.bench(|| black_box(&sheet).render());
}

/// Six poses in a strip 1600 pixels wide.
#[divan::bench(sample_count = 10)]
fn strip_of_6(bencher: Bencher) {
    let (positions, triangles) = body();
    let mut strip = MotionStrip::new(&triangles, Colours::Uniform(palette::CENTRE));
    for step in 0..6 {
        strip.frames.push(Frame {
            seconds: step as f32 * 0.25,
            positions: &positions,
            highlighted: &[],
            note: String::new(),
        });
    }
    bencher.bench(|| black_box(&strip).render());
}

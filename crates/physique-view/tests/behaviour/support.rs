//! Scenes that several tests share.

use glam::{Vec3, vec3};
use physique_view::{Camera, Colour, Colours, Image, Mesh, Projection, Scene, Shading};

/// An orthographic camera before the plane z = 0: one metre is one pixel, the origin is the
/// picture's top left corner and y points down through -Y.
pub(crate) fn pixel_camera(width: u32, height: u32) -> Camera {
    let middle = vec3(width as f32 * 0.5, height as f32 * -0.5, 0.0);
    Camera {
        eye: middle + Vec3::Z * 10.0,
        target: middle,
        up: Vec3::Y,
        projection: Projection::Orthographic {
            half_height: height as f32 * 0.5,
        },
        near: 0.1,
    }
}

/// A point given in pixels (y down) at a depth.
pub(crate) fn at(x: f32, y: f32, z: f32) -> Vec3 {
    vec3(x, -y, z)
}

pub(crate) fn mesh<'a>(
    positions: &'a [Vec3],
    triangles: &'a [[u32; 3]],
    colour: Colour,
) -> Mesh<'a> {
    Mesh {
        positions,
        triangles,
        colours: Colours::Uniform(colour),
        highlighted: &[],
        shading: Shading::Flat,
    }
}

/// Draw meshes before black, one pixel a metre.
pub(crate) fn draw(meshes: &[Mesh<'_>], width: u32, height: u32) -> Image {
    let mut scene = Scene::new();
    scene.set_background(Colour::BLACK);
    scene
        .add_meshes(meshes.iter().copied())
        .expect("sound meshes");
    scene
        .render(&pixel_camera(width, height), width, height)
        .expect("a picture")
}

/// Red, linear, at a pixel.
pub(crate) fn red(image: &Image, x: u32, y: u32) -> f32 {
    image.pixel(x, y).expect("inside").linear().x
}

/// A sphere of 20 * 4^`splits` triangles around the origin.
pub(crate) fn sphere(radius: f32, splits: u32) -> (Vec<Vec3>, Vec<[u32; 3]>) {
    let golden = (1.0 + 5.0_f32.sqrt()) / 2.0;
    let mut positions = Vec::new();
    for (a, b) in [
        (1.0, golden),
        (-1.0, golden),
        (1.0, -golden),
        (-1.0, -golden),
    ] {
        positions.extend([vec3(0.0, a, b), vec3(a, b, 0.0), vec3(b, 0.0, a)]);
    }
    let edge = 2.0;
    let near = |a: Vec3, b: Vec3| (a.distance(b) - edge).abs() < 1e-3;
    let mut triangles = Vec::new();
    for a in 0..12 {
        for b in a + 1..12 {
            for c in b + 1..12 {
                let [p, q, r] = [positions[a], positions[b], positions[c]];
                if near(p, q) && near(q, r) && near(r, p) {
                    let outward = (q - p).cross(r - p).dot(p) > 0.0;
                    triangles.push(if outward { [a, b, c] } else { [a, c, b] }.map(|i| i as u32));
                }
            }
        }
    }
    for _ in 0..splits {
        let mut finer = Vec::new();
        // Neighbours share the middles of their edges, so that normals have no seams.
        let mut middles = std::collections::BTreeMap::new();
        for [a, b, c] in triangles {
            let mut middle = |from: u32, to: u32| {
                *middles
                    .entry((from.min(to), from.max(to)))
                    .or_insert_with(|| {
                        positions.push((positions[from as usize] + positions[to as usize]) * 0.5);
                        positions.len() as u32 - 1
                    })
            };
            let (ab, bc, ca) = (middle(a, b), middle(b, c), middle(c, a));
            finer.extend([[a, ab, ca], [ab, b, bc], [ca, bc, c], [ab, bc, ca]]);
        }
        triangles = finer;
    }
    (
        positions
            .into_iter()
            .map(|p| p.normalize() * radius)
            .collect(),
        triangles,
    )
}

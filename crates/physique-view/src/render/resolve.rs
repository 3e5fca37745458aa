//! From visible triangles to a pixel's colour.

use glam::Vec3;

use super::contour::OUTLINE_STEP;
use super::light::shade;
use super::projection::{Ray, ViewTransform};
use super::raster::{NOTHING, SAMPLE_POSITIONS, SAMPLES, Samples};
use crate::scene::PreparedMesh;
use crate::{Colour, Colours, Scene, Shading, palette};

/// How strongly a highlighted triangle shines through the body, and how much of a body below the
/// floor can be seen through it.
const XRAY_OPACITY: f32 = 0.72;
const BELOW_FLOOR: f32 = 0.35;

/// What the samples of a band show: the nearest surface, and the nearest highlighted one.
pub(super) struct Shown<'a> {
    pub(super) surface: &'a Samples,
    pub(super) highlight: Option<&'a Samples>,
}

/// Colours pixels.
pub(super) struct Resolver<'a> {
    scene: &'a Scene<'a>,
    view: ViewTransform,
    background: Vec3,
    highlight: Vec3,
}

/// A pixel's colour, and what in it lies behind a nearer surface.
pub(super) struct Pixel {
    pub(super) colour: Colour,
    pub(super) behind: Option<Behind>,
}

/// The part of a pixel at an outline that shows the surface behind.
#[derive(Clone, Copy, Debug)]
pub(super) struct Behind {
    /// Its share of the pixel's linear light.
    pub(super) light: Vec3,
    /// Its own nearness.
    pub(super) nearness: f32,
}

/// Where a ray meets a triangle.
struct Hit {
    distance: f32,
    weights: Vec3,
    normal: Vec3,
}

impl<'a> Resolver<'a> {
    pub(super) fn new(scene: &'a Scene<'a>, view: ViewTransform) -> Self {
        Self {
            scene,
            view,
            background: scene.background.linear(),
            highlight: palette::INTERSECTION.linear(),
        }
    }

    /// The pixel at (`column`, `row`), whose samples stand at `index`.
    pub(super) fn pixel(&self, shown: &Shown<'_>, index: usize, column: u32, row: u32) -> Pixel {
        let ids = &shown.surface.ids[index];
        let lit = shown
            .highlight
            .map_or([NOTHING; SAMPLES], |samples| samples.ids[index]);
        if *ids == [ids[0]; SAMPLES] && lit == [lit[0]; SAMPLES] {
            let ray = self.view.ray(f64::from(column) + 0.5, f64::from(row) + 0.5);
            let colour = Colour::from_linear(self.colour(ids[0], lit[0], &ray));
            return Pixel {
                colour,
                behind: None,
            };
        }
        let nearness = &shown.surface.nearness[index];
        let nearest = nearness.iter().copied().fold(f32::NEG_INFINITY, f32::max);
        let edge = self.view.depth(nearest) + OUTLINE_STEP;
        let mut light = Vec3::ZERO;
        let mut behind: Option<Behind> = None;
        let mut done = [false; SAMPLES];
        // Samples that show the same are coloured once, in the middle of where they lie.
        for first in 0..SAMPLES {
            if done[first] {
                continue;
            }
            let (mut x, mut y, mut count) = (0, 0, 0);
            for sample in first..SAMPLES {
                if ids[sample] == ids[first] && lit[sample] == lit[first] {
                    done[sample] = true;
                    x += SAMPLE_POSITIONS[sample].0;
                    y += SAMPLE_POSITIONS[sample].1;
                    count += 1;
                }
            }
            let middle =
                |corner: u32, sum: i64| f64::from(corner) + sum as f64 / (16 * count) as f64;
            let ray = self.view.ray(middle(column, x), middle(row, y));
            let share = count as f32 / SAMPLES as f32;
            let here = self.colour(ids[first], lit[first], &ray) * share;
            light += here;
            if ids[first] != NOTHING && self.view.depth(nearness[first]) > edge {
                let far = behind.get_or_insert(Behind {
                    light: Vec3::ZERO,
                    nearness: nearness[first],
                });
                // The nearest of several: whichever sample comes first must not matter.
                far.nearness = far.nearness.max(nearness[first]);
                far.light += here;
            }
        }
        Pixel {
            colour: Colour::from_linear(light),
            behind,
        }
    }

    fn colour(&self, id: u32, lit: u32, ray: &Ray) -> Vec3 {
        let surface = self.triangle(id).and_then(|(mesh, triangle)| {
            let hit = meet(mesh, triangle, ray)?;
            Some((self.surface_colour(mesh, triangle, &hit, ray), hit.distance))
        });
        let mut colour = self.with_floor(surface, ray);
        if lit != NOTHING && lit != id {
            // Hidden inside the body: lay it over what hides it, shaded so that its form shows.
            if let Some((mesh, triangle)) = self.triangle(lit)
                && let Some(hit) = meet(mesh, triangle, ray)
            {
                let facing = hit.normal.dot(ray.direction.normalize_or_zero()).abs();
                colour = colour.lerp(self.highlight * (0.75 + 0.25 * facing), XRAY_OPACITY);
            }
        }
        colour
    }

    /// The floor is nearly opaque: what sinks into it can still be seen.
    fn with_floor(&self, surface: Option<(Vec3, f32)>, ray: &Ray) -> Vec3 {
        let behind = surface.map_or(self.background, |(colour, _)| colour);
        let Some(ground) = &self.scene.ground else {
            return behind;
        };
        let Some(distance) = ground.hit(ray) else {
            return behind;
        };
        match surface {
            Some((_, surface_distance)) if surface_distance <= distance => behind,
            _ => {
                let (floor, fade) =
                    ground.shade(&self.view, ray, distance, self.scene.shadow.as_ref());
                let see_through = if surface.is_some() { BELOW_FLOOR } else { 0.0 };
                behind.lerp(floor, fade * (1.0 - see_through))
            }
        }
    }

    fn surface_colour(
        &self,
        prepared: &PreparedMesh<'_>,
        triangle: usize,
        hit: &Hit,
        ray: &Ray,
    ) -> Vec3 {
        let corners = prepared.mesh.triangles[triangle];
        let mixed = |values: [Vec3; 3]| {
            values[0] * hit.weights.x + values[1] * hit.weights.y + values[2] * hit.weights.z
        };
        let albedo = if prepared.is_highlighted(triangle) {
            self.highlight
        } else {
            match prepared.mesh.colours {
                Colours::Uniform(colour) => colour.linear(),
                Colours::PerTriangle(colours) => colours[triangle].linear(),
                Colours::PerVertex(colours) => mixed(corners.map(|i| colours[i as usize].linear())),
            }
        };
        let smooth = match prepared.mesh.shading {
            Shading::Flat => hit.normal,
            Shading::Smooth => mixed(corners.map(|i| prepared.normals[i as usize]))
                .try_normalize()
                .unwrap_or(hit.normal),
        };
        let towards_eye = -ray.direction.normalize_or_zero();
        // Seen from behind, the surface shows its other side.
        let normal = if hit.normal.dot(towards_eye) < 0.0 {
            -smooth
        } else {
            smooth
        };
        shade(albedo, normal, towards_eye)
    }

    fn triangle(&self, id: u32) -> Option<(&PreparedMesh<'a>, usize)> {
        if id == NOTHING {
            return None;
        }
        let after = self
            .scene
            .meshes
            .partition_point(|prepared| prepared.first_triangle <= id);
        let prepared = self.scene.meshes.get(after.checked_sub(1)?)?;
        Some((prepared, (id - prepared.first_triangle) as usize))
    }
}

/// Where a ray meets a triangle's plane (Möller and Trumbore 1997), drawn into the triangle if
/// the ray just misses it, as the middle of a pixel's samples may. Holds in any projection and
/// for clipped triangles, so no attribute is ever interpolated on the screen.
fn meet(prepared: &PreparedMesh<'_>, triangle: usize, ray: &Ray) -> Option<Hit> {
    let [a, b, c] = prepared.mesh.triangles[triangle].map(|i| prepared.mesh.positions[i as usize]);
    let (ab, ac) = (b - a, c - a);
    let normal = ab.cross(ac).try_normalize()?;
    let cross = ray.direction.cross(ac);
    let determinant = ab.dot(cross);
    let from_a = ray.origin - a;
    let around = from_a.cross(ab);
    let (mut v, mut w) = (
        from_a.dot(cross) / determinant,
        ray.direction.dot(around) / determinant,
    );
    if !(v.is_finite() && w.is_finite()) {
        // Seen edge on: its middle will do.
        (v, w) = (1.0 / 3.0, 1.0 / 3.0);
    }
    let weights = Vec3::new(1.0 - v - w, v, w).max(Vec3::ZERO);
    let weights = weights / weights.element_sum();
    let point = a * weights.x + b * weights.y + c * weights.z;
    let distance = (point - ray.origin).dot(ray.direction) / ray.direction.length_squared();
    Some(Hit {
        distance,
        weights,
        normal,
    })
}

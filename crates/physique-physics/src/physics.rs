//! The physics of motions on one body: prepared once, measured often.

use glam::DVec3;
use physique_body::Body;
use physique_motion::Motion;
use rayon::prelude::*;

use crate::frame::{Filters, FrameMeter};
use crate::judge::judge;
use crate::soles::{SolePoint, sole_points};
use crate::support::classify;
use crate::transforms::Transforms;
use crate::{
    Error, FramePhysics, GroundChoice, MassMoments, MassPoints, PhysicsMeasures, PhysicsOptions,
    Rig, ground,
};

/// Frames that one thread takes at once; fixed, so that results do not depend on the threads.
const BLOCK: usize = 256;
/// Distance between the mass points, in metres. Costs nothing a frame.
const MASS_SPACING: f64 = 0.02;

/// A body ready to be measured: mass, sole points, skin areas.
///
/// ```
/// use physique_body::{Body, Sex, open_body};
/// use physique_motion::embedded;
/// use physique_physics::{Physics, PhysicsOptions};
///
/// let body = Body::mean(open_body()?, Sex::Neutral)?;
/// let physics = Physics::new(&body)?;
/// let walk = embedded::clip("walk").expect("it is embedded").load()?;
/// let measured = physics.measure(&walk.motion, &PhysicsOptions::default())?;
/// assert!(measured.ground.penetration_mean_m < 0.05);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Clone, Debug)]
pub struct Physics {
    body: Body,
    rig: Rig,
    mass_points: MassPoints,
    moments: MassMoments,
    soles: Vec<SolePoint>,
    vertex_areas: Vec<f64>,
}

impl Physics {
    /// Prepares a body: a tenth of a second, once.
    ///
    /// # Errors
    /// [`Error::Geometry`] for a surface that is not closed, [`Error::Shape`] for a body without
    /// inside or without feet.
    pub fn new(body: &Body) -> Result<Self, Error> {
        let mass_points = MassPoints::new(body, MASS_SPACING)?;
        Ok(Self {
            rig: Rig::new(body),
            moments: mass_points.moments(),
            mass_points,
            soles: sole_points(body)?.to_vec(),
            vertex_areas: vertex_areas(body),
            body: body.clone(),
        })
    }

    /// The body.
    pub const fn body(&self) -> &Body {
        &self.body
    }

    /// Its skeleton.
    pub const fn rig(&self) -> &Rig {
        &self.rig
    }

    /// Its mass points.
    pub const fn mass_points(&self) -> &MassPoints {
        &self.mass_points
    }

    /// The sums over its mass points.
    pub const fn moments(&self) -> &MassMoments {
        &self.moments
    }

    /// Its twelve sole points.
    pub fn soles(&self) -> &[SolePoint] {
        &self.soles
    }

    /// `[vertices]` skin area that each vertex stands for in the rest pose, in m2.
    pub fn vertex_areas(&self) -> &[f64] {
        &self.vertex_areas
    }

    /// Height of the ground by the options, in metres.
    pub fn ground_height(&self, motion: &Motion, options: &PhysicsOptions) -> f64 {
        match options.ground {
            GroundChoice::Given(height) => height,
            GroundChoice::Estimated => {
                ground::estimate(&self.body, &self.rig, &self.soles, motion, options)
            }
        }
    }

    /// Measures a motion, frames in parallel. The result does not depend on the number of threads.
    ///
    /// Costs about 0.1 ms a frame on one core.
    ///
    /// # Errors
    /// [`Error::NoFrames`] for an empty motion, [`Error::Option`] for options out of range.
    pub fn measure(
        &self,
        motion: &Motion,
        options: &PhysicsOptions,
    ) -> Result<PhysicsMeasures, Error> {
        options.check()?;
        let filters = Filters::new(motion, options)?;
        let ground = self.ground_height(motion, options);
        let frames = self.frames(motion, options, &filters, ground)?;
        PhysicsMeasures::summarise(frames, ground, &filters, motion).ok_or(Error::NoFrames)
    }

    fn frames(
        &self,
        motion: &Motion,
        options: &PhysicsOptions,
        filters: &Filters,
        ground: f64,
    ) -> Result<Vec<FramePhysics>, Error> {
        let count = motion.frame_count();
        let begins: Vec<_> = (0..count).step_by(BLOCK).collect();
        let blocks = begins
            .into_par_iter()
            .map_init(
                || FrameMeter::new(self, motion, options, filters, ground),
                |meter, begin| {
                    let end = (begin + BLOCK).min(count);
                    let around =
                        begin.saturating_sub(filters.reach())..(end + filters.reach()).min(count);
                    let transforms = Transforms::of(&self.rig, motion, around);
                    (begin..end)
                        .map(|frame| meter.measure(&transforms, frame))
                        .collect::<Result<Vec<_>, _>>()
                },
            )
            .collect::<Result<Vec<_>, _>>()?;
        let mut frames: Vec<_> = blocks.into_iter().flatten().collect();

        judge(&mut frames, &filters.balance);
        let touching: Vec<_> = frames
            .iter()
            .map(|frame| frame.support == crate::Support::Ground)
            .collect();
        let heights: Vec<_> = frames.iter().map(|frame| frame.centre_of_mass.y).collect();
        let support = classify(&touching, &heights, motion.frame_rate().frame_seconds());
        for (frame, support) in frames.iter_mut().zip(support) {
            frame.support = support;
        }
        Ok(frames)
    }
}

/// A third of the area of the triangles around each vertex.
fn vertex_areas(body: &Body) -> Vec<f64> {
    let vertices = body.rest_vertices();
    let mut areas = vec![0.0; vertices.len()];
    for triangle in body.model().triangles() {
        let [a, b, c]: [DVec3; 3] = triangle.map(|v| vertices[v as usize].as_dvec3());
        let third = (b - a).cross(c - a).length() / 6.0;
        triangle.iter().for_each(|&v| areas[v as usize] += third);
    }
    areas
}

//! The physics of one frame.

use glam::{DMat4, DVec2, DVec3, Quat};
use physique_body::{Body, Joint, Pose, PosedBody};
use physique_motion::Motion;

use crate::balance::on_ground;
use crate::contact::{AroundFrame, bearing_skin};
use crate::soles::{SOLE_POINTS, skinned};
use crate::transforms::Transforms;
use crate::{
    Centroid, Error, Physics, PhysicsOptions, PressureModel, Support, SupportPolygon, TimeFilter,
};

/// The physics of one frame, in metres, seconds and kilograms; places on the ground are `(x, z)`.
#[derive(Clone, Debug, PartialEq)]
pub struct FramePhysics {
    /// Height of the lowest skin above the ground; negative below it.
    pub lowest_m: f64,
    /// What carries the body.
    pub support: Support,
    /// Mean horizontal speed of the sole points that stay on the ground; 0 where none does.
    pub slide_m_s: f64,
    /// Centre of mass.
    pub centre_of_mass: DVec3,
    /// Base of support: the hull of the skin that bears the body; `None` without contact.
    pub base_of_support: Option<SupportPolygon>,
    /// Centre of pressure by [`PressureModel::HUMOS`]; `None` in the air.
    pub centre_of_pressure: Option<DVec2>,
    /// The whole body's motion, averaged over about a tenth of a second
    /// ([`TimeFilter::averaging`]); `None` near the ends of the clip, where derivatives have no
    /// neighbours.
    pub centroid: Option<Centroid>,
    /// Zero moment point of that motion; `None` near the ends, without contact, or with too little
    /// load.
    pub zero_moment_point: Option<DVec2>,
    /// Signed distance of the zero moment point to the base of support, averaged over the same
    /// time; negative inside.
    pub zero_moment_distance_m: Option<f64>,
    /// How far inside the base of support the capture point lies (Hof's margin of stability).
    pub margin_of_stability_m: Option<f64>,
    /// How the joints move; `None` near the ends.
    pub smoothness: Option<JointMotion>,
}

/// Means over the 22 joints in one frame.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct JointMotion {
    /// Speed, in m/s.
    pub speed_m_s: f64,
    /// Magnitude of the acceleration, in m/s2.
    pub acceleration_m_s2: f64,
    /// Magnitude of the jerk, in m/s3.
    pub jerk_m_s3: f64,
    /// Mean of the squared jerk, in m2/s6.
    pub squared_jerk: f64,
    /// Distance from the smoothed path, in metres: what moves faster than the cut-off.
    pub jitter_m: f64,
}

/// Derivative filters of a measurement.
#[derive(Clone, Debug)]
pub(crate) struct Filters {
    pub(crate) balance: TimeFilter,
    pub(crate) smoothness: TimeFilter,
    /// Frames on either side over which speeds of skin are taken.
    pub(crate) speed_reach: f64,
}

impl Filters {
    /// Speeds of skin are taken over this long to either side, in seconds.
    const SPEED_REACH: f64 = 0.05;

    pub(crate) fn new(motion: &Motion, options: &PhysicsOptions) -> Result<Self, Error> {
        let rate = motion.frame_rate();
        Ok(Self {
            balance: TimeFilter::averaging(rate, options.balance_cutoff_hz)?,
            smoothness: TimeFilter::new(rate, options.smoothness_cutoff_hz)?,
            speed_reach: Self::SPEED_REACH * rate.per_second(),
        })
    }

    /// Frames that a frame's measures need on either side.
    pub(crate) fn reach(&self) -> usize {
        let filters = self.balance.reach().max(self.smoothness.reach());
        filters.max(self.speed_reach.ceil() as usize)
    }
}

/// Measures frame after frame; one a thread.
pub(crate) struct FrameMeter<'a> {
    physics: &'a Physics,
    motion: &'a Motion,
    options: &'a PhysicsOptions,
    filters: &'a Filters,
    ground: f64,
    posed: PosedBody,
    around: AroundFrame,
    derivatives: [Vec<DMat4>; 4],
    contacts: Vec<DVec2>,
}

impl<'a> FrameMeter<'a> {
    pub(crate) fn new(
        physics: &'a Physics,
        motion: &'a Motion,
        options: &'a PhysicsOptions,
        filters: &'a Filters,
        ground: f64,
    ) -> Self {
        Self {
            posed: physics.body().posed(),
            physics,
            motion,
            options,
            filters,
            ground,
            around: AroundFrame::default(),
            derivatives: Default::default(),
            contacts: Vec::new(),
        }
    }

    /// Measures a frame of the motion. What its neighbours decide comes later: whether it flies
    /// without contact (here [`Support::Nothing`]), and where the averaged base of support is.
    pub(crate) fn measure(
        &mut self,
        transforms: &Transforms,
        frame: usize,
    ) -> Result<FramePhysics, Error> {
        let rotations: &[Quat] = self.motion.frame_rotations(frame);
        let pose = Pose {
            root_translation: self.motion.root_translation()[frame],
            rotations,
        };
        self.physics.body().pose(&pose, &mut self.posed)?;
        let after = self.motion.frame_count() - 1 - frame;
        let reach = [frame, after].map(|frames| self.filters.speed_reach.min(frames as f64));
        let frame_s = self.motion.frame_rate().frame_seconds();
        self.around.set(transforms, frame, reach, frame_s);

        let vertices = self.posed.vertices();
        let lowest = vertices.iter().map(|v| v.y).fold(f32::MAX, f32::min);
        bearing_skin(
            self.physics.body(),
            vertices,
            &self.around,
            (self.ground, self.options),
            &mut self.contacts,
        );
        let polygon = SupportPolygon::around(&mut self.contacts);
        let centroid = self.centroid(transforms, frame);
        let zero_moment_point = match (&polygon, &centroid) {
            (Some(_), Some(centroid)) => centroid.zero_moment_point(self.ground),
            _ => None,
        };
        let capture_point = centroid.and_then(|centroid| centroid.capture_point(self.ground));
        let margin = || Some(-polygon.as_ref()?.signed_distance(capture_point?));
        let margin_of_stability_m = margin();
        Ok(FramePhysics {
            lowest_m: f64::from(lowest) - self.ground,
            support: match polygon {
                Some(_) => Support::Ground,
                None => Support::Nothing,
            },
            slide_m_s: self.slide(transforms.frame(frame)),
            centre_of_mass: self.physics.moments().mean(transforms.frame(frame)),
            centre_of_pressure: self.centre_of_pressure(),
            base_of_support: polygon,
            centroid,
            zero_moment_point,
            zero_moment_distance_m: None,
            margin_of_stability_m,
            smoothness: self.joint_motion(transforms, frame),
        })
    }

    /// Mean horizontal speed of the sole points that are low in a frame, just before and just after,
    /// and not so fast that they swing.
    fn slide(&self, now: &[DMat4]) -> f64 {
        let [before, after] = self.around.sides();
        let (frames, seconds) = ([before, now, after], self.around.seconds());
        let body: &Body = self.physics.body();
        let (mut sum, mut count) = (0.0, 0);
        for sole in self.physics.soles() {
            let points = frames.map(|transforms| skinned(body, sole.vertex, transforms));
            let low = |p: &DVec3| p.y - self.ground < self.options.contact_height;
            let way = on_ground(points[2] - points[0]).length();
            // A single frame goes nowhere.
            let speed = if seconds > 0.0 { way / seconds } else { 0.0 };
            if points.iter().all(low) && speed < self.options.swing_speed {
                sum += speed;
                count += 1;
            }
        }
        debug_assert!(count <= SOLE_POINTS);
        if count == 0 {
            0.0
        } else {
            sum / f64::from(count as u32)
        }
    }

    fn centre_of_pressure(&self) -> Option<DVec2> {
        /// Above this height, in metres, pressure is below the published least.
        const HIGHEST: f32 = 0.26;
        const LEAST: f64 = 5e-4;
        let highest = self.ground as f32 + HIGHEST;
        let points = self
            .posed
            .vertices()
            .iter()
            .zip(self.physics.vertex_areas());
        let points = points
            .filter(|(position, _)| position.y < highest)
            .map(|(position, &area)| (position.as_dvec3(), area));
        PressureModel::HUMOS.centre(points, self.ground, LEAST)
    }

    fn centroid(&mut self, transforms: &Transforms, frame: usize) -> Option<Centroid> {
        let filter = &self.filters.balance;
        if !filter.covers(frame, self.motion.frame_count()) {
            return None;
        }
        let [poses, first, second, _] = &mut self.derivatives;
        transforms.derivative(filter, 0, frame, poses);
        transforms.derivative(filter, 1, frame, first);
        transforms.derivative(filter, 2, frame, second);
        Some(Centroid::new(self.physics.moments(), poses, first, second))
    }

    fn joint_motion(&mut self, transforms: &Transforms, frame: usize) -> Option<JointMotion> {
        let filter = &self.filters.smoothness;
        if !filter.covers(frame, self.motion.frame_count()) {
            return None;
        }
        for (order, derivative) in self.derivatives.iter_mut().enumerate() {
            transforms.derivative(filter, order, frame, derivative);
        }
        let mut means = JointMotion::default();
        let share = 1.0 / Joint::COUNT as f64;
        let joints = &self.physics.rig().rest_joints()[..Joint::COUNT];
        for (joint, rest) in joints.iter().enumerate() {
            let at = |transforms: &[DMat4]| (transforms[joint] * rest.extend(1.0)).truncate();
            let [value, first, second, third] = &self.derivatives;
            let jerk = at(third).length();
            means.speed_m_s += at(first).length() * share;
            means.acceleration_m_s2 += at(second).length() * share;
            means.jerk_m_s3 += jerk * share;
            means.squared_jerk += jerk * jerk * share;
            means.jitter_m += at(value).distance(at(transforms.frame(frame))) * share;
        }
        Some(means)
    }
}

//! Does the floor of a recording slope?

use glam::{DMat4, DVec2, DVec3, DVec4, Quat, Vec3};

use super::foot_tracks::{FootTracks, lower_of};

/// A floor that slopes a little, since the recording's frame was not level.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct SlopingFloor {
    /// Turns the source's world so that the floor is level.
    pub(super) level_from_source: Quat,
    /// Angle between the floor's normal and the vertical, in degrees.
    pub(super) degrees: f32,
}

/// Fewer steps tell no slope.
const FEWEST_STEPS: usize = 5;
/// Steps that reach less far in a direction (standard deviation, metres) tell no slope along it.
const LEAST_REACH: f64 = 0.5;
/// A floor that slopes less, in degrees, is level for all that its feet can tell.
const LEAST_DEGREES: f64 = 0.3;
/// What slopes more, in degrees, is a ramp that people walked on rather than a bad calibration.
const MOST_DEGREES: f64 = 2.0;
/// A floor is flat when nine of ten steps lie so near to its plane, in metres.
const FLAT_WITHIN: f64 = 0.01;

impl SlopingFloor {
    /// The slope that the steps of a clip show: a plane through them is flat and fits at least
    /// twice as well as a level one. `None` for a level or uneven floor, and for clips that stay
    /// in one place.
    pub(super) fn find(feet: &FootTracks) -> Option<Self> {
        let steps = steps(feet);
        if steps.len() < FEWEST_STEPS {
            return None;
        }
        let directions = far_directions(&steps);
        let [level, sloping] = [&[][..], &directions[..]].map(|directions| {
            let plane = Plane::through(&steps, directions);
            (plane.usual_distance(&steps), plane)
        });
        let normal = DVec3::new(-sloping.1.slope.x, 1.0, -sloping.1.slope.y).normalize();
        let degrees = normal.angle_between(DVec3::Y).to_degrees();
        let slopes = (LEAST_DEGREES..MOST_DEGREES).contains(&degrees)
            && sloping.0 < FLAT_WITHIN
            && 2.0 * sloping.0 < level.0;
        slopes.then(|| Self {
            level_from_source: Quat::from_rotation_arc(normal.as_vec3(), Vec3::Y),
            degrees: degrees as f32,
        })
    }
}

/// Where a foot stood for a while.
struct Step {
    /// Place of the ball of the foot, from the middle of all steps.
    place: DVec3,
    /// 1 for the left foot, -1 for the right.
    foot: f64,
    /// For how long, in seconds, but no more than counts.
    seconds: f64,
}

/// The steps of the foot that is the lower one.
fn steps(feet: &FootTracks) -> Vec<Step> {
    /// A foot that stands nearer to its last place, in metres, has shuffled.
    const SAME_PLACE: f32 = 0.15;
    /// Shorter stands are none, longer ones say no more about the floor.
    const SECONDS: [f64; 2] = [0.05, 0.5];
    let mut stands: Vec<(usize, Vec<Vec3>)> = Vec::new();
    for frame in 0..feet.frame_count() {
        let side = lower_of(|side| feet.sides[side].tip(frame).y);
        if !feet.stands(side, frame) {
            continue;
        }
        let tip = feet.sides[side].tip(frame);
        let before = stands.iter_mut().rev().find(|(of, _)| *of == side);
        match before {
            Some((_, tips)) if tips[0].distance(tip) < SAME_PLACE => tips.push(tip),
            _ => stands.push((side, vec![tip])),
        }
    }
    let mut steps: Vec<Step> = stands
        .into_iter()
        .map(|(side, mut tips)| {
            // The heel lifts the ball a little as the foot comes and goes.
            tips.sort_by(|a, b| a.y.total_cmp(&b.y));
            Step {
                place: tips[tips.len() / 4].as_dvec3(),
                foot: if side == 0 { 1.0 } else { -1.0 },
                seconds: tips.len() as f64 / f64::from(feet.frame_rate),
            }
        })
        .collect();
    steps.retain(|step| step.seconds > SECONDS[0]);
    let whole: f64 = steps.iter().map(|step| step.seconds.min(SECONDS[1])).sum();
    let mut middle = DVec3::ZERO;
    for step in &mut steps {
        step.seconds = step.seconds.min(SECONDS[1]);
        middle += step.place * step.seconds / whole;
    }
    for step in &mut steps {
        step.place -= middle;
    }
    steps
}

/// Horizontal unit directions, square to each other, in which the steps reach far.
fn far_directions(steps: &[Step]) -> Vec<DVec2> {
    let (mut whole, mut xx, mut xz, mut zz) = (0.0, 0.0, 0.0, 0.0);
    for Step { place, seconds, .. } in steps {
        whole += seconds;
        xx += seconds * place.x * place.x;
        xz += seconds * place.x * place.z;
        zz += seconds * place.z * place.z;
    }
    // Principal axes of the covariance.
    let longest = DVec2::from_angle(0.5 * (2.0 * xz).atan2(xx - zz));
    let mut directions = vec![longest, longest.perp()];
    directions.retain(|direction| {
        let variance = direction.x * direction.x * xx
            + 2.0 * direction.x * direction.y * xz
            + direction.y * direction.y * zz;
        variance > LEAST_REACH * LEAST_REACH * whole
    });
    directions
}

/// `y = height + slope . (x, z)`, seen from the middle of the steps; one height for each foot,
/// since markers never sit alike.
#[derive(Default)]
struct Plane {
    height: f64,
    left_over_right: f64,
    slope: DVec2,
}

impl Plane {
    /// The plane with the least sum of vertical distances, sloping only in the given directions:
    /// weighted least squares, repeated with weights of one over the distance.
    fn through(steps: &[Step], directions: &[DVec2]) -> Self {
        const ROUNDS: usize = 20;
        const SMALLEST_DISTANCE: f64 = 1e-3;
        let mut plane = Self::default();
        for _ in 0..ROUNDS {
            // An unknown that no direction uses stays 0.
            let (mut normal, mut right) = (DMat4::IDENTITY * 1e-12, DVec4::ZERO);
            for step in steps {
                let flat = DVec2::new(step.place.x, step.place.z);
                let along = |place: usize| directions.get(place).map_or(0.0, |d| d.dot(flat));
                let row = DVec4::new(1.0, step.foot, along(0), along(1));
                let weight = step.seconds / plane.distance(step).max(SMALLEST_DISTANCE);
                let [a, b, c, d] = row.to_array().map(|part| weight * part * row);
                normal += DMat4::from_cols(a, b, c, d);
                right += weight * step.place.y * row;
            }
            // Steps of one foot alone do not tell it from the other.
            normal.y_axis.y += 0.01 * normal.x_axis.x;
            let unknowns = normal.inverse() * right;
            let slopes = [unknowns.z, unknowns.w];
            plane.height = unknowns.x;
            plane.left_over_right = unknowns.y;
            plane.slope = directions.iter().zip(slopes).map(|(d, s)| *d * s).sum();
        }
        plane
    }

    /// Vertical distance of a step from the plane.
    fn distance(&self, step: &Step) -> f64 {
        let flat = DVec2::new(step.place.x, step.place.z);
        let height = self.height + step.foot * self.left_over_right;
        (step.place.y - height - self.slope.dot(flat)).abs()
    }

    /// Nine of ten steps are nearer, by their time.
    fn usual_distance(&self, steps: &[Step]) -> f64 {
        let distances = steps.iter().map(|step| (self.distance(step), step.seconds));
        let mut distances: Vec<(f64, f64)> = distances.collect();
        distances.sort_by(|a, b| a.0.total_cmp(&b.0));
        let mut left = 0.9 * steps.iter().map(|step| step.seconds).sum::<f64>();
        for (distance, seconds) in distances {
            left -= seconds;
            if left <= 0.0 {
                return distance;
            }
        }
        0.0
    }
}

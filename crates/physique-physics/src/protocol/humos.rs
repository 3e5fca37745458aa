//! HUMOS (Tripathi et al., arXiv 2409.03944), 20 fps: as released, and corrected.
//!
//! Both weigh the body by vertices: ten parts closed by caps, each part's volume in the first frame
//! spread evenly over its vertices. Both take as base of support the hull of vertices below 5 cm
//! that move less than 2 cm to the next frame. They differ in
//!
//! | | released | corrected |
//! |---|---|---|
//! | vertical acceleration in the zero moment point | wrong sign, `g - a` | `g + a` |
//! | second derivative | `[1, -2, 1] / h^2` | five frames, quadratic Savitzky-Golay |
//! | frames without base of support | distance 0: unstable | left out and counted |
//! | penetration, floating | means over bad frames only | means over all frames |
//! | skate per cent | any movement in contact (threshold 0) | above 5 mm a frame |

use glam::{DMat4, DVec2, DVec3};
use physique_body::Joint;
use physique_motion::Motion;

use super::ProtocolMeasure;
use super::parts::vertex_volumes;
use super::track::{Track, pose};
use crate::balance::on_ground;
use crate::measures::mean;
use crate::transforms::Transforms;
use crate::{Centroid, Error, MassMoments, MassPoints, Physics, SupportPolygon, TimeFilter};

/// Tolerance of penetration and floating, in metres.
const TOLERANCE: f64 = 0.005;
/// Foot joints lower than this in two frames are in contact.
const JOINT_CONTACT: f64 = 0.015;
/// Corrected skate: displacement a frame beyond which a foot skates.
const SKATE: f64 = 0.005;
/// Vertices of the base of support are lower than this,
const SUPPORT_HEIGHT: f64 = 0.05;
/// and move less than this to the next frame.
const SUPPORT_STEP: f64 = 0.02;
/// Gravity as the paper's code writes it.
const PAPER_GRAVITY: f64 = 9.8;

pub(super) fn released(
    physics: &Physics,
    motion: &Motion,
    track: &Track,
) -> Result<Vec<ProtocolMeasure>, Error> {
    let filter = TimeFilter::second_difference(motion.frame_rate());
    // The first and last frame copy their neighbours; frames without support count as distance 0.
    let inner = stability(physics, motion, track, &filter, released_zero_moment_point)?;
    let mut distances: Vec<_> = inner.iter().map(|d| d.unwrap_or(0.0)).collect();
    if let (Some(&first), Some(&last)) = (distances.first(), distances.last()) {
        distances.insert(0, first);
        distances.push(last);
    }
    let stable = distances.iter().map(|&d| if d < 0.0 { 100.0 } else { 0.0 });
    let outside = distances.iter().copied().filter(|&d| d > 0.0);
    let lowest = || track.lowest_skin.iter().copied();
    let below = lowest().filter(|&height| height < -TOLERANCE).map(f64::abs);
    let above = lowest().filter(|&height| height >= TOLERANCE);
    let steps = || contact_steps(track);
    Ok(vec![
        // Means over no frame are published as 0.
        ProtocolMeasure::new("penetrate_cm", Some(100.0 * mean(below).unwrap_or(0.0))),
        ProtocolMeasure::new("float_cm", Some(100.0 * mean(above).unwrap_or(0.0))),
        ProtocolMeasure::new("skate_cm_s", per_second(mean(steps()), track)),
        ProtocolMeasure::new(
            "skate_percent",
            mean(steps().map(|step| percent(step > 0.0))),
        ),
        ProtocolMeasure::new("dyn_stability_percent", mean(stable)),
        ProtocolMeasure::new("bos_dist_cm", mean(outside.map(|d| 100.0 * d))),
    ])
}

pub(super) fn corrected(
    physics: &Physics,
    motion: &Motion,
    track: &Track,
) -> Result<Vec<ProtocolMeasure>, Error> {
    let filter = TimeFilter::savitzky_golay_5(motion.frame_rate());
    let distances = stability(physics, motion, track, &filter, |centroid, floor| {
        centroid.zero_moment_point(floor)
    })?;
    let judged = || distances.iter().copied().flatten();
    let left_out = distances.iter().map(|distance| percent(distance.is_none()));
    let lowest = || track.lowest_skin.iter().copied();
    let below = lowest().map(|height| if height < -TOLERANCE { -height } else { 0.0 });
    let above = lowest().map(|height| if height >= TOLERANCE { height } else { 0.0 });
    let steps = || contact_steps(track);
    Ok(vec![
        ProtocolMeasure::new("penetrate_cm", mean(below).map(|d| 100.0 * d)),
        ProtocolMeasure::new("float_cm", mean(above).map(|d| 100.0 * d)),
        ProtocolMeasure::new("skate_cm_s", per_second(mean(steps()), track)),
        ProtocolMeasure::new(
            "skate_percent",
            mean(steps().map(|step| percent(step > SKATE))),
        ),
        ProtocolMeasure::new(
            "dyn_stability_percent",
            mean(judged().map(|distance| percent(distance < 0.0))),
        ),
        ProtocolMeasure::new("bos_dist_cm", mean(judged().map(|d| 100.0 * d.max(0.0)))),
        ProtocolMeasure::new("unjudged_percent", mean(left_out)),
    ])
}

fn percent(holds: bool) -> f64 {
    if holds { 100.0 } else { 0.0 }
}

fn per_second(metres_a_frame: Option<f64>, track: &Track) -> Option<f64> {
    metres_a_frame.map(|metres| 100.0 * metres * track.frames_per_second)
}

/// Horizontal step of every foot joint in every pair of frames, 0 where it is not in contact.
fn contact_steps(track: &Track) -> impl Iterator<Item = f64> + '_ {
    track.pairs().flat_map(|frame| {
        Joint::FEET.map(|joint| {
            let contact = track.stays_below(frame, joint, JOINT_CONTACT);
            if contact {
                track.step_on_ground(frame, joint).length()
            } else {
                0.0
            }
        })
    })
}

/// As [`Centroid::zero_moment_point`], but gravity less the upward acceleration: singular in an
/// upward push of 1 g instead of free fall, where the field's code finds NaN.
fn released_zero_moment_point(centroid: &Centroid, floor: f64) -> Option<DVec2> {
    let support = PAPER_GRAVITY - centroid.acceleration.y;
    let turn = centroid.angular_momentum_rate;
    let point = on_ground(centroid.centre)
        - on_ground(centroid.acceleration) * (centroid.centre.y - floor) / support
        + DVec2::new(turn.z, -turn.x) / (centroid.mass * support);
    point.is_finite().then_some(point)
}

/// Signed distance of the zero moment point to the base of support, for the frames that the filter
/// covers and that have a next one.
fn stability(
    physics: &Physics,
    motion: &Motion,
    track: &Track,
    filter: &TimeFilter,
    zero_moment_point: impl Fn(&Centroid, f64) -> Option<DVec2>,
) -> Result<Vec<Option<f64>>, Error> {
    let count = motion.frame_count();
    let moments = vertex_moments(physics, motion)?;
    let mut posed = [physics.body().posed(), physics.body().posed()];
    let mut second: Vec<DMat4> = Vec::new();
    let mut distances = Vec::new();
    for frame in filter.reach()..count.saturating_sub(filter.reach()) {
        let around = frame - filter.reach()..frame + filter.reach() + 1;
        let transforms = Transforms::of(physics.rig(), motion, around);
        transforms.derivative(filter, 2, frame, &mut second);
        let poses = transforms.frame(frame);
        let centroid = Centroid {
            mass: moments.mass(),
            centre: moments.mean(poses),
            acceleration: moments.mean(&second),
            angular_momentum_rate: moments.moment_about_centre(poses, &second),
            ..Centroid::default()
        };
        let [now, next] = &mut posed;
        pose(physics, motion, frame, now)?;
        pose(physics, motion, frame + 1, next)?;
        let mut contacts: Vec<DVec2> = now
            .vertices()
            .iter()
            .zip(next.vertices())
            .filter(|(v, _)| f64::from(v.y) - track.floor < SUPPORT_HEIGHT)
            .filter(|(v, next)| f64::from(v.distance(**next)) < SUPPORT_STEP)
            .map(|(v, _)| on_ground(v.as_dvec3()))
            .collect();
        let polygon = SupportPolygon::around(&mut contacts);
        let polygon = polygon.filter(|polygon| polygon.corners().len() > 2);
        let point = zero_moment_point(&centroid, track.floor);
        distances.push(
            polygon
                .zip(point)
                .map(|(polygon, point)| polygon.signed_distance(point)),
        );
    }
    Ok(distances)
}

/// The vertices as mass points.
fn vertex_moments(physics: &Physics, motion: &Motion) -> Result<MassMoments, Error> {
    let body = physics.body();
    let mut posed = body.posed();
    pose(physics, motion, 0, &mut posed)?;
    let vertices: Vec<DVec3> = posed.vertices().iter().map(|v| v.as_dvec3()).collect();
    let model = body.model();
    let rows: Vec<Vec<_>> = (0..model.vertex_count())
        .map(|vertex| {
            let row = model.blend_weights().row(vertex);
            row.filter(|&(_, weight)| weight > 0.0)
                .map(|(joint, weight)| (joint, f64::from(weight)))
                .collect()
        })
        .collect();
    let rest = body.rest_vertices().iter().map(|v| v.as_dvec3()).collect();
    let masses = vertex_volumes(body, &vertices);
    let parts = model.vertex_parts().to_vec();
    Ok(MassPoints::from_parts(rest, masses, &rows, parts).moments())
}

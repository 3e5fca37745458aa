//! Hands that touch the body on purpose stay there while everything else is pushed apart.

use glam::DVec3;
use physique_body::Joint;
use physique_physics::loss::SkinPoint;
use physique_proxy::SphereBody;
use rayon::prelude::*;

use super::figure::Pose;
use super::wrench::{Wrenches, posed};

/// A hand this near to another part may touch it, in metres between the spheres.
const NEAR: f64 = 0.01;
/// A hand that moves faster over the other part than this passes by, in m/s.
const SLOW: f64 = 0.25;

/// Hand spheres and what they touch in each frame of the source.
pub(super) struct Touches {
    spheres: Vec<Sphere>,
    contacts: Vec<Vec<Contact>>,
}

struct Sphere {
    /// Its centre.
    point: SkinPoint,
    radius: f64,
}

/// Two spheres whose gap should not grow beyond the source's, in metres.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Contact {
    spheres: [usize; 2],
    gap: f64,
}

impl Touches {
    /// Finds the touches of a motion: in each frame the nearest sphere of another limb or the trunk
    /// for each hand, if it is near and hardly moves against the hand.
    pub(super) fn of(spheres: &SphereBody, source: &[Pose], frame_s: f64) -> Self {
        let hands: [Vec<usize>; 2] = [Joint::LeftWrist, Joint::RightWrist]
            .map(|wrist| spheres_of(spheres, |joint| joint == wrist));
        let others: [Vec<usize>; 2] = [0, 1].map(|side| {
            let arm = Joint::ARMS[side];
            spheres_of(spheres, |joint| !arm.contains(&joint))
        });
        let all = (0..spheres.sphere_count()).map(|sphere| Sphere::of(spheres, sphere));
        let mut touches = Self {
            spheres: all.collect(),
            contacts: Vec::with_capacity(source.len()),
        };
        let centres = |pose: &Pose| -> Vec<DVec3> {
            let spheres = touches.spheres.iter();
            spheres.map(|sphere| sphere_centre(sphere, pose)).collect()
        };
        let posed: Vec<_> = source.par_iter().map(centres).collect();
        for frame in 0..source.len() {
            let nearest = |side: usize| touches.nearest(&posed[frame], &hands[side], &others[side]);
            let found = [nearest(0), nearest(1)];
            let neighbours = [
                &posed[frame.saturating_sub(1)],
                &posed[(frame + 1).min(posed.len() - 1)],
            ];
            let contacts = found.into_iter().flatten().filter(|contact| {
                let [hand, other] = contact.spheres;
                let apart = neighbours.map(|centres| centres[hand] - centres[other]);
                speed(apart, frame, posed.len(), frame_s) < SLOW
            });
            touches.contacts.push(contacts.collect());
        }
        touches
    }

    /// Number of frames in which a hand touches something.
    pub(super) fn frames(&self) -> usize {
        self.contacts
            .iter()
            .filter(|found| !found.is_empty())
            .count()
    }

    /// Squared widening of the gaps of a frame, in m2, times `weight`; pushes its forces.
    pub(super) fn cost(
        &self,
        frame: usize,
        pose: &Pose,
        weight: f64,
        wrenches: &mut Wrenches,
    ) -> f64 {
        let world = &pose.world_from_rest;
        let mut cost = 0.0;
        for contact in &self.contacts[frame] {
            let [hand, other] = contact.spheres.map(|sphere| &self.spheres[sphere]);
            let apart = posed(&hand.point, world) - posed(&other.point, world);
            let distance = apart.length();
            let excess = distance - hand.radius - other.radius - contact.gap;
            if excess <= 0.0 || distance == 0.0 {
                continue;
            }
            cost += weight * excess * excess;
            let force = apart * (2.0 * weight * excess / distance);
            wrenches.push_skin(&hand.point, world, force);
            wrenches.push_skin(&other.point, world, -force);
        }
        cost
    }

    fn nearest(&self, centres: &[DVec3], hand: &[usize], others: &[usize]) -> Option<Contact> {
        let pairs = hand
            .iter()
            .flat_map(|&a| others.iter().map(move |&b| [a, b]));
        let contacts = pairs.map(|spheres| {
            let [a, b] = spheres;
            let touching = self.spheres[a].radius + self.spheres[b].radius;
            let gap = centres[a].distance(centres[b]) - touching;
            Contact { spheres, gap }
        });
        let nearest = contacts.min_by(|a, b| a.gap.total_cmp(&b.gap))?;
        (nearest.gap < NEAR).then_some(Contact {
            gap: nearest.gap.max(0.0),
            ..nearest
        })
    }
}

impl Sphere {
    fn of(spheres: &SphereBody, sphere: usize) -> Self {
        let row = spheres.blend_weights[sphere].iter();
        let row = row.filter(|(_, weight)| *weight != 0.0);
        Self {
            point: SkinPoint {
                rest: spheres.centres[sphere].as_dvec3(),
                weights: row
                    .map(|&(joint, weight)| (joint.into(), weight.into()))
                    .collect(),
                area: 0.0,
            },
            radius: f64::from(spheres.radii[sphere]),
        }
    }
}

fn sphere_centre(sphere: &Sphere, pose: &Pose) -> DVec3 {
    posed(&sphere.point, &pose.world_from_rest)
}

fn spheres_of(spheres: &SphereBody, wanted: impl Fn(Joint) -> bool) -> Vec<usize> {
    let all = 0..spheres.sphere_count();
    all.filter(|&sphere| wanted(spheres.dominant_joint(sphere)))
        .collect()
}

/// Speed of a difference, from its values a frame before and after, where these exist.
fn speed(apart: [DVec3; 2], frame: usize, frames: usize, frame_s: f64) -> f64 {
    let span = (frame + 1).min(frames - 1) - frame.saturating_sub(1);
    if span == 0 {
        return 0.0;
    }
    (apart[1] - apart[0]).length() / (frame_s * span as f64)
}

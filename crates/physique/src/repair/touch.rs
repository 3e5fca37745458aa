//! Hands that touch the body on purpose stay there while everything else is pushed apart.

use glam::{DMat3, DMat4, DVec3};
use physique_body::{Body, Joint};
use physique_motion::{FrameRate, Motion};
use physique_physics::Rig;
use physique_proxy::SphereBody;

use super::change::Changed;

/// A hand this near to another part may touch it, in metres between the spheres.
const NEAR: f64 = 0.01;
/// A hand that moves faster over the other part than this passes by, in m/s.
const SLOW: f64 = 0.25;

/// Hand spheres and what they touch in each frame of the source.
pub(super) struct Touches {
    rig: Rig,
    spheres: Vec<Sphere>,
    contacts: Vec<Vec<Contact>>,
}

struct Sphere {
    rest: DVec3,
    radius: f64,
    follows: Vec<(usize, f64)>,
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
    pub(super) fn of(body: &Body, spheres: &SphereBody, motion: &Motion) -> Self {
        let hands: [Vec<usize>; 2] = [Joint::LeftWrist, Joint::RightWrist]
            .map(|wrist| spheres_of(spheres, |joint| joint == wrist));
        let others: [Vec<usize>; 2] = [0, 1].map(|side| {
            let arm = Joint::ARMS[side];
            spheres_of(spheres, |joint| !arm.contains(&joint))
        });
        let mut touches = Self {
            rig: Rig::new(body),
            spheres: (0..spheres.sphere_count())
                .map(|sphere| Sphere::of(spheres, sphere))
                .collect(),
            contacts: Vec::with_capacity(motion.frame_count()),
        };
        let posed: Vec<_> = (0..motion.frame_count())
            .map(|frame| touches.pose(motion, frame))
            .collect();
        for frame in 0..motion.frame_count() {
            let nearest = |side: usize| touches.nearest(&posed[frame], &hands[side], &others[side]);
            let found = [nearest(0), nearest(1)];
            let neighbours = [
                &posed[frame.saturating_sub(1)],
                &posed[(frame + 1).min(posed.len() - 1)],
            ];
            let contacts = found.into_iter().flatten().filter(|contact| {
                let [hand, other] = contact.spheres;
                let apart = neighbours.map(|centres| centres[hand] - centres[other]);
                speed(apart, frame, posed.len(), motion.frame_rate()) < SLOW
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

    /// Squared widening of all gaps, in m2; adds `weight` times its derivatives by small turns
    /// `R -> exp(w) R` of the rotations, `[frames][22]`.
    pub(super) fn cost(&self, changed: &Changed, weight: f64, turns: &mut [DVec3]) -> f64 {
        let mut cost = 0.0;
        let mut world = Vec::new();
        for (frame, contacts) in self.contacts.iter().enumerate() {
            if contacts.is_empty() {
                continue;
            }
            let joints = frame * Joint::COUNT..(frame + 1) * Joint::COUNT;
            let rotations = changed.rotations[joints.clone()].iter().copied();
            self.rig.pose(rotations, changed.root[frame], &mut world);
            for contact in contacts {
                let [hand, other] = contact.spheres.map(|sphere| &self.spheres[sphere]);
                let apart = hand.centre(&world) - other.centre(&world);
                let distance = apart.length();
                let excess = distance - hand.radius - other.radius - contact.gap;
                if excess <= 0.0 || distance == 0.0 {
                    continue;
                }
                cost += excess * excess;
                let force = apart * (2.0 * weight * excess / distance);
                self.push(hand, force, &world, &mut turns[joints.clone()]);
                self.push(other, -force, &world, &mut turns[joints.clone()]);
            }
        }
        cost
    }

    /// Adds the derivatives by turns of all joints that carry a sphere, given that by its centre.
    fn push(&self, sphere: &Sphere, force: DVec3, world: &[DMat4], turns: &mut [DVec3]) {
        for &(follows, weight) in &sphere.follows {
            let point = world[follows].transform_point3(sphere.rest);
            let mut carrier = Joint::from_index(follows);
            while let Some(joint) = carrier {
                let index = joint.index();
                let pivot = world[index].transform_point3(self.rig.rest_joints()[index]);
                let torque = (point - pivot).cross(force) * weight;
                carrier = joint.parent();
                let axes = carrier.map_or(DMat3::IDENTITY, |parent| {
                    DMat3::from_mat4(world[parent.index()])
                });
                turns[index] += axes.transpose() * torque;
            }
        }
    }

    fn pose(&self, motion: &Motion, frame: usize) -> Vec<DVec3> {
        let rotations = motion.frame_rotations(frame).iter();
        let rotations = rotations.map(|rotation| DMat3::from_quat(rotation.as_dquat()));
        let mut world = Vec::new();
        let root = motion.root_translation()[frame].as_dvec3();
        self.rig.pose(rotations, root, &mut world);
        let centres = self.spheres.iter().map(|sphere| sphere.centre(&world));
        centres.collect()
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
            rest: spheres.centres[sphere].as_dvec3(),
            radius: f64::from(spheres.radii[sphere]),
            follows: row
                .map(|&(joint, weight)| (joint.into(), weight.into()))
                .collect(),
        }
    }

    fn centre(&self, world: &[DMat4]) -> DVec3 {
        let parts = self.follows.iter();
        let parts = parts.map(|&(joint, weight)| world[joint].transform_point3(self.rest) * weight);
        parts.sum()
    }
}

fn spheres_of(spheres: &SphereBody, wanted: impl Fn(Joint) -> bool) -> Vec<usize> {
    let all = 0..spheres.sphere_count();
    all.filter(|&sphere| wanted(spheres.dominant_joint(sphere)))
        .collect()
}

/// Speed of a difference, from its values a frame before and after, where these exist.
fn speed(apart: [DVec3; 2], frame: usize, frames: usize, rate: FrameRate) -> f64 {
    let span = (frame + 1).min(frames - 1) - frame.saturating_sub(1);
    if span == 0 {
        return 0.0;
    }
    (apart[1] - apart[0]).length() * rate.per_second() / span as f64
}

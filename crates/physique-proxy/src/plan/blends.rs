//! Which spheres follow which joints, in the orders in which skinning and its way back visit them.

use std::array::from_fn;

use physique_body::Joint;

use crate::SphereBody;

/// Spheres by the number of joints that they follow: no loop over them has a branch.
#[derive(Clone, Debug, Default)]
pub(crate) struct Blends {
    pub(crate) one: Vec<Blend<1>>,
    pub(crate) two: Vec<Blend<2>>,
    pub(crate) three: Vec<Blend<3>>,
    pub(crate) four: Vec<Blend<4>>,
}

/// A sphere and the joints that it follows.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Blend<const JOINTS: usize> {
    pub(crate) sphere: u16,
    pub(crate) joints: [u16; JOINTS],
    pub(crate) arms: [Arm; JOINTS],
}

/// A sphere that follows a joint.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Influence {
    pub(crate) sphere: u16,
    pub(crate) arm: Arm,
}

/// How a sphere hangs on a joint.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Arm {
    /// The weight times the vector from joint to centre, at rest.
    pub(crate) weighted: [f32; 3],
    pub(crate) weight: f32,
}

/// Blends of all spheres, and the same joint by joint; spheres are named by their place in `order`.
pub(super) fn lay_out(
    body: &SphereBody,
    order: &[u16],
) -> (Blends, [Vec<Influence>; Joint::COUNT]) {
    let mut blends = Blends::default();
    let mut followers: [Vec<_>; Joint::COUNT] = from_fn(|_| Vec::new());
    for (place, &sphere) in order.iter().enumerate() {
        let (place, sphere) = (place as u16, usize::from(sphere));
        let row = joints(&body.blend_weights[sphere]).map(|(joint, weight)| {
            let vector = body.centres[sphere] - body.rest_joints[joint];
            let arm = Arm {
                weighted: (vector * weight).to_array(),
                weight,
            };
            followers[joint].push(Influence { sphere: place, arm });
            (joint as u16, arm)
        });
        match *row.collect::<Vec<_>>() {
            [] => {}
            [a] => blends.one.push(blend(place, [a])),
            [a, b] => blends.two.push(blend(place, [a, b])),
            [a, b, c] => blends.three.push(blend(place, [a, b, c])),
            [a, b, c, d, ..] => blends.four.push(blend(place, [a, b, c, d])),
        }
    }
    (blends, followers)
}

/// Joints with a weight; those named twice once.
fn joints(row: &[(u8, f32); 4]) -> impl Iterator<Item = (usize, f32)> + '_ {
    (0..Joint::COUNT).filter_map(|joint| {
        let own = row.iter().filter(|entry| usize::from(entry.0) == joint);
        let weight: f32 = own.map(|entry| entry.1).sum();
        (weight != 0.0).then_some((joint, weight))
    })
}

fn blend<const JOINTS: usize>(sphere: u16, row: [(u16, Arm); JOINTS]) -> Blend<JOINTS> {
    Blend {
        sphere,
        joints: row.map(|(joint, _)| joint),
        arms: row.map(|(_, arm)| arm),
    }
}

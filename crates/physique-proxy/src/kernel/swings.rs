//! Joint positions to local rotations, and back: [`RotationLayer`] in 32 bits, a frame a lane.
//!
//! Its equations are in `physique_motion::features`; names are the same. Where a formula has a
//! choice, all lanes compute both sides and each takes its own.

use physique_body::Joint;
use physique_motion::features::{GradientRule, RotationLayer};

use super::Workspace;
use super::kinematics::PARENTS;
use super::vectors::{
    add, add_to, cross, dot, multiply, outer, product, rotation, scale, splat, subtract, transpose,
};
use crate::lanes::{Lanes, Simd};

/// The layer, laid out for the kernel.
#[derive(Clone, Debug)]
pub(crate) struct Swings {
    /// By joint: where its bones point at rest; `None` for joints that are never swung.
    rest: [Option<Rest>; Joint::COUNT],
    /// Whether the gradient reaches a joint's rotation through those of its parents.
    full: bool,
}

#[derive(Clone, Copy, Debug)]
struct Rest {
    direction: [f32; 3],
    /// What bones that are folded straight back turn by, row by row.
    half_turn: [f32; 9],
}

impl Swings {
    pub(crate) fn new(layer: &RotationLayer, rule: GradientRule) -> Self {
        let rest = layer.rest_directions().map(|direction| {
            let direction = direction?;
            let axis = direction.any_orthonormal_vector().to_array();
            let entry = |place: usize| {
                let (row, column) = (place / 3, place % 3);
                2.0 * axis[row] * axis[column] - f64::from(u8::from(row == column))
            };
            Some(Rest {
                direction: direction.as_vec3().to_array(),
                half_turn: std::array::from_fn(|place| entry(place) as f32),
            })
        });
        let full = rule == GradientRule::Full;
        Self { rest, full }
    }
}

/// What the way back needs of the way there.
pub(crate) struct SwingWork<L> {
    /// From each joint's parent to the joint; that of the pelvis is the heading.
    bones: [Unit<L>; Joint::COUNT],
    swings: [Swing<L>; Joint::COUNT],
}

/// The direction of a vector; zero where it has none.
#[derive(Clone, Copy)]
struct Unit<L> {
    direction: [L; 3],
    /// 0 where there is no direction.
    inverse_length: L,
}

/// The turn of one joint; see `physique_motion::features`.
#[derive(Clone, Copy)]
struct Swing<L> {
    now: Unit<L>,
    axis: [L; 3],
    /// 1 / (1 + cosine).
    share: L,
    /// 1 unless bones are folded straight back.
    unfolded: L,
}

impl<L: Copy> SwingWork<L> {
    pub(crate) const fn new(zero: L) -> Self {
        let unit = Unit {
            direction: [zero; 3],
            inverse_length: zero,
        };
        let swing = Swing {
            now: unit,
            axis: [zero; 3],
            share: zero,
            unfolded: zero,
        };
        Self {
            bones: [unit; Joint::COUNT],
            swings: [swing; Joint::COUNT],
        }
    }
}

/// Squared sine below which bones are folded straight back: 1 + cosine is below 1e-12.
const FOLDED: f32 = 2e-12;

/// From `joints` to `local`. Returns 0 in lanes of numbers, else NaN.
#[inline(always)]
pub(super) fn forward<S: Simd>(simd: S, plan: &Swings, work: &mut Workspace<S::Lanes>) -> S::Lanes {
    let (zero, one) = (simd.splat(0.0), simd.splat(1.0));
    let mut poison = zero;
    let joints = &work.joints;
    let bones = &mut work.swings.bones;
    let mut sums = [[zero; 3]; Joint::COUNT];
    for joint in 1..Joint::COUNT {
        let parent = PARENTS[joint];
        bones[joint] = unit(simd, subtract(joints[joint], joints[parent]), &mut poison);
        sums[parent] = add(sums[parent], bones[joint].direction);
    }
    let across = across(joints);
    bones[0] = unit(simd, [across[2], zero, zero - across[0]], &mut poison);
    let [x, _, z] = bones[0].direction;
    // Without a heading, as at rest: facing +Z.
    let z = z + (one - one.where_positive(bones[0].inverse_length));
    work.local[0] = [z, zero, x, zero, one, zero, zero - x, zero, z];

    let identity = [one, zero, zero, zero, one, zero, zero, zero, one];
    let mut world = [work.local[0]; Joint::COUNT];
    for joint in 1..Joint::COUNT {
        let above = world[PARENTS[joint]];
        let Some(rest) = &plan.rest[joint] else {
            work.local[joint] = identity;
            world[joint] = above;
            continue;
        };
        let now = unit(simd, sums[joint], &mut poison);
        let missing = one - one.where_positive(now.inverse_length);
        let direction = splat(simd, rest.direction);
        // Without bones, as at rest.
        let in_parent = add(
            multiply(&transpose(&above), now.direction),
            scale(direction, missing),
        );
        let (swing, local) = swing(simd, rest, now, in_parent);
        work.swings.swings[joint] = swing;
        work.local[joint] = local;
        world[joint] = product(&above, &local);
    }
    poison
}

/// c I + [n]x + n n^T / (1 + c) with c = u . w and n = u x w.
#[inline(always)]
fn swing<S: Simd>(
    simd: S,
    rest: &Rest,
    now: Unit<S::Lanes>,
    in_parent: [S::Lanes; 3],
) -> (Swing<S::Lanes>, [S::Lanes; 9]) {
    let one = simd.splat(1.0);
    let direction = splat(simd, rest.direction);
    let axis = cross(direction, in_parent);
    let cosine = dot(direction, in_parent);
    let sine_square = dot(axis, axis);
    // 1 + cosine, or where that loses its digits, the same from the sine.
    let ahead = one.where_positive(cosine);
    let inverse = (one + cosine).max(simd.splat(0.5)).inverse_sqrt();
    let inverse_sine = sine_square.max(simd.splat(0.1 * FOLDED)).inverse_sqrt();
    let share = (inverse * inverse).where_positive(ahead)
        + ((one - cosine) * inverse_sine * inverse_sine).where_positive(one - ahead);
    let folded = one.where_positive(simd.splat(FOLDED) - sine_square);
    let unfolded = one - folded.where_positive(one - ahead);

    let [x, y, z] = axis;
    let [xs, ys, zs] = scale(axis, share);
    let mut rotation = [
        xs.mul_add(x, cosine),
        xs * y - z,
        xs * z + y,
        ys * x + z,
        ys.mul_add(y, cosine),
        ys * z - x,
        zs * x - y,
        zs * y + x,
        zs.mul_add(z, cosine),
    ];
    if S::Lanes::any(unfolded.below(one)) {
        for place in 0..9 {
            let half_turn = simd.splat(rest.half_turn[place]);
            rotation[place] =
                rotation[place].where_positive(unfolded) + half_turn.where_positive(one - unfolded);
        }
    }
    let swing = Swing {
        now,
        axis,
        share,
        unfolded,
    };
    (swing, rotation)
}

/// From the derivatives by `local` to those by `joints`, which they replace.
#[inline(always)]
pub(super) fn backward<S: Simd>(simd: S, plan: &Swings, work: &mut Workspace<S::Lanes>) {
    let zero = simd.splat(0.0);
    let mut by_world = [[zero; 9]; Joint::COUNT];
    let mut by_sums = [[zero; 3]; Joint::COUNT];
    for joint in (1..Joint::COUNT).rev() {
        let parent = PARENTS[joint];
        let above = rotation(&work.world_from_joint[parent]);
        let below = by_world[joint];
        let mut by_local = work.local[joint];
        if plan.full {
            add_to(&mut by_local, &product(&transpose(&above), &below));
            // below local^T, where local has given way to the derivatives: it is above^T world.
            let world = rotation(&work.world_from_joint[joint]);
            let through = product(&product(&below, &transpose(&world)), &above);
            add_to(&mut by_world[parent], &through);
        }
        if let Some(rest) = &plan.rest[joint] {
            let swing = &work.swings.swings[joint];
            let by_direction = swing.gradient(splat(simd, rest.direction), &by_local);
            let [x, y, z] = by_direction;
            let by_direction = [
                x.where_positive(swing.unfolded),
                y.where_positive(swing.unfolded),
                z.where_positive(swing.unfolded),
            ];
            by_sums[joint] = swing.now.gradient(multiply(&above, by_direction));
            if plan.full {
                add_to(
                    &mut by_world[parent],
                    &outer(swing.now.direction, by_direction),
                );
            }
        }
    }
    let mut by_heading = work.local[0];
    add_to(&mut by_heading, &by_world[0]);

    let bones = &work.swings.bones;
    let by_joints = &mut work.joints;
    *by_joints = [[zero; 3]; Joint::COUNT];
    for joint in 1..Joint::COUNT {
        let parent = PARENTS[joint];
        let by_bone = bones[joint].gradient(by_sums[parent]);
        by_joints[joint] = add(by_joints[joint], by_bone);
        by_joints[parent] = subtract(by_joints[parent], by_bone);
    }
    let [xx, _, xz, _, _, _, zx, _, zz] = by_heading;
    let by_forward = bones[0].gradient([xz - zx, zero, xx + zz]);
    let by_across = [zero - by_forward[2], zero, by_forward[0]];
    for [left, right] in ACROSS {
        by_joints[left] = subtract(by_joints[left], by_across);
        by_joints[right] = add(by_joints[right], by_across);
    }
}

/// Left and right of hips and shoulders, which say where the body faces.
const ACROSS: [[usize; 2]; 2] = [
    [Joint::LeftHip.index(), Joint::RightHip.index()],
    [Joint::LeftShoulder.index(), Joint::RightShoulder.index()],
];

#[inline(always)]
fn across<L: Lanes>(joints: &[[L; 3]; Joint::COUNT]) -> [L; 3] {
    let [hips, shoulders] = ACROSS;
    add(
        subtract(joints[hips[1]], joints[hips[0]]),
        subtract(joints[shoulders[1]], joints[shoulders[0]]),
    )
}

impl<L: Lanes> Unit<L> {
    /// The gradient by the vector from the one by its direction.
    #[inline(always)]
    fn gradient(&self, by_direction: [L; 3]) -> [L; 3] {
        let along = dot(self.direction, by_direction);
        let across = subtract(by_direction, scale(self.direction, along));
        scale(across, self.inverse_length)
    }
}

impl<L: Lanes> Swing<L> {
    /// The gradient by the direction in the parent's frame.
    #[inline(always)]
    fn gradient(&self, rest: [L; 3], by_rotation: &[L; 9]) -> [L; 3] {
        let [xx, xy, xz, yx, yy, yz, zx, zy, zz] = *by_rotation;
        let (axis, share) = (self.axis, self.share);
        let turned = multiply(by_rotation, axis);
        let back = multiply(&transpose(by_rotation), axis);
        let by_cosine = (share * share).neg_mul_add(dot(axis, turned), xx + yy + zz);
        let skew = [zy - yz, xz - zx, yx - xy];
        let by_axis = add(scale(add(turned, back), share), skew);
        add(scale(rest, by_cosine), cross(by_axis, rest))
    }
}

/// A vector's direction; numbers too large to be squared poison their lanes.
#[inline(always)]
fn unit<S: Simd>(simd: S, vector: [S::Lanes; 3], poison: &mut S::Lanes) -> Unit<S::Lanes> {
    let least = simd.splat(f32::MIN_POSITIVE);
    let square = dot(vector, vector);
    *poison = square.mul_add(simd.splat(0.0), *poison);
    let inverse_length = square.max(least).inverse_sqrt();
    let inverse_length = inverse_length.where_positive(square - least);
    Unit {
        direction: scale(vector, inverse_length),
        inverse_length,
    }
}

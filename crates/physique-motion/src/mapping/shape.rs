//! Human joints by the shape of the tree, whatever their names.
//!
//! A body is a tree that branches twice: at the pelvis into two legs and a trunk, at the chest
//! into two arms and a head. The two limbs of a pair have bones of equal length. In each limb the
//! two longest bones in a row are thigh and shin, or upper arm and forearm.

use physique_body::Joint;

use super::human_joints::{Gathered, HumanJoints};
use crate::Skeleton;

/// How much the bones of a pair of limbs may differ in length.
const PAIR_TOLERANCE: f32 = 0.05;

/// The human joints; which side is called left is arbitrary until the clip tells
/// ([`super::sides`]). `None` where the tree has no such shape.
pub(super) fn find(skeleton: &Skeleton) -> Option<HumanJoints> {
    let tree = Tree::new(skeleton);
    // Joints come parents first, so the first pair from the root down is the legs'.
    let (pelvis, legs) = (0..skeleton.joint_count()).find_map(|joint| {
        let pair = tree.pair_at(joint)?;
        tree.has_pair_beside(joint, pair).then_some((joint, pair))
    })?;
    let (chest, arms) = (0..skeleton.joint_count())
        .filter(|&joint| joint == pelvis || tree.is_trunk_of(joint, pelvis, legs))
        .find_map(|joint| {
            let pair = if joint == pelvis {
                tree.pair_among(joint, legs)?
            } else {
                tree.pair_at(joint)?
            };
            Some((joint, pair))
        })?;

    let mut gathered = Gathered::default();
    let mut set = |joint: Joint, source: Option<usize>| gathered.joints[joint.index()] = source;
    set(Joint::Pelvis, Some(pelvis));
    for (leg, [hip, knee, ankle, foot]) in legs.into_iter().zip(Joint::LEGS) {
        let limb = tree.limb(leg)?;
        set(hip, Some(limb.top));
        set(knee, Some(limb.middle));
        set(ankle, Some(limb.end));
        set(foot, limb.after);
    }
    for (arm, [collar, shoulder, elbow, wrist]) in arms.into_iter().zip(Joint::ARMS) {
        let limb = tree.limb(arm)?;
        set(collar, limb.before);
        set(shoulder, Some(limb.top));
        set(elbow, Some(limb.middle));
        set(wrist, Some(limb.end));
    }
    let trunk: Vec<usize> = skeleton
        .path_to_root(chest)
        .take_while(|&at| at != pelvis)
        .collect();
    gathered.spine = trunk.into_iter().rev().collect();

    // The head ends the longest of what else hangs on the chest.
    let beside_arms = skeleton
        .children(chest)
        .filter(|child| !arms.contains(child));
    let beside_arms = beside_arms.filter(|child| chest != pelvis || !legs.contains(child));
    if let Some(neck) = beside_arms.max_by(|&a, &b| tree.reach(a).total_cmp(&tree.reach(b))) {
        let mut chain = vec![neck];
        let single_child = |joint: usize| {
            let mut children = skeleton.children(joint);
            children.next().filter(|_| children.next().is_none())
        };
        // A chain of one is a head; of more, all but the last are neck. An end joint without
        // length below the head is no joint of its own.
        while let Some(child) = single_child(chain[chain.len() - 1]) {
            chain.push(child);
        }
        if chain.len() > 2 && tree.is_tip(chain[chain.len() - 1]) {
            chain.pop();
        }
        let head = chain.pop();
        gathered.joints[Joint::Head.index()] = head;
        gathered.neck = chain;
    }
    let human = gathered.finish()?;
    human.problem(skeleton).is_none().then_some(human)
}

/// The chief bones of an arm or a leg.
struct Limb {
    before: Option<usize>,
    top: usize,
    middle: usize,
    end: usize,
    after: Option<usize>,
}

struct Tree<'a> {
    skeleton: &'a Skeleton,
    /// By joint: the way down from its origin to the furthest tip.
    reach: Vec<f32>,
    /// By joint: the child through which that way leads.
    toward_tip: Vec<Option<usize>>,
}

impl<'a> Tree<'a> {
    fn new(skeleton: &'a Skeleton) -> Self {
        let joints = skeleton.joints();
        let mut reach = vec![0.0f32; joints.len()];
        let mut toward_tip = vec![None; joints.len()];
        for (index, joint) in joints.iter().enumerate() {
            let sites = joint.end_sites.iter().map(|site| site.length());
            reach[index] = sites.fold(0.0, f32::max);
        }
        for (index, joint) in joints.iter().enumerate().rev() {
            if let Some(parent) = joint.parent {
                let way = reach[index] + joint.rest_translation.length();
                if toward_tip[parent].is_none() || way > reach[parent] {
                    toward_tip[parent] = Some(index);
                    reach[parent] = reach[parent].max(way);
                }
            }
        }
        Self {
            skeleton,
            reach,
            toward_tip,
        }
    }

    /// The way from a joint's parent through the joint to the furthest tip.
    fn reach(&self, joint: usize) -> f32 {
        self.reach[joint] + self.bone(joint)
    }

    fn bone(&self, joint: usize) -> f32 {
        self.skeleton.joints()[joint].rest_translation.length()
    }

    /// Whether a joint ends a chain.
    fn is_tip(&self, joint: usize) -> bool {
        self.toward_tip[joint].is_none()
    }

    /// The joints from `joint` to the furthest tip.
    fn way_down(&self, joint: usize) -> Vec<usize> {
        std::iter::successors(Some(joint), |&at| self.toward_tip[at]).collect()
    }

    /// The two children of a joint that begin limbs of equal bones.
    fn pair_at(&self, joint: usize) -> Option<[usize; 2]> {
        self.pair_among(joint, [usize::MAX; 2])
    }

    /// As [`Self::pair_at`], leaving two children out.
    fn pair_among(&self, joint: usize, without: [usize; 2]) -> Option<[usize; 2]> {
        let children: Vec<usize> = self
            .skeleton
            .children(joint)
            .filter(|child| !without.contains(child))
            .collect();
        let mut best: Option<(f32, [usize; 2])> = None;
        for (place, &a) in children.iter().enumerate() {
            for &b in &children[place + 1..] {
                let length = self.reach(a).min(self.reach(b));
                let longer = best.is_none_or(|(longest, _)| length > longest);
                if longer && self.are_alike(a, b) {
                    best = Some((length, [a, b]));
                }
            }
        }
        best.map(|(_, pair)| pair)
    }

    /// Whether two children begin limbs: thigh and shin (or arm and forearm) equal on both, and
    /// these two most of the limb's length.
    fn are_alike(&self, a: usize, b: usize) -> bool {
        let (Some(first), Some(second)) = (self.limb(a), self.limb(b)) else {
            return false;
        };
        let bones = |limb: &Limb| [self.bone(limb.middle), self.bone(limb.end)];
        let alike = |a: f32, b: f32| (a - b).abs() <= PAIR_TOLERANCE * a.max(b) && a > 0.0;
        let [upper_a, lower_a] = bones(&first);
        let [upper_b, lower_b] = bones(&second);
        alike(upper_a, upper_b)
            && alike(lower_a, lower_b)
            && upper_a + lower_a > 0.4 * self.reach(a)
    }

    /// Thigh and shin (or arm and forearm): the two longest bones in a row on the way down.
    fn limb(&self, first: usize) -> Option<Limb> {
        let way = self.way_down(first);
        let (place, _) = way
            .windows(3)
            .enumerate()
            .map(|(place, bones)| (place, self.bone(bones[1]) + self.bone(bones[2])))
            .reduce(|best, next| if next.1 > best.1 { next } else { best })?;
        Some(Limb {
            before: place.checked_sub(1).map(|before| way[before]),
            top: way[place],
            middle: way[place + 1],
            end: way[place + 2],
            after: way.get(place + 3).copied(),
        })
    }

    /// Whether another pair of limbs begins at `joint` or below it, beside `pair`.
    fn has_pair_beside(&self, joint: usize, pair: [usize; 2]) -> bool {
        self.pair_among(joint, pair).is_some()
            || (joint + 1..self.skeleton.joint_count())
                .any(|below| self.is_trunk_of(below, joint, pair) && self.pair_at(below).is_some())
    }

    /// Whether `joint` lies below the pelvis, but in neither leg.
    fn is_trunk_of(&self, joint: usize, pelvis: usize, legs: [usize; 2]) -> bool {
        joint != pelvis
            && self.skeleton.is_at_or_below(joint, pelvis)
            && !legs
                .iter()
                .any(|&leg| self.skeleton.is_at_or_below(joint, leg))
    }
}

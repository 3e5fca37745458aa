//! A figure's skeleton at rest.

use glam::{Quat, Vec3};

use super::bind::bind_poses;
use super::document::Document;
use super::tree::{Placement, Tree};
use super::{Accessors, Context};
use crate::unspoken::{Bone, LengthUnit, tip_to_tip};
use crate::{Error, Skeleton, SkeletonJoint, SkeletonPose, mapping};

/// The figure that an animation moves.
pub(super) struct Figure {
    pub(super) skeleton: Skeleton,
    pub(super) joints: Vec<Joint>,
    pub(super) metres_per_unit: f64,
    pub(super) notes: Vec<String>,
}

/// The node of a joint of the skeleton, and how it stands where nothing moves it.
pub(super) struct Joint {
    pub(super) node: usize,
    /// Its node's own placement in its parent.
    pub(super) local: Placement,
    /// What its parent's frame is in the skeleton's: for the topmost joints, all nodes above;
    /// for others, the scales above. Metres.
    pub(super) base: Placement,
}

impl Joint {
    /// A node's rotation and translation as the skeleton has them.
    pub(super) fn placed(&self, rotation: Quat, translation: Vec3) -> (Quat, Vec3) {
        let placed = self.base.of(&Placement {
            rotation,
            position: translation,
            scale: 1.0,
        });
        (placed.rotation, placed.position)
    }
}

impl Figure {
    /// The figure of `nodes`, parents first, with the rest pose of a skin.
    pub(super) fn new(
        document: &Document<'_>,
        tree: &Tree<'_>,
        nodes: Vec<usize>,
        skin: Option<usize>,
        accessors: &mut Accessors<'_>,
        context: &Context<'_>,
    ) -> Result<Self, Error> {
        if nodes.is_empty() {
            let expected = "an animation that turns or moves nodes";
            return Err(context.format("the file", expected, "none"));
        }
        let place_of = |node: usize| nodes.iter().position(|&other| other == node);
        let parents: Vec<Option<usize>> = nodes
            .iter()
            .map(|&node| tree.parent(node).and_then(place_of))
            .collect();
        let mut notes = Vec::new();
        let mut joints = Vec::with_capacity(nodes.len());
        let mut worlds = Vec::with_capacity(nodes.len());
        for (&node, parent) in nodes.iter().zip(&parents) {
            let local = tree.local(node, context)?;
            let above = tree.base(node, context)?;
            if tree.is_stretched(node) && !tree.node(node).children.is_empty() {
                let name = tree.name(node);
                notes.push(format!("scale: {name} differs by axis; its mean is taken"));
            }
            worlds.push(above.of(&local));
            let base = match parent {
                None => above,
                Some(_) => Placement {
                    rotation: Quat::IDENTITY,
                    position: Vec3::ZERO,
                    scale: above.scale,
                },
            };
            joints.push(Joint { node, local, base });
        }

        let own = SkeletonPose {
            rotations: worlds.iter().map(|world| world.rotation).collect(),
            positions: worlds.iter().map(|world| world.position).collect(),
        };
        let skeleton = |pose: &SkeletonPose| skeleton(tree, &nodes, &parents, pose, &worlds);
        let binds = match skin {
            Some(skin) => bind_poses(document, tree, &nodes, skin, &own, accessors, context)?,
            None => Vec::new(),
        };
        let mut chosen = None;
        for bind in &binds {
            let candidate = skeleton(bind)?;
            if chosen.is_none() && stands_upright(&candidate) {
                chosen = Some(candidate);
            }
        }
        let mut skeleton = match chosen {
            Some(skeleton) => skeleton,
            None => {
                if skin.is_some() {
                    let why = match binds.is_empty() {
                        true => "the skin has no inverse bind matrices of use",
                        false => "the bind pose does not stand upright",
                    };
                    notes.push(format!("rest pose: the nodes' own, since {why}"));
                }
                skeleton(&own)?
            }
        };

        let scale = worlds.first().map_or(1.0, |world| world.scale);
        if (scale - 1.0).abs() > 1e-3 {
            notes.push(format!(
                "scale: nodes above and at the root scale bones by {scale}"
            ));
        }
        let unit = unit(&skeleton, context.options.unit, &mut notes);
        let metres = unit.metres() as f32;
        if metres != 1.0 {
            skeleton = scaled(&skeleton, metres)?;
            for joint in &mut joints {
                joint.base.scale *= metres;
                joint.base.position *= metres;
            }
        }
        Ok(Self {
            skeleton,
            joints,
            metres_per_unit: unit.metres(),
            notes,
        })
    }
}

/// The skeleton that stands so in the world.
fn skeleton(
    tree: &Tree<'_>,
    nodes: &[usize],
    parents: &[Option<usize>],
    pose: &SkeletonPose,
    worlds: &[Placement],
) -> Result<Skeleton, Error> {
    let joints = nodes.iter().enumerate().map(|(index, &node)| {
        let (rotation, position) = (pose.rotations[index], pose.positions[index]);
        let (rest_rotation, rest_translation) = match parents[index] {
            None => (rotation, position),
            Some(parent) => {
                let parent_from_world = pose.rotations[parent].inverse();
                (
                    parent_from_world * rotation,
                    parent_from_world * (position - pose.positions[parent]),
                )
            }
        };
        let ends_chain = !parents.contains(&Some(index));
        // Bare nodes below the last joint mark where its bone ends.
        let tips = tree.node(node).children.iter().filter(|&&child| {
            let child = tree.node(child);
            ends_chain && child.mesh.is_none() && child.translation.is_some()
        });
        let tip = |&child: &usize| {
            let offset = tree
                .node(child)
                .translation
                .map_or(Vec3::ZERO, Vec3::from_array);
            offset * worlds[index].scale
        };
        SkeletonJoint {
            name: tree.name(node),
            parent: parents[index],
            rest_translation,
            rest_rotation: rest_rotation.normalize(),
            end_sites: tips.map(tip).filter(|tip| tip.length() < 1e12).collect(),
        }
    });
    Skeleton::new(joints.collect())
}

/// Whether the shoulders stand above the ankles; true of what is no human, which has neither.
fn stands_upright(skeleton: &Skeleton) -> bool {
    let Some(human) = mapping::find_joints(skeleton).map(|found| found.joints) else {
        return true;
    };
    let pose = skeleton.rest_pose();
    let middle = |[a, b]: [usize; 2]| (pose.positions[a] + pose.positions[b]) / 2.0;
    let upright = middle(human.shoulders()) - middle(human.ankles());
    upright.y > 0.8 * upright.length()
}

/// Metres, unless only another unit makes a human.
fn unit(skeleton: &Skeleton, given: Option<LengthUnit>, notes: &mut Vec<String>) -> LengthUnit {
    if let Some(given) = given {
        return given;
    }
    let bones = skeleton.joints().iter().map(|joint| Bone {
        parent: joint.parent,
        length: joint.rest_translation.length(),
        tips: joint.end_sites.len(),
        longest_tip: joint
            .end_sites
            .iter()
            .map(|tip| tip.length())
            .fold(0.0, f32::max),
    });
    let size = tip_to_tip(&bones.collect::<Vec<_>>());
    let others = [
        (LengthUnit::Centimetre, "centimetres"),
        (LengthUnit::Millimetre, "millimetres"),
        (LengthUnit::Inch, "inches"),
    ];
    let other = others.into_iter().find(|(unit, _)| unit.is_human(size));
    match other {
        Some((unit, name)) if !LengthUnit::Metre.is_human(size) => {
            notes.push(format!(
                "unit: {name}, since the longest way through the skeleton is {size:.1} of the \
                 file's units, which should be metres"
            ));
            unit
        }
        _ => LengthUnit::Metre,
    }
}

fn scaled(skeleton: &Skeleton, factor: f32) -> Result<Skeleton, Error> {
    let joints = skeleton.joints().iter().map(|joint| SkeletonJoint {
        rest_translation: joint.rest_translation * factor,
        end_sites: joint.end_sites.iter().map(|&tip| tip * factor).collect(),
        ..joint.clone()
    });
    Skeleton::new(joints.collect())
}

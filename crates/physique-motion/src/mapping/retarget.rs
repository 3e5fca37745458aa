//! Frames of the source to frames of the body.

use glam::{Quat, Vec3};
use physique_body::Joint;

use super::{
    MappingOptions,
    alignment::{AlignedBy, Alignment, LIMB_BONES},
    axes::degrees_between,
    body_rest::BodyRest,
    centre_of_mass,
    figure::ball_of_foot,
    fit_error::{FitError, FitErrorGatherer},
    floor::Floor,
    human_joints::HumanJoints,
    legs::Leg,
    range::RangeCheck,
    soles::Soles,
    spine::SpineWeights,
    twist::share_wrist_twist,
};
use crate::{Error, Motion, SkeletonClip, SkeletonPose};

/// All that is constant over a clip.
pub(super) struct Retarget<'a> {
    human: &'a HumanJoints,
    body: &'a BodyRest,
    alignment: Alignment,
    spine: SpineWeights,
    soles: Soles,
    /// Turns the source's world before anything else.
    level_from_source: Quat,
    /// Body size over source size.
    scale: f32,
    plant_feet: bool,
    share_twist: bool,
    /// Height in the source's world that becomes height 0.
    ground: f32,
    /// By side: the joint and place in its frame of the ball of the foot.
    balls: [Option<(usize, Vec3)>; 2],
}

/// What a run found out.
#[derive(Clone, Debug)]
pub(super) struct Outcome {
    pub(super) aligned_by: AlignedBy,
    pub(super) scale: f32,
    pub(super) ground: f32,
    pub(super) fit_error: FitError,
    pub(super) largest_leg_correction_degrees: f32,
    pub(super) notes: Vec<String>,
}

impl<'a> Retarget<'a> {
    pub(super) fn new(
        clip: &SkeletonClip,
        human: &'a HumanJoints,
        body: &'a BodyRest,
        alignment: Alignment,
        floor: &Floor,
        options: &MappingOptions,
    ) -> Result<Self, Error> {
        let pose = clip.pose(0);
        let distance = |a: usize, b: usize| pose.positions[a].distance(pose.positions[b]);
        let legs = human
            .sides()
            .map(|limbs| distance(limbs.hip, limbs.knee) + distance(limbs.knee, limbs.ankle));
        let leg = (legs[0] + legs[1]) / 2.0;
        if !(leg.is_finite() && leg > 1e-3) {
            return Err(Error::NotHuman {
                problem: format!("its legs are {leg} m long"),
            });
        }
        let scale = body.leg_length() / leg;
        Ok(Self {
            human,
            body,
            alignment,
            spine: SpineWeights::new(human, &pose, body),
            ground: ground(&floor.soles, body, scale),
            soles: floor.soles,
            level_from_source: floor.level_from_source(),
            scale,
            plant_feet: options.plant_feet,
            share_twist: options.share_wrist_twist,
            balls: human
                .sides()
                .map(|limbs| ball_of_foot(clip.skeleton(), limbs)),
        })
    }

    /// Maps all frames from `first_frame` on.
    pub(super) fn run(
        &self,
        clip: &SkeletonClip,
        first_frame: usize,
    ) -> Result<(Motion, Outcome), Error> {
        let ground = self.ground;
        let frames = clip.frame_count() - first_frame;
        let mut root_translation = Vec::with_capacity(frames);
        let mut rotations = Vec::with_capacity(frames * Joint::COUNT);
        let mut errors = FitErrorGatherer::default();
        let mut range = RangeCheck::default();
        let mut largest_turn = 0.0f32;
        let mut pose = SkeletonPose::default();
        for frame in first_frame..clip.frame_count() {
            clip.pose_into(frame, &mut pose);
            pose.turn(self.level_from_source);
            let mut world = self.orient(&pose);
            range.add(&world);
            if self.share_twist {
                self.share_wrist_twist(&mut world);
            }
            let mut pelvis = self.place_pelvis(&pose, &world, ground);
            if self.plant_feet {
                pelvis += self.to_balance(&pose, &world, pelvis, ground);
                let turn = self.plant_feet(&pose, &mut world, pelvis, ground);
                largest_turn = largest_turn.max(turn);
            }
            let positions = self.positions(&world, pelvis);
            for joint in Joint::ALL {
                if let Some(source) = self.human.source_of(joint) {
                    let goal = self.scaled(pose.positions[source], ground);
                    errors.add(joint, goal.distance(positions[joint.index()]));
                }
            }
            for (upper, lower) in LIMB_BONES {
                let ends = [upper, lower].map(|joint| self.human.source_of(joint));
                if let [Some(from), Some(to)] = ends {
                    let source = pose.positions[to] - pose.positions[from];
                    let result = positions[lower.index()] - positions[upper.index()];
                    errors.add_bone(upper, degrees_between(source, result));
                }
            }
            root_translation.push(pelvis - self.body.joint(Joint::Pelvis));
            rotations.extend(Joint::ALL.map(|joint| match joint.parent() {
                None => world[joint.index()],
                Some(parent) => world[parent.index()].inverse() * world[joint.index()],
            }));
        }
        let outcome = Outcome {
            aligned_by: self.alignment.by,
            scale: self.scale,
            ground,
            fit_error: errors.finish(),
            largest_leg_correction_degrees: largest_turn,
            notes: self
                .notes(ground)
                .into_iter()
                .chain(range.notes())
                .collect(),
        };
        Ok((
            Motion::new(clip.frame_rate(), None, root_translation, rotations)?,
            outcome,
        ))
    }

    /// The same with the source's heights left alone.
    pub(super) fn on_ground_of_source(self) -> Self {
        Self {
            ground: 0.0,
            ..self
        }
    }

    fn notes(&self, ground: f32) -> Vec<String> {
        let mut notes: Vec<String> = self.alignment.note.iter().cloned().collect();
        if ground.abs() > 0.05 {
            notes.push(format!(
                "the source's feet stand {ground:.2} m above its height 0"
            ));
        }
        notes
    }

    /// A place of the source's world in the body's size, over the body's ground.
    fn scaled(&self, position: Vec3, ground: f32) -> Vec3 {
        (position - Vec3::Y * ground) * self.scale
    }

    /// World orientations of the body's joints.
    fn orient(&self, pose: &SkeletonPose) -> [Quat; Joint::COUNT] {
        let mut world = [Quat::IDENTITY; Joint::COUNT];
        self.spine
            .orient(self.human, &self.alignment, pose, &mut world);
        for joint in Joint::ALL {
            let is_trunk = matches!(
                joint,
                Joint::Pelvis
                    | Joint::Spine1
                    | Joint::Spine2
                    | Joint::Spine3
                    | Joint::Neck
                    | Joint::Head
            );
            let Some(parent) = joint.parent().filter(|_| !is_trunk) else {
                continue;
            };
            world[joint.index()] = match self.human.source_of(joint) {
                Some(source) => self.alignment.world_from_body(pose, source),
                None => world[parent.index()],
            };
        }
        world
    }

    fn share_wrist_twist(&self, world: &mut [Quat; Joint::COUNT]) {
        for [_, _, elbow, wrist] in Joint::ARMS {
            let forearm = self.body.bone(elbow, wrist);
            world[elbow.index()] =
                share_wrist_twist(world[elbow.index()], world[wrist.index()], forearm);
        }
    }

    /// Where the pelvis is when the middle of the hips is where the source has it.
    fn place_pelvis(&self, pose: &SkeletonPose, world: &[Quat; Joint::COUNT], ground: f32) -> Vec3 {
        let [left, right] = self.human.hips().map(|hip| pose.positions[hip]);
        let hips = self.scaled((left + right) / 2.0, ground);
        let from_pelvis = self.body.middle_of_hips() - self.body.joint(Joint::Pelvis);
        hips - world[Joint::Pelvis.index()] * from_pelvis
    }

    /// How far the pelvis must move for the centre of mass to be over the feet where the source
    /// has it.
    ///
    /// In a walk the trunk sways to one side and the hips to the other, and the centre of mass
    /// hardly at all. A longer trunk that turns by the same angles sways too far: 1 cm at the pace
    /// of steps is 10 cm of zero moment point.
    fn to_balance(
        &self,
        pose: &SkeletonPose,
        world: &[Quat; Joint::COUNT],
        pelvis: Vec3,
        ground: f32,
    ) -> Vec3 {
        /// Beyond this, in metres, hips keep their place rather than the centre of mass.
        const LONGEST: f32 = 0.1;
        let mut planted = *world;
        self.plant_feet(pose, &mut planted, pelvis, ground);
        let body = self.mass_of_body(&self.positions(&planted, pelvis));
        let way = centre_of_mass::between(&body, &self.mass_of_source(pose, ground));
        centre_of_mass::pelvis_way(way, LONGEST)
    }

    fn mass_of_body(&self, positions: &[Vec3; Joint::COUNT]) -> centre_of_mass::Figure {
        let at = |joint: Joint| positions[joint.index()];
        let spine = [
            at(Joint::LeftHip).midpoint(at(Joint::RightHip)),
            at(Joint::Pelvis),
            at(Joint::Spine1),
            at(Joint::Spine2),
            at(Joint::Spine3),
            at(Joint::LeftShoulder).midpoint(at(Joint::RightShoulder)),
        ];
        centre_of_mass::Figure {
            joints: positions.map(Some),
            trunk: centre_of_mass::trunk_centre(spine.into_iter()),
        }
    }

    fn mass_of_source(&self, pose: &SkeletonPose, ground: f32) -> centre_of_mass::Figure {
        let at = |joint: usize| self.scaled(pose.positions[joint], ground);
        let middle = |[left, right]: [usize; 2]| at(left).midpoint(at(right));
        let spine = [self.human.pelvis]
            .into_iter()
            .chain(self.human.spine.iter().copied());
        let spine = std::iter::once(middle(self.human.hips()))
            .chain(spine.map(at))
            .chain([middle(self.human.shoulders())]);
        centre_of_mass::Figure {
            joints: Joint::ALL.map(|joint| self.human.source_of(joint).map(at)),
            trunk: centre_of_mass::trunk_centre(spine),
        }
    }

    /// Turns thighs and shins until ankles and soles are where the scaled source has them; gives
    /// the largest turn in degrees.
    fn plant_feet(
        &self,
        pose: &SkeletonPose,
        world: &mut [Quat; Joint::COUNT],
        pelvis: Vec3,
        ground: f32,
    ) -> f32 {
        let mut largest = 0.0f32;
        for (side, [hip, knee, ankle, foot]) in Joint::LEGS.into_iter().enumerate() {
            let limbs = self.human.sides()[side];
            let mut goal = self.scaled(pose.positions[limbs.ankle], ground);
            if let Some((joint, offset)) = self.balls[side] {
                // What touches the ground is at the same height over it as in the source.
                let ball = pose.positions[joint] + pose.rotations[joint] * offset;
                let ankle_of_source = pose.positions[limbs.ankle];
                let source = self.scale * self.soles.over_floor(ankle_of_source, Some(ball));
                let sole = self.scaled(Vec3::Y * self.soles.ankle_height, ground).y
                    - self.body.height(ankle);
                let ball = (world[ankle.index()] * self.body.bone(ankle, foot)).y + goal.y;
                let result = (goal.y - self.body.height(ankle)).min(ball - self.body.height(foot));
                goal.y += source + sole - result;
            }
            let before = Leg {
                hip: pelvis + world[0] * self.body.offset(hip),
                bones: [self.body.bone(hip, knee), self.body.bone(knee, ankle)],
                world_from_bone: [world[hip.index()], world[knee.index()]],
            };
            let after = before.reaching(goal);
            for (bone, joint) in [hip, knee].into_iter().enumerate() {
                let turn = before.world_from_bone[bone].angle_between(after.world_from_bone[bone]);
                largest = largest.max(turn.to_degrees());
                world[joint.index()] = after.world_from_bone[bone];
            }
        }
        largest
    }

    /// Positions of all joints in the world.
    fn positions(&self, world: &[Quat; Joint::COUNT], pelvis: Vec3) -> [Vec3; Joint::COUNT] {
        let mut positions = [pelvis; Joint::COUNT];
        for joint in Joint::ALL {
            if let Some(parent) = joint.parent() {
                positions[joint.index()] =
                    positions[parent.index()] + world[parent.index()] * self.body.offset(joint);
            }
        }
        positions
    }
}

/// Where the soles of a standing foot are in the source's world, unless its feet never come down
/// to its height 0.
fn ground(soles: &Soles, body: &BodyRest, scale: f32) -> f32 {
    /// A foot that stays this much over height 0 is in the air rather than on the ground.
    const IN_THE_AIR: f32 = 0.12;
    let sole = soles.ankle_height - body.height(Joint::LeftAnkle) / scale;
    if sole > IN_THE_AIR { 0.0 } else { sole }
}

//! Which joints of a foreign skeleton are the human ones.

use physique_body::Joint;

use crate::Skeleton;

/// Arm and leg of one side, as indices into a foreign skeleton.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Limbs {
    /// Clavicle.
    pub collar: Option<usize>,
    /// Top of the upper arm.
    pub shoulder: usize,
    /// Top of the forearm.
    pub elbow: usize,
    /// Top of the hand.
    pub wrist: Option<usize>,
    /// Top of the thigh.
    pub hip: usize,
    /// Top of the shin.
    pub knee: usize,
    /// Top of the foot.
    pub ankle: usize,
    /// Ball of the foot, where the toes begin.
    pub foot: Option<usize>,
}

/// The human joints of a foreign skeleton, as indices into it.
///
/// Hips, knees, ankles, shoulders and elbows must be there; the rest may be missing. Spine and
/// neck hold any number of joints, from the bottom up.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct HumanJoints {
    /// The joint that carries hips and spine.
    pub pelvis: usize,
    /// Between pelvis and neck.
    pub spine: Vec<usize>,
    /// Between the last spine joint and the head.
    pub neck: Vec<usize>,
    /// Bottom of the head.
    pub head: Option<usize>,
    /// The body's own left.
    pub left: Limbs,
    /// The body's own right.
    pub right: Limbs,
}

impl HumanJoints {
    /// Left and right hip.
    pub const fn hips(&self) -> [usize; 2] {
        [self.left.hip, self.right.hip]
    }

    /// Left and right ankle.
    pub const fn ankles(&self) -> [usize; 2] {
        [self.left.ankle, self.right.ankle]
    }

    /// Left and right shoulder.
    pub const fn shoulders(&self) -> [usize; 2] {
        [self.left.shoulder, self.right.shoulder]
    }

    /// The joint that carries neck and arms: the last of the spine, or the pelvis.
    pub fn chest(&self) -> usize {
        self.spine.last().copied().unwrap_or(self.pelvis)
    }

    /// Left and right limbs.
    pub const fn sides(&self) -> [&Limbs; 2] {
        [&self.left, &self.right]
    }

    /// All joints, some more than once where one joint serves as two.
    pub(super) fn all(&self) -> impl Iterator<Item = usize> + '_ {
        let chains = self.spine.iter().chain(&self.neck).copied();
        let single = Joint::ALL
            .into_iter()
            .filter_map(|joint| self.source_of(joint));
        single.chain(chains)
    }

    /// The source joint of a body joint, where one joint is the source. Spine and neck are
    /// resampled from chains instead, so they have none.
    pub const fn source_of(&self, joint: Joint) -> Option<usize> {
        match joint {
            Joint::Pelvis => Some(self.pelvis),
            Joint::Spine1 | Joint::Spine2 | Joint::Spine3 | Joint::Neck => None,
            Joint::Head => self.head,
            Joint::LeftCollar => self.left.collar,
            Joint::LeftShoulder => Some(self.left.shoulder),
            Joint::LeftElbow => Some(self.left.elbow),
            Joint::LeftWrist => self.left.wrist,
            Joint::LeftHip => Some(self.left.hip),
            Joint::LeftKnee => Some(self.left.knee),
            Joint::LeftAnkle => Some(self.left.ankle),
            Joint::LeftFoot => self.left.foot,
            Joint::RightCollar => self.right.collar,
            Joint::RightShoulder => Some(self.right.shoulder),
            Joint::RightElbow => Some(self.right.elbow),
            Joint::RightWrist => self.right.wrist,
            Joint::RightHip => Some(self.right.hip),
            Joint::RightKnee => Some(self.right.knee),
            Joint::RightAnkle => Some(self.right.ankle),
            Joint::RightFoot => self.right.foot,
        }
    }

    /// The first way in which the joints do not form a human tree; `None` for a good one.
    pub fn problem(&self, skeleton: &Skeleton) -> Option<String> {
        let name = |joint: usize| &skeleton.joints()[joint].name;
        let mut bones = Vec::new();
        for limbs in self.sides() {
            bones.extend([(limbs.hip, limbs.knee), (limbs.knee, limbs.ankle)]);
            bones.push((limbs.shoulder, limbs.elbow));
            bones.extend(limbs.wrist.map(|wrist| (limbs.elbow, wrist)));
            bones.extend(limbs.foot.map(|foot| (limbs.ankle, foot)));
            bones.extend(limbs.collar.map(|collar| (collar, limbs.shoulder)));
        }
        let middle = [self.pelvis].into_iter().chain(self.spine.iter().copied());
        let middle: Vec<usize> = middle
            .chain(self.neck.iter().copied())
            .chain(self.head)
            .collect();
        bones.extend(middle.windows(2).map(|bone| (bone[0], bone[1])));
        for (upper, lower) in bones {
            if upper == lower || !skeleton.is_at_or_below(lower, upper) {
                let (upper, lower) = (name(upper), name(lower));
                return Some(format!("{lower} does not hang below {upper}"));
            }
        }
        for (left, right, what) in [
            (self.left.hip, self.right.hip, "leg"),
            (self.left.shoulder, self.right.shoulder, "arm"),
        ] {
            let one_limb =
                skeleton.is_at_or_below(left, right) || skeleton.is_at_or_below(right, left);
            if one_limb {
                let (left, right) = (name(left), name(right));
                return Some(format!("{left} and {right} belong to the same {what}"));
            }
        }
        None
    }
}

/// Human joints while they are being gathered, by name or by shape.
#[derive(Clone, Debug, Default)]
pub(super) struct Gathered {
    pub(super) joints: [Option<usize>; Joint::COUNT],
    pub(super) spine: Vec<usize>,
    pub(super) neck: Vec<usize>,
}

impl Gathered {
    /// The joints without which there is no body.
    const NEEDED: [Joint; 11] = [
        Joint::Pelvis,
        Joint::LeftHip,
        Joint::RightHip,
        Joint::LeftKnee,
        Joint::RightKnee,
        Joint::LeftAnkle,
        Joint::RightAnkle,
        Joint::LeftShoulder,
        Joint::RightShoulder,
        Joint::LeftElbow,
        Joint::RightElbow,
    ];

    /// Needed joints that have not been found.
    pub(super) fn missing(&self) -> Vec<Joint> {
        let needed = Self::NEEDED.into_iter();
        needed
            .filter(|joint| self.joints[joint.index()].is_none())
            .collect()
    }

    /// Number of joints found.
    pub(super) fn count(&self) -> usize {
        self.joints.iter().flatten().count() + self.spine.len() + self.neck.len()
    }

    /// The joints, if all that are needed were found.
    pub(super) fn finish(self) -> Option<HumanJoints> {
        let get = |joint: Joint| self.joints[joint.index()];
        let left = Limbs {
            collar: get(Joint::LeftCollar),
            shoulder: get(Joint::LeftShoulder)?,
            elbow: get(Joint::LeftElbow)?,
            wrist: get(Joint::LeftWrist),
            hip: get(Joint::LeftHip)?,
            knee: get(Joint::LeftKnee)?,
            ankle: get(Joint::LeftAnkle)?,
            foot: get(Joint::LeftFoot),
        };
        let right = Limbs {
            collar: get(Joint::RightCollar),
            shoulder: get(Joint::RightShoulder)?,
            elbow: get(Joint::RightElbow)?,
            wrist: get(Joint::RightWrist),
            hip: get(Joint::RightHip)?,
            knee: get(Joint::RightKnee)?,
            ankle: get(Joint::RightAnkle)?,
            foot: get(Joint::RightFoot),
        };
        Some(HumanJoints {
            pelvis: get(Joint::Pelvis)?,
            head: get(Joint::Head),
            spine: self.spine,
            neck: self.neck,
            left,
            right,
        })
    }
}

impl From<HumanJoints> for Gathered {
    fn from(human: HumanJoints) -> Self {
        Self {
            joints: Joint::ALL.map(|joint| human.source_of(joint)),
            spine: human.spine,
            neck: human.neck,
        }
    }
}

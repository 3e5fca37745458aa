//! What text formats leave unsaid of a figure: its length unit and its up axis.

use crate::{SkeletonClip, SkeletonPose, UpAxis, clip::spread, mapping};

/// The length unit of a file.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum LengthUnit {
    /// 1 m.
    Metre,
    /// 1 cm.
    Centimetre,
    /// 1 mm.
    Millimetre,
    /// 2.54 cm.
    Inch,
    /// (1 / 0.45) inch = 5.644 cm, the unit of CMU's ASF/AMC recordings.
    Acclaim,
    /// Metres in one unit of the file.
    Metres(f64),
}

impl LengthUnit {
    /// The units that inference chooses from.
    const NAMED: [Self; 5] = [
        Self::Metre,
        Self::Centimetre,
        Self::Millimetre,
        Self::Inch,
        Self::Acclaim,
    ];

    /// Metres in one unit.
    pub fn metres(self) -> f64 {
        match self {
            Self::Metre => 1.0,
            Self::Centimetre => 0.01,
            Self::Millimetre => 0.001,
            Self::Inch => 0.0254,
            Self::Acclaim => 0.0254 / 0.45,
            Self::Metres(metres) => metres,
        }
    }

    fn name(self) -> &'static str {
        match self {
            Self::Metre => "metres",
            Self::Centimetre => "centimetres",
            Self::Millimetre => "millimetres",
            Self::Inch => "inches",
            Self::Acclaim => "Acclaim units of 5.644 cm",
            Self::Metres(_) => "units",
        }
    }

    /// How far off the size of an adult a figure is in this unit: |ln(size / adult)|. `tip_to_tip`
    /// is the longest way through its skeleton, see [`tip_to_tip`].
    fn misfit(self, tip_to_tip: f32) -> f64 {
        /// Foot to the other hand of an adult of 1.7 m, along the bones.
        const ADULT_METRES: f64 = 2.3;
        (f64::from(tip_to_tip) * self.metres() / ADULT_METRES)
            .ln()
            .abs()
    }

    /// Whether a figure has a human's size in this unit, a child's or a giant's included.
    pub(crate) fn is_human(self, tip_to_tip: f32) -> bool {
        self.misfit(tip_to_tip) <= 0.6
    }
}

/// One joint of a figure whose unit is not known yet.
pub(crate) struct Bone {
    pub(crate) parent: Option<usize>,
    /// From the parent's joint to this one.
    pub(crate) length: f32,
    /// Tips of bones that end here without a joint.
    pub(crate) tips: usize,
    /// The farthest of them.
    pub(crate) longest_tip: f32,
}

/// Length of the longest way through the skeleton, tip to tip, in the file's unit.
///
/// Bones above the first branching do not count: they place the figure in the world.
pub(crate) fn tip_to_tip(bones: &[Bone]) -> f32 {
    // Ways that go on below a joint.
    let mut ways: Vec<usize> = bones.iter().map(|bone| bone.tips).collect();
    for parent in bones.iter().filter_map(|bone| bone.parent) {
        ways[parent] += 1;
    }
    // Longest way down from each joint, children before parents.
    let mut down: Vec<f32> = bones.iter().map(|bone| bone.longest_tip).collect();
    let mut through = down.clone();
    let mut widest = 0.0f32;
    for (index, bone) in bones.iter().enumerate().rev() {
        widest = widest.max(through[index]);
        let Some(parent) = bone.parent else {
            continue;
        };
        let arm = down[index] + bone.length;
        if ways[parent] > 1 {
            through[parent] = through[parent].max(down[parent] + arm);
        }
        down[parent] = down[parent].max(arm);
    }
    widest
}

/// The unit that makes the longest way through the skeleton human, and a note that says so.
pub(crate) fn unit(tip_to_tip: f32) -> (LengthUnit, String) {
    if tip_to_tip <= 0.0 {
        let note = "unit: metres, since the skeleton has no length";
        return (LengthUnit::Metre, note.into());
    }
    let unit = LengthUnit::NAMED
        .into_iter()
        .min_by(|a, b| a.misfit(tip_to_tip).total_cmp(&b.misfit(tip_to_tip)))
        .unwrap_or(LengthUnit::Metre);
    let mut note = format!(
        "unit: {}, since the longest way through the skeleton is {tip_to_tip:.1} of the file's \
         units, so {:.2} m",
        unit.name(),
        f64::from(tip_to_tip) * unit.metres(),
    );
    if !unit.is_human(tip_to_tip) {
        note += " (unlike an adult's 2.3 m: state the unit if this is wrong)";
    }
    (unit, note)
}

/// The axis along which the figure stands, and a note where that is not Y. Y where no human is
/// found in the skeleton.
pub(crate) fn up_axis(clip: &SkeletonClip) -> (UpAxis, Option<String>) {
    let Some(human) = mapping::find_joints(clip.skeleton()).map(|found| found.joints) else {
        return (UpAxis::Y, None);
    };
    let mut pose = SkeletonPose::default();
    let (mut along_z, mut frames) = (0, 0);
    for frame in spread(clip.frame_count(), 64) {
        clip.pose_into(frame, &mut pose);
        let middle = |[a, b]: [usize; 2]| (pose.positions[a] + pose.positions[b]) / 2.0;
        let upright = middle(human.shoulders()) - middle(human.ankles());
        along_z += usize::from(upright.z > upright.y.abs() && upright.z > upright.x.abs());
        frames += 1;
    }
    if frames > 0 && along_z * 5 >= frames * 4 {
        let note = "up axis: Z, since the shoulders stand above the ankles along it";
        (UpAxis::Z, Some(note.into()))
    } else {
        (UpAxis::Y, None)
    }
}

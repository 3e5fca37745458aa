//! Any humanoid skeleton to the body's 22 joints.
//!
//! 1. **Which joint is which** ([`find_joints`]): by the names of a family of rigs, by the shape
//!    of the tree, or by a mapping file ([`NameTable`]).
//! 2. **What its axes mean** ([`AlignedBy`]): for each joint, how it is turned when the body
//!    would be at rest; from a rest pose in which a person stands, a T-pose in the first frame,
//!    the one that is known of the rig, or the anatomy that the clip shows.
//! 3. **Rotations**: the body's joint takes the source's world orientation through that constant;
//!    limbs point the same way in the world, twist is the source's. A spine of any number of
//!    joints is resampled.
//! 4. **Proportions**: the path is scaled by the length of the legs, and legs are corrected so
//!    that ankles stay where the scaled source has them and soles at their height over the
//!    ground. The world is not turned: a clip keeps its heading.
//! 5. **The error is said**: [`Mapped::report`].

mod alignment;
mod anatomy;
mod axes;
mod body_rest;
mod centre_of_mass;
mod figure;
mod find;
mod fit_error;
mod floor;
mod foot_tracks;
mod human_joints;
mod known_t_pose;
mod legs;
mod name;
mod name_table;
mod own_body;
mod range;
mod reference;
mod report;
mod retarget;
mod shape;
mod sides;
mod slope;
mod soles;
mod spine;
mod t_pose;
mod twist;

pub use alignment::AlignedBy;
pub use body_rest::BodyRest;
pub use find::{Found, FoundBy, find_joints};
pub(crate) use fit_error::FitErrorGatherer;
pub use fit_error::{Angles, Distances, FitError};
pub use human_joints::{HumanJoints, Limbs};
pub use name_table::NameTable;
pub use report::{JointSource, MappingReport};

use crate::{Error, Motion, SkeletonClip};
use alignment::Alignment;
use floor::Floor;
use foot_tracks::FootTracks;
use retarget::Retarget;

/// How to map.
#[derive(Clone, Debug, PartialEq)]
pub struct MappingOptions {
    /// Names that go before what is found; see [`NameTable`].
    pub table: Option<NameTable>,
    /// Keep a first frame that is a T-pose put before the motion; dropped by default.
    pub keep_t_pose: bool,
    /// Correct the legs so that feet keep their scaled places and heights; on by default.
    /// Otherwise leg bones keep the source's directions exactly and feet slide by what the
    /// proportions differ.
    pub plant_feet: bool,
    /// Turn the world so that the floor is level, where steps show that it slopes by 0.3 to 2
    /// degrees as a whole: the recording's own frame was not level. On by default.
    pub level_floor: bool,
    /// Let forearms take part of the twist of the wrists, as forearms do; on by default. Hands
    /// and the directions of all bones stay.
    pub share_wrist_twist: bool,
}

impl Default for MappingOptions {
    fn default() -> Self {
        Self {
            table: None,
            keep_t_pose: false,
            plant_feet: true,
            level_floor: true,
            share_wrist_twist: true,
        }
    }
}

/// A motion of the body and how it came about.
#[derive(Clone, Debug, PartialEq)]
pub struct Mapped {
    /// The motion on the body's 22 joints.
    pub motion: Motion,
    /// What matched what, and how far the result is from the source.
    pub report: MappingReport,
}

/// Maps a clip of any humanoid skeleton to the body.
///
/// A clip of the body's own skeleton ([`SkeletonClip::from_motion`]) comes back as it was.
///
/// Cost: about 10 microseconds a frame, and some 400 frames more to find the alignment.
///
/// # Errors
/// [`Error::NotHuman`] when the skeleton has no body in it; [`Error::NoFrames`] for an empty clip.
pub fn map_to_body(
    clip: &SkeletonClip,
    body: &BodyRest,
    options: &MappingOptions,
) -> Result<Mapped, Error> {
    let mut found = find::find_joints_with(clip.skeleton(), options.table.as_ref())?;
    if clip.frame_count() == 0 {
        return Err(Error::NoFrames);
    }
    let left_is_left = sides::agreement(clip, &found.joints);
    let mut notes = Vec::new();
    if left_is_left < 0.0 && found.by == FoundBy::Shape {
        found.joints = sides::exchanged(found.joints);
    } else if left_is_left < -0.8 {
        notes.push(
            "left and right look exchanged: toes point backwards for a body with these sides"
                .to_owned(),
        );
    }
    let is_own = own_body::is_own(clip.skeleton(), body);
    let options = if is_own {
        &own_body::unchanged(options)
    } else {
        options
    };
    let t_pose_frames = t_pose::leading_frames(clip, &found.joints);
    let first_frame = if options.keep_t_pose {
        0
    } else {
        t_pose_frames
    };
    let feet = FootTracks::of(clip, &found.joints, t_pose_frames);
    let floor = Floor::under(feet, body, options.level_floor);
    notes.extend(floor.notes());
    let known_t_pose = NameTable::known_t_pose(&found.by, options.table.as_ref());
    let leads_with_t_pose = t_pose_frames > 0;
    let alignment = Alignment::find(
        clip,
        &found.joints,
        body,
        floor.soles,
        leads_with_t_pose,
        known_t_pose,
    );
    let retarget = Retarget::new(clip, &found.joints, body, alignment, &floor, options)?;
    let retarget = if is_own {
        retarget.on_ground_of_source()
    } else {
        retarget
    };
    let (motion, outcome) = retarget.run(clip, first_frame)?;
    let report = MappingReport::new(clip, found, &outcome, first_frame, notes);
    Ok(Mapped { motion, report })
}

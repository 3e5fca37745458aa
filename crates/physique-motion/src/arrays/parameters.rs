//! Dictionaries of SMPL's parameters, as programs that recover people from video write them.
//!
//! | format | rotations | place | world | frames a second |
//! |---|---|---|---|---|
//! | GVHMR | `smpl_params_global`: `global_orient`, `body_pose` | `transl` | Y up | 30 |
//! | WHAM | `pose_world` `[frames][72]` | `trans_world` | Y up | 30 |
//! | AIST++ | `smpl_poses` `[frames][72]` | `smpl_trans` / `smpl_scaling` | Y up | 60 |
//! | EDGE | `smpl_poses` | `smpl_trans` | Z up | 30 |
//! | TRAM | `pred_rotmat` `[frames][24][3][3]` | `pred_trans` | the camera's | 30 |
//! | Kimodo | `local_rot_mats` `[frames][22][3][3]` | `root_positions` (the pelvis) | Y up | 30 |
//! | any | `global_orient` and `body_pose`, `poses`, or `pose` | `transl` or `trans` | inferred | `fps` |
//!
//! Where a format does not state its frame rate, that of its program is taken, with a note.

use glam::DQuat;
use physique_body::Joint;

use crate::fields::Fields;
use crate::smpl_motion::{
    Path, Rotations, SMPL_JOINTS, SMPLH_JOINTS, SMPLX_JOINTS, SmplMotion, left_out, read_shape,
    space_of, vectors_of,
};
use crate::world::World;
use crate::{Error, FrameRate, Recording, ShapeSpace};

/// Keys under which dictionaries state their frame rate.
pub(super) const RATE_KEYS: [&str; 5] = [
    "fps",
    "mocap_framerate",
    "mocap_frame_rate",
    "frame_rate",
    "framerate",
];

/// One program's dictionary.
pub(super) struct Format {
    pub(super) name: &'static str,
    /// The dictionary within the file's, where there is one.
    within: Option<&'static str>,
    pose: Pose,
    place: &'static str,
    /// By which the place is to be divided.
    scale: Option<&'static str>,
    /// Whether the place is the pelvis's, not SMPL's translation.
    is_pelvis: bool,
    /// Otherwise inferred from how the body stands.
    world: Option<World>,
    /// Usual frames a second, where the file does not say.
    rate: Option<f64>,
}

enum Pose {
    /// All joints in one array.
    Whole(&'static str),
    /// The root and the others.
    Parts(&'static str, &'static str),
}

const ANY: Format = Format {
    name: "SMPL parameters",
    within: None,
    pose: Pose::Whole("poses"),
    place: "trans",
    scale: None,
    is_pelvis: false,
    world: None,
    rate: None,
};

/// In the order in which they are tried.
const FORMATS: [Format; 11] = [
    Format {
        name: "GVHMR results",
        within: Some("smpl_params_global"),
        pose: Pose::Parts("global_orient", "body_pose"),
        place: "transl",
        world: Some(World::YUp),
        rate: Some(30.0),
        ..ANY
    },
    Format {
        name: "WHAM results",
        pose: Pose::Whole("pose_world"),
        place: "trans_world",
        world: Some(World::YUp),
        rate: Some(30.0),
        ..ANY
    },
    Format {
        name: "AIST++",
        pose: Pose::Whole("smpl_poses"),
        place: "smpl_trans",
        scale: Some("smpl_scaling"),
        world: Some(World::YUp),
        rate: Some(60.0),
        ..ANY
    },
    Format {
        name: "EDGE results",
        pose: Pose::Whole("smpl_poses"),
        place: "smpl_trans",
        world: Some(World::ZUp),
        rate: Some(30.0),
        ..ANY
    },
    Format {
        name: "TRAM results",
        pose: Pose::Whole("pred_rotmat"),
        place: "pred_trans",
        world: Some(World::Camera),
        rate: Some(30.0),
        ..ANY
    },
    Format {
        name: "Kimodo",
        pose: Pose::Whole("local_rot_mats"),
        place: "root_positions",
        is_pelvis: true,
        world: Some(World::YUp),
        rate: Some(30.0),
        ..ANY
    },
    Format {
        pose: Pose::Parts("global_orient", "body_pose"),
        place: "transl",
        ..ANY
    },
    Format {
        pose: Pose::Parts("global_orient", "body_pose"),
        ..ANY
    },
    Format {
        place: "transl",
        ..ANY
    },
    ANY,
    Format {
        pose: Pose::Whole("pose"),
        ..ANY
    },
];

/// The format of a dictionary, if its keys are those of one.
pub(super) fn format_of(fields: &Fields<'_>) -> Option<&'static Format> {
    FORMATS.iter().find(|format| match format.within {
        Some(key) => fields.child(key).is_some_and(|child| format.fits(&child)),
        None => format.fits(fields),
    })
}

impl Format {
    fn fits(&self, fields: &Fields<'_>) -> bool {
        let has_pose = match self.pose {
            Pose::Whole(key) => fields.contains(key),
            Pose::Parts(root, body) => fields.contains_all(&[root, body]),
        };
        let scale = self.scale.is_none_or(|key| fields.contains(key));
        has_pose && scale && fields.contains(self.place)
    }

    /// Reads a dictionary of this format.
    ///
    /// # Errors
    /// [`Error::Format`] and [`Error::Array`] with the array; a frame rate that is neither in the
    /// file nor given, where the format has no usual one.
    pub(super) fn read(&self, fields: &mut Fields<'_>) -> Result<Recording, Error> {
        let mut child = self.within.and_then(|key| fields.child(key));
        let fields = child.as_mut().unwrap_or(fields);
        let mut notes = Vec::new();
        let frame_rate = self.frame_rate(fields, &mut notes)?;
        let poses = self.poses(fields)?;
        let frames = poses.frames();
        let place = fields.matrix(self.place, &[3])?;
        if place.rows() != frames {
            let expected = format!("{frames} frames as in the rotations");
            let found = format!("{} frames", place.rows());
            return Err(fields.format(self.place, &expected, &found));
        }
        let scale = self.scale(fields)?;
        let places = vectors_of(&place.values).map(|at| at / scale).collect();
        let space = match (self.name, fields.optional_text("surface_model_type")?.0) {
            // Both recover SMPL-X's body from video, 21 joints and the root.
            ("GVHMR results" | "Kimodo", _) => ShapeSpace::SmplX,
            (_, Some(model)) if model.to_lowercase().contains("smplx") => ShapeSpace::SmplX,
            _ => space_of(poses.joints),
        };
        let shape = read_shape(fields, space, &mut notes)?;
        match poses.joints {
            SMPLX_JOINTS => notes.push(left_out("hands, jaw and eyes")),
            SMPLH_JOINTS | SMPL_JOINTS => notes.push(left_out("hands")),
            _ => {}
        }
        let rotations = poses.first(Joint::COUNT);
        let motion = SmplMotion {
            frame_rate,
            world: world(fields, self.world, &rotations, &mut notes),
            shape,
            rotations,
            path: if self.is_pelvis {
                Path::Pelvis(places)
            } else {
                Path::Translation(places)
            },
            notes,
        };
        motion.into_recording(fields)
    }

    fn poses(&self, fields: &mut Fields<'_>) -> Result<Rotations, Error> {
        let (root, body) = match self.pose {
            Pose::Parts(root, body) => (root, body),
            Pose::Whole(key) => {
                self.refuse_other_skeletons(fields, key)?;
                let known = [Joint::COUNT, SMPL_JOINTS, SMPLH_JOINTS, SMPLX_JOINTS];
                return Rotations::read(fields, key, &known);
            }
        };
        let root = Rotations::read(fields, root, &[1])?;
        let others = [Joint::COUNT - 1, SMPL_JOINTS - 1];
        let body = Rotations::read(fields, body, &others)?;
        if body.frames() != root.frames() {
            let expected = format!("{} frames as in the root's", root.frames());
            let found = format!("{} frames", body.frames());
            return Err(fields.format("body_pose", &expected, &found));
        }
        let joints = body.joints + 1;
        let frames = root
            .values
            .iter()
            .zip(body.values.chunks_exact(body.joints));
        let values: Vec<DQuat> = frames
            .flat_map(|(root, body)| std::iter::once(root).chain(body).copied())
            .collect();
        Ok(Rotations { values, joints })
    }

    /// Kimodo generates motions of other skeletons under the same keys.
    fn refuse_other_skeletons(&self, fields: &mut Fields<'_>, key: &str) -> Result<(), Error> {
        let whose = match *fields.array(key)?.shape() {
            [_, 30 | 77, 3, 3] => "NVIDIA's SOMA body",
            [_, 34, 3, 3] => "the robot Unitree G1",
            _ => return Ok(()),
        };
        if self.name != "Kimodo" {
            return Ok(());
        }
        let expected = "22 joints of SMPL-X: generate with Kimodo's SMPL-X model, or export BVH";
        let found = format!("the joints of {whose}");
        Err(fields.format(key, expected, &found))
    }

    fn scale(&self, fields: &mut Fields<'_>) -> Result<f64, Error> {
        let Some(key) = self.scale else {
            return Ok(1.0);
        };
        let scale = fields.number(key)?;
        if scale.is_finite() && scale > 0.0 {
            Ok(scale)
        } else {
            Err(fields.format(key, "a positive number", &scale.to_string()))
        }
    }

    fn frame_rate(
        &self,
        fields: &mut Fields<'_>,
        notes: &mut Vec<String>,
    ) -> Result<FrameRate, Error> {
        frame_rate(
            fields,
            &RATE_KEYS,
            self.rate.map(|rate| (rate, self.name)),
            notes,
        )
    }
}

/// The frame rate given, or in the file under one of the keys, or the usual one of a format.
pub(super) fn frame_rate(
    fields: &mut Fields<'_>,
    keys: &[&str],
    usual: Option<(f64, &str)>,
    notes: &mut Vec<String>,
) -> Result<FrameRate, Error> {
    if let Some(given) = fields.options.frame_rate {
        return Ok(given);
    }
    for key in keys {
        if fields.contains(key) {
            let value = fields.number(key)?;
            return FrameRate::new(value).map_err(|_| {
                fields.format(key, "a positive number below 1,000,000", &value.to_string())
            });
        }
    }
    let Some((usual, whose)) = usual else {
        let expected =
            "a number under `fps` or `mocap_framerate`, or a frame rate given as an option";
        return Err(fields.format_at("the frame rate", expected, "neither"));
    };
    notes.push(format!(
        "The file does not state its frame rate: {usual} frames a second were taken, as is usual for {whose}."
    ));
    FrameRate::new(usual)
}

/// The world given, or the format's, or the one in which the body stands most upright.
pub(super) fn world(
    fields: &Fields<'_>,
    known: Option<World>,
    rotations: &[DQuat],
    notes: &mut Vec<String>,
) -> World {
    if let Some(up) = fields.options.up_axis {
        return World::from(up);
    }
    if let Some(world) = known {
        return world;
    }
    let roots = rotations.iter().step_by(Joint::COUNT).copied();
    let (world, upright) = World::most_upright(roots);
    let sure = if upright > 0.5 {
        ""
    } else {
        ", though not by much"
    };
    notes.push(format!(
        "The file does not state its up axis: the body stands most upright with {}{sure}, which was taken.",
        world.words()
    ));
    world
}

//! Tables of joint names, and mapping files, which have the same form.
//!
//! ```toml
//! name = "My rig"                      # optional
//! pelvis = "Hips"
//! spine = ["Spine", "Chest"]           # from the bottom up; those that exist count
//! neck = ["Neck"]
//! head = "Head"
//! left_hip = "Thigh_L|UpperLeg_L"      # the first that exists
//! ```
//!
//! Keys are the body's joint names ([`Joint::name`]) except `spine1` to `spine3`, which are the
//! one chain `spine`. A rig whose zero pose is no human pose may say how its joints are turned in
//! a T-pose: facing +Z with Y up, as quaternions `(x, y, z, w)`, `world_from_joint`, by the rig's
//! own names.
//!
//! ```toml
//! [t_pose]
//! Hips = [0.0, 0.0, 0.0, 1.0]
//! Thigh_L = [0.0, 0.0, 1.0, 0.0]
//! ```

use std::{path::Path, sync::LazyLock};

use physique_body::Joint;

use super::{find::FoundBy, human_joints::Gathered, known_t_pose::KnownTPose, name::NamedJoints};
use crate::{Error, Skeleton};

/// Names of joints, by what they are, and how they are turned in a T-pose where that is known.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct NameTable {
    name: String,
    /// By body joint: names in order of preference. Empty for spine and neck.
    joints: [Vec<String>; Joint::COUNT],
    spine: Vec<String>,
    neck: Vec<String>,
    t_pose: Option<KnownTPose>,
}

/// The tables that come with the crate.
static FAMILIES: LazyLock<Vec<NameTable>> = LazyLock::new(|| {
    const TEXTS: [&str; 15] = [
        include_str!("families/acclaim.toml"),
        include_str!("families/bandai_namco.toml"),
        include_str!("families/biped.toml"),
        include_str!("families/cgspeed.toml"),
        include_str!("families/daz.toml"),
        include_str!("families/deep_mimic.toml"),
        include_str!("families/iclone.toml"),
        include_str!("families/lafan1.toml"),
        include_str!("families/mixamo.toml"),
        include_str!("families/rokoko.toml"),
        include_str!("families/smpl.toml"),
        include_str!("families/smpl_short.toml"),
        include_str!("families/style_100.toml"),
        include_str!("families/unity.toml"),
        include_str!("families/unreal.toml"),
    ];
    // A test parses them all; none is ever left out.
    let tables = TEXTS
        .into_iter()
        .map(|text| NameTable::parse(text, Path::new("family")));
    tables.filter_map(Result::ok).collect()
});

impl NameTable {
    /// The tables that come with the crate.
    pub fn families() -> &'static [Self] {
        &FAMILIES
    }

    /// What the table calls itself.
    pub fn name(&self) -> &str {
        &self.name
    }

    /// A table from TOML text; `path` only names it in errors.
    ///
    /// # Errors
    /// [`Error::Format`] for anything but `key = "name"` or `key = ["name", ...]` with the keys
    /// of the table above, and for rotations of a T-pose that are none.
    pub fn parse(text: &str, path: &Path) -> Result<Self, Error> {
        let error = |place: &str, expected: &str, found: String| Error::Format {
            path: path.into(),
            place: place.into(),
            expected: expected.into(),
            found,
        };
        let entries: toml::Table = text
            .parse()
            .map_err(|found: toml::de::Error| error("the file", "TOML", found.to_string()))?;
        let mut table = Self::default();
        for (key, value) in entries {
            let names = match value {
                toml::Value::String(name) => vec![name],
                toml::Value::Array(values) => values
                    .into_iter()
                    .map(|value| match value {
                        toml::Value::String(name) => Ok(name),
                        other => Err(error(&key, "names of joints", other.type_str().into())),
                    })
                    .collect::<Result<_, _>>()?,
                toml::Value::Table(rotations) if key == "t_pose" => {
                    table.t_pose = Some(KnownTPose::parse(&rotations, path)?);
                    continue;
                }
                other => return Err(error(&key, "a name or names", other.type_str().into())),
            };
            match key.as_str() {
                "name" => table.name = names.concat(),
                "spine" => table.spine = names,
                "neck" => table.neck = names,
                _ => {
                    let joint = Joint::ALL.into_iter().find(|joint| joint.name() == key);
                    let joint = joint.filter(|joint| {
                        !matches!(joint, Joint::Spine1 | Joint::Spine2 | Joint::Spine3)
                    });
                    let Some(joint) = joint else {
                        let expected = "a joint of the body such as pelvis, spine or left_hip";
                        return Err(error("a key", expected, key));
                    };
                    table.joints[joint.index()] = names
                        .iter()
                        .flat_map(|name| name.split('|'))
                        .map(|name| name.trim().to_owned())
                        .collect();
                }
            }
        }
        Ok(table)
    }

    /// Looks the table's names up in a skeleton.
    pub(super) fn gather(&self, skeleton: &Skeleton) -> Gathered {
        let joints = NamedJoints::new(skeleton);
        let find = |name: &String| joints.find(name);
        let mut gathered = Gathered::default();
        for (names, place) in self.joints.iter().zip(&mut gathered.joints) {
            *place = names.iter().find_map(find);
        }
        gathered.spine = self.spine.iter().filter_map(find).collect();
        gathered.neck = self.neck.iter().filter_map(find).collect();
        gathered
    }

    /// The T-pose that is known of a skeleton whose joints were found so: the mapping file's, or
    /// that of the family of names.
    pub(super) fn known_t_pose<'a>(by: &FoundBy, file: Option<&'a Self>) -> Option<&'a KnownTPose> {
        match by {
            FoundBy::Names { family } => {
                let table = Self::families().iter().find(|table| table.name == *family);
                table.and_then(|table| table.t_pose.as_ref())
            }
            FoundBy::Shape => None,
            FoundBy::File { rest } => file.and_then(|file| file.t_pose.as_ref()).or_else(|| {
                let rest = rest.as_deref()?;
                Self::known_t_pose(rest, file)
            }),
        }
    }

    /// Every name of this mapping file that the skeleton lacks: a file must be right.
    pub(super) fn unknown_names(&self, skeleton: &Skeleton) -> Vec<String> {
        let joints = NamedJoints::new(skeleton);
        let exists = |name: &String| joints.find(name).is_some();
        let single = self.joints.iter().filter(|names| !names.is_empty());
        let single = single
            .filter(|names| !names.iter().any(exists))
            .map(|names| names.join("|"));
        let chains = self.spine.iter().chain(&self.neck);
        single
            .chain(chains.filter(|name| !exists(name)).cloned())
            .collect()
    }

    /// This table's entries over `under`'s.
    pub(super) fn over(&self, under: Gathered, skeleton: &Skeleton) -> Gathered {
        let mut result = self.gather(skeleton);
        for (place, below) in result.joints.iter_mut().zip(under.joints) {
            *place = place.or(below);
        }
        if self.spine.is_empty() {
            result.spine = under.spine;
        }
        if self.neck.is_empty() {
            result.neck = under.neck;
        }
        result
    }
}

#[cfg(test)]
mod tests {
    use super::{Joint, NameTable, Path};

    #[test]
    fn every_family_parses_and_names_the_needed_joints() {
        let families = NameTable::families();
        assert_eq!(families.len(), 15);
        for family in families {
            assert!(!family.name().is_empty());
            assert!(!family.spine.is_empty(), "{}", family.name());
            for joint in [Joint::Pelvis, Joint::LeftKnee, Joint::RightElbow] {
                assert!(
                    !family.joints[joint.index()].is_empty(),
                    "{}",
                    family.name()
                );
            }
            if let Some(t_pose) = &family.t_pose {
                // Every joint that the family names, not only those that some file has.
                let single = family.joints.iter().flatten();
                for name in single.chain(&family.spine).chain(&family.neck) {
                    assert!(t_pose.turns(name), "{} {name}", family.name());
                }
            }
            for joint in Joint::ALL {
                let both = [joint, joint.mirrored()].map(|side| family.joints[side.index()].len());
                assert_eq!(both[0], both[1], "{} {joint}", family.name());
            }
        }
    }

    #[test]
    fn a_wrong_key_or_value_is_named() {
        for (text, word) in [
            ("spine2 = \"a\"", "spine2"),
            ("left_hop = \"a\"", "left_hop"),
            ("pelvis = 3", "pelvis"),
            ("neck = [1]", "neck"),
            ("pelvis", "TOML"),
            ("[t_pose]\nHips = [0, 0, 1]", "Hips"),
            ("[t_pose]\nHips = [0, 0, 0, 0]", "Hips"),
            ("[t_pose]\nHips = [0, 0, \"a\", 1]", "Hips"),
            ("[t_pose]\nHips = [0, 0, nan, 1]", "Hips"),
            ("[spine]\nHips = [0, 0, 0, 1]", "spine"),
        ] {
            let error = NameTable::parse(text, Path::new("map.toml")).unwrap_err();
            assert!(error.to_string().contains(word), "{error}");
        }
    }
}

//! Formats that motions are written in.

use std::path::Path;

/// A format that motions are written in.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum ExportFormat {
    /// Biovision hierarchy, text.
    Bvh,
    /// AMASS `.npz` of SMPL-H or SMPL-X.
    Amass,
    /// Skinned, animated glTF 2.0.
    Glb,
    /// HumanML3D features, `[frames][263]`.
    HumanMl3d,
    /// KIT-ML features, `[frames][251]`.
    Kit,
    /// Joint positions, `[frames][22][3]`.
    Positions,
    /// Joint positions as text.
    PositionCsv,
    /// Path of the pelvis and local rotations as text.
    RotationCsv,
    /// Physique's own, which keeps every bit.
    Native,
}

impl ExportFormat {
    /// All formats.
    pub const ALL: [Self; 9] = [
        Self::Bvh,
        Self::Amass,
        Self::Glb,
        Self::HumanMl3d,
        Self::Kit,
        Self::Positions,
        Self::PositionCsv,
        Self::RotationCsv,
        Self::Native,
    ];

    /// What people call it.
    pub const fn name(self) -> &'static str {
        match self {
            Self::Bvh => "BVH",
            Self::Amass => "AMASS",
            Self::Glb => "glTF",
            Self::HumanMl3d => "HumanML3D",
            Self::Kit => "KIT",
            Self::Positions => "joint positions",
            Self::PositionCsv => "CSV of positions",
            Self::RotationCsv => "CSV of rotations",
            Self::Native => "Physique's own",
        }
    }

    /// Ending of its files, without the first dot.
    pub const fn ending(self) -> &'static str {
        match self {
            Self::Bvh => "bvh",
            Self::Amass => "npz",
            Self::Glb => "glb",
            Self::HumanMl3d | Self::Kit | Self::Positions => "npy",
            Self::PositionCsv => "csv",
            Self::RotationCsv => "rotations.csv",
            Self::Native => "motion.npz",
        }
    }

    /// The format that a file's name asks for: the longest ending that fits. `None` for unknown
    /// endings, and for `.npy`, which three formats share.
    pub fn of(path: &Path) -> Option<Self> {
        let name = path.file_name()?.to_string_lossy().to_ascii_lowercase();
        Self::ALL
            .into_iter()
            .filter(|format| format.ending() != "npy")
            .filter(|format| name.ends_with(&format!(".{}", format.ending())))
            .max_by_key(|format| format.ending().len())
    }

    /// The rate at which all files of the format are, because they cannot say.
    pub const fn frame_rate(self) -> Option<f64> {
        match self {
            Self::HumanMl3d | Self::Positions => Some(20.0),
            Self::Kit => Some(12.5),
            _ => None,
        }
    }
}

#[cfg(test)]
mod tests {
    use std::path::Path;

    use super::ExportFormat;

    #[test]
    fn endings_tell_formats_apart() {
        for format in ExportFormat::ALL {
            let name = format!("some.clip.{}", format.ending());
            let expected = (format.ending() != "npy").then_some(format);
            assert_eq!(ExportFormat::of(Path::new(&name)), expected, "{name}");
        }
        let of = |name: &str| ExportFormat::of(Path::new(name));
        assert_eq!(of("WALK.BVH"), Some(ExportFormat::Bvh));
        assert_eq!(of("bvh"), None);
        assert_eq!(of("walk.fbx"), None);
    }
}

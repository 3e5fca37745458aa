//! An arm of two bones, small enough to be reckoned by hand.

use glam::Vec3;
use physique_motion::bvh::LengthUnit;
use physique_motion::{Error, ReadOptions, SkeletonClip, acclaim};

/// A root and a chain of two bones, whose numbers turn about axes of their own.
pub(crate) const ARM: &str = "# made by hand
:version 1.10
:name arm
:units
  mass 1.0
  length 2.54
  angle deg
:documentation
  Anything, begin end :not-a-keyword
:root
  order TX TY TZ RX RY RZ
  axis XYZ
  position 0 0 0
  orientation 0 0 0
:bonedata
  begin
    id 1
    name upper
    direction 1 0 0
    length 2
    axis 0 0 90 XYZ
    dof rx
    limits (-160.0 20.0)
  end
  begin
    id 2
    name lower
    direction 1 0 0
    length 1
    axis 0 0 0
    dof rz rx
    limits (-160.0 20.0)
           (-inf inf)
  end
:hierarchy
  begin
    root upper
    upper lower
  end
";

pub(crate) const WAVE: &str = "#!OML:ASF somewhere
:FULLY-SPECIFIED
:DEGREES
1
root 0 0 0 0 0 0
upper 0
lower 0 0
2
root 1 2 3 0 0 0
upper 90
lower 0 0
3
root 0 0 0 90 0 90
upper 0
lower 90 90
";

pub(crate) fn metres() -> ReadOptions {
    ReadOptions {
        unit: Some(LengthUnit::Metre),
        ..ReadOptions::default()
    }
}

pub(crate) fn parse(asf: &str, amc: &str, options: &ReadOptions) -> Result<SkeletonClip, Error> {
    acclaim::parse(
        asf.as_bytes(),
        "arm.asf",
        amc.as_bytes(),
        "wave.amc",
        options,
    )
}

/// World positions of a bone's start and of its tip.
pub(crate) fn ends(clip: &SkeletonClip, frame: usize, name: &str) -> [Vec3; 2] {
    let pose = clip.pose(frame);
    let joint = clip.skeleton().find(name).unwrap();
    let skeleton = clip.skeleton();
    let tip = match skeleton.children(joint).next() {
        Some(child) => pose.positions[child],
        None => {
            pose.positions[joint] + pose.rotations[joint] * skeleton.joints()[joint].end_sites[0]
        }
    };
    [pose.positions[joint], tip]
}

pub(crate) fn assert_near(found: Vec3, expected: [f32; 3]) {
    assert!(
        found.distance(expected.into()) < 1e-5,
        "{found} {expected:?}"
    );
}

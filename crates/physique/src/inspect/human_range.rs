//! How far people turn their joints.
//!
//! Angles are those of [`super::JointRange`]. Limits are wide on purpose: what healthy adults reach
//! (American Academy of Orthopaedic Surgeons, "Joint Motion", 1965; Norkin and White, "Measurement
//! of Joint Motion") plus what dancers and gymnasts reach more, and some 15 degrees for the
//! difference between a joint of the body and the recorder's. Spine and shoulder girdle share
//! their turning among joints that no goniometer measures singly: their limits are our own.

use physique_body::Joint;

/// From and to, in degrees.
pub(super) type Range = [f32; 2];

/// Of bending, leaning to the side, and turning about the bone.
pub(super) const fn of(joint: Joint) -> [Range; 3] {
    match joint {
        Joint::Pelvis => [[-180.0, 180.0]; 3],
        Joint::Spine1 | Joint::Spine2 | Joint::Spine3 => {
            [[-45.0, 60.0], [-40.0, 40.0], [-45.0, 45.0]]
        }
        Joint::Neck | Joint::Head => [[-60.0, 60.0], [-45.0, 45.0], [-75.0, 75.0]],
        Joint::LeftCollar | Joint::RightCollar => [[-45.0, 45.0], [-30.0, 60.0], [-75.0, 75.0]],
        Joint::LeftShoulder | Joint::RightShoulder => {
            [[-90.0, 165.0], [-135.0, 120.0], [-150.0, 150.0]]
        }
        // In the T-pose the hinge points up or forwards, as the shoulder is turned: flexion is bend,
        // or partly side.
        Joint::LeftElbow | Joint::RightElbow => [[-30.0, 165.0], [-75.0, 75.0], [-150.0, 150.0]],
        Joint::LeftWrist | Joint::RightWrist => [[-105.0, 105.0], [-60.0, 60.0], [-105.0, 105.0]],
        Joint::LeftHip | Joint::RightHip => [[-50.0, 160.0], [-60.0, 105.0], [-90.0, 90.0]],
        Joint::LeftKnee | Joint::RightKnee => [[-20.0, 170.0], [-30.0, 30.0], [-60.0, 60.0]],
        Joint::LeftAnkle | Joint::RightAnkle => [[-75.0, 60.0], [-50.0, 50.0], [-60.0, 60.0]],
        Joint::LeftFoot | Joint::RightFoot => [[-75.0, 90.0], [-45.0, 45.0], [-45.0, 45.0]],
    }
}

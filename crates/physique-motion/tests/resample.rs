//! Another frame rate: old frames to the bit where they coincide, the shorter way in between.

#![allow(clippy::unwrap_used)]

use glam::{Quat, Vec3};
use physique_body::Joint;
use physique_motion::{FrameRate, Motion, embedded};

fn rate(per_second: f64) -> FrameRate {
    FrameRate::new(per_second).unwrap()
}

/// Turns and moves evenly: `radians` and `metres` a second.
fn even(fps: f64, frames: usize, radians: f32, metres: f32) -> Motion {
    let seconds = |frame: usize| frame as f32 / fps as f32;
    let root = (0..frames).map(|f| Vec3::X * metres * seconds(f)).collect();
    let rotations = (0..frames)
        .flat_map(|f| [Quat::from_rotation_y(radians * seconds(f)); Joint::COUNT])
        // Every other quaternion is the other sign of the same rotation.
        .enumerate()
        .map(|(index, q)| {
            if (index / Joint::COUNT).is_multiple_of(2) {
                q
            } else {
                -q
            }
        })
        .collect();
    Motion::new(rate(fps), None, root, rotations).unwrap()
}

/// Bit by bit.
fn assert_same(a: &Motion, frame: usize, b: &Motion, other: usize) {
    assert_eq!(a.root_translation()[frame], b.root_translation()[other]);
    assert_eq!(a.frame_rotations(frame), b.frame_rotations(other));
}

#[test]
fn every_third_frame_from_60_to_20_is_the_old_one_to_the_bit() {
    let clip = embedded::clip("walk").unwrap().load().unwrap().motion;
    let sixty = clip.resampled(rate(60.0)).unwrap();
    let twenty = sixty.resampled(rate(20.0)).unwrap();
    assert_eq!(twenty.frame_count(), (sixty.frame_count() - 1) / 3 + 1);
    for frame in 0..twenty.frame_count() {
        assert_same(&twenty, frame, &sixty, 3 * frame);
    }
    assert_eq!(clip.resampled(clip.frame_rate()).unwrap(), clip);
}

#[test]
fn even_motion_stays_even_at_any_rate() {
    let motion = even(30.0, 31, 1.0, 2.0);
    for fps in [7.0, 20.0, 24.0, 59.94, 120.0] {
        let other = motion.resampled(rate(fps)).unwrap();
        assert_eq!(other.frame_rate(), rate(fps));
        // One second between first and last frame, both of which may stay.
        assert_eq!(other.frame_count(), fps.floor() as usize + 1, "{fps}");
        for frame in 0..other.frame_count() {
            let seconds = (frame as f64 / fps) as f32;
            assert!((other.root_translation()[frame].x - 2.0 * seconds).abs() < 1e-5);
            for rotation in other.frame_rotations(frame) {
                let expected = Quat::from_rotation_y(seconds);
                assert!(
                    rotation.angle_between(expected) < 2e-3,
                    "{fps} frame {frame}"
                );
            }
        }
    }
}

#[test]
fn short_motions_stay() {
    let motion = even(30.0, 1, 1.0, 1.0);
    let other = motion.resampled(rate(20.0)).unwrap();
    assert_same(&other, 0, &motion, 0);
    assert_eq!(other.frame_count(), 1);
    let none = even(30.0, 0, 1.0, 1.0).resampled(rate(20.0)).unwrap();
    assert_eq!(none.frame_count(), 0);
}

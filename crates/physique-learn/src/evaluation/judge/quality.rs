//! Whether a motion trembles or slides.

use glam::Vec3;
use physique_motion::features::{FeatureSkeleton, JointPositions};

use crate::Error;

/// Toes of SMPL's skeleton.
const TOES: [usize; 2] = [10, 11];
/// Ankles and toes: the lowest of them in a motion is taken to be on the floor.
const FEET: [usize; 4] = [7, 8, 10, 11];
/// A toe below this height above the floor, in metres, is taken to stand.
const CONTACT_M: f32 = 0.05;
/// Length of KIT's unit, about.
const KIT_UNIT_M: f32 = 1.0 / 600.0;

/// How smooth a motion is and how its feet stand.
#[derive(Clone, Copy, Debug, Default, PartialEq, serde::Serialize)]
pub struct MotionQuality {
    /// Mean length of the third derivative of all joints' positions, in m/s³.
    pub jerk_m_s3: f64,
    /// Mean horizontal speed of toes within 5 cm above the floor, in m/s; 0 where there are none.
    pub foot_slide_m_s: f64,
}

impl MotionQuality {
    /// Measures joints; 0 for motions that are too short to have a derivative.
    ///
    /// # Errors
    /// [`Error::Motion`] when sums of huge numbers overflow.
    pub fn of(positions: &JointPositions) -> Result<Self, Error> {
        let unit = match positions.skeleton() {
            FeatureSkeleton::HumanMl3d => 1.0,
            FeatureSkeleton::Kit => KIT_UNIT_M,
        };
        let positions = positions.to_smpl_joints()?;
        let rate = positions.frame_rate().per_second();
        let frames: Vec<&[Vec3]> = positions.frames().collect();
        let jerks = frames.windows(4).flat_map(|frames| {
            (0..frames[0].len()).map(move |joint| {
                let at = |frame: usize| frames[frame][joint];
                let third = at(3) - 3.0 * at(2) + 3.0 * at(1) - at(0);
                f64::from(third.length() * unit)
            })
        });
        let heights = frames
            .iter()
            .flat_map(|joints| FEET.map(|foot| joints[foot].y));
        let stands = heights.fold(f32::INFINITY, f32::min) + CONTACT_M / unit;
        let slides = frames.windows(2).flat_map(|frames| {
            TOES.into_iter().filter_map(move |toe| {
                let (now, next) = (frames[0][toe], frames[1][toe]);
                let step = (next - now) * Vec3::new(1.0, 0.0, 1.0);
                (now.y < stands && next.y < stands).then(|| f64::from(step.length() * unit))
            })
        });
        Ok(Self {
            jerk_m_s3: mean(jerks) * rate.powi(3),
            foot_slide_m_s: mean(slides) * rate,
        })
    }

    /// The mean of several; zeros for none.
    pub fn mean(of: &[Self]) -> Self {
        Self {
            jerk_m_s3: mean(of.iter().map(|quality| quality.jerk_m_s3)),
            foot_slide_m_s: mean(of.iter().map(|quality| quality.foot_slide_m_s)),
        }
    }
}

/// 0 for no values.
fn mean(values: impl Iterator<Item = f64>) -> f64 {
    let (sum, count) = values.fold((0.0, 0_usize), |(sum, count), value| {
        (sum + value, count + 1)
    });
    sum / count.max(1) as f64
}

#[cfg(test)]
mod tests {
    use glam::Vec3;
    use physique_motion::FrameRate;
    use physique_motion::features::{FeatureSkeleton, JointPositions};

    use super::MotionQuality;

    /// All joints at these places, frame by frame, ten a second.
    fn motion(places: impl Iterator<Item = Vec3>) -> JointPositions {
        let rate = FrameRate::new(10.0).expect("possible");
        let positions = places.flat_map(|place| [place; 22]).collect();
        JointPositions::new(rate, FeatureSkeleton::HumanMl3d, positions).expect("finite")
    }

    #[test]
    fn a_cubic_has_its_third_derivative() {
        // 0.5 t^3: jerk 3 m/s3; the floor is where it starts.
        let places = (0..8).map(|frame| Vec3::Y * 0.5 * (0.1 * frame as f32).powi(3));
        let quality = MotionQuality::of(&motion(places)).expect("sound");
        assert!((quality.jerk_m_s3 - 3.0).abs() < 1e-3, "{quality:?}");
        assert_eq!(quality.foot_slide_m_s, 0.0);
    }

    #[test]
    fn only_low_toes_slide() {
        // 2 m/s along the ground, then 4 m/s in the air.
        let places = (0..5).map(|frame| Vec3::X * 0.2 * frame as f32);
        let flight = (0..5).map(|frame| Vec3::new(0.4 * frame as f32, 0.06, 0.0));
        let quality = MotionQuality::of(&motion(places.chain(flight))).expect("sound");
        assert!((quality.foot_slide_m_s - 2.0).abs() < 1e-5, "{quality:?}");
    }

    #[test]
    fn a_single_frame_has_neither() {
        let quality = MotionQuality::of(&motion(std::iter::once(Vec3::ZERO)));
        assert_eq!(quality.expect("sound"), MotionQuality::default());
    }
}

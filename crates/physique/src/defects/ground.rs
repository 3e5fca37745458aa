//! Bodies in the ground or above it.

use physique_physics::GroundMeasures;

use super::{Defect, DefectKind, DefectLimits};

/// Centimetres in a metre.
const CM: f64 = 100.0;

/// `standing` is the height at which the soles stand by the clip's own account.
pub(super) fn find(ground: &GroundMeasures, standing: f64, limits: &DefectLimits) -> Vec<Defect> {
    let mut defects = Vec::new();
    let depth = CM * ground.penetration_mean_m;
    if depth > limits.below_ground_cm {
        let message = format!(
            "The lowest skin is {depth:.1} cm in the ground on average and {:.1} cm at worst; the \
             soles stand at a height of {:.1} cm.",
            CM * ground.penetration_worst_m,
            CM * standing
        );
        defects.push(Defect::measured(
            DefectKind::BelowGround,
            message,
            None,
            depth,
            limits.below_ground_cm,
        ));
    }
    let height = CM * ground.floating_mean_m;
    if height > limits.floating_cm {
        let message = format!(
            "The lowest skin is {height:.1} cm above the ground on average, flight left out; the \
             soles stand at a height of {:.1} cm.",
            CM * standing
        );
        defects.push(Defect::measured(
            DefectKind::Floating,
            message,
            None,
            height,
            limits.floating_cm,
        ));
    }
    defects
}

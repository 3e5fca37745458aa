//! The zero moment point at the centre of pressure.

use glam::{DVec2, DVec3};

use super::zero_moment::ZeroMoment;
use super::{FrameLoss, Window};
use crate::balance::on_ground;
use crate::{PressureModel, TimeFilter};

/// HUMOS's dynamic stability: `rho^2 r^2 / (rho^2 + r^2)` of the distance r between centre of
/// pressure and zero moment point, in m2 (HUMOS, arXiv 2409.03944; here with the right sign of the
/// vertical acceleration).
///
/// A body in the air, or with hardly any load, has no term: the published loss pulls it to its
/// centre of mass instead.
#[derive(Clone, Debug, PartialEq)]
pub struct PressureBalance {
    /// Height of the ground, in metres.
    pub ground: f64,
    /// Derivatives over time.
    pub filter: TimeFilter,
    /// Pressure by height.
    pub pressure: PressureModel,
    /// Distances far beyond this no longer count more, in metres; published as 30, which never
    /// matters. 0.1 does.
    pub rho: f64,
}

/// Less pressure than this everywhere is none, as published.
pub(crate) const LEAST_PRESSURE: f64 = 5e-4;

impl FrameLoss for PressureBalance {
    fn reach(&self) -> usize {
        self.filter.reach()
    }

    fn term(&self, window: &mut Window<'_>, scale: f64) -> f64 {
        let body = window.shaped.body;
        let points: Vec<_> = (0..body.skin.len())
            .map(|point| window.skin_point(0, point))
            .collect();
        let pressures: Vec<_> = points
            .iter()
            .map(|point| self.pressure.pressure(point.y - self.ground))
            .collect();
        if pressures.iter().copied().fold(0.0, f64::max) < LEAST_PRESSURE {
            return 0.0;
        }
        let Some(zero_moment) = ZeroMoment::new(window, &self.filter, self.ground) else {
            return 0.0;
        };
        let areas = body.skin.iter().map(|point| point.area);
        let loads: Vec<_> = pressures.iter().zip(areas).map(|(p, a)| p * a).collect();
        let total: f64 = loads.iter().sum();
        let weighted = points
            .iter()
            .zip(&loads)
            .map(|(p, load)| on_ground(*p) * *load);
        let centre = weighted.sum::<DVec2>() / total;

        let apart = zero_moment.point - centre;
        let (r2, rho2) = (apart.length_squared(), self.rho * self.rho);
        let gradient = apart * (2.0 * (rho2 / (rho2 + r2)).powi(2) * scale);
        zero_moment.backward(window, gradient);
        for (index, (point, load)) in points.iter().zip(&loads).enumerate() {
            let to_load = -gradient.dot(on_ground(*point) - centre) / total;
            let rise = self.pressure.slope(point.y - self.ground) * body.skin[index].area;
            let across = gradient * (-load / total);
            let skin = DVec3::new(across.x, to_load * rise, across.y);
            window.add_skin_gradient(0, index, skin);
        }
        rho2 * r2 / (rho2 + r2)
    }
}

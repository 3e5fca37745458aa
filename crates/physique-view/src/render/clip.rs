//! Cutting triangles to what can be drawn (Sutherland and Hodgman 1974).

use super::projection::ClipPoint;

/// Pixel coordinates beyond this are cut away: the rasteriser's integers then cannot overflow.
pub(super) const GUARD: f64 = 65_536.0;

/// A convex polygon: a triangle cut by five planes has at most eight corners.
#[derive(Clone, Copy, Debug)]
pub(super) struct Polygon {
    corners: [ClipPoint; 8],
    count: usize,
}

impl Polygon {
    fn push(&mut self, point: ClipPoint) {
        if let Some(slot) = self.corners.get_mut(self.count) {
            *slot = point;
            self.count += 1;
        }
    }

    pub(super) fn corners(&self) -> &[ClipPoint] {
        &self.corners[..self.count]
    }

    /// The part of the polygon where `inside` is not negative.
    fn cut(&self, inside: impl Fn(&ClipPoint) -> f64) -> Self {
        let mut kept = Self { count: 0, ..*self };
        for (index, &point) in self.corners().iter().enumerate() {
            let next = self.corners()[(index + 1) % self.count];
            let (here, there) = (inside(&point), inside(&next));
            if here >= 0.0 {
                kept.push(point);
            }
            if (here >= 0.0) != (there >= 0.0) {
                kept.push(point.lerp(next, here / (here - there)));
            }
        }
        kept
    }
}

/// The visible part of a triangle: before the near plane (if there is one) and inside the guard band.
pub(super) fn clip(triangle: [ClipPoint; 3], near: Option<f64>) -> Polygon {
    let [a, b, c] = triangle;
    let mut polygon = Polygon {
        corners: [a, b, c, a, a, a, a, a],
        count: 3,
    };
    if let Some(near) = near
        && triangle.iter().any(|p| p.w < near)
    {
        polygon = polygon.cut(|p| p.w - near);
    }
    if polygon
        .corners()
        .iter()
        .any(|p| p.x.abs() > GUARD * p.w || p.y.abs() > GUARD * p.w)
    {
        polygon = polygon
            .cut(|p| GUARD * p.w - p.x)
            .cut(|p| GUARD * p.w + p.x)
            .cut(|p| GUARD * p.w - p.y)
            .cut(|p| GUARD * p.w + p.y);
    }
    polygon
}

#[cfg(test)]
mod tests {
    use super::*;

    fn point(x: f64, y: f64, w: f64) -> ClipPoint {
        ClipPoint {
            x,
            y,
            depth: 1.0,
            w,
        }
    }

    #[test]
    fn whole_triangles_stay_whole() {
        let polygon = clip(
            [point(0., 0., 1.), point(5., 0., 1.), point(0., 5., 2.)],
            Some(0.1),
        );
        assert_eq!(polygon.corners().len(), 3);
    }

    #[test]
    fn one_corner_behind_leaves_a_quadrilateral_on_the_near_plane() {
        let polygon = clip(
            [point(0., 0., 1.), point(5., 0., 1.), point(0., 5., -1.)],
            Some(0.5),
        );
        assert_eq!(polygon.corners().len(), 4);
        assert_eq!(
            polygon
                .corners()
                .iter()
                .filter(|p| (p.w - 0.5).abs() < 1e-12)
                .count(),
            2
        );
    }

    #[test]
    fn all_behind_leaves_nothing() {
        let polygon = clip(
            [point(0., 0., -1.), point(5., 0., -1.), point(0., 5., 0.)],
            Some(0.5),
        );
        assert!(polygon.corners().is_empty());
    }

    #[test]
    fn far_corners_are_brought_inside_the_guard_band() {
        let polygon = clip(
            [
                point(-1e9, -1e9, 1.),
                point(1e9, -1e9, 1.),
                point(0., 1e9, 1.),
            ],
            None,
        );
        assert!(!polygon.corners().is_empty());
        for p in polygon.corners() {
            assert!(
                p.x.abs() <= GUARD * p.w * (1.0 + 1e-9) && p.y.abs() <= GUARD * p.w * (1.0 + 1e-9)
            );
        }
    }
}

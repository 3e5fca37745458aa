//! The base of support: a convex polygon on the ground and how far inside a point lies.

use std::f64::consts::TAU;

use glam::DVec2;

/// Convex hull of points on the ground, `(x, z)` in metres; at least one point.
#[derive(Clone, Debug, PartialEq)]
pub struct SupportPolygon {
    corners: Vec<DVec2>,
}

impl SupportPolygon {
    /// The hull (Andrew's monotone chain); `None` of no points. `points` are sorted.
    pub fn around(points: &mut Vec<DVec2>) -> Option<Self> {
        points.sort_unstable_by(|a, b| a.x.total_cmp(&b.x).then(a.y.total_cmp(&b.y)));
        points.dedup();
        if points.len() < 3 {
            let corners = points.clone();
            return (!corners.is_empty()).then_some(Self { corners });
        }
        let mut corners: Vec<DVec2> = Vec::new();
        half_hull(&mut corners, points.iter().copied());
        corners.pop();
        let lower = corners.len();
        let mut upper = Vec::new();
        half_hull(&mut upper, points.iter().rev().copied());
        upper.pop();
        corners.truncate(lower);
        corners.extend(upper);
        Some(Self { corners })
    }

    /// The mean of polygons by weights (Minkowski's): all weighted means of one point of each.
    ///
    /// Its distance in any direction is the mean of theirs. `None` without any weight.
    pub fn mean<'a>(polygons: impl IntoIterator<Item = (f64, &'a Self)>) -> Option<Self> {
        let mut total = 0.0;
        let mut corner = DVec2::ZERO;
        let mut edges = Vec::new();
        for (weight, polygon) in polygons {
            // The first corner is the leftmost: edges turn from there all around.
            let Some(&first) = polygon.corners.first().filter(|_| weight > 0.0) else {
                continue;
            };
            total += weight;
            corner += first * weight;
            let next = polygon.corners.iter().cycle().skip(1);
            edges.extend(polygon.corners.iter().zip(next).map(|(&from, &to)| {
                let edge = to - from;
                let angle = edge.y.atan2(edge.x);
                let down = angle <= -std::f64::consts::FRAC_PI_2;
                (if down { angle + TAU } else { angle }, edge * weight)
            }));
        }
        edges.retain(|(_, edge)| *edge != DVec2::ZERO);
        edges.sort_unstable_by(|a, b| a.0.total_cmp(&b.0));
        let mut corners = vec![corner / total];
        for (_, edge) in edges.iter().take(edges.len().saturating_sub(1)) {
            corner += *edge;
            corners.push(corner / total);
        }
        (total > 0.0).then_some(Self { corners })
    }

    /// The corners, counter-clockwise in the plane `(x, z)`; one or two where all points lie in
    /// one place or on one line.
    pub fn corners(&self) -> &[DVec2] {
        &self.corners
    }

    /// Signed distance of a point to the edge: negative inside, in metres. A polygon without area
    /// has no inside.
    pub fn signed_distance(&self, point: DVec2) -> f64 {
        let count = self.corners.len();
        let mut nearest = f64::MAX;
        let mut inside = count > 2;
        for (index, &from) in self.corners.iter().enumerate() {
            let to = self.corners[(index + 1) % count];
            let edge = to - from;
            inside &= edge.perp_dot(point - from) >= 0.0;
            let along = (point - from).dot(edge) / edge.length_squared().max(f64::MIN_POSITIVE);
            nearest = nearest.min(point.distance(from + edge * along.clamp(0.0, 1.0)));
        }
        if inside { -nearest } else { nearest }
    }

    /// Area, in m2.
    pub fn area(&self) -> f64 {
        let count = self.corners.len();
        (0..count)
            .map(|index| self.corners[index].perp_dot(self.corners[(index + 1) % count]))
            .sum::<f64>()
            / 2.0
    }
}

/// The chain of left turns over sorted points.
fn half_hull(chain: &mut Vec<DVec2>, points: impl Iterator<Item = DVec2>) {
    for point in points {
        while let [.., before, last] = chain[..]
            && (last - before).perp_dot(point - before) <= 0.0
        {
            chain.pop();
        }
        chain.push(point);
    }
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;

    proptest! {
        #[test]
        fn holds_all_points_and_is_convex(
            points in prop::collection::vec((-1.0..1.0_f64, -1.0..1.0_f64), 1..40)
        ) {
            let mut points: Vec<_> = points.into_iter().map(DVec2::from).collect();
            let hull = SupportPolygon::around(&mut points).unwrap();
            for &point in &points {
                prop_assert!(hull.signed_distance(point) < 1e-12);
            }
            let corners = hull.corners();
            let count = corners.len();
            for i in 0..count {
                let (a, b, c) = (corners[i], corners[(i + 1) % count], corners[(i + 2) % count]);
                prop_assert!(count < 3 || (b - a).perp_dot(c - b) > 0.0);
            }
        }
    }

    proptest! {
        #[test]
        fn a_mean_reaches_as_far_as_the_mean_of_the_reaches(
            polygons in prop::collection::vec(
                (0.01..1.0_f64, prop::collection::vec((-1.0..1.0_f64, -1.0..1.0_f64), 1..9)), 1..6)
        ) {
            let polygons: Vec<_> = polygons
                .into_iter()
                .map(|(weight, points)| {
                    let mut points: Vec<_> = points.into_iter().map(DVec2::from).collect();
                    (weight, SupportPolygon::around(&mut points).unwrap())
                })
                .collect();
            let total: f64 = polygons.iter().map(|(weight, _)| weight).sum();
            let mean = SupportPolygon::mean(polygons.iter().map(|(w, p)| (*w, p))).unwrap();
            let reach = |polygon: &SupportPolygon, way: DVec2| {
                polygon.corners().iter().map(|c| way.dot(*c)).fold(f64::MIN, f64::max)
            };
            for step in 0..16 {
                let way = DVec2::from_angle(TAU * f64::from(step) / 16.0);
                let expected: f64 = polygons.iter().map(|(w, p)| w * reach(p, way)).sum();
                prop_assert!((reach(&mean, way) - expected / total).abs() < 1e-12);
            }
            let middle = mean.corners().iter().sum::<DVec2>() / mean.corners().len() as f64;
            prop_assert!(mean.area() < 1e-9 || mean.signed_distance(middle) < 0.0);
        }
    }

    #[test]
    fn points_and_lines_have_no_inside() {
        let mut line = vec![DVec2::ZERO, DVec2::X, DVec2::X * 0.5];
        let hull = SupportPolygon::around(&mut line).unwrap();
        assert_eq!(hull.signed_distance(DVec2::new(0.5, 0.0)), 0.0);
        assert_eq!(hull.signed_distance(DVec2::new(0.5, 0.2)), 0.2);
        let hull = SupportPolygon::around(&mut vec![DVec2::X]).unwrap();
        assert_eq!(hull.signed_distance(DVec2::ZERO), 1.0);
        assert_eq!(SupportPolygon::around(&mut Vec::new()), None);
    }
}

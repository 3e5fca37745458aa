//! Conic distance fields: how far a point has come through a triangle, and which way is out.
//!
//! After Ballan et al., "Motion Capture of Hands in Action Using Discriminative Salient Points" (ECCV
//! 2012) and Tzionas et al., "Capturing Hands in Action" (IJCV 2016), as SMPLify-X (CVPR 2019) uses
//! them for bodies. Each of two intersecting triangles spreads a cone over its circumscribed circle,
//! with its tip in front of the triangle and ever wider behind it; the corners of the other one pay
//! for where they are in it:
//!
//! ```text
//! h = n . (p - o)                         height of the point p above the circumcentre o
//! F = |p - o - h n| / (r (1 - h / sigma)) distance from the axis, 1 on the cone
//! Y = 1 - sigma - h                       behind the triangle, h <= -sigma
//!   = (3 - 2 sigma) / 4 - h / (2 sigma) - (1 - 2 sigma) / (4 sigma^2) h^2     near it
//!   = 0                                   in front of it, h >= sigma
//! cost = ((1 - F) Y)^4                    within the cone, F < 1; else 0
//! ```

use glam::DVec3;

/// Conic distance fields of one shape.
///
/// Costs have no dimension of their own: lengths count in a [unit](ConicField::unit). A corner that
/// stands `d` units behind the middle of a triangle costs about `d^4`.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ConicField {
    /// Height of the cone's tip in front of the triangle, in units; above 0.
    pub sigma: f64,
    /// The unit in metres; above 0.
    pub unit: f64,
}

impl Default for ConicField {
    /// Half a millimetre, in millimetres, as published for hands.
    fn default() -> Self {
        Self {
            sigma: 0.5,
            unit: 1e-3,
        }
    }
}

/// What a pair of triangles costs, and how that changes with the corners of both, a metre.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct PairGradient {
    /// The cost.
    pub cost: f64,
    /// By the corners of the first triangle.
    pub first: [DVec3; 3],
    /// By the corners of the second triangle.
    pub second: [DVec3; 3],
}

impl ConicField {
    /// What two triangles cost that intersect: the corners of each in the field of the other.
    /// Triangles without area have no field.
    #[must_use]
    pub fn pair_cost(&self, first: [DVec3; 3], second: [DVec3; 3]) -> f64 {
        self.side(first, second).0 + self.side(second, first).0
    }

    /// [`ConicField::pair_cost`] and its derivatives. Some 0.2 microseconds.
    #[must_use]
    pub fn pair_gradient(&self, first: [DVec3; 3], second: [DVec3; 3]) -> PairGradient {
        let (cost, first_as_field, second_as_points) = self.side(first, second);
        let (more, second_as_field, first_as_points) = self.side(second, first);
        PairGradient {
            cost: cost + more,
            first: std::array::from_fn(|corner| first_as_field[corner] + first_as_points[corner]),
            second: std::array::from_fn(|c| second_as_field[c] + second_as_points[c]),
        }
    }

    /// Three points in the field of a triangle: cost, and derivatives by the triangle and the points.
    #[inline(always)]
    fn side(&self, triangle: [DVec3; 3], points: [DVec3; 3]) -> (f64, [DVec3; 3], [DVec3; 3]) {
        let nothing = [DVec3::ZERO; 3];
        let origin = triangle[0];
        let local = |point: DVec3| (point - origin) / self.unit;
        let Some(cone) = Cone::over(local(triangle[1]), local(triangle[2])) else {
            return (0.0, nothing, nothing);
        };
        let mut by_cone = ByCone::default();
        let (mut cost, mut by_points) = (0.0, nothing);
        for (point, by_point) in points.into_iter().zip(&mut by_points) {
            cost += cone.cost(self.sigma, local(point), &mut by_cone, by_point);
        }
        if cost == 0.0 {
            return (0.0, nothing, nothing);
        }
        let [by_b, by_c] = cone.backward(&by_cone);
        // Everything is measured from the first corner.
        let by_a = -(by_b + by_c + by_points.iter().sum::<DVec3>());
        let a_metre = |by: DVec3| by / self.unit;
        (
            cost,
            [by_a, by_b, by_c].map(a_metre),
            by_points.map(a_metre),
        )
    }
}

/// The cone of a triangle whose first corner is the origin.
struct Cone {
    /// To the other two corners.
    edges: [DVec3; 2],
    /// Twice the area along the normal.
    cross: DVec3,
    normal: DVec3,
    centre: DVec3,
    radius: f64,
}

/// Derivatives by a cone.
#[derive(Default)]
struct ByCone {
    normal: DVec3,
    centre: DVec3,
    radius: f64,
}

impl Cone {
    /// `None` for a triangle without area.
    #[inline(always)]
    fn over(b: DVec3, c: DVec3) -> Option<Self> {
        let cross = b.cross(c);
        let square = cross.length_squared();
        let centre = (cross.cross(b) * c.length_squared() + c.cross(cross) * b.length_squared())
            / (2.0 * square);
        (square > 0.0 && centre.is_finite()).then(|| Self {
            edges: [b, c],
            cross,
            normal: cross / square.sqrt(),
            centre,
            radius: centre.length(),
        })
    }

    /// What a point costs; derivatives are added to.
    #[inline(always)]
    fn cost(&self, sigma: f64, point: DVec3, by: &mut ByCone, by_point: &mut DVec3) -> f64 {
        let from_centre = point - self.centre;
        let height = self.normal.dot(from_centre);
        if height >= sigma {
            return 0.0;
        }
        let aside = from_centre - self.normal * height;
        let distance = aside.length();
        let narrowing = 1.0 - height / sigma;
        let reach = self.radius * narrowing;
        if distance >= reach {
            return 0.0;
        }
        let within = 1.0 - distance / reach;
        let (depth, by_height) = depth(sigma, height);
        let field = within * depth;
        let by_field = 4.0 * field.powi(3);

        let by_within = by_field * depth;
        let by_aside = aside * (-by_within / (reach * distance.max(f64::MIN_POSITIVE)));
        let by_reach = by_within * distance / (reach * reach);
        let by_height = by_field * within * by_height - by_reach * self.radius / sigma;
        // What moves the point along the normal does not move it aside.
        let by_from_centre = by_aside + self.normal * by_height;
        by.normal += from_centre * by_height - by_aside * height;
        by.centre -= by_from_centre;
        by.radius += by_reach * narrowing;
        *by_point += by_from_centre;
        field.powi(4)
    }

    /// From derivatives by the cone to those by the two other corners.
    #[inline(always)]
    fn backward(&self, by: &ByCone) -> [DVec3; 2] {
        let [b, c] = self.edges;
        let square = self.cross.length_squared();
        // The first corner lies on the circle.
        let by_centre = by.centre + self.centre * (by.radius / self.radius);
        let by_sum = by_centre / (2.0 * square);
        let (b_square, c_square) = (b.length_squared(), c.length_squared());
        let by_cross = (by.normal - self.normal * self.normal.dot(by.normal)) / square.sqrt()
            - self.cross * (2.0 * by_centre.dot(self.centre) / square)
            + b.cross(by_sum) * c_square
            + by_sum.cross(c) * b_square;
        let by_b = c.cross(by_cross)
            + by_sum.cross(self.cross) * c_square
            + b * (2.0 * by_sum.dot(c.cross(self.cross)));
        let by_c = by_cross.cross(b)
            + self.cross.cross(by_sum) * b_square
            + c * (2.0 * by_sum.dot(self.cross.cross(b)));
        [by_b, by_c]
    }
}

/// How deep a height is, and the derivative.
#[inline(always)]
fn depth(sigma: f64, height: f64) -> (f64, f64) {
    if height <= -sigma {
        return (1.0 - sigma - height, -1.0);
    }
    let bend = (1.0 - 2.0 * sigma) / (4.0 * sigma * sigma);
    let slope = 0.5 / sigma;
    (
        (3.0 - 2.0 * sigma) / 4.0 - height * (slope + bend * height),
        -slope - 2.0 * bend * height,
    )
}

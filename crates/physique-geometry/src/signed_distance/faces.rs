//! The distance of many points to one triangle.

use glam::Vec3;

use super::LANES;

/// One number a point.
pub(super) type Lanes = [f32; LANES];

/// Points side by side: structure of arrays.
#[derive(Debug, Clone, Copy)]
pub(super) struct Packet {
    pub(super) x: Lanes,
    pub(super) y: Lanes,
    pub(super) z: Lanes,
}

impl Packet {
    /// Takes up to [`LANES`] points, at least one; the last is repeated.
    pub(super) fn of(points: &[Vec3]) -> Self {
        let lane = |i: usize| points[i.min(points.len() - 1)];
        Self {
            x: std::array::from_fn(|i| lane(i).x),
            y: std::array::from_fn(|i| lane(i).y),
            z: std::array::from_fn(|i| lane(i).z),
        }
    }
}

/// A triangle, prepared for distances.
#[derive(Debug, Clone, Copy)]
pub(super) struct Face {
    a: [f32; 3],
    ab: [f32; 3],
    ac: [f32; 3],
    /// Unit normal; zero for a triangle without area.
    normal: [f32; 3],
    ab_ab: f32,
    ab_ac: f32,
    ac_ac: f32,
    /// Squared double area; zero without area: then no point lies above the inside.
    determinant: f32,
    inverse_ab: f32,
    inverse_ac: f32,
    inverse_bc: f32,
}

impl Face {
    pub(super) fn new([a, b, c]: [Vec3; 3]) -> Self {
        let (ab, ac, bc) = (b - a, c - a, c - b);
        let (ab_ab, ab_ac, ac_ac) = (ab.length_squared(), ab.dot(ac), ac.length_squared());
        let normal = ab.as_dvec3().cross(ac.as_dvec3());
        let inverse = |square: f32| if square > 0.0 { 1.0 / square } else { 0.0 };
        Self {
            a: a.into(),
            ab: ab.into(),
            ac: ac.into(),
            normal: normal.normalize_or_zero().as_vec3().into(),
            ab_ab,
            ab_ac,
            ac_ac,
            determinant: normal.length_squared() as f32,
            inverse_ab: inverse(ab_ab),
            inverse_ac: inverse(ac_ac),
            inverse_bc: inverse(bc.length_squared()),
        }
    }

    /// Squared distance of every point: to the plane for points above the inside, else to the
    /// nearest side.
    #[inline(always)]
    pub(super) fn squared_distances(&self, points: &Packet) -> Lanes {
        let ([ax, ay, az], [ux, uy, uz], [vx, vy, vz]) = (self.a, self.ab, self.ac);
        let (bcx, bcy, bcz) = (vx - ux, vy - uy, vz - uz);
        let [nx, ny, nz] = self.normal;
        let corner = self.ab_ab - self.ab_ac;
        let mut squares = [0.0; LANES];
        for (lane, square) in squares.iter_mut().enumerate() {
            let (x, y, z) = (
                points.x[lane] - ax,
                points.y[lane] - ay,
                points.z[lane] - az,
            );
            let along_ab = x * ux + y * uy + z * uz;
            let along_ac = x * vx + y * vy + z * vz;

            // Barycentric coordinates, times the determinant.
            let v = self.ac_ac * along_ab - self.ab_ac * along_ac;
            let w = self.ab_ab * along_ac - self.ab_ac * along_ab;
            let inside = (v > 0.0) & (w > 0.0) & (v + w < self.determinant);
            let height = x * nx + y * ny + z * nz;

            let to_side = |x: f32, y: f32, z: f32, t: f32, side: [f32; 3]| {
                let t = t.clamp(0.0, 1.0);
                let (dx, dy, dz) = (x - t * side[0], y - t * side[1], z - t * side[2]);
                dx * dx + dy * dy + dz * dz
            };
            let ab = to_side(x, y, z, along_ab * self.inverse_ab, self.ab);
            let ac = to_side(x, y, z, along_ac * self.inverse_ac, self.ac);
            let along_bc = (along_ac - along_ab + corner) * self.inverse_bc;
            let bc = to_side(x - ux, y - uy, z - uz, along_bc, [bcx, bcy, bcz]);
            let side = ab.min(ac).min(bc);
            *square = if inside { height * height } else { side };
        }
        squares
    }
}

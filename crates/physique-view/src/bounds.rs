//! An axis-aligned box around points.

use glam::Vec3;

/// The smallest axis-aligned box around some points, in metres.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Bounds {
    /// The least x, y and z.
    pub min: Vec3,
    /// The greatest x, y and z.
    pub max: Vec3,
}

impl Bounds {
    /// The box around points; `None` if there are none. Points with NaN are passed over.
    ///
    /// ```
    /// use glam::vec3;
    /// use physique_view::Bounds;
    /// let bounds = Bounds::around(&[vec3(0., 1., 0.), vec3(2., 0., 0.)]).expect("two points");
    /// assert_eq!(bounds.centre(), vec3(1., 0.5, 0.));
    /// ```
    #[must_use]
    pub fn around(points: &[Vec3]) -> Option<Self> {
        points
            .iter()
            .filter(|point| !point.is_nan())
            .map(|&point| Self {
                min: point,
                max: point,
            })
            .reduce(Self::union)
    }

    /// The box around both.
    #[must_use]
    pub fn union(self, other: Self) -> Self {
        Self {
            min: self.min.min(other.min),
            max: self.max.max(other.max),
        }
    }

    /// The middle of the box.
    #[must_use]
    pub fn centre(&self) -> Vec3 {
        (self.min + self.max) * 0.5
    }

    /// Width, height and depth of the box.
    #[must_use]
    pub fn size(&self) -> Vec3 {
        self.max - self.min
    }

    /// The eight corners.
    #[must_use]
    pub fn corners(&self) -> [Vec3; 8] {
        std::array::from_fn(|corner| {
            let pick =
                |bit: usize, low: f32, high: f32| if corner >> bit & 1 == 0 { low } else { high };
            Vec3::new(
                pick(0, self.min.x, self.max.x),
                pick(1, self.min.y, self.max.y),
                pick(2, self.min.z, self.max.z),
            )
        })
    }
}

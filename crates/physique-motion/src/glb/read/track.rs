//! Keyframes of one node, and what lies between them.

use std::rc::Rc;

use glam::{Quat, Vec3};

use super::Context;
use super::accessor::Accessors;
use super::document::{Interpolation, Property, Sampler};
use crate::Error;

/// Keys of a translation or rotation over time.
pub(super) struct Track {
    /// Rising times in seconds.
    pub(super) times: Rc<[f32]>,
    /// `[keys][width]`, or `[keys][in-tangent, value, out-tangent][width]` for cubic splines.
    values: Rc<[f32]>,
    interpolation: Interpolation,
    width: usize,
}

impl Track {
    /// Reads the keys of a sampler.
    pub(super) fn new(
        sampler: &Sampler,
        property: Property,
        accessors: &mut Accessors<'_>,
        context: &Context<'_>,
    ) -> Result<Self, Error> {
        let (kind, width) = match property {
            Property::Rotation => ("VEC4", 4),
            _ => ("VEC3", 3),
        };
        let times = accessors.numbers(sampler.input, "SCALAR", context)?;
        let values = accessors.numbers(sampler.output, kind, context)?;
        let values_a_key = match sampler.interpolation {
            Interpolation::CubicSpline => 3,
            Interpolation::Linear | Interpolation::Step => 1,
        };
        let place = || format!("accessor {}", sampler.output);
        if times.is_empty() || Some(values.len()) != times.len().checked_mul(width * values_a_key) {
            let expected = format!("values for {} keys, at least one", times.len());
            let found = (values.len() / width).to_string();
            return Err(context.format(place(), expected, found));
        }
        if !times.is_sorted() {
            let place = format!("accessor {}", sampler.input);
            return Err(context.format(place, "times that rise", "a time before the one before"));
        }
        let track = Self {
            times,
            values,
            interpolation: sampler.interpolation,
            width,
        };
        if property == Property::Rotation
            && let Some(key) = (0..track.times.len()).find(|&key| {
                let length = track.rotation_key(key).length();
                !(length > 1e-6 && length < 1e6)
            })
        {
            let found = track.rotation_key(key).to_string();
            let place = format!("{}, key {key}", place());
            return Err(context.format(place, "a quaternion of some length", found));
        }
        Ok(track)
    }

    pub(super) fn translation(&self, moment: Moment) -> Vec3 {
        match self.span(moment) {
            Span::At(key) => self.translation_key(key),
            Span::Between { key, weight, .. } if self.interpolation == Interpolation::Linear => {
                self.translation_key(key)
                    .lerp(self.translation_key(key + 1), weight)
            }
            Span::Between {
                key,
                weight,
                seconds,
            } => Vec3::from_slice(&self.spline::<3>(key, weight, seconds)),
        }
    }

    pub(super) fn rotation(&self, moment: Moment) -> Quat {
        match self.span(moment) {
            Span::At(key) => self.rotation_key(key).normalize(),
            Span::Between { key, weight, .. } if self.interpolation == Interpolation::Linear => {
                // glam takes the short way.
                let before = self.rotation_key(key).normalize();
                before
                    .slerp(self.rotation_key(key + 1).normalize(), weight)
                    .normalize()
            }
            Span::Between {
                key,
                weight,
                seconds,
            } => {
                let spline = Quat::from_array(self.spline::<4>(key, weight, seconds));
                // Tangents may lead through zero; there the key before is as good as any.
                if spline.is_finite() && spline.length() > 1e-6 {
                    spline.normalize()
                } else {
                    self.rotation_key(key).normalize()
                }
            }
        }
    }

    /// Whether any key differs from `rest`.
    pub(super) fn changes(&self, rest: Vec3) -> bool {
        let mut keys = (0..self.times.len()).map(|key| self.translation_key(key));
        keys.any(|key| key.distance(rest) > 1e-3 * rest.length())
    }

    /// Where a moment lies among the keys.
    fn span(&self, moment: Moment) -> Span {
        let seconds = moment.seconds;
        let at = |key: usize| f64::from(self.times[key]);
        // The first key after the moment.
        let after = self
            .times
            .partition_point(|&time| f64::from(time) <= seconds);
        let last = self.times.len() - 1;
        let before = after.saturating_sub(1);
        let is_near = |key: usize| (at(key) - seconds).abs() <= moment.tolerance;
        if after > last {
            return Span::At(last);
        }
        if after == 0 || is_near(after) {
            return Span::At(after);
        }
        if is_near(before) || self.interpolation == Interpolation::Step {
            return Span::At(before);
        }
        let length = at(after) - at(before);
        Span::Between {
            key: before,
            weight: ((seconds - at(before)) / length) as f32,
            seconds: length as f32,
        }
    }

    fn translation_key(&self, key: usize) -> Vec3 {
        Vec3::from_slice(self.key(key))
    }

    fn rotation_key(&self, key: usize) -> Quat {
        Quat::from_slice(self.key(key))
    }

    /// The value at a key, without its tangents.
    fn key(&self, key: usize) -> &[f32] {
        let first = match self.interpolation {
            Interpolation::CubicSpline => 3 * key + 1,
            Interpolation::Linear | Interpolation::Step => key,
        };
        &self.values[first * self.width..][..self.width]
    }

    /// glTF 2.0, appendix C: a cubic Hermite spline, its tangents by the second.
    fn spline<const WIDTH: usize>(&self, key: usize, weight: f32, seconds: f32) -> [f32; WIDTH] {
        let part = |key: usize, part: usize| &self.values[(3 * key + part) * WIDTH..][..WIDTH];
        let (start, leaving) = (part(key, 1), part(key, 2));
        let (arriving, end) = (part(key + 1, 0), part(key + 1, 1));
        let (t, t2, t3) = (weight, weight.powi(2), weight.powi(3));
        std::array::from_fn(|at| {
            (2.0 * t3 - 3.0 * t2 + 1.0) * start[at]
                + seconds * (t3 - 2.0 * t2 + t) * leaving[at]
                + (3.0 * t2 - 2.0 * t3) * end[at]
                + seconds * (t3 - t2) * arriving[at]
        })
    }
}

/// A moment, and how near to it a key counts as being there.
#[derive(Clone, Copy)]
pub(super) struct Moment {
    pub(super) seconds: f64,
    pub(super) tolerance: f64,
}

/// Where a moment lies among keys.
enum Span {
    At(usize),
    /// After `key`, by a share `weight` of the `seconds` to the next.
    Between {
        key: usize,
        weight: f32,
        seconds: f32,
    },
}

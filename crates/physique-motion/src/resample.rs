//! Another frame rate for a motion.

use glam::{Quat, Vec3};
use physique_body::Joint;

use crate::{Error, FrameRate, Motion};

/// A place between two frames.
#[derive(Clone, Copy)]
struct Place {
    frame: usize,
    next: usize,
    share_of_next: f32,
}

impl Motion {
    /// The motion at another frame rate: rotations by spherical, the root by linear interpolation.
    ///
    /// The first frame stays the first, and no frame lies behind the last, so that the motion ends
    /// up to one new frame earlier. Where a new frame falls on an old one, as in every third frame
    /// from 60 to 20 fps, the old one is taken to the bit. Nothing is smoothed: as in the
    /// data sets, which keep every n-th frame, motion faster than half the new rate is aliased.
    ///
    /// # Errors
    /// None for a sound motion; the type is that of [`Motion::new`].
    pub fn resampled(&self, frame_rate: FrameRate) -> Result<Self, Error> {
        let places = places(self.frame_count(), self.frame_rate(), frame_rate);
        let mut root = Vec::with_capacity(places.len());
        let mut rotations = Vec::with_capacity(places.len() * Joint::COUNT);
        for place in places {
            root.push(self.root_at(place));
            rotations.extend(self.rotations_at(place));
        }
        Self::new(frame_rate, self.shape().cloned(), root, rotations)
    }

    fn root_at(&self, place: Place) -> Vec3 {
        let root = self.root_translation();
        match place.share_of_next {
            0.0 => root[place.frame],
            share => root[place.frame].lerp(root[place.next], share),
        }
    }

    fn rotations_at(&self, place: Place) -> impl Iterator<Item = Quat> + '_ {
        let now = self.frame_rotations(place.frame);
        let next = self.frame_rotations(place.next);
        now.iter()
            .zip(next)
            .map(move |(&now, &next)| match place.share_of_next {
                0.0 => now,
                // The shorter way round.
                share => now.slerp(next, share),
            })
    }
}

/// Where the new frames lie among the old.
fn places(frames: usize, old: FrameRate, new: FrameRate) -> Vec<Place> {
    /// Closer to a frame than this share of its time is on it: rates as files round them.
    const ON_FRAME: f64 = 1e-4;
    let Some(last) = frames.checked_sub(1) else {
        return Vec::new();
    };
    let old_frames_per_new = old.per_second() / new.per_second();
    let at = |new_frame: usize| {
        let at = new_frame as f64 * old_frames_per_new;
        let nearest = at.round();
        if (at - nearest).abs() < ON_FRAME {
            nearest
        } else {
            at
        }
    };
    (0..)
        .map(at)
        .take_while(|&at| at <= last as f64)
        .map(|at| {
            let frame = at.floor() as usize;
            Place {
                frame,
                next: (frame + 1).min(last),
                share_of_next: at.fract() as f32,
            }
        })
        .collect()
}

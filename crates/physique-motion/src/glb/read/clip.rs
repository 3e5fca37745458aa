//! One animation as a clip of its figure.

use std::collections::HashMap;

use glam::{Quat, Vec3};

use super::clock::Clock;
use super::document::{Animation, Property};
use super::figure::Figures;
use super::rest::{Figure, Joint};
use super::track::Track;
use super::{Accessors, Context};
use crate::{Conversion, Error, SkeletonClip};

/// Farther than this from its rest, a joint counts as moving within its parent, in metres.
const STILL: f32 = 1e-5;

/// Memory and work that all animations of a file share.
pub(super) struct Budget {
    left: u64,
    limit: u64,
}

impl Budget {
    pub(super) const fn new(limit: u64) -> Self {
        Self { left: limit, limit }
    }

    fn take(&mut self, count: u64, bytes: u64, context: &Context<'_>) -> Result<(), Error> {
        let taken = (self.limit - self.left).saturating_add(count.saturating_mul(bytes));
        let what = "the size in bytes of all keys and frames of its animations";
        context.check(what, taken, self.limit)?;
        self.left = self.limit - taken;
        Ok(())
    }
}

/// What the clips of a file are made from.
pub(super) struct Reader<'a, 'b> {
    pub(super) context: &'b Context<'b>,
    pub(super) figures: Figures<'a>,
    pub(super) accessors: Accessors<'a>,
    pub(super) budget: Budget,
}

type Tracks = HashMap<(usize, Property), Track>;

impl Reader<'_, '_> {
    /// The clip of an animation; `place` names it in errors.
    pub(super) fn clip(
        &mut self,
        animation: &Animation,
        place: &str,
    ) -> Result<SkeletonClip, Error> {
        let figure = self
            .figures
            .of(animation, &mut self.accessors, self.context)?;
        let mut notes = figure.notes.clone();
        let tracks = self.tracks(animation, &figure, place, &mut notes)?;
        if tracks.is_empty() {
            let expected = "tracks that move its figure";
            return Err(self.context.format(place, expected, "none"));
        }
        let mut in_order: Vec<(&(usize, Property), &Track)> = tracks.iter().collect();
        in_order.sort_by_key(|((node, property), _)| (*node, *property == Property::Rotation));
        let in_order: Vec<&Track> = in_order.into_iter().map(|(_, track)| track).collect();
        let clock = Clock::new(&in_order, self.context)?;
        if !clock.note.is_empty() {
            notes.push(clock.note.clone());
        }
        self.frames(&figure, &tracks, &clock, notes)
    }

    /// The tracks of the figure's joints.
    fn tracks(
        &mut self,
        animation: &Animation,
        figure: &Figure,
        place: &str,
        notes: &mut Vec<String>,
    ) -> Result<Tracks, Error> {
        let nodes: HashMap<usize, &Joint> = figure
            .joints
            .iter()
            .map(|joint| (joint.node, joint))
            .collect();
        let mut tracks = Tracks::new();
        let (mut elsewhere, mut scales) = (0, 0);
        for channel in &animation.channels {
            let property = channel.target.path;
            let node = channel.target.node.filter(|node| nodes.contains_key(node));
            let (Some(node), true) = (node, property != Property::Other) else {
                elsewhere += 1;
                continue;
            };
            let Some(sampler) = animation.samplers.get(channel.sampler) else {
                let expected = format!("sampler {}", channel.sampler);
                let found = format!("{} of them", animation.samplers.len());
                return Err(self.context.format(place, expected, found));
            };
            let track = Track::new(sampler, property, &mut self.accessors, self.context)?;
            self.budget
                .take(track.times.len() as u64, 16, self.context)?;
            if property == Property::Scale {
                scales += usize::from(track.changes(Vec3::splat(nodes[&node].local.scale)));
            } else if tracks.insert((node, property), track).is_some() {
                let found = format!("two of node {node}");
                return Err(self
                    .context
                    .format(place, "one track of a kind for a node", found));
            }
        }
        if elsewhere > 0 {
            notes.push(format!(
                "{elsewhere} tracks of other things than joints are left out"
            ));
        }
        if scales > 0 {
            notes.push(format!(
                "scale: {scales} tracks that change sizes are left out"
            ));
        }
        Ok(tracks)
    }

    fn frames(
        &mut self,
        figure: &Figure,
        tracks: &Tracks,
        clock: &Clock,
        notes: Vec<String>,
    ) -> Result<SkeletonClip, Error> {
        let (frames, joints) = (clock.frames, figure.joints.len());
        // A rotation, and twice a translation: by joint, then by frame.
        let bytes = size_of::<Quat>() + 2 * size_of::<Vec3>();
        let count = (frames as u64).saturating_mul(joints as u64);
        self.budget.take(count, bytes as u64, self.context)?;
        let mut rotations = vec![Quat::IDENTITY; frames * joints];
        let mut moved = Vec::new();
        let mut paths = Vec::new();
        for (index, joint) in figure.joints.iter().enumerate() {
            let turned = tracks.get(&(joint.node, Property::Rotation));
            let shifted = tracks.get(&(joint.node, Property::Translation));
            let local = |frame: usize| {
                let moment = clock.moment(frame);
                let rotation = turned.map_or(joint.local.rotation, |track| track.rotation(moment));
                let position =
                    shifted.map_or(joint.local.position, |track| track.translation(moment));
                joint.placed(rotation, position)
            };
            let mut path = Vec::with_capacity(frames);
            for frame in 0..frames {
                let (rotation, translation) = local(frame);
                rotations[frame * joints + index] = rotation;
                path.push(translation);
            }
            let rest = figure.skeleton.joints()[index].rest_translation;
            if path.iter().any(|place| place.distance(rest) > STILL) {
                moved.push(index);
                paths.push(path);
            }
        }
        let translations = (0..frames).flat_map(|frame| paths.iter().map(move |path| path[frame]));
        let conversion = Conversion {
            metres_per_unit: figure.metres_per_unit,
            notes,
            ..Conversion::default()
        };
        SkeletonClip::new(
            figure.skeleton.clone(),
            clock.rate,
            conversion,
            rotations,
            moved,
            translations.collect(),
        )
    }
}

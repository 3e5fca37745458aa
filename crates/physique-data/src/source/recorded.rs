//! Any folder of motions, by a recipe.

use std::collections::{BTreeSet, HashSet};
use std::path::Path;

use physique::body::{Body, Sex, open_body};
use physique::load::{LoadOptions, load_each};
use physique::motion::features::{FeatureSkeleton, JointPositions, canonicalise, extract_window};
use physique::motion::mapping::BodyRest;
use physique::motion::{FrameRate, Motion, ReadOptions};

use super::files::{below, may_hold_motion, without_ending};
use super::{About, Draft, DraftClip, Outcome, Plan, Sayings, SplitBy, Work, left_out};
use crate::index::SkeletonName;
use crate::recipe::{Labels, LoadedTable, Pattern, plain};
use crate::{Caption, DataLimits, Error, LeftOut, Reason, Recipe, Storage};

/// A file that a source of the recipe names.
#[derive(Debug)]
struct Found {
    file: String,
    labels: Labels,
    frame_rate: Option<FrameRate>,
}

pub(super) fn work<'a>(
    recipe: &'a Recipe,
    folder: &'a Path,
    limits: &'a DataLimits,
) -> Result<Work<'a>, Error> {
    let (found, plan) = find(recipe, folder, limits)?;
    let frame_rate = FrameRate::new(recipe.frame_rate)?;
    let rows = |seconds: f64| ((seconds * recipe.frame_rate).round() as usize).max(1);
    let windows = (rows(recipe.windows.shortest), rows(recipe.windows.longest));
    let looker = Looker {
        recipe,
        folder,
        body: Body::mean(open_body().map_err(physique::Error::from)?, Sex::Neutral)
            .map_err(physique::Error::from)?,
        frame_rate,
        shortest: windows.0,
        limits,
    };
    Ok(Work {
        about: About {
            name: recipe.name.clone(),
            licence: recipe.licence.clone(),
            attribution: recipe.attribution.clone(),
            storage: Storage::Positions,
            skeleton: SkeletonName::Humanml3d,
            frame_rate: recipe.frame_rate,
            windows,
            told: recipe.told_labels(),
        },
        plan,
        look: Box::new(move |job| looker.look(&found[job])),
        statistics: None,
    })
}

/// Files by the recipe's patterns, with their labels.
fn find(recipe: &Recipe, folder: &Path, limits: &DataLimits) -> Result<(Vec<Found>, Plan), Error> {
    let names = below(folder)?;
    let mut taken = HashSet::new();
    let mut recordings = BTreeSet::new();
    let (mut found, mut plan) = (Vec::new(), Plan::default());
    for source in &recipe.sources {
        let pattern = Pattern::parse(&source.files).map_err(|problem| Error::Recipe {
            recipe: recipe.name.clone(),
            problem,
        })?;
        let named = names.iter().enumerate();
        let named: Vec<(usize, Labels)> = named
            .filter(|(index, _)| !taken.contains(index))
            .filter_map(|(index, name)| Some((index, pattern.labels(name)?)))
            .collect();
        if named.is_empty() {
            let note = format!("The pattern {:?} names no file.", source.files);
            plan.notes.push(note);
            continue;
        }
        let table = match &source.table {
            Some(table) => table.load(folder, &names, limits)?,
            None => LoadedTable::default(),
        };
        let frame_rate = source.frame_rate.map(FrameRate::new).transpose()?;
        for (index, mut labels) in named {
            taken.insert(index);
            labels.extend(source.labels.clone());
            table.add_to(&mut labels);
            let file = names[index].clone();
            match refused(recipe, &labels, &mut recordings) {
                Some((reason, message)) => plan.left_out.push(LeftOut {
                    name: without_ending(&file).to_owned(),
                    reason,
                    message,
                }),
                None => found.push(Found {
                    file,
                    labels,
                    frame_rate,
                }),
            }
        }
    }
    if taken.is_empty() {
        return Err(Error::Folder {
            folder: folder.into(),
            expected: format!("files such as {:?}", recipe.sources[0].files),
            found: format!("none among {} files", names.len()),
        });
    }
    plan.unnamed_files = names
        .iter()
        .enumerate()
        .filter(|(index, name)| !taken.contains(index) && may_hold_motion(name))
        .count();
    plan.jobs = found.len();
    Ok((found, plan))
}

/// Why a file is not even opened.
fn refused(
    recipe: &Recipe,
    labels: &Labels,
    recordings: &mut BTreeSet<Vec<String>>,
) -> Option<(Reason, String)> {
    if let Some(rule) = recipe.leave_out.iter().find(|rule| rule.matches(labels)) {
        return Some((Reason::Recipe, rule.reason.clone()));
    }
    let key = recipe
        .unique_by
        .iter()
        .map(|label| labels.get(label).map(|value| plain(value)));
    let key = key
        .collect::<Option<Vec<_>>>()
        .filter(|key| !key.is_empty())?;
    let told = key.join(", ");
    let is_new = recordings.insert(key);
    (!is_new).then(|| {
        let message = format!(
            "Another file is the same recording: {} {told}.",
            recipe.unique_by.join(", ")
        );
        (Reason::Duplicate, message)
    })
}

/// Looks at files.
struct Looker<'a> {
    recipe: &'a Recipe,
    folder: &'a Path,
    body: Body,
    frame_rate: FrameRate,
    shortest: usize,
    limits: &'a DataLimits,
}

impl Looker<'_> {
    fn look(&self, found: &Found) -> Vec<Outcome> {
        let name = without_ending(&found.file);
        let options = LoadOptions {
            read: ReadOptions {
                frame_rate: found.frame_rate,
                ..ReadOptions::default()
            },
            ..LoadOptions::default()
        };
        let path = self.folder.join(&found.file);
        let motions = match load_each(&path, &self.body, &options) {
            Ok(motions) => motions,
            Err(problem) => return vec![self.unreadable(name, &problem)],
        };
        let looked = motions.into_iter().map(|(key, loaded)| {
            let name = match key.rsplit_once('#') {
                Some((_, key)) => format!("{name}#{key}"),
                None => name.to_owned(),
            };
            match loaded {
                Ok(loaded) => self
                    .draft(&name, &loaded.motion, &found.labels)
                    .unwrap_or_else(|(reason, message)| left_out(&name, reason, message)),
                Err(problem) => self.unreadable(&name, &problem),
            }
        });
        looked.collect()
    }

    /// The reader's error without the path of the folder, so that data files do not tell where they
    /// were built.
    fn unreadable(&self, name: &str, problem: &physique::Error) -> Outcome {
        let reason = match problem {
            physique::Error::Motion(physique::motion::Error::NotFinite { .. }) => Reason::NotFinite,
            _ => Reason::Unreadable,
        };
        let folder = format!("{}/", self.folder.display());
        left_out(name, reason, problem.to_string().replace(&folder, ""))
    }

    fn draft(
        &self,
        name: &str,
        motion: &Motion,
        labels: &Labels,
    ) -> Result<Outcome, (Reason, String)> {
        let no_features =
            |problem: physique::motion::Error| (Reason::NoFeatures, problem.to_string());
        let motion = motion.resampled(self.frame_rate).map_err(no_features)?;
        let rows = motion.frame_count().saturating_sub(1);
        if rows < self.shortest {
            let message = format!(
                "{rows} rows of features, where the shortest window has {}.",
                self.shortest
            );
            return Err((Reason::TooShort, message));
        }
        let rest = BodyRest::from(&self.body);
        let positions = JointPositions::from_motion(&motion, &rest).map_err(no_features)?;
        let positions = canonicalise(&positions).map_err(no_features)?;
        self.check_speed(&positions)?;
        let mut features = vec![extract_window(&positions).map_err(no_features)?];
        let mut clips = vec![self.clip(rows, false, labels.clone())?];
        if self.recipe.mirror {
            features.push(extract_window(&positions.mirrored()).map_err(no_features)?);
            clips.push(self.clip(rows, true, self.recipe.mirrored(labels))?);
        }
        let group = self.recipe.split.within.as_ref();
        let group = group.and_then(|label| labels.get(label)).cloned();
        let numbers = positions.positions().iter();
        Ok(Outcome::Kept(Draft {
            name: name.to_owned(),
            rows: numbers.flat_map(glam::Vec3::to_array).collect(),
            row_count: positions.frame_count(),
            features,
            clips,
            split: SplitBy::Rule(group.unwrap_or_default()),
        }))
    }

    fn clip(
        &self,
        frames: usize,
        mirrored: bool,
        labels: Labels,
    ) -> Result<DraftClip, (Reason, String)> {
        let no_caption = |message| (Reason::NoCaption, message);
        let sentences = self.recipe.sentences(&labels, self.limits.captions_a_clip);
        let sentences = sentences.map_err(no_caption)?;
        if sentences.training.is_empty() && !self.recipe.captions.is_empty() {
            let told: Vec<String> = labels.iter().map(|(a, b)| format!("{a} = {b:?}")).collect();
            let message = format!("No caption of the recipe fits {}.", told.join(", "));
            return Err(no_caption(message));
        }
        let caption = |text| Caption { text, tokens: None };
        let training = sentences.training.into_iter();
        let held_out = sentences.held_out.into_iter();
        Ok(DraftClip {
            start: 0,
            frames,
            mirrored,
            labels,
            sayings: Sayings {
                training: training
                    .map(|(text, weight)| (caption(text), weight))
                    .collect(),
                held_out: held_out.map(caption).collect(),
            },
        })
    }

    /// Refuses a motion in which a joint jumps.
    fn check_speed(&self, positions: &JointPositions) -> Result<(), (Reason, String)> {
        let limit = self.recipe.refuse.joint_speed as f32;
        let rate = self.frame_rate.per_second() as f32;
        let frames = positions.frames().zip(positions.frames().skip(1));
        for (frame, (now, next)) in frames.enumerate() {
            for (joint, (now, next)) in now.iter().zip(next).enumerate() {
                let speed = now.distance(*next) * rate;
                if speed > limit {
                    let joint = FeatureSkeleton::HumanMl3d.joint_name(joint);
                    let message = format!(
                        "The {} moves at {speed:.0} m/s after {:.2} s, above {limit}.",
                        joint.unwrap_or("body"),
                        frame as f32 / rate
                    );
                    return Err((Reason::Jump, message));
                }
            }
        }
        Ok(())
    }
}

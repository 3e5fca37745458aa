//! Tracks of PHALP and 4D-Humans: a dictionary a frame of video, of the people seen in it.
//!
//! | key of a frame | content |
//! |---|---|
//! | `time` | number of the frame |
//! | `tid` | the number of each person's track |
//! | `smpl` | of each, matrices `global_orient` `[1][3][3]` and `body_pose` `[23][3][3]`, and `betas` |
//! | `camera` | of each, where the body's origin is from the camera |
//!
//! People are seen in some frames and not in others: what lies between two sights is interpolated.
//! Rajasegaran et al., "Tracking People by Predicting 3D Appearance, Location and Pose", CVPR 2022;
//! Goel et al., "Humans in 4D", ICCV 2023.

use std::collections::BTreeMap;

use glam::{DMat3, DQuat, DVec3};
use physique_body::Joint;
use physique_files::Data;

use super::{Context, parameters};
use crate::fields::Fields;
use crate::read::Part;
use crate::smpl_motion::{Path, SmplMotion, left_out, quaternion, read_shape, vectors_of};
use crate::world::World;
use crate::{Error, ShapeSpace, SourceMotion};

/// Usual frames a second of video.
const RATE: f64 = 30.0;

/// A person in one frame.
struct Sight<'a> {
    frame: usize,
    smpl: &'a Data,
    place: DVec3,
}

/// Whether a dictionary is one of these.
pub(super) fn holds(data: &Data) -> bool {
    let mut frames = data.entries().iter();
    frames.any(|(_, frame)| frame.get("tid").is_some() && frame.get("smpl").is_some())
}

/// One motion a track, named by its number.
pub(super) fn read(context: &Context<'_>, data: &Data) -> Result<Vec<Part>, Error> {
    let tracks = tracks(context, data)?;
    if tracks.is_empty() {
        return Err(context.format("the tracks", "at least one person", "none"));
    }
    // Tracks may be short and far apart in time: together they must fit, too.
    let spans = tracks.values().map(|sights| span(sights));
    context.check_frames(spans.fold(0, usize::saturating_add))?;
    let parts = tracks.into_iter().map(|(track, sights)| Part {
        key: track.to_string(),
        text: None,
        format: "PHALP tracks",
        motion: motion(context, track, &sights),
    });
    Ok(parts.collect())
}

/// The sights of each track, in order of time.
fn tracks<'a>(
    context: &Context<'_>,
    data: &'a Data,
) -> Result<BTreeMap<usize, Vec<Sight<'a>>>, Error> {
    let mut tracks: BTreeMap<usize, Vec<Sight<'a>>> = BTreeMap::new();
    for (order, (name, frame)) in data.entries().iter().enumerate() {
        let wrong = |key: &str, expected: &str| {
            let found = frame.get(key).map_or("none".into(), Data::kind);
            let place = format!("`{}.{key}`", name.escape_debug());
            context.format(place, expected, found)
        };
        let time = match frame.get("time") {
            None => order,
            Some(time) => {
                let time = time.number().and_then(whole);
                time.ok_or_else(|| wrong("time", "a frame's number"))?
            }
        };
        let numbers = frame.get("tid").and_then(Data::numbers);
        let bodies = frame.get("smpl").and_then(Data::list);
        let (Some(numbers), Some(bodies)) = (numbers, bodies) else {
            continue;
        };
        let places = frame.get("camera").and_then(vectors).unwrap_or_default();
        if places.len() < numbers.len().min(bodies.len()) {
            return Err(wrong("camera", "three numbers a person"));
        }
        for ((number, smpl), place) in numbers.into_iter().zip(bodies).zip(places) {
            let track = whole(number).ok_or_else(|| wrong("tid", "numbers of tracks"))?;
            tracks.entry(track).or_default().push(Sight {
                frame: time,
                smpl,
                place,
            });
        }
    }
    for sights in tracks.values_mut() {
        sights.sort_by_key(|sight| sight.frame);
        sights.dedup_by_key(|sight| sight.frame);
    }
    Ok(tracks)
}

/// Three numbers each, in a list or in the rows of an array.
fn vectors(data: &Data) -> Option<Vec<DVec3>> {
    let numbers: Vec<f64> = match data {
        Data::List(items) => {
            let rows = items.iter().map(Data::numbers);
            rows.collect::<Option<Vec<_>>>()?.concat()
        }
        other => other.numbers()?,
    };
    Some(vectors_of(&numbers).collect())
}

/// A whole number from 0 that a machine can count to.
fn whole(number: f64) -> Option<usize> {
    const MOST: f64 = (1_u64 << 31) as f64;
    ((0.0..MOST).contains(&number) && number.fract() == 0.0).then_some(number as usize)
}

/// Frames from the first sight to the last.
fn span(sights: &[Sight<'_>]) -> usize {
    match sights {
        [first, .., last] => last.frame - first.frame + 1,
        rest => rest.len(),
    }
}

/// The motion of one track, frame by frame.
fn motion(
    context: &Context<'_>,
    track: usize,
    sights: &[Sight<'_>],
) -> Result<SourceMotion, Error> {
    let place = |sight: &Sight<'_>| format!("frame {}, track {track}", sight.frame);
    let mut rotations: Vec<DQuat> = Vec::new();
    let mut places: Vec<DVec3> = Vec::new();
    let mut last: Option<(&Sight<'_>, Vec<DQuat>)> = None;
    for sight in sights {
        let pose = pose(context, &place(sight), sight.smpl)?;
        if !sight.place.is_finite() {
            let found = sight.place.to_string();
            return Err(context.format(place(sight), "a finite place of the camera", found));
        }
        if let Some((before, from)) = &last {
            let steps = sight.frame - before.frame;
            for step in 1..steps {
                let share = step as f64 / steps as f64;
                places.push(before.place.lerp(sight.place, share));
                rotations.extend(from.iter().zip(&pose).map(|(a, b)| a.slerp(*b, share)));
            }
        }
        places.push(sight.place);
        rotations.extend(&pose);
        last = Some((sight, pose));
    }
    let mut notes = vec![
        left_out("hands"),
        "A camera sees the path: depth is its guess, and the ground slopes as it was held.".into(),
    ];
    if places.len() > sights.len() {
        notes.push(format!(
            "{} frames in which the person was not seen were interpolated.",
            places.len() - sights.len()
        ));
    }
    let mut fields = Fields::of_tree(
        sights
            .first()
            .map_or(&Data::Other("nothing"), |sight| sight.smpl),
        "",
        context.path,
        context.options,
    );
    let frame_rate = parameters::frame_rate(&mut fields, &[], Some((RATE, "video")), &mut notes)?;
    let motion = SmplMotion {
        frame_rate,
        world: parameters::world(&fields, Some(World::Camera), &rotations, &mut notes),
        shape: read_shape(&mut fields, ShapeSpace::Smpl, &mut notes)?,
        rotations,
        path: Path::Translation(places),
        notes,
    };
    Ok(SourceMotion::Body(motion.into_recording(&fields)?))
}

/// The 22 rotations of a person in one frame.
fn pose(context: &Context<'_>, place: &str, smpl: &Data) -> Result<Vec<DQuat>, Error> {
    let matrices = |key: &str, least: usize| {
        let numbers = smpl.get(key).and_then(Data::numbers);
        let numbers = numbers.filter(|all| all.len() >= 9 * least && all.len().is_multiple_of(9));
        numbers.ok_or_else(|| {
            let found = smpl.get(key).map_or("none".into(), Data::kind);
            let expected = format!("{least} rotation matrices or more under `{key}`");
            context.format(place, &expected, found)
        })
    };
    let root = matrices("global_orient", 1)?;
    let body = matrices("body_pose", Joint::COUNT - 1)?;
    let rows = root.as_chunks::<9>().0[..1].iter();
    let rows = rows.chain(&body.as_chunks::<9>().0[..Joint::COUNT - 1]);
    let turns = rows.map(|rows| {
        let turn = DMat3::from_cols_array(rows).transpose();
        quaternion(turn).ok_or_else(|| {
            let found = format!("determinant {:.3}", turn.determinant());
            context.format(place, "rotation matrices", found)
        })
    });
    turns.collect()
}

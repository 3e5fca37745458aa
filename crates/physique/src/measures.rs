//! Every measure by a flat name, for tables, conditions, CSV and Parquet. Names end in their unit.

use std::borrow::Cow;

use crate::physics_score::{BalanceScore, FeetScore, GroundScore, SmoothnessScore};
use crate::self_intersection::SelfIntersection;
use crate::sia::SiaScore;
use crate::{Group, MotionScore, Protocol};

/// A measure's name, and how to find it.
pub(crate) type Named<Score> = (&'static str, fn(&Score) -> Option<f64>);

const CLIP: [Named<MotionScore>; 3] = [
    ("frames", |score| Some(score.frames as f64)),
    ("frame_rate_fps", |score| Some(score.frame_rate_fps)),
    ("duration_s", |score| Some(score.duration_s)),
];

const FLOOR: [Named<MotionScore>; 1] = [("floor_height_m", |score| score.floor_height_m)];

const SELF_INTERSECTION: [Named<SelfIntersection>; 6] = [
    ("self_intersection_mean_cm3", |found| Some(found.mean_cm3)),
    ("self_intersection_mean_percent_of_body", |found| {
        Some(found.mean_percent_of_body)
    }),
    ("self_intersection_worst_cm3", |found| Some(found.worst_cm3)),
    ("self_intersection_worst_s", |found| Some(found.worst_s)),
    ("self_intersection_frames_above_50_cm3_percent", |found| {
        Some(found.frames_above_50_cm3_percent)
    }),
    ("crease_mean_cm3", |found| Some(found.crease_mean_cm3)),
];

const SIA: [Named<SiaScore>; 3] = [
    ("sia_self_intersection_cm3", |found| {
        Some(found.self_intersection_cm3)
    }),
    ("sia_volume_cm3", |found| Some(found.volume_cm3)),
    ("sia_self_intersection_percent", |found| {
        Some(found.self_intersection_percent)
    }),
];

/// The measures of a score; those not measured are left out.
pub fn measures(score: &MotionScore) -> Vec<(Cow<'static, str>, f64)> {
    let mut measures = Vec::new();
    add(&mut measures, &CLIP, Some(score));
    add(&mut measures, &FLOOR, Some(score));
    add(
        &mut measures,
        &SELF_INTERSECTION,
        score.self_intersection.as_ref(),
    );
    add(&mut measures, &GroundScore::NAMED, score.ground.as_ref());
    add(&mut measures, &FeetScore::NAMED, score.feet.as_ref());
    add(&mut measures, &BalanceScore::NAMED, score.balance.as_ref());
    add(
        &mut measures,
        &SmoothnessScore::NAMED,
        score.smoothness.as_ref(),
    );
    add(&mut measures, &SIA, score.sia.as_ref());
    for published in &score.published {
        for (name, value) in &published.measures {
            if let Some(value) = *value {
                measures.push((published_name(published.protocol, name), value));
            }
        }
    }
    measures
}

/// Names of all measures that these protocols and groups can have, in the order of reports.
pub fn measure_names(protocols: &[Protocol], groups: &[Group]) -> Vec<Cow<'static, str>> {
    let mut names = Vec::new();
    let native = |group| protocols.contains(&Protocol::Native) && groups.contains(&group);
    add_names(&mut names, &CLIP, true);
    add_names(&mut names, &FLOOR, needs_floor(protocols, groups));
    add_names(
        &mut names,
        &SELF_INTERSECTION,
        native(Group::SelfIntersection),
    );
    add_names(&mut names, &GroundScore::NAMED, native(Group::Ground));
    add_names(&mut names, &FeetScore::NAMED, native(Group::Feet));
    add_names(&mut names, &BalanceScore::NAMED, native(Group::Balance));
    add_names(
        &mut names,
        &SmoothnessScore::NAMED,
        native(Group::Smoothness),
    );
    add_names(&mut names, &SIA, protocols.contains(&Protocol::Sia));
    for &protocol in protocols {
        if let Protocol::Published(published) = protocol {
            let of_protocol = published.measure_names().iter();
            names.extend(of_protocol.map(|name| published_name(protocol, name)));
        }
    }
    names
}

/// Whether anything is asked for that stands on a floor.
pub(crate) fn needs_floor(protocols: &[Protocol], groups: &[Group]) -> bool {
    protocols.iter().any(|protocol| match protocol {
        Protocol::Native => groups.iter().any(|&group| group != Group::SelfIntersection),
        Protocol::Sia => false,
        Protocol::Published(_) => true,
    })
}

/// `gmd_skating_ratio` for the skating ratio of GMD.
fn published_name(protocol: Protocol, measure: &str) -> Cow<'static, str> {
    format!("{}_{measure}", protocol.name().replace('-', "_")).into()
}

fn add<Score>(
    measures: &mut Vec<(Cow<'static, str>, f64)>,
    named: &[Named<Score>],
    score: Option<&Score>,
) {
    let Some(score) = score else { return };
    let found = named
        .iter()
        .filter_map(|(name, value)| Some(((*name).into(), value(score)?)));
    measures.extend(found);
}

fn add_names<Score>(names: &mut Vec<Cow<'static, str>>, named: &[Named<Score>], wanted: bool) {
    if wanted {
        names.extend(named.iter().map(|&(name, _)| Cow::from(name)));
    }
}

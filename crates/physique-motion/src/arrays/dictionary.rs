//! Dictionaries of arrays: which format their keys make, for one person or for several.

use physique_files::Data;

use super::{Context, joints, mdm, parameters, phalp, rows};
use crate::fields::Fields;
use crate::npz::Array;
use crate::read::Part;
use crate::{Error, ReadOptions, SourceMotion, amass, native};

/// People within people are no format of ours.
const DEEPEST: usize = 2;

/// All motions of a dictionary.
pub(super) fn read(context: &Context<'_>, data: &Data) -> Result<Vec<Part>, Error> {
    match one_person(context, data, "") {
        Some(parts) => parts,
        None if phalp::holds(data) => phalp::read(context, data),
        None => people(context, data, "", 0),
    }
}

/// The motions of a dictionary whose keys are those of a format.
fn one_person(context: &Context<'_>, data: &Data, place: &str) -> Option<Result<Vec<Part>, Error>> {
    if mdm::holds(data) {
        return Some(mdm::read(context, data));
    }
    let mut fields = Fields::of_tree(data, place, context.path, context.options);
    let one = |format, recording: Result<_, Error>| {
        let motion = SourceMotion::Body(recording?);
        Ok(vec![Part::only(format, motion)])
    };
    if fields.contains(native::MARK) {
        return Some(one("Physique motion", native::from_fields(&mut fields)));
    }
    let has_rate = ["mocap_framerate", "mocap_frame_rate"]
        .iter()
        .any(|key| fields.contains(key));
    if amass::holds(&fields) && (has_rate || fields.contains("pose_body")) {
        return Some(one("AMASS", amass::from_fields(&mut fields)));
    }
    if let Some(format) = parameters::format_of(&fields) {
        return Some(one(format.name, format.read(&mut fields)));
    }
    if mdm::holds_rotations(data) {
        return Some(mdm::read_rotations(&mut fields));
    }
    single_array(context, data)
}

/// The only array of a dictionary that has the shape of a motion.
fn single_array(context: &Context<'_>, data: &Data) -> Option<Result<Vec<Part>, Error>> {
    let arrays = data.entries().iter().filter_map(|(_, value)| match value {
        Data::Array(array) if is_motion(array) => Some(array),
        _ => None,
    });
    let arrays: Vec<_> = arrays.collect();
    match arrays.as_slice() {
        [array] => Some(at_rate_beside(context, data, array)),
        _ => None,
    }
}

/// An array's motions, at the frame rate that the dictionary states beside it.
fn at_rate_beside(context: &Context<'_>, data: &Data, array: &Array) -> Result<Vec<Part>, Error> {
    let mut fields = Fields::of_tree(data, "", context.path, context.options);
    let is_stated = parameters::RATE_KEYS.iter().any(|key| fields.contains(key));
    if !is_stated || context.options.frame_rate.is_some() {
        return super::one_array(context, array);
    }
    let rate = parameters::frame_rate(&mut fields, &parameters::RATE_KEYS, None, &mut Vec::new())?;
    let options = ReadOptions {
        frame_rate: Some(rate),
        ..context.options.clone()
    };
    let path = context.path;
    let options = &options;
    super::one_array(&Context { path, options }, array)
}

/// Whether an array has the shape of features, positions or rows of rotations.
fn is_motion(array: &Array) -> bool {
    joints::Axes::of(array.shape()).is_some() || rows::holds(array)
}

/// The motions of a dictionary or list of dictionaries or arrays, one a person.
fn people(
    context: &Context<'_>,
    data: &Data,
    place: &str,
    depth: usize,
) -> Result<Vec<Part>, Error> {
    let numbered;
    let entries: Vec<(&str, &Data)> = match data {
        Data::List(items) => {
            numbered = (0..items.len())
                .map(|index| index.to_string())
                .collect::<Vec<_>>();
            numbered.iter().map(String::as_str).zip(items).collect()
        }
        _ => {
            let entries = data.entries().iter();
            entries.map(|(key, value)| (key.as_str(), value)).collect()
        }
    };
    let mut found = Vec::new();
    for (key, person) in entries {
        let path = if place.is_empty() {
            key.to_owned()
        } else {
            format!("{place}.{key}")
        };
        let parts = match person {
            Data::Dict(_) => one_person(context, person, &path),
            Data::Array(array) if is_motion(array) => Some(at_rate_beside(context, data, array)),
            _ => None,
        };
        let parts = match (parts, person) {
            (Some(parts), _) => parts,
            (None, Data::Dict(_) | Data::List(_)) if depth < DEEPEST => {
                match people(context, person, &path, depth + 1) {
                    Ok(parts) => {
                        found.extend(parts);
                        continue;
                    }
                    Err(_) => continue,
                }
            }
            _ => continue,
        };
        match parts {
            Ok(parts) => found.extend(parts.into_iter().map(|part| Part {
                key: match part.key.as_str() {
                    "" => path.clone(),
                    inner => format!("{path}.{inner}"),
                },
                ..part
            })),
            Err(error) => found.push(Part {
                key: path,
                text: None,
                format: "",
                motion: Err(error),
            }),
        }
    }
    if found.is_empty() {
        return Err(context.unknown(describe(data)));
    }
    Ok(found)
}

/// What a dictionary of no known format looks like: those that people have are named.
fn describe(data: &Data) -> String {
    let has = |keys: &[&str]| keys.iter().any(|key| data.get(key).is_some());
    let inner_has = |keys: &[&str]| {
        let mut inner = data.entries().iter().map(|(_, value)| value);
        inner.any(|value| keys.iter().any(|key| value.get(key).is_some()))
    };
    const ROBOT: [&str; 5] = ["dof_pos", "dof", "qpos", "joint_pos", "root_trans_offset"];
    if has(&ROBOT) || inner_has(&ROBOT) {
        return "joint angles of a robot, which has no human body: score the human motion that it \
                was retargeted from"
            .into();
    }
    if has(&["mean"]) && has(&["std"]) {
        return "means and deviations of features, which are no motion".into();
    }
    if has(&["v_template", "shapedirs"]) {
        return "a body model, which goes to --body, not a motion".into();
    }
    let entries = data.entries();
    let shown: Vec<_> = entries
        .iter()
        .take(12)
        .map(|(key, value)| format!("`{}`: {}", key.escape_debug(), value.kind()))
        .collect();
    let more = if entries.len() > shown.len() {
        ", ..."
    } else {
        ""
    };
    match data {
        Data::Dict(_) => format!("a dictionary of {}{more}", shown.join(", ")),
        other => other.kind(),
    }
}

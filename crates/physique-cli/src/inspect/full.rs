//! Everything about a file, for a person, in 100 columns.

use std::fmt::Write as _;

use physique::inspect::{
    BodyInspection, FileInspection, MotionInspection, Movement, SourceInspection,
};

use super::joint_table::joint_table;

/// Widest line.
const COLUMNS: usize = 100;
/// Where facts begin, behind their names.
const FACTS: usize = 14;

/// A file and all that is in it.
pub(super) fn file(file: &FileInspection) -> String {
    let mut text = heading(file);
    if let Some(reason) = &file.unreadable {
        fact(&mut text, "unreadable", reason);
    }
    if let Some(found) = &file.body {
        body(&mut text, found);
    }
    for motion in &file.motions {
        if file.motions.len() > 1 {
            let _ = writeln!(text, "\n{}", motion.name);
        }
        motion_facts(&mut text, motion);
    }
    text
}

fn heading(file: &FileInspection) -> String {
    let mut title = file.file.clone();
    if let Some(bytes) = file.bytes {
        title += &format!(", {}", size(bytes));
    }
    format!("{title}\n{}\n", "─".repeat(COLUMNS))
}

fn size(bytes: u64) -> String {
    match bytes {
        0..1_000 => format!("{bytes} bytes"),
        1_000..1_000_000 => format!("{:.0} kB", bytes as f64 / 1e3),
        _ => format!("{:.1} MB", bytes as f64 / 1e6),
    }
}

fn body(text: &mut String, body: &BodyInspection) {
    fact(text, "body model", &body.name);
    let mesh = format!(
        "{} vertices, {} triangles, {} open edges, {} parts",
        body.vertices, body.triangles, body.open_edges, body.components
    );
    fact(text, "mesh", &mesh);
    let skin = format!(
        "{} joints, up to {} a vertex; {} betas, {} pose directions",
        body.joints, body.influences, body.betas, body.pose_directions
    );
    fact(text, "skeleton", &skin);
    fact(text, "mean body", &format!("{:.2} m tall", body.stature_m));
}

fn motion_facts(text: &mut String, motion: &MotionInspection) {
    if let Some(shown) = &motion.text {
        fact(text, "text", shown);
    }
    if let Some(format) = motion.format {
        let time = format!(
            "{} frames at {} a second, {:.2} s",
            motion.frames,
            rate(motion.frame_rate_fps),
            motion.seconds
        );
        fact(text, "format", &format!("{format}: {time}"));
    }
    if let Some(source) = &motion.source {
        fact(text, "skeleton", &skeleton(source));
        fact(text, "world", &world(source));
    }
    if let Some(movement) = &motion.movement {
        fact(text, "person", &person(motion, movement));
        fact(text, "movement", &way(movement));
    }
    if let Some(fall) = motion.hardest_fall_g {
        let says = if fall < 0.8 {
            "nothing falls freely, so the motion cannot confirm its frame rate"
        } else {
            "gravity's own, as far as 22 joints tell"
        };
        let says = if fall > 2.5 {
            "more than gravity can do"
        } else {
            says
        };
        fact(text, "hardest fall", &format!("{fall:.1} g: {says}"));
    }
    if let Some(fit) = &motion.fit {
        let error = format!(
            "{:.1} cm mean, {:.1} cm in 95 of 100, {:.1} cm at worst, from the joints of our body",
            fit.mean_error_cm, fit.p95_error_cm, fit.worst_error_cm
        );
        fact(text, "fit", &error);
    }
    if !motion.range_of_motion.is_empty() {
        text.push('\n');
        *text += &joint_table(motion);
    }
    if let Some(source) = &motion.source
        && !source.unmatched.is_empty()
    {
        fact(text, "not followed", &source.unmatched.join(", "));
    }
    for note in &motion.notes {
        fact(text, "note", note);
    }
    for warning in &motion.warnings {
        fact(
            text,
            "! warning",
            &format!("{}: {}", warning.kind, warning.message),
        );
    }
    if motion.warnings.is_empty() && motion.source.is_some() {
        fact(text, "warnings", "none");
    }
}

/// A rate as people write it.
pub(super) fn rate(per_second: f64) -> f64 {
    (per_second * 100.0).round() / 100.0
}

fn skeleton(source: &SourceInspection) -> String {
    let mut text = match source.holds {
        "positions" => format!("positions of {} joints", source.joints),
        "body" => format!("rotations of the body's {} joints", source.joints),
        _ => format!("{} joints", source.joints),
    };
    if let Some(by) = &source.matched_by {
        text += &format!(", matched by {by}");
    }
    if let Some(by) = &source.aligned_by {
        text += &format!(", axes by {by}");
    }
    text
}

fn world(source: &SourceInspection) -> String {
    let unit = source.metres_per_unit.map(|metres| match metres {
        1.0 => "metres".to_owned(),
        0.01 => "centimetres".to_owned(),
        0.001 => "millimetres".to_owned(),
        0.0254 => "inches".to_owned(),
        metres => format!("units of {:.3} cm", 100.0 * metres),
    });
    let unit = unit.unwrap_or_else(|| "units of its own".to_owned());
    format!("{unit}, {} up", source.up_axis)
}

fn person(motion: &MotionInspection, movement: &Movement) -> String {
    let stature = motion.stature_m.map_or(String::new(), |metres| {
        format!("{metres:.2} m tall by the legs, ")
    });
    let degrees = movement.facing_degrees.round();
    let axis = match degrees {
        -45.0..=45.0 => "+Z",
        45.0..=135.0 => "+X",
        -135.0..=-45.0 => "-X",
        _ => "-Z",
    };
    let sides = if motion
        .warnings
        .iter()
        .any(|warning| warning.kind == "sides")
    {
        "left and right look exchanged"
    } else {
        "left and right as named"
    };
    format!("{stature}faces {axis} at first ({degrees:.0}° from +Z to +X), {sides}")
}

fn way(movement: &Movement) -> String {
    let [x, z] = movement.floor_m;
    let [low, high] = movement.pelvis_height_m;
    let turned = movement.turned_degrees.round();
    let side = if turned < 0.0 { "right" } else { "left" };
    format!(
        "{:.2} m at {:.2} m/s, {:.2} m from start to end, on {x:.2} m x {z:.2} m (X x Z); turns {:.0}° to the {side}; pelvis {low:.2} to {high:.2} m high",
        movement.path_m,
        movement.mean_speed_m_s,
        movement.displacement_m,
        turned.abs(),
    )
}

/// A named fact, wrapped below itself.
fn fact(text: &mut String, name: &str, fact: &str) {
    let mut line = format!("{name:<FACTS$}");
    let mut used = FACTS;
    for (index, word) in fact.split_whitespace().enumerate() {
        let width = word.chars().count();
        if index > 0 && used + 1 + width > COLUMNS {
            *text += line.trim_end();
            text.push('\n');
            line = " ".repeat(FACTS);
            used = FACTS;
        } else if index > 0 {
            line.push(' ');
            used += 1;
        }
        line += word;
        used += width;
    }
    *text += line.trim_end();
    text.push('\n');
}

//! An index that can be trusted.

use physique::motion::FrameRate;
use physique::motion::features::FeatureStatistics;

use crate::Index;

/// Place, expectation and finding.
type Problem = (String, String, String);

/// Holds every number of the index against what it counts.
pub(super) fn index(index: &Index, rows: u64, columns: u32) -> Result<(), Problem> {
    let expect = |holds: bool,
                  place: &dyn Fn() -> String,
                  expected: &dyn Fn() -> String,
                  found: &dyn Fn() -> String| {
        match holds {
            true => Ok(()),
            false => Err((place(), expected(), found())),
        }
    };
    let own = |text: &'static str| move || text.to_owned();
    expect(
        index.columns() == columns as usize,
        &own("head"),
        &|| format!("{} numbers in a row", index.columns()),
        &|| columns.to_string(),
    )?;
    let rate = FrameRate::new(index.frame_rate);
    expect(
        rate.is_ok(),
        &own("frame_rate"),
        &own("a number above 0"),
        &|| index.frame_rate.to_string(),
    )?;
    let (shortest, longest) = (index.shortest_window, index.longest_window);
    expect(
        1 <= shortest && shortest <= longest && longest <= 1 << 20,
        &own("windows"),
        &own("1 <= shortest <= longest <= 2^20"),
        &|| format!("{shortest} and {longest}"),
    )?;
    let statistics = FeatureStatistics::new(
        index.skeleton.into(),
        index.mean.clone(),
        index.deviation.clone(),
    );
    if let Err(problem) = statistics {
        let expected = "mean and deviation of every column";
        return Err(("statistics".into(), expected.into(), problem.to_string()));
    }
    recordings(index, rows)?;
    for (number, clip) in index.clips.iter().enumerate() {
        let of = index.recordings.get(clip.recording);
        let length = of.map_or(0, |recording| index.feature_rows(recording));
        let end = clip.start.checked_add(clip.frames);
        let is_inside = clip.frames > 0 && end.is_some_and(|end| end <= length);
        expect(
            is_inside,
            &|| format!("clip {number}"),
            &|| format!("rows within the {length} of recording {}", clip.recording),
            &|| format!("{} from {}", clip.frames, clip.start),
        )?;
        expect(
            clip.captions < index.caption_sets.len(),
            &|| format!("clip {number}"),
            &|| format!("one of {} caption sets", index.caption_sets.len()),
            &|| clip.captions.to_string(),
        )?;
    }
    for (number, set) in index.caption_sets.iter().enumerate() {
        let place = || format!("caption set {number}");
        let count = index.captions.len();
        let wrong = set
            .training
            .iter()
            .chain(&set.held_out)
            .find(|&&caption| caption >= count);
        if let Some(wrong) = wrong {
            return Err((
                place(),
                format!("captions below {count}"),
                wrong.to_string(),
            ));
        }
        let are_weights = set.weights.len() == set.training.len()
            && set
                .weights
                .iter()
                .all(|weight| weight.is_finite() && *weight > 0.0);
        expect(
            are_weights,
            &place,
            &|| format!("{} weights above 0", set.training.len()),
            &|| format!("{:?}", &set.weights[..set.weights.len().min(8)]),
        )?;
    }
    Ok(())
}

/// One after the other, without gaps, up to the last row.
fn recordings(index: &Index, rows: u64) -> Result<(), Problem> {
    let mut next = 0_u64;
    for (number, recording) in index.recordings.iter().enumerate() {
        let end = next.checked_add(recording.rows as u64);
        let fits = recording.rows > 0 && recording.first_row == next;
        match end.filter(|&end| fits && end <= rows) {
            Some(end) => next = end,
            None => {
                return Err((
                    format!("recording {number}"),
                    format!("rows from {next} on, {rows} in all"),
                    format!("{} from {}", recording.rows, recording.first_row),
                ));
            }
        }
    }
    match next == rows {
        true => Ok(()),
        false => Err((
            "recordings".into(),
            format!("{rows} rows in all"),
            next.to_string(),
        )),
    }
}

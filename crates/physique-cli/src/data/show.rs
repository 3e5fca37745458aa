//! `physique data show`.

use anyhow::Result;
use physique_data::{DataLimits, Dataset, Storage};

use super::arguments::ShowArguments;
use super::table;
use crate::exit::Exit;
use crate::text_table::{Column, render};

pub(crate) fn run(arguments: &ShowArguments) -> Result<Exit> {
    let dataset = Dataset::open(&arguments.file, &DataLimits::default())?;
    if arguments.verify {
        dataset.verify()?;
    }
    let index = dataset.index();
    if arguments.json {
        println!("{}", serde_json::to_string_pretty(&index.report)?);
    } else if arguments.clips {
        clips(&dataset);
    } else if arguments.left_out {
        for left_out in &index.report.left_out {
            let reason = left_out.reason.name();
            println!("{}: {reason}: {}", left_out.name, left_out.message);
        }
    } else {
        let stored = match index.storage {
            Storage::Positions => "positions of joints, features by window",
            Storage::Features => "features",
        };
        println!("{} ({}; {})", index.name, index.licence, index.attribution);
        println!(
            "{stored}, {} columns, {} frames a second, windows of {} to {} rows",
            index.mean.len(),
            index.frame_rate,
            index.shortest_window,
            index.longest_window
        );
        table::print(&index.report);
    }
    Ok(Exit::Done)
}

fn clips(dataset: &Dataset) {
    let index = dataset.index();
    let columns = [
        Column::words(&["clip"]),
        Column::words(&["split"]),
        Column::number("s", &["seconds"]),
        Column::words(&["caption"]),
    ];
    let rows: Vec<Vec<String>> = index
        .clips
        .iter()
        .map(|clip| {
            let captions = &index.caption_sets[clip.captions].training;
            let caption = captions
                .first()
                .map(|&caption| index.captions[caption].text.clone());
            vec![
                index.clip_name(clip),
                clip.split.name().to_owned(),
                format!("{:.1}", clip.frames as f64 / index.frame_rate),
                caption.unwrap_or_default(),
            ]
        })
        .collect();
    print!("{}", render(&columns, &rows));
}

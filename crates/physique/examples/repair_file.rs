//! Repairs a motion file and prints every measure before and after.
//!
//! ```text
//! cargo run --release -p physique --example repair_file -- walk.bvh fixed.bvh
//! ```

use std::path::Path;

use physique::body::{Body, Sex, open_body};
use physique::export::{ExportFormat, ExportOptions, Provenance, export};
use physique::load::{LoadOptions, load};
use physique::measures::measures;
use physique::proxy::open_proxy;
use physique::{RepairOptions, Repairer};

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let mut arguments = std::env::args().skip(1);
    let (Some(input), Some(output)) = (arguments.next(), arguments.next()) else {
        return Err("usage: repair_file IN OUT.bvh".into());
    };
    let body = Body::mean(open_body()?, Sex::Neutral)?;
    let proxy = open_proxy()?;
    let repairer = Repairer::new(
        body.clone(),
        proxy.of_body(&body)?,
        &proxy.pairs()?,
        RepairOptions::default(),
    )?;
    let loaded = load(Path::new(&input), &body, &LoadOptions::default())?;
    let repaired = repairer.repair(&loaded.motion)?;
    let after = measures(&repaired.after);
    for (name, before) in measures(&repaired.before) {
        let after = after.iter().find(|(other, _)| *other == name);
        let after = after.map_or("-".to_owned(), |(_, after)| format!("{after:.2}"));
        println!("{name:48} {before:10.2} {after:>10}");
    }
    for worse in &repaired.held_back_by {
        println!("going further would bring {worse}");
    }
    let options = ExportOptions::new(ExportFormat::Bvh);
    export(
        Path::new(&output),
        &repaired.motion,
        &body,
        Provenance::default(),
        &options,
    )?;
    Ok(())
}

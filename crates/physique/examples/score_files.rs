//! Scores motion files on the mean body: `cargo run --example score_files -- walk.bvh ...`.

use std::path::Path;

use physique::body::{Body, Sex, open_body};
use physique::load::{LoadOptions, load};
use physique::{ScoreOptions, Scorer};

fn main() -> Result<(), physique::Error> {
    let body = Body::mean(open_body()?, Sex::Neutral)?;
    let scorer = Scorer::new(body, ScoreOptions::default())?;
    for file in std::env::args().skip(1) {
        let loaded = load(Path::new(&file), scorer.body(), &LoadOptions::default())?;
        let score = scorer.score(&loaded.motion)?;
        if let Some(found) = score.self_intersection {
            println!(
                "{:8.1} cm3 mean {:8.1} worst {:6.1} creases  {file}",
                found.mean_cm3, found.worst_cm3, found.crease_mean_cm3
            );
            for pair in found.pairs.iter().filter(|pair| !pair.crease).take(3) {
                println!("    {:?} {:.1} cm3", pair.parts, pair.mean_cm3);
            }
        }
    }
    Ok(())
}

//! Encodes the lines of a text file into a `.npy` of `[captions][384]`, to hold against other
//! programs: `encode_captions CAPTIONS.txt OUT.npy [FOLDER_OF_A_BERT]`.

use std::error::Error;
use std::path::Path;
use std::time::Instant;

use physique_files::npz::npy_f32;
use physique_text::{MiniLm, TextEncoder, TextLimits};

fn main() -> Result<(), Box<dyn Error>> {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    let (captions, output) = match arguments.as_slice() {
        [captions, output, ..] => (captions, output),
        _ => return Err("expected CAPTIONS.txt OUT.npy [FOLDER]".into()),
    };
    let start = Instant::now();
    let encoder = match arguments.get(2) {
        Some(folder) => MiniLm::read(Path::new(folder), &TextLimits::default())?,
        None => MiniLm::embedded()?,
    };
    println!("opened in {:.0} ms", start.elapsed().as_secs_f64() * 1e3);
    let text = std::fs::read_to_string(captions)?;
    let captions: Vec<&str> = text.lines().collect();
    let start = Instant::now();
    let found = encoder.encode(&captions);
    let seconds = start.elapsed().as_secs_f64();
    println!("{} captions in {seconds:.2} s", captions.len());
    let shape = [found.captions(), found.width()];
    std::fs::write(output, npy_f32(&shape, found.values())?)?;
    Ok(())
}

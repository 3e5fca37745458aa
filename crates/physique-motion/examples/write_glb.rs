//! Writes an embedded clip on the open body as a skinned, animated figure.
//!
//! ```text
//! cargo run -p physique-motion --example write_glb -- dance dance.glb
//! ```

use std::error::Error;

use physique_body::{Body, open_body};
use physique_motion::{embedded, glb};

fn main() -> Result<(), Box<dyn Error>> {
    let mut arguments = std::env::args().skip(1);
    let name = arguments.next().unwrap_or_else(|| "dance".into());
    let path = arguments.next().unwrap_or_else(|| format!("{name}.glb"));

    let body = Body::new(open_body()?, &[])?;
    let clip = embedded::clip(&name).ok_or("no such clip")?.load()?;
    glb::write(&path, &glb::SkinnedMesh::of(&body), &clip.motion)?;
    println!(
        "{path}: {} frames, {:.2} s",
        clip.motion.frame_count(),
        clip.motion.seconds()
    );
    Ok(())
}

//! Makes the embedded clips from PyPI `pybullet`'s copy of DeepMimic's motions.
//!
//! ```text
//! cargo run -p physique-motion --example embed_clips -- WHEEL FOLDER
//! ```
//!
//! reads the wheel `pybullet-3.2.7-*.whl` (any platform's: the motions are the same), checks every
//! source against its hash, maps it to the open body, and writes `FOLDER/*.motion.npz` and
//! `FOLDER/sha256sums`. The same input gives the same bytes.

#![allow(missing_docs)]

use std::error::Error;
use std::fmt::Write as _;
use std::fs::{self, File};
use std::io::Read as _;
use std::path::Path;

use physique_body::{Body, open_body};
use physique_motion::mapping::{BodyRest, MappingOptions, map_to_body};
use physique_motion::{ReadOptions, Recording, deep_mimic, native};
use sha2::{Digest, Sha256};

/// Name of each clip, of its source, and the hash of that.
const CLIPS: [(&str, &str, &str); 6] = [
    (
        "dance",
        "dance_b",
        "b5a9d7a3f2304f6242776d7ff6d19d1f6bcb98d78d68622761c3843b614a92b5",
    ),
    (
        "get_up",
        "getup_faceup",
        "5936c32d51dad9b0cd5e61df681079d160436cdce845c312f200d7a347c4040d",
    ),
    (
        "jump",
        "jump",
        "a433557e94b193d8a95530572a0e32f387eb6d9996987b4216efb65444c3c641",
    ),
    (
        "spin_kick",
        "spinkick",
        "60ec9c200d96e0cd71693061f24db0bd8da9eb295daf487f6f60f8dfb324075a",
    ),
    (
        "walk",
        "walk",
        "32d082c3599bc40aac50b1afa196ff1e2cf3842bb40f0541ab088845f6328a41",
    ),
    (
        "run",
        "run",
        "2cbe488023b243e5769299158ce7c78875ec4b701a2ffe6c0beeaf83d16ca87b",
    ),
];

fn main() -> Result<(), Box<dyn Error>> {
    let mut arguments = std::env::args().skip(1);
    let (Some(wheel), Some(folder)) = (arguments.next(), arguments.next()) else {
        return Err("usage: embed_clips WHEEL FOLDER".into());
    };
    let mut wheel = zip::ZipArchive::new(File::open(wheel)?)?;
    let body = Body::new(open_body()?, &[])?;
    let mut sums = String::new();
    for (name, source, expected) in CLIPS {
        let entry = format!("pybullet_data/data/motions/humanoid3d_{source}.txt");
        let mut text = Vec::new();
        wheel.by_name(&entry)?.read_to_end(&mut text)?;
        let found = hex(&text);
        if found != expected {
            return Err(format!("{entry}: expected SHA-256 {expected}, found {found}.").into());
        }
        let clip = deep_mimic::parse(&text, &entry, &ReadOptions::default())?;
        let mapped = map_to_body(&clip, &BodyRest::from(&body), &MappingOptions::default())?;
        let recording = Recording {
            motion: mapped.motion,
            name: name.into(),
            rest_pelvis: body.rest_joints()[0],
            source: Some(format!(
                "PyPI pybullet 3.2.7, {entry} (SHA-256 {found}); a motion of DeepMimic, altered: \
                 mapped from its humanoid to the open body"
            )),
            licence: Some("zlib, as the wheel's LICENSE.txt says".into()),
            notes: Vec::new(),
        };
        let bytes = native::to_npz(&recording)?;
        let file = format!("{name}.motion.npz");
        writeln!(sums, "{}  {file}", hex(&bytes))?;
        fs::write(Path::new(&folder).join(file), bytes)?;
    }
    fs::write(Path::new(&folder).join("sha256sums"), sums)?;
    Ok(())
}

fn hex(bytes: &[u8]) -> String {
    let digest = Sha256::digest(bytes);
    digest.iter().map(|byte| format!("{byte:02x}")).collect()
}

//! Every embedded asset has a card that states its hash.

use std::fs;
use std::path::{Path, PathBuf};

use anyhow::{Context, Result, bail, ensure};
use sha2::{Digest, Sha256};

use crate::shell::root;

/// SHA-256 of a file in hexadecimal.
pub(crate) fn hash(path: &Path) -> Result<String> {
    let bytes = fs::read(path).with_context(|| format!("reading {}", path.display()))?;
    let digest = Sha256::digest(&bytes);
    Ok(digest.iter().map(|byte| format!("{byte:02x}")).collect())
}

/// Checks that each asset's hash stands in a card of its folder: `*.md`, or the `sha256sums` that
/// the card refers to. Licence texts (`*.txt`) are no assets.
pub(crate) fn check() -> Result<()> {
    println!("== asset cards");
    let mut missing = Vec::new();
    let mut count = 0;
    for folder in asset_folders()? {
        let has_ending = |path: &Path, ending| path.extension().is_some_and(|e| e == ending);
        let is_card = |path: &PathBuf| has_ending(path, "md") || path.ends_with("sha256sums");
        let files = files(&folder)?
            .into_iter()
            .filter(|path| !has_ending(path, "txt"));
        let (cards, assets): (Vec<_>, Vec<_>) = files.partition(is_card);
        let cards = cards
            .iter()
            .map(fs::read_to_string)
            .collect::<Result<String, _>>()?;
        for asset in assets {
            count += 1;
            let hash = hash(&asset)?;
            if !cards.contains(&hash) {
                missing.push(format!("{} ({hash})", asset.display()));
            }
        }
    }
    ensure!(
        count > 0,
        "no assets found: this check has lost its folders"
    );
    if !missing.is_empty() {
        bail!("no card states the hash of:\n  {}", missing.join("\n  "));
    }
    println!("== asset cards: {count} assets match their cards");
    Ok(())
}

/// The `assets` folder of every crate, and the folders within.
fn asset_folders() -> Result<Vec<PathBuf>> {
    let mut folders = Vec::new();
    for krate in fs::read_dir(root().join("crates"))? {
        let assets = krate?.path().join("assets");
        if assets.is_dir() {
            for entry in fs::read_dir(&assets)? {
                folders.extend(Some(entry?.path()).filter(|path| path.is_dir()));
            }
            folders.push(assets);
        }
    }
    folders.sort();
    Ok(folders)
}

fn files(folder: &Path) -> Result<Vec<PathBuf>> {
    let mut files = Vec::new();
    for entry in fs::read_dir(folder)? {
        let path = entry?.path();
        if path.is_file() {
            files.push(path);
        }
    }
    files.sort();
    Ok(files)
}

//! Rebuilds every embedded asset from its public source and compares hashes.

use std::fs;
use std::path::Path;
use std::process::Command;

use anyhow::{Context, Result, bail};

use crate::cards::hash;
use crate::python::environment;
use crate::shell::{root, scratch, step};

/// A script that builds assets: its folder below `tools/` holds `build.py` and
/// `requirements.txt`; `build.py --output FOLDER` fetches its source and writes all files.
struct Recipe {
    tool: &'static str,
    /// Where the built files live.
    assets: &'static str,
}

const RECIPES: [Recipe; 4] = [
    Recipe {
        tool: "open_body",
        assets: "crates/physique-body/assets",
    },
    Recipe {
        tool: "clips",
        assets: "crates/physique-motion/assets",
    },
    Recipe {
        tool: "minilm",
        assets: "crates/physique-text/assets",
    },
    Recipe {
        tool: "fonts",
        assets: "crates/physique-view/assets",
    },
];

pub(crate) fn run(write: bool) -> Result<()> {
    let mut differing = Vec::new();
    for recipe in RECIPES {
        let tool = root().join("tools").join(recipe.tool);
        let built = scratch().join("assets").join(recipe.tool);
        if built.exists() {
            fs::remove_dir_all(&built)?;
        }
        fs::create_dir_all(&built)?;
        let python = environment(recipe.tool, &tool.join("requirements.txt"))?;
        step(
            &format!("build {}", recipe.tool),
            Command::new(python)
                .arg(tool.join("build.py"))
                .arg("--output")
                .arg(&built)
                .current_dir(root()),
        )?;
        compare(&built, &root().join(recipe.assets), write, &mut differing)?;
    }
    if differing.is_empty() {
        println!("== every asset is what its source makes");
    } else if !write {
        bail!("rebuilt assets differ from the embedded ones: {differing:?}");
    }
    Ok(())
}

/// Compares what was built with what is embedded, file by file; every built file must be there.
fn compare(built: &Path, embedded: &Path, write: bool, differing: &mut Vec<String>) -> Result<()> {
    let mut count = 0;
    for entry in fs::read_dir(built)? {
        let built = entry?.path();
        let name = built.file_name().context("a built file without a name")?;
        let embedded = embedded.join(name);
        let same = embedded.exists() && hash(&built)? == hash(&embedded)?;
        println!(
            "   {} {}",
            if same { "same   " } else { "DIFFERS" },
            embedded.display()
        );
        if !same {
            differing.push(name.to_string_lossy().into_owned());
            if write {
                fs::copy(&built, &embedded)?;
            }
        }
        count += 1;
    }
    if count == 0 {
        bail!("nothing was built in {}", built.display());
    }
    Ok(())
}

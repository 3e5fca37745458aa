//! A virtual environment of pinned Python packages below the target folder.

use std::path::{Path, PathBuf};
use std::process::Command;

use anyhow::Result;

use crate::shell::{scratch, step};

/// The interpreter of an environment called `name` that has `requirements` installed.
pub(crate) fn environment(name: &str, requirements: &Path) -> Result<PathBuf> {
    let folder = scratch().join(name);
    let python = folder.join("bin/python");
    if !python.exists() {
        step(
            &format!("make the Python environment `{name}`"),
            Command::new("python3").args(["-m", "venv"]).arg(&folder),
        )?;
    }
    step(
        &format!("install {}", requirements.display()),
        Command::new(&python)
            .args([
                "-m",
                "pip",
                "install",
                "--quiet",
                "--disable-pip-version-check",
                "-r",
            ])
            .arg(requirements),
    )?;
    Ok(python)
}

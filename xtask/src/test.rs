//! Everything that CI demands.

use anyhow::Result;

use crate::cards;
use crate::shell::{cargo, step};

/// What is off by default and tested all the same: kernels for graphics processors. Documentation is
/// built without it, as users build the crates.
const GPU: &str = "physique-cli/wgpu";

pub(crate) fn run() -> Result<()> {
    step("format", &mut cargo(&["fmt", "--all", "--check"]))?;
    cards::check()?;
    step(
        "lints",
        &mut cargo(&[
            "clippy",
            "--workspace",
            "--all-targets",
            "--locked",
            "--features",
            GPU,
            "--",
            "-D",
            "warnings",
        ]),
    )?;
    // Library and command code may not panic; tests, benches and examples may.
    step(
        "no panics in libraries",
        &mut cargo(&[
            "clippy",
            "--workspace",
            "--lib",
            "--bins",
            "--locked",
            "--features",
            GPU,
            "--",
            "-D",
            "warnings",
            "-D",
            "clippy::unwrap_used",
            "-D",
            "clippy::expect_used",
            "-D",
            "clippy::panic",
        ]),
    )?;
    step(
        "documentation",
        cargo(&["doc", "--workspace", "--no-deps", "--locked"]).env("RUSTDOCFLAGS", "-D warnings"),
    )?;
    let tests = ["test", "--workspace", "--locked", "--features", GPU];
    step("tests", &mut cargo(&tests))
}

//! The table of attacks in `docs/safety.md`: every test writes its own part when
//! `PHYSIQUE_WRITE_SAFETY` is set, and otherwise compares what happened with what stands there.

#![allow(
    clippy::unwrap_used,
    clippy::expect_used,
    reason = "a test that cannot go on says where"
)]

use std::time::Duration;
use std::{env, fs};

const PAGE: &str = "../../docs/safety.md";

/// What came of a hostile file.
pub(crate) struct Row {
    pub(crate) file: String,
    pub(crate) bytes: usize,
    pub(crate) tried: String,
    pub(crate) happened: String,
    pub(crate) peak: usize,
    pub(crate) time: Duration,
}

impl Row {
    /// The columns that are the same on every machine.
    fn constant(&self) -> String {
        // Neither a bar nor a line break may end a cell.
        let cell = |text: &str| text.replace('|', "/").replace(['\n', '\r'], " ");
        let (file, tried) = (cell(&self.file), cell(&self.tried));
        format!(
            "| {file} | {} | {tried} | {} |",
            self.bytes,
            cell(&self.happened)
        )
    }

    fn line(&self) -> String {
        let peak = self.peak / 1000;
        let time = self.time.as_secs_f64() * 1e3;
        format!("{} {peak} kB | {time:.1} ms |\n", self.constant())
    }
}

/// Writes the rows between the marks of `part`, or panics where the page tells another story.
pub(crate) fn write_or_compare(part: &str, rows: &[Row]) {
    let page = fs::read_to_string(PAGE).unwrap();
    let (begin, end) = (
        format!("<!-- {part} -->\n"),
        format!("<!-- end of {part} -->\n"),
    );
    let start = page.find(&begin).expect("the page has the part") + begin.len();
    let stop = page.find(&end).expect("the part ends");
    if env::var_os("PHYSIQUE_WRITE_SAFETY").is_none() {
        for row in rows {
            let constant = row.constant();
            assert!(
                page[start..stop].contains(&constant),
                "docs/safety.md lacks {constant}: run with PHYSIQUE_WRITE_SAFETY=1"
            );
        }
        return;
    }
    let head = "| file | bytes | what it tries | what happens | memory | time |\n|---|--:|---|---|--:|--:|\n";
    let lines: String = rows.iter().map(Row::line).collect();
    let page = format!("{}{head}{lines}{}", &page[..start], &page[stop..]);
    fs::write(PAGE, page).unwrap();
}

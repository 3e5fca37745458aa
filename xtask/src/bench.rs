//! Runs the benchmarks and prints one table, with goals and, where asked for, peers.

mod peers;

use anyhow::Result;
use comfy_table::{CellAlignment, Table, presets};

use crate::shell::{cargo, output};

/// What a benchmark must reach (milliseconds), and its stretch goal.
struct Goal {
    benchmark: &'static str,
    goal: f64,
    stretch: f64,
}

/// One benchmark's medians.
struct Row {
    crate_name: &'static str,
    name: String,
    milliseconds: f64,
}

const CRATES: [&str; 6] = [
    "physique-geometry",
    "physique-body",
    "physique-motion",
    "physique-proxy",
    "physique",
    "physique-view",
];

/// Examples that measure what no benchmark can, and print a table of their own.
const TABLES: [(&str, &str); 2] = [
    ("physique-proxy", "fit_speed"),
    ("physique", "sphere_against_mesh"),
];

/// Goals of whole groups: every benchmark whose name begins so.
const GOALS: [Goal; 7] = [
    Goal {
        benchmark: "sia_voxels/",
        goal: 0.05,
        stretch: 0.03,
    },
    Goal {
        benchmark: "covered_volumes/10/",
        goal: 0.6,
        stretch: 0.3,
    },
    Goal {
        benchmark: "overlaps_by_body_part/",
        goal: 0.6,
        stretch: 0.3,
    },
    Goal {
        benchmark: "triangle_pairs/",
        goal: 3.0,
        stretch: 1.0,
    },
    Goal {
        benchmark: "triangle_pairs_with_shared_vertices/",
        goal: 3.0,
        stretch: 1.0,
    },
    // Before `native_hour`, with which its name begins, too.
    Goal {
        benchmark: "native_hour_without_self_intersection",
        goal: 15_000.0,
        stretch: 8_000.0,
    },
    Goal {
        benchmark: "native_hour",
        goal: 60_000.0,
        stretch: 30_000.0,
    },
];

pub(crate) fn run(peers: bool) -> Result<()> {
    let mut rows = Vec::new();
    for crate_name in CRATES {
        println!("== {crate_name}");
        let printed = output(crate_name, &mut cargo(&["bench", "--package", crate_name]))?;
        rows.extend(medians(&printed).map(|(name, milliseconds)| Row {
            crate_name,
            name,
            milliseconds,
        }));
    }
    let mut table = Table::new();
    table.load_style(presets::UTF8_HORIZONTAL_ONLY);
    table.set_header([
        "crate",
        "benchmark",
        "median, ms",
        "goal, ms",
        "stretch, ms",
        "met",
    ]);
    for row in &rows {
        let goal = GOALS
            .iter()
            .find(|goal| row.name.starts_with(goal.benchmark));
        let met = goal.map_or("", |goal| match row.milliseconds {
            ms if ms <= goal.stretch => "stretch",
            ms if ms <= goal.goal => "goal",
            _ => "no",
        });
        let limit = |limit: fn(&Goal) -> f64| goal.map_or(String::new(), |g| limit(g).to_string());
        table.add_row([
            row.crate_name.to_owned(),
            row.name.clone(),
            format!("{:.4}", row.milliseconds),
            limit(|goal| goal.goal),
            limit(|goal| goal.stretch),
            met.to_owned(),
        ]);
    }
    for column in 2..5 {
        if let Some(column) = table.column_mut(column) {
            column.set_cell_alignment(CellAlignment::Right);
        }
    }
    println!("{table}");
    for (package, example) in TABLES {
        let mut command = cargo(&["run", "--release", "-p", package, "--example", example]);
        println!("== {example}\n{}", output(example, &mut command)?);
    }
    if peers {
        peers::skinning(&rows)?;
        peers::sphere_loss()?;
        peers::step_time()?;
    }
    Ok(())
}

/// Names and medians in milliseconds of divan's tree: the third column of each line with times.
///
/// A name is the path through the tree, as in `covered_volumes/10/rest`; each level is indented by
/// three characters.
fn medians(printed: &str) -> impl Iterator<Item = (String, f64)> + '_ {
    let mut path: Vec<String> = Vec::new();
    printed.lines().filter_map(move |line| {
        let (branch, rest) = line.split_once("─ ")?;
        let depth = branch.chars().count().saturating_sub(1) / 3;
        // Names end where the columns begin, after at least two blanks.
        let name = rest.split("  ").next()?.trim();
        path.truncate(depth);
        path.push(name.to_owned());
        let median = milliseconds(rest.split('│').nth(2)?)?;
        Some((path.join("/"), median))
    })
}

/// "12.5 µs" in milliseconds.
fn milliseconds(cell: &str) -> Option<f64> {
    let (number, unit) = cell.trim().split_once(' ')?;
    let scale = match unit.trim() {
        "ns" => 1e-6,
        "µs" => 1e-3,
        "ms" => 1.0,
        "s" => 1e3,
        _ => return None,
    };
    Some(number.parse::<f64>().ok()? * scale)
}

#[cfg(test)]
mod tests {
    use super::medians;

    #[test]
    fn reads_the_tree_that_divan_prints() {
        let printed = "\
Timer precision: 20 ns
skinning                  fastest       │ slowest       │ median        │ mean          │ samples │ iters
├─ batch                  542.3 µs      │ 2.042 ms      │ 690.2 µs      │ 711 µs        │ 100     │ 100
│                         118 Kitem/s   │ 31.34 Kitem/s │ 92.71 Kitem/s │ 90 Kitem/s    │         │
├─ sizes                                │               │               │               │         │
│  ├─ arms down           1.5 ms        │ 2.042 ms      │ 1.7 ms        │ 711 µs        │ 100     │ 100
│  ╰─ deep                              │               │               │               │         │
│     ╰─ 128              1.5 s         │ 2.042 s       │ 1.7 s         │ 711 µs        │ 100     │ 100
╰─ one                    17.61 µs      │ 111.2 µs      │ 17.73 µs      │ 18.74 µs      │ 100     │ 100
";
        let found: Vec<_> = medians(printed).collect();
        let expected = [
            ("batch", 0.6902),
            ("sizes/arms down", 1.7),
            ("sizes/deep/128", 1700.0),
            ("one", 0.01773),
        ];
        assert_eq!(found.len(), expected.len());
        for ((name, ms), (expected_name, expected_ms)) in found.iter().zip(expected) {
            assert_eq!(name, expected_name);
            assert!((ms / expected_ms - 1.0).abs() < 1e-9, "{name}: {ms}");
        }
    }
}

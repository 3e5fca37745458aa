//! How well the sphere loss agrees with the volume that a body really covers twice, over frames of real
//! motion: rank correlation, and how well it tells frames that intersect by more than 50 cm³.
//!
//! ```sh
//! cargo run --release --example proxy_agreement -- FOLDER [scatter.svg]
//! ```
//!
//! 5,000 frames, spread evenly over all BVH files below the folder; the truth is the column scan at
//! 1 cm with creases apart. A loss needs a threshold to tell frames apart: the one of the best F1 score
//! on every second file is tried on the other files.

#[path = "support/chart.rs"]
mod chart;

use std::path::{Path, PathBuf};

use physique::body::{Body, Sex, open_body};
use physique::load::{LoadOptions, load};
use physique::motion::Motion;
use physique::proxy::{Pairs, PoseMatrices, SelfIntersection, open_proxy_with, pose_matrices};
use physique::{ScoreOptions, Scorer};
use rayon::prelude::*;

use chart::{Axis, Picture};

type Failure = Box<dyn std::error::Error>;

const FRAMES: usize = 5_000;
const INTERSECTS_CM3: f64 = 50.0;
const SIZES: [usize; 3] = [128, 192, 256];
/// Which pairs are compared. Creases are between neighbours, which the last two leave out: parts fewer
/// than two, and three, steps apart in the tree of joints.
const KINDS: [&str; 4] = [
    "all of different joints",
    "reduced, as in the paper",
    "reduced, no neighbours",
    "reduced, three steps apart",
];
const LOSSES: usize = KINDS.len() * SIZES.len();

/// One frame: which file it is of, the truth, and what the losses say.
struct Row {
    file: usize,
    cm3: f64,
    losses: [f64; LOSSES],
}

fn main() -> Result<(), Failure> {
    let mut arguments = std::env::args().skip(1);
    let folder = arguments.next().ok_or("expected a folder of BVH files")?;
    let mut files = Vec::new();
    find(Path::new(&folder), &mut files)?;
    files.sort();
    let body = Body::mean(open_body()?, Sex::Neutral)?;
    let mut losses = Vec::new();
    for size in SIZES {
        let proxy = open_proxy_with(size)?;
        let spheres = proxy.of_body(&body)?;
        let joint = |sphere| spheres.dominant_joint(sphere);
        let steps = |i, j| joint(i).tree_distance(joint(j));
        let reduced = proxy.pairs()?;
        for pairs in [
            Pairs::all(size)?.filtered(|i, j| steps(i, j) >= 1),
            reduced.filtered(|i, j| steps(i, j) >= 1),
            reduced.filtered(|i, j| steps(i, j) >= 2),
            reduced.filtered(|i, j| steps(i, j) >= 3),
        ] {
            losses.push((pairs.len(), SelfIntersection::new(&spheres, &pairs)?));
        }
    }
    let scorer = Scorer::new(body, ScoreOptions::default())?;

    let rows: Vec<Vec<Row>> = files
        .par_iter()
        .enumerate()
        .map(|(file, path)| {
            let Ok(loaded) = load(path, scorer.body(), &LoadOptions::default()) else {
                eprintln!("{}: left out", path.display());
                return Vec::new();
            };
            let share = (file + 1) * FRAMES / files.len() - file * FRAMES / files.len();
            let measured = measure(file, share, &loaded.motion, &scorer, &losses);
            measured.unwrap_or_else(|problem| {
                eprintln!("{}: {problem}", path.display());
                Vec::new()
            })
        })
        .collect();
    let rows: Vec<Row> = rows.into_iter().flatten().collect();
    let positive = rows.iter().filter(|row| row.cm3 > INTERSECTS_CM3).count();
    let some = rows.iter().filter(|row| row.cm3 > 0.0).count();
    println!(
        "{} frames of {} files; {some} with some intersection, {positive} above {INTERSECTS_CM3} cm³\n",
        rows.len(),
        files.len()
    );
    println!(
        "| spheres | pairs | | rank correlation | the same where it intersects | precision | recall \
         | F1 | threshold, cm² | loss 0 where nothing intersects |"
    );
    println!("|--:|--:|---|--:|--:|--:|--:|--:|--:|--:|");
    for (index, (pairs, _)) in losses.iter().enumerate() {
        let (size, kind) = (SIZES[index / KINDS.len()], KINDS[index % KINDS.len()]);
        report(size, *pairs, kind, index, &rows);
    }
    if let Some(path) = arguments.next() {
        std::fs::write(&path, scatter(&rows))?;
    }
    Ok(())
}

/// BVH files below a folder.
fn find(folder: &Path, files: &mut Vec<PathBuf>) -> Result<(), Failure> {
    for entry in std::fs::read_dir(folder)? {
        let path = entry?.path();
        if path.is_dir() {
            find(&path, files)?;
        } else if path.extension().is_some_and(|ending| ending == "bvh") {
            files.push(path);
        }
    }
    Ok(())
}

/// Some frames of a motion, evenly spread.
fn measure(
    file: usize,
    share: usize,
    motion: &Motion,
    scorer: &Scorer,
    losses: &[(usize, SelfIntersection)],
) -> Result<Vec<Row>, Failure> {
    let count = motion.frame_count();
    let share = share.min(count);
    let chosen: Vec<usize> = (0..share)
        .map(|number| (2 * number + 1) * count / (2 * share))
        .collect();
    let rotations = chosen
        .iter()
        .flat_map(|&frame| motion.frame_rotations(frame).to_vec());
    let roots = chosen.iter().map(|&frame| motion.root_translation()[frame]);
    let still = Motion::new(
        motion.frame_rate(),
        None,
        roots.collect(),
        rotations.collect(),
    )?;
    let truth = scorer.self_intersections(&still, |_| ())?;
    let poses: Vec<PoseMatrices> = (0..share)
        .map(|frame| pose_matrices(still.frame_rotations(frame)))
        .collect();
    let mut rows: Vec<Row> = truth
        .iter()
        .map(|frame| Row {
            file,
            cm3: frame.intersection_cm3,
            losses: [0.0; LOSSES],
        })
        .collect();
    let mut found = vec![0.0; share];
    for (index, (_, loss)) in losses.iter().enumerate() {
        loss.losses(&poses, &mut found)?;
        for (row, &loss) in rows.iter_mut().zip(&found) {
            row.losses[index] = f64::from(loss);
        }
    }
    Ok(rows)
}

fn report(spheres: usize, pairs: usize, kind: &str, index: usize, rows: &[Row]) {
    let of = |rows: &mut dyn Iterator<Item = &Row>| -> Vec<(f64, f64)> {
        rows.map(|row| (row.losses[index], row.cm3)).collect()
    };
    let all = of(&mut rows.iter());
    let intersecting = of(&mut rows.iter().filter(|row| row.cm3 > 0.0));
    let threshold = best_threshold(of(&mut rows.iter().filter(|row| row.file % 2 == 0)));
    let tried = of(&mut rows.iter().filter(|row| row.file % 2 == 1));
    let [precision, recall, f1] = told(&tried, threshold);
    let clean = all.iter().filter(|row| row.1 == 0.0);
    let silent = clean.clone().filter(|row| row.0 == 0.0).count();
    println!(
        "| {spheres} | {pairs} | {kind} | {:.3} | {:.3} | {:.1} % | {:.1} % | {:.3} | {:.2} | {:.1} % |",
        rank_correlation(&all),
        rank_correlation(&intersecting),
        100.0 * precision,
        100.0 * recall,
        f1,
        1e4 * threshold,
        100.0 * silent as f64 / clean.count().max(1) as f64
    );
}

/// Precision, recall and F1 of "the loss is above the threshold" for "more than 50 cm³".
fn told(rows: &[(f64, f64)], threshold: f64) -> [f64; 3] {
    let count = |told: bool, true_: bool| {
        let is =
            |row: &&(f64, f64)| (row.0 > threshold) == told && (row.1 > INTERSECTS_CM3) == true_;
        rows.iter().filter(is).count() as f64
    };
    let (hits, alarms, misses) = (count(true, true), count(true, false), count(false, true));
    [
        hits / (hits + alarms).max(1.0),
        hits / (hits + misses).max(1.0),
        2.0 * hits / (2.0 * hits + alarms + misses).max(1.0),
    ]
}

/// The threshold of the best F1 score: half-way between two losses.
fn best_threshold(mut rows: Vec<(f64, f64)>) -> f64 {
    rows.sort_by(|a, b| b.0.total_cmp(&a.0));
    let positive = rows.iter().filter(|row| row.1 > INTERSECTS_CM3).count() as f64;
    let (mut hits, mut best) = (0.0, (0.0, 0.0));
    for (told, pair) in rows.windows(2).enumerate() {
        hits += f64::from(u8::from(pair[0].1 > INTERSECTS_CM3));
        let f1 = 2.0 * hits / (told as f64 + 1.0 + positive);
        if pair[0].0 > pair[1].0 && f1 > best.0 {
            best = (f1, (pair[0].0 + pair[1].0) / 2.0);
        }
    }
    best.1
}

/// Spearman's: the correlation of ranks, equals sharing their mean.
fn rank_correlation(rows: &[(f64, f64)]) -> f64 {
    let a = ranks(rows.iter().map(|row| row.0).collect());
    let b = ranks(rows.iter().map(|row| row.1).collect());
    let mean = (rows.len() as f64 - 1.0) / 2.0;
    let product = |a: &[f64], b: &[f64]| -> f64 {
        let terms = a.iter().zip(b).map(|(a, b)| (a - mean) * (b - mean));
        terms.sum()
    };
    product(&a, &b) / (product(&a, &a) * product(&b, &b)).sqrt()
}

fn ranks(numbers: Vec<f64>) -> Vec<f64> {
    let mut order: Vec<usize> = (0..numbers.len()).collect();
    order.sort_by(|&a, &b| numbers[a].total_cmp(&numbers[b]));
    let mut ranks = vec![0.0; numbers.len()];
    let mut start = 0;
    for equals in order.chunk_by(|&a, &b| numbers[a] == numbers[b]) {
        let mean = start as f64 + (equals.len() as f64 - 1.0) / 2.0;
        equals.iter().for_each(|&place| ranks[place] = mean);
        start += equals.len();
    }
    ranks
}

/// Volume against the loss of 192 spheres.
fn scatter(rows: &[Row]) -> String {
    let mut picture = Picture::new();
    for kind in [1, 3] {
        let index = KINDS.len() + kind;
        let title = format!("192 spheres, pairs {}", KINDS[kind]);
        let x = Axis {
            title: "volume covered twice, cm³ (creases apart)",
            ticks: &[
                (0.0, "0"),
                (1.0, "1"),
                (10.0, "10"),
                (50.0, "50"),
                (100.0, "100"),
                (1e3, "1,000"),
                (1e4, "10,000"),
            ],
            range: [0.0, 1e4],
            scale: |cm3| (1.0 + cm3).ln(),
        };
        let y = Axis {
            title: "sphere loss, cm²",
            ticks: &[
                (0.0, "0"),
                (1.0, "1"),
                (10.0, "10"),
                (100.0, "100"),
                (1e3, "1,000"),
                (1e4, "10,000"),
            ],
            range: [0.0, 1e4],
            scale: |cm2| (1.0 + cm2).ln(),
        };
        let points: Vec<_> = rows
            .iter()
            .map(|row| (row.cm3.min(1e4), (1e4 * row.losses[index]).min(1e4)))
            .collect();
        picture.chart(&title, x, y).dots("#1f5fa8", &points);
    }
    picture.finish()
}

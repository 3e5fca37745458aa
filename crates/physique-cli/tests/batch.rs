//! Large jobs: in parts, continued, put together, with bad clips left out.

#![allow(clippy::unwrap_used)]

use std::fs;
use std::path::Path;
use std::process::{Command, Stdio};
use std::time::Duration;

use assert_cmd::cargo::cargo_bin;

mod support;
use support::{at, fails, succeeds, write_bvh};

/// Seven clips, one of them broken, and a job over them without the slow measure.
fn folder_of_seven() -> tempfile::TempDir {
    let folder = tempfile::tempdir().unwrap();
    for (index, name) in ["walk", "run", "jump", "dance", "walk", "run"]
        .iter()
        .enumerate()
    {
        write_bvh(
            &folder.path().join(format!("clips/{index}_{name}.bvh")),
            name,
        );
    }
    fs::write(folder.path().join("clips/6_broken.bvh"), "HIERARCHY\n").unwrap();
    folder
}

const FAST: [&str; 4] = ["score", "--without", "self", "--series"];

#[test]
fn parts_put_together_are_the_whole_to_the_byte() {
    let folder = folder_of_seven();
    let clips = at(&folder, "clips");
    let parts = [1, 2, 3].map(|part| {
        let [output, shard] = [at(&folder, &format!("{part}.jsonl")), format!("{part}/3")];
        // One clip is broken: the part that has it fails, and says so in its output, too.
        let code = if part == 1 { 1 } else { 0 };
        fails(
            code,
            &[&FAST[..], &[&clips, "--shard", &shard, "-o", &output]].concat(),
        );
        output
    });
    for name in ["whole.jsonl", "whole.json", "whole.csv", "whole.parquet"] {
        let [whole, merged] = [at(&folder, name), at(&folder, &format!("merged_{name}"))];
        fails(1, &[&FAST[..], &[&clips, "-o", &whole]].concat());
        // The order in which parts are given does not matter.
        let [one, two, three] = &parts;
        fails(1, &["score", "--merge", three, one, two, "-o", &merged]);
        assert_eq!(
            fs::read(whole).unwrap(),
            fs::read(merged).unwrap(),
            "{name}"
        );
    }
    let [one, two, _] = &parts;
    assert!(fails(1, &["score", "--merge", one, two]).contains("part 3/3 is missing"));
    assert!(fails(1, &["score", "--merge", two, one, two]).contains("given twice"));
    let whole = at(&folder, "whole.jsonl");
    assert!(fails(1, &["score", "--merge", &whole]).contains("not a part"));
    let cut = at(&folder, "cut.jsonl");
    let text = fs::read_to_string(one).unwrap();
    let kept: Vec<_> = text.lines().take(2).collect();
    fs::write(&cut, kept.join("\n")).unwrap();
    assert!(fails(1, &["score", "--merge", &cut, two, &parts[2]]).contains("expected 3 files"));
}

#[test]
fn parts_of_other_jobs_are_refused() {
    let folder = folder_of_seven();
    let clips = at(&folder, "clips");
    let [one, two] = ["one.jsonl", "two.jsonl"].map(|name| at(&folder, name));
    let part = |shard: &str, output: &str, more: &[&str]| {
        let common = [
            "score", "--only", "feet", &clips, "--shard", shard, "-o", output,
        ];
        support::physique(&[&common[..], more].concat());
    };
    part("1/2", &one, &[]);
    part("2/2", &two, &["--floor", "lowest"]);
    assert!(fails(1, &["score", "--merge", &one, &two]).contains("scored otherwise"));
    fs::remove_file(folder.path().join("clips/0_walk.bvh")).unwrap();
    part("2/2", &two, &[]);
    assert!(fails(1, &["score", "--merge", &one, &two]).contains("another job"));
    let text = fails(
        1,
        &[
            "score",
            &clips,
            "--shard",
            "1/2",
            "-o",
            &at(&folder, "part.csv"),
        ],
    );
    assert!(text.contains(".jsonl"), "{text}");
}

/// Starts the command, waits until its journal holds some files, kills it.
fn killed_in_the_middle(arguments: &[&str], journal: &Path, whole: usize) {
    let mut child = Command::new(cargo_bin("physique"))
        .args(arguments)
        .stdout(Stdio::null())
        .stderr(Stdio::null())
        .spawn()
        .unwrap();
    // A line says what the run is, then a line a file.
    let done = || fs::read_to_string(journal).map_or(0, |text| text.lines().count());
    while done() < 3 {
        assert_eq!(
            child.try_wait().unwrap(),
            None,
            "it ended before it was killed"
        );
        std::thread::sleep(Duration::from_millis(1));
    }
    child.kill().unwrap();
    child.wait().unwrap();
    assert!((3..=whole).contains(&done()), "{}", done());
}

#[test]
fn a_killed_run_continues_and_its_output_is_that_of_an_unbroken_one() {
    let folder = tempfile::tempdir().unwrap();
    write_bvh(&folder.path().join("clips/00.bvh"), "dance");
    for index in 1..12 {
        let copy = folder.path().join(format!("clips/{index:02}.bvh"));
        fs::copy(folder.path().join("clips/00.bvh"), copy).unwrap();
    }
    let clips = at(&folder, "clips");
    let [broken, unbroken] = [at(&folder, "a.json"), at(&folder, "b.json")];
    let common = ["--threads", "1", "score", "--spacing", "0.02", &clips, "-o"];
    let arguments = |output| [&common[..], &[output]].concat();
    let journal = folder.path().join("a.json.partial");
    killed_in_the_middle(&arguments(&broken), &journal, 12);
    assert!(!Path::new(&broken).exists(), "no output before all is done");
    // Cut off in the middle of a line, as a full disk or a power failure would.
    let text = fs::read(&journal).unwrap();
    fs::write(&journal, &text[..text.len() - 10]).unwrap();

    let other_options = [&arguments(&broken)[..], &["--floor", "lowest"]].concat();
    assert!(fails(1, &other_options).contains("other options"));
    let output = support::physique(&arguments(&broken));
    let said = support::text(&output.stderr);
    assert!(said.contains("of 12 files are already done"), "{said}");
    succeeds(&arguments(&unbroken));
    assert_eq!(fs::read(&broken).unwrap(), fs::read(&unbroken).unwrap());
    assert!(!journal.exists());
}

#[test]
fn bad_clips_are_left_out() {
    let folder = folder_of_seven();
    let clips = at(&folder, "clips");
    let list = at(&folder, "bad.txt");
    succeeds(&["scan", "--only", "unreadable", &clips, "-o", &list]);
    let table = succeeds(&["score", "--only", "feet", "--exclude", &list, &clips]);
    assert!(
        !table.contains("6_broken.bvh") && table.contains("5_run.bvh"),
        "{table}"
    );
}

/// Four motions of a generator in one file.
fn generated(folder: &tempfile::TempDir) -> String {
    let results = at(folder, "clips/results.npy");
    fs::create_dir_all(folder.path().join("clips")).unwrap();
    let fixture = "../physique-motion/tests/fixtures/arrays/mdm_results.npy";
    fs::copy(fixture, &results).unwrap();
    results
}

#[test]
fn motions_of_a_file_are_left_out_by_their_numbers() {
    let folder = tempfile::tempdir().unwrap();
    let (results, list) = (generated(&folder), at(&folder, "bad.txt"));
    let lines = format!("{results}#1\n{results}#3\n{results}#9\nelsewhere/walk.bvh\n");
    fs::write(&list, lines).unwrap();
    let score = ["score", "--only", "feet", "--csv", "--exclude", &list];
    let output = support::physique(&[&score[..], &[&results]].concat());
    let (table, said) = (support::text(&output.stdout), support::text(&output.stderr));
    let has = |key: u8| table.contains(&format!("results.npy#{key}"));
    assert_eq!([0, 1, 2, 3].map(has), [true, false, true, false], "{table}");
    for word in ["holds no results.npy#9", "1 of the lines"] {
        assert!(said.contains(word), "{said}");
    }
    // A run with another list is another job.
    let output = at(&folder, "part.jsonl");
    let part = |more: &[&str]| {
        let common = ["score", "--only", "feet", &results, "--shard", "1/1"];
        succeeds(&[&common[..], more].concat());
    };
    part(&["-o", &output]);
    let other = at(&folder, "other.jsonl");
    part(&["-o", &other, "--exclude", &list]);
    let jobs = [output, other].map(|path| {
        let text = fs::read_to_string(path).unwrap();
        let head = text.lines().next().unwrap();
        let sum = head.split("files_sha256").nth(1).unwrap();
        sum[..60].to_owned()
    });
    assert_ne!(jobs[0], jobs[1]);
}

#[test]
fn statistics_among_motions_are_passed_over() {
    let folder = tempfile::tempdir().unwrap();
    generated(&folder);
    let mean = at(&folder, "clips/Mean.npy");
    for name in ["Mean.npy", "Std.npy"] {
        let path = folder.path().join("clips").join(name);
        let bytes = physique::motion::npz::npy_f32(&[263], &[0.5; 263]).unwrap();
        fs::write(path, bytes).unwrap();
    }
    let clips = at(&folder, "clips");
    let converted = at(&folder, "bvh");
    for arguments in [
        vec!["score", "--only", "feet", &clips],
        vec!["scan", "--only", "unreadable", &clips],
        vec!["inspect", &clips],
        vec!["convert", &clips, &converted, "--to", "bvh"],
    ] {
        let output = support::physique(&arguments);
        let said = support::text(&output.stderr);
        assert!(output.status.success(), "{arguments:?}: {said}");
        for word in ["2 files", "Mean.npy", "Std.npy"] {
            assert!(said.contains(word), "{arguments:?}: {said}");
        }
        assert!(!support::text(&output.stdout).contains("Mean"));
    }
    let said = fails(1, &["score", "--only", "feet", &mean]);
    assert!(said.contains("--mean or --std"), "{said}");
}

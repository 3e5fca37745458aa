//! Hostile proxies: what each file must come to, in little memory and time, with nothing run.
//!
//! `PHYSIQUE_WRITE_SAFETY=1 cargo test -p physique-proxy --test attacks` writes the table in
//! `docs/safety.md`.

#![allow(clippy::unwrap_used, reason = "a test that cannot go on says where")]

use std::collections::BTreeSet;
use std::fs;
use std::path::Path;
use std::time::{Duration, Instant};

use physique_proxy::files::ProxyLimits;

mod hostile;
#[path = "../../../attacks/support/memory.rs"]
mod memory;
#[path = "../../../attacks/support/table.rs"]
mod table;

use hostile::{Published, use_proxy};
use table::Row;

const ATTACKS: &str = "../../attacks/proxy";
const TRACE: &str = "physique_was_here";
const LIMITS: ProxyLimits = ProxyLimits {
    bytes: 32 << 20,
    parameters: 8 << 20,
    spheres: 4_096,
};
/// Beside the file itself.
const LARGEST_PEAK: usize = LIMITS.bytes as usize;
const LONGEST: Duration = Duration::from_secs(5);

/// A hostile file, and what must happen: a word of its error, or nothing where it is harmless.
struct Attack {
    file: String,
    bytes: Vec<u8>,
    stands_for: Option<String>,
    tries: String,
    word: String,
}

/// The files of the folder, as its list says.
fn small() -> Vec<Attack> {
    let list = fs::read_to_string(Path::new(ATTACKS).join("expected.tsv")).unwrap();
    let attacks = list.lines().map(|line| {
        let [file, stands_for, tries, word] = line.split('\t').collect::<Vec<_>>()[..] else {
            panic!("four columns, not {line}");
        };
        Attack {
            file: file.into(),
            bytes: fs::read(Path::new(ATTACKS).join(file)).unwrap(),
            stands_for: Some(stands_for.to_owned()).filter(|file| !file.is_empty()),
            tries: tries.into(),
            word: word.into(),
        }
    });
    attacks.collect()
}

/// What needs more than a small file: made here.
fn large() -> Vec<Attack> {
    let file = |header: String| {
        let length = (header.len() as u64).to_le_bytes();
        [&length[..], header.as_bytes()].concat()
    };
    let array = "\"a\":{\"dtype\":\"F32\",\"shape\":[0],\"data_offsets\":[0,0]},";
    let arrays = format!("{{{}}}", array.repeat(300_000).trim_end_matches(','));
    let spaces = format!("{{{}}}", " ".repeat(1_000_000));
    [
        (
            "arrays.safetensors",
            "300,000 empty arrays",
            arrays,
            "its header",
        ),
        (
            "spaces.safetensors",
            "a header of 1,000,000 spaces",
            spaces,
            "physique-proxy 1",
        ),
    ]
    .map(|(name, tries, header, word)| Attack {
        file: format!("{name} (made by the test)"),
        bytes: file(header),
        stands_for: None,
        tries: tries.into(),
        word: word.into(),
    })
    .into()
}

#[test]
fn every_attack_comes_to_nothing() {
    let attacks = small();
    let listed: BTreeSet<&str> = attacks.iter().map(|attack| &*attack.file).collect();
    let there = fs::read_dir(ATTACKS).unwrap();
    let there = there.map(|entry| entry.unwrap().file_name().into_string().unwrap());
    let unlisted: Vec<String> = there
        .filter(|name| !listed.contains(&**name) && !name.ends_with(".tsv"))
        .collect();
    assert!(unlisted.is_empty(), "not in expected.tsv: {unlisted:?}");

    let folder = Published::new();
    let here = folder.path("").display().to_string();
    let mut rows = Vec::new();
    let mut wrong = Vec::new();
    for attack in attacks.into_iter().chain(large()) {
        let Attack {
            file,
            bytes,
            stands_for,
            tries,
            word,
        } = attack;
        let (before, start) = (memory::start(), Instant::now());
        let found = folder.read(&file, stands_for.as_deref(), &bytes, &LIMITS);
        if let Ok(proxy) = &found {
            use_proxy(proxy);
        }
        let (peak, time) = (memory::peak() - before, start.elapsed());
        let happened = match &found {
            Ok(proxy) => format!("harmless: {} spheres", proxy.sphere_count()),
            Err(error) => {
                let text = error.to_string().replace(&here, "");
                text.chars().take(170).collect()
            }
        };
        let as_expected = match &found {
            Ok(_) => word.is_empty(),
            Err(error) => {
                let text = error.to_string();
                let named = stands_for.as_deref().unwrap_or(&file);
                let folder = text.contains(here.trim_end_matches('/'));
                !word.is_empty() && text.contains(&word) && (text.contains(named) || folder)
            }
        };
        if !as_expected || peak > LARGEST_PEAK || time > LONGEST {
            wrong.push(format!(
                "{file}: expected `{word}`, found {happened}; {peak} bytes, {time:?}"
            ));
        }
        rows.push(Row {
            file: match stands_for {
                Some(stands_for) => format!("{file} as {stands_for}"),
                None => file,
            },
            bytes: bytes.len(),
            tried: tries,
            happened,
            peak,
            time,
        });
    }
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
    table::write_or_compare("attacks on proxies", &rows);
    for folder in [".", "..", "../..", ATTACKS] {
        assert!(!Path::new(folder).join(TRACE).exists(), "something was run");
    }
}

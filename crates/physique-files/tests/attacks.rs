//! Hostile files: what each must come to, in little memory and time, with nothing run.
//!
//! `PHYSIQUE_WRITE_SAFETY=1 cargo test -p physique-files --test attacks` writes the table in
//! `docs/safety.md`.

#![allow(clippy::unwrap_used)]

use std::collections::BTreeSet;
use std::fs;
use std::path::Path;
use std::time::{Duration, Instant};

use physique_files::npz::{ArrayError, ArrayLimits};
use physique_files::pickle::{Pickle, PickleError, PickleLimits};
use physique_files::{Error, named_arrays};

#[path = "../../../attacks/support/memory.rs"]
mod memory;
#[path = "../../../attacks/support/table.rs"]
mod table;

use table::Row;

const ATTACKS: &str = "../../attacks";
const TRACE: &str = "physique_was_here";
const LIMIT: u64 = 32 << 20;
/// The file, a copy of it, the limit, and what the table of values holds while it grows.
const LARGEST_PEAK: usize = 3 * LIMIT as usize;
const LONGEST: Duration = Duration::from_secs(5);

/// What must happen to each file.
#[rustfmt::skip]
const EXPECTED: &[(&str, Outcome)] = {
    use Outcome::{Data, Limit, Malformed, Refused, Truncated};
    &[
        ("os_system.pkl", Refused("os.system")),
        ("posix_system.pkl", Refused("posix.system")),
        ("nt_system.pkl", Refused("nt.system")),
        ("builtins_eval.pkl", Refused("builtins.eval")),
        ("builtins_exec.pkl", Refused("__builtin__.execfile")),
        ("builtins_open.pkl", Refused("builtins.open")),
        ("subprocess.pkl", Refused("subprocess.Popen")),
        ("protocol_4.pkl", Refused("posix.system")),
        ("getattr_chain.pkl", Refused("builtins.getattr")),
        ("dotted_name.pkl", Refused("numpy.core.os.system")),
        ("numpy_load.pkl", Refused("numpy.load")),
        ("numpy_runstring.pkl", Refused("numpy.testing._private.utils.runstring")),
        ("torch_load.pkl", Refused("torch.load")),
        ("instance.pkl", Refused("os.system")),
        ("object.pkl", Refused("os.system")),
        ("new_object.pkl", Refused("subprocess.Popen")),
        ("extension.pkl", Refused("copyreg.extension 1")),
        ("build_setstate.pkl", Refused("os.system")),
        ("objects.npy", Refused("os.system")),
        ("objects.npz", Refused("os.system")),
        ("torch.pt", Refused("os.system")),
        ("persistent_text.pkl", Malformed),
        ("call_of_text.pkl", Malformed),
        ("huge_text.pkl", Truncated),
        ("huge_text_8.pkl", Truncated),
        ("huge_bytes.pkl", Truncated),
        ("huge_long.pkl", Truncated),
        ("huge_frame.pkl", Truncated),
        ("negative_long.pkl", Malformed),
        ("negative_bytes.pkl", Malformed),
        ("huge_memo.pkl", Data),
        ("huge_memo_text.pkl", Malformed),
        ("digits.pkl", Data),
        ("billion_laughs.pkl", Limit),
        ("shared_text.pkl", Limit),
        ("deep_lists.pkl", Limit),
        ("deep_tuples.pkl", Limit),
        ("itself.pkl", Limit),
        ("dict_of_itself.pkl", Limit),
        ("chumpy_of_itself.pkl", Limit),
        ("duplicates.pkl", Data),
        ("underflow_pop.pkl", Malformed),
        ("underflow_reduce.pkl", Malformed),
        ("underflow_build.pkl", Malformed),
        ("underflow_mark.pkl", Malformed),
        ("through_mark.pkl", Malformed),
        ("odd_items.pkl", Malformed),
        ("empty_stop.pkl", Malformed),
        ("no_stop.pkl", Truncated),
        ("unknown_opcode.pkl", Malformed),
        ("protocol_9.pkl", Malformed),
        ("array_overflow.pkl", Malformed),
        ("array_overflow_64.pkl", Malformed),
        ("array_negative.pkl", Malformed),
        ("array_short.pkl", Malformed),
        ("array_many_dimensions.pkl", Malformed),
        ("array_of_nothing.pkl", Data),
        ("array_never_filled.pkl", Data),
        ("tensor_outside.pkl", Malformed),
        ("bomb.npz", Limit),
        ("bomb_that_lies.npz", Outcome::Array),
        ("overflow.npz", Outcome::Array),
        ("huge_shape.npz", Outcome::Array),
        ("huge_digits.npz", Outcome::Array),
        ("many_entries.npz", Limit),
        ("path.npz", Data),
        ("truncated.npz", Outcome::Array),
        ("directory_gone.npz", Outcome::Array),
        ("header.npy", Outcome::Array),
    ]
};

#[derive(Clone, Copy, Debug, PartialEq)]
enum Outcome {
    /// Refused by this name.
    Refused(&'static str),
    /// A limit ended it.
    Limit,
    /// A broken pickle.
    Malformed,
    /// Ends in the middle.
    Truncated,
    /// A broken array or archive.
    Array,
    /// Harmless: read as data.
    Data,
}

fn matches(outcome: Outcome, found: &Result<usize, Error>) -> bool {
    match (outcome, found) {
        (
            Outcome::Refused(expected),
            Err(Error::Pickle(PickleError::Refused { module, name, .. })),
        ) => format!("{module}.{name}") == expected,
        (
            Outcome::Limit,
            Err(Error::Pickle(PickleError::Limit { .. }) | Error::NamedArrays { .. }),
        )
        | (
            Outcome::Limit,
            Err(Error::Array(ArrayError::Bytes { .. } | ArrayError::Entries { .. })),
        )
        | (
            Outcome::Malformed,
            Err(Error::Pickle(PickleError::Malformed { .. } | PickleError::Call { .. })),
        )
        | (Outcome::Truncated, Err(Error::Pickle(PickleError::Truncated { .. })))
        | (Outcome::Array, Err(Error::Array(_)))
        | (Outcome::Data, Ok(_)) => true,
        _ => false,
    }
}

/// As a user's program would: by its ending first, then everything in it. Number of arrays.
fn read(
    name: &str,
    bytes: Vec<u8>,
    arrays: &ArrayLimits,
    pickles: &PickleLimits,
) -> Result<usize, Error> {
    if name.ends_with(".pkl") {
        Pickle::read(bytes.clone(), pickles)?;
        if !Pickle::looks_like(&bytes) {
            return Ok(0);
        }
    }
    Ok(named_arrays(bytes, arrays, pickles)?.len())
}

#[test]
fn every_attack_comes_to_nothing() {
    let listed: BTreeSet<String> = EXPECTED.iter().map(|(name, _)| (*name).into()).collect();
    let there: BTreeSet<String> = fs::read_dir(ATTACKS)
        .unwrap()
        .map(|entry| entry.unwrap())
        .filter(|entry| entry.file_type().unwrap().is_file())
        .map(|entry| entry.file_name().into_string().unwrap())
        .filter(|name| !name.ends_with(".py") && !name.ends_with(".md"))
        .collect();
    assert_eq!(
        listed, there,
        "every file is listed, and every listed file is there"
    );

    let arrays = ArrayLimits {
        bytes: LIMIT,
        ..ArrayLimits::default()
    };
    let pickles = PickleLimits {
        bytes: LIMIT,
        ..PickleLimits::default()
    };
    let mut rows = Vec::new();
    let mut wrong = Vec::new();
    for &(name, outcome) in EXPECTED {
        let bytes = fs::read(Path::new(ATTACKS).join(name)).unwrap();
        let length = bytes.len();
        let (before, start) = (memory::start(), Instant::now());
        let found = read(name, bytes, &arrays, &pickles);
        let (peak, time) = (memory::peak() - before, start.elapsed());
        let text = match &found {
            Ok(arrays) => format!("read as data, {arrays} arrays"),
            Err(error) => error.to_string().chars().take(160).collect(),
        };
        if !matches(outcome, &found) || peak > LARGEST_PEAK || time > LONGEST {
            wrong.push(format!(
                "{name}: expected {outcome:?}, found {text}, {peak} bytes, {time:?}"
            ));
        }
        let stem = name.rsplit_once('.').map_or(name, |(stem, _)| stem);
        rows.push(Row {
            file: name.into(),
            bytes: length,
            tried: stem.replace('_', " "),
            happened: text,
            peak,
            time,
        });
    }
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
    table::write_or_compare("attacks on arrays and pickles", &rows);
    for folder in [".", "..", "../..", ATTACKS] {
        assert!(!Path::new(folder).join(TRACE).exists(), "something was run");
        assert!(
            !Path::new(folder).join(format!("{TRACE}.npy")).exists(),
            "something was written"
        );
    }
}

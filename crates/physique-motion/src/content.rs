//! What a file is, by its first bytes and never by its ending.

use crate::acclaim::{self, AcclaimFile};
use crate::csv;
use crate::npz::Archive;
use physique_files::pickle::Pickle;
use physique_files::torch::TorchFile;

/// Kinds of files that are told apart before any reader is asked.
pub(crate) enum Content {
    /// A ZIP archive of NumPy arrays.
    Npz,
    /// A NumPy array, a pickle or a PyTorch file.
    Arrays,
    Bvh,
    /// Binary, or JSON.
    Gltf,
    /// The `.amc` of a pair.
    AcclaimMotion,
    DeepMimic,
    /// Text of ours.
    Csv(csv::Content),
    /// None that is read; what it looks like.
    Other(String),
}

impl Content {
    pub(crate) fn of(bytes: &[u8]) -> Self {
        /// Marks of files that people have, but that are not read.
        const MARKS: [(&[u8], &str); 2] = [
            (b"Kaydara FBX", "Autodesk FBX; Blender converts it to BVH"),
            (b"\xfd7zXZ", "an xz file; unpack it first"),
        ];
        if Archive::looks_like(bytes) {
            // PyTorch's archives name their entries in the open.
            let is_torch = bytes.windows(8).any(|window| window == b"data.pkl");
            return if is_torch { Self::Arrays } else { Self::Npz };
        }
        if bytes.is_empty() {
            return Self::Other("an empty file".into());
        }
        if let Some((_, name)) = MARKS.iter().find(|(mark, _)| bytes.starts_with(mark)) {
            return Self::Other((*name).into());
        }
        if bytes.starts_with(b"glTF") {
            return Self::Gltf;
        }
        if bytes.starts_with(b"\x93NUMPY") || TorchFile::looks_like_legacy(bytes) {
            return Self::Arrays;
        }
        let text = after_comments(bytes);
        let starts_with = |word: &str| {
            let start = text.get(..word.len());
            start.is_some_and(|start| start.eq_ignore_ascii_case(word.as_bytes()))
        };
        if starts_with("HIERARCHY") {
            return Self::Bvh;
        }
        match acclaim::looks_like(text) {
            Some(AcclaimFile::Motion) => return Self::AcclaimMotion,
            Some(AcclaimFile::Skeleton) => {
                let hint = "an Acclaim skeleton without motion; give the .amc that goes with it";
                return Self::Other(hint.into());
            }
            None => {}
        }
        if let Some(content) = csv::Content::of(bytes) {
            return Self::Csv(content);
        }
        if starts_with("{") {
            let mentions = |key: &[u8]| text.windows(key.len()).any(|window| window == key);
            return if mentions(b"\"asset\"") {
                Self::Gltf
            } else if mentions(b"\"Frames\"") {
                Self::DeepMimic
            } else {
                Self::Other("JSON, but neither glTF nor DeepMimic's".into())
            };
        }
        if let Some(looks_like) = rows_of_numbers(text) {
            return Self::Other(looks_like);
        }
        if Pickle::looks_like(bytes) {
            return Self::Arrays;
        }
        let start = &text[..text.len().min(24)];
        Self::Other(format!(
            "a file that begins with `{}`",
            start.escape_ascii()
        ))
    }
}

/// What a table of numbers without names looks like, if its first line is one.
fn rows_of_numbers(text: &[u8]) -> Option<String> {
    /// Longer lines are no row of one pose.
    const LONGEST: usize = 1 << 16;
    let line = text.split(|&byte| byte == b'\n').next()?;
    let line = str::from_utf8(line.get(..line.len().min(LONGEST))?).ok()?;
    let numbers: Result<Vec<f64>, _> = line
        .trim()
        .split(',')
        .map(|number| number.trim().parse())
        .collect();
    let numbers = numbers.ok().filter(|numbers| numbers.len() > 1)?;
    let count = numbers.len();
    // A place, a quaternion of unit length, and at least as many joints as a pair of legs has.
    let turn = numbers.get(3..7).unwrap_or_default().iter();
    let length: f64 = turn.map(|part| part * part).sum();
    Some(if count >= 7 + 10 && (length - 1.0).abs() < 1e-3 {
        let joints = count - 7;
        format!(
            "a robot's poses (MuJoCo qpos: place, quaternion and {joints} joint angles a line), \
             which have no human body; score the human motion that they were retargeted from"
        )
    } else {
        format!("lines of {count} numbers without names")
    })
}

/// Text behind a byte order mark, blank lines and the `#` and `//` comments that BVH allows.
fn after_comments(bytes: &[u8]) -> &[u8] {
    let mut text = bytes.strip_prefix(b"\xef\xbb\xbf").unwrap_or(bytes);
    loop {
        text = text.trim_ascii_start();
        if !(text.starts_with(b"#") || text.starts_with(b"//")) {
            return text;
        }
        let line_end = text.iter().position(|&byte| byte == b'\n');
        text = &text[line_end.unwrap_or(text.len())..];
    }
}

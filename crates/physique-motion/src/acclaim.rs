//! Acclaim skeletons and motions (`.asf` with `.amc`), as CMU's and HDM05's recordings come.
//!
//! The skeleton file lists bones by direction and length in the world's axes at rest; the motion
//! file has a line a bone and frame. A bone starts where its parent ends. With `C` the turn that
//! a bone's `axis` states and `M` that of its numbers in a frame, the bone stands in the world as
//! `W(bone) = W(parent) · C · M · C⁻¹`. The root's numbers move it in the world; its preset
//! `position` and `orientation`, which are zero in every recording that we know, go before.
//!
//! | question | rule |
//! |---|---|
//! | order of turns | About **fixed** axes in the order of the tokens of `dof`, `order` or `axis`: `rx ry rz` is `Rz · Ry · Rx`. |
//! | unit | Inches over the factor `length` of `:units`: CMU's 0.45 makes (1 / 0.45) inch = 5.644 cm. Where that makes no human size, the unit is inferred as for [`crate::bvh`]. |
//! | angles | What the motion's header says, `:DEGREES` or `:RADIANS`; else `angle` of `:units`; else degrees. |
//! | frame rate | `:SAMPLES-PER-SECOND`, which few files have; else 120 a second, CMU's rate, with a note. |
//! | up axis | Y, unless the figure stands along Z in four of five frames. |
//! | bones that a frame leaves out | Refused under `:FULLY-SPECIFIED`; otherwise they stay as they were. |
//!
//! A motion needs its skeleton: [`find_skeleton`] says where it is looked for.
//!
//! Acclaim Skeleton File Definition 1.10, 1995; CMU's notes on it
//! (<http://graphics.cs.cmu.edu/nsp/course/cs229/info/ACCLAIMdef.html>) and on its unit
//! (<http://mocap.cs.cmu.edu/faqs.php>).

mod channel;
mod clip;
mod figure;
mod locate;
mod motion;
mod skeleton;
mod text;

use std::path::Path;

pub use locate::find_skeleton;

use crate::read_file::read_file;
use crate::{Error, ReadOptions, SkeletonClip};

/// Which of the two files a text is.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum AcclaimFile {
    Skeleton,
    Motion,
}

/// What a text without comments before it looks like: a keyword with a colon, or the number of
/// a frame and the root's line.
pub(crate) fn looks_like(text: &[u8]) -> Option<AcclaimFile> {
    /// Keywords stand in the first lines.
    const HEAD: usize = 1 << 16;
    let mut lines = text::lines(Path::new(""), &text[..text.len().min(HEAD)]);
    let first = lines.next()?;
    if first.text.starts_with(b":") {
        let mut lines = std::iter::once(first).chain(lines);
        let opens_skeleton = |line: text::Line<'_>| {
            let keywords = [":version", ":units", ":root", ":bonedata", ":hierarchy"];
            keywords.iter().any(|keyword| line.starts_with(keyword))
        };
        return Some(if lines.any(opens_skeleton) {
            AcclaimFile::Skeleton
        } else {
            AcclaimFile::Motion
        });
    }
    let is_number = first.text.iter().all(u8::is_ascii_digit);
    let root_follows = lines.next().is_some_and(|line| line.starts_with("root"));
    (is_number && root_follows).then_some(AcclaimFile::Motion)
}

/// Reads an `.amc` with the skeleton that [`find_skeleton`] finds.
///
/// # Errors
/// [`Error::Io`]; [`Error::Limit`]; [`Error::Format`] with the line, the frame and the bone, and
/// where no skeleton is found.
pub fn read(path: impl AsRef<Path>, options: &ReadOptions) -> Result<SkeletonClip, Error> {
    let path = path.as_ref();
    let motion = read_file(path, options.limits.bytes)?;
    parse_beside(&motion, path, options)
}

/// Reads the text of an `.amc`, with the skeleton found beside `path`.
pub(crate) fn parse_beside(
    motion: &[u8],
    path: &Path,
    options: &ReadOptions,
) -> Result<SkeletonClip, Error> {
    let skeleton_path = find_skeleton(path, options)?;
    let skeleton = read_file(&skeleton_path, options.limits.bytes)?;
    parse(&skeleton, skeleton_path, motion, path, options)
}

/// Reads the texts of an `.asf` and its `.amc`; the paths only name them in errors.
///
/// # Errors
/// As [`read`], without [`Error::Io`].
pub fn parse(
    skeleton: &[u8],
    skeleton_path: impl AsRef<Path>,
    motion: &[u8],
    motion_path: impl AsRef<Path>,
    options: &ReadOptions,
) -> Result<SkeletonClip, Error> {
    let figure = skeleton::parse(skeleton, skeleton_path.as_ref(), &options.limits)?;
    let motion_path = motion_path.as_ref();
    let motion = motion::parse(motion, motion_path, &figure, &options.limits)?;
    clip::clip(&figure, motion, options)
}

//! Which results of an earlier run can stay.

use std::fs::{self, File};
use std::io::{Read, Seek, SeekFrom};
use std::path::{Path, PathBuf};
use std::time::SystemTime;

use anyhow::{Context, Result};
use physique::ExportFormat;
use physique_files::write_file;

/// What makes results of an earlier run good for this one.
#[derive(Debug)]
pub(crate) struct Resume {
    format: ExportFormat,
    /// Results from before were made with other settings.
    since: SystemTime,
}

impl Resume {
    /// Compares the settings of this run with those that the folder remembers in a hidden file,
    /// one a format; new settings are remembered and make everything old.
    pub(crate) fn new(folder: &Path, format: ExportFormat, settings: &str) -> Result<Self> {
        let memory = folder.join(format!(
            ".physique-convert.{}.json",
            format.name().to_ascii_lowercase().replace([' ', '\''], "-")
        ));
        fs::create_dir_all(folder).with_context(|| folder.display().to_string())?;
        if fs::read_to_string(&memory).ok().as_deref() != Some(settings) {
            write_file(&memory, settings.as_bytes())?;
        }
        let since = fs::metadata(&memory).and_then(|memory| memory.modified());
        Ok(Self {
            format,
            since: since.with_context(|| memory.display().to_string())?,
        })
    }

    /// Whether the output is newer than its input and these settings, and whole.
    pub(crate) fn is_done(&self, input: &Path, output: &Path) -> bool {
        let modified = |path: &Path| fs::metadata(path).and_then(|file| file.modified());
        let (Ok(source), Ok(result)) = (modified(input), modified(output)) else {
            return false;
        };
        result >= source && result >= self.since && is_whole(output, self.format)
    }
}

/// Whether the file ends where its format says it does: cheap, since we rename whole files only,
/// but a full disk or a broken copy leaves others.
fn is_whole(path: &Path, format: ExportFormat) -> bool {
    let Ok(mut file) = File::open(path) else {
        return false;
    };
    let Ok(length) = file.metadata().map(|file| file.len()) else {
        return false;
    };
    let mut read_at = |from: SeekFrom, count: usize| -> Option<Vec<u8>> {
        let mut bytes = vec![0; count];
        file.seek(from).ok()?;
        file.read_exact(&mut bytes).ok()?;
        Some(bytes)
    };
    let whole = match format {
        ExportFormat::Glb => {
            let header = read_at(SeekFrom::Start(0), 12);
            header.map(|header| {
                let stated = u32::from_le_bytes([header[8], header[9], header[10], header[11]]);
                header.starts_with(b"glTF") && u64::from(stated) == length
            })
        }
        ExportFormat::Amass | ExportFormat::Native => {
            let end = read_at(SeekFrom::End(-22), 22);
            end.map(|end| end.starts_with(b"PK\x05\x06"))
        }
        ExportFormat::HumanMl3d | ExportFormat::Kit | ExportFormat::Positions => {
            let header = read_at(SeekFrom::Start(0), 128);
            header.map(|header| npy_length(&header) == Some(length))
        }
        ExportFormat::Bvh | ExportFormat::PositionCsv | ExportFormat::RotationCsv => {
            let end = read_at(SeekFrom::End(-1), 1);
            end.map(|end| end == b"\n")
        }
    };
    whole.unwrap_or(false)
}

/// Length that a `.npy` of ours must have by its header: 32-bit numbers.
fn npy_length(header: &[u8]) -> Option<u64> {
    let text_length = u64::from(u16::from_le_bytes([*header.get(8)?, *header.get(9)?]));
    let text = String::from_utf8_lossy(header.get(10..)?).into_owned();
    let (_, shape) = text.split_once("'shape': (")?;
    let (shape, _) = shape.split_once(')')?;
    let mut numbers = 1_u64;
    for size in shape
        .split(',')
        .map(str::trim)
        .filter(|size| !size.is_empty())
    {
        numbers = numbers.checked_mul(size.parse().ok()?)?;
    }
    numbers.checked_mul(4)?.checked_add(10 + text_length)
}

/// A folder made for a file, if need be.
pub(crate) fn make_room(output: &Path) -> Result<PathBuf> {
    let folder = output.parent().unwrap_or(output).to_owned();
    if !folder.as_os_str().is_empty() {
        fs::create_dir_all(&folder).with_context(|| folder.display().to_string())?;
    }
    Ok(folder)
}

//! Pictures as PNG files.

use std::path::{Path, PathBuf};

use crate::{Image, ViewError};

impl Image {
    /// The picture as the bytes of a PNG file: 8-bit sRGB, the same for the same picture.
    ///
    /// # Errors
    /// [`ViewError::Encode`] if the encoder fails.
    pub fn encode_png(&self) -> Result<Vec<u8>, ViewError> {
        let bytes: Vec<u8> = self
            .pixels()
            .iter()
            .flat_map(|colour| colour.srgb())
            .collect();
        let mut file = Vec::new();
        let mut encoder = png::Encoder::new(&mut file, self.width(), self.height());
        encoder.set_color(png::ColorType::Rgb);
        encoder.set_depth(png::BitDepth::Eight);
        encoder.set_source_srgb(png::SrgbRenderingIntent::RelativeColorimetric);
        encoder.set_compression(png::Compression::Balanced);
        let mut writer = encoder.write_header()?;
        writer.write_image_data(&bytes)?;
        writer.finish()?;
        Ok(file)
    }

    /// Write a PNG file. It is written beside and then renamed, so that nobody sees half a picture.
    ///
    /// # Errors
    /// [`ViewError::Encode`] or [`ViewError::Write`]; then the file at `path` is as it was before.
    pub fn write_png(&self, path: impl AsRef<Path>) -> Result<(), ViewError> {
        let path = path.as_ref();
        let bytes = self.encode_png()?;
        let beside = beside(path);
        std::fs::write(&beside, bytes)
            .and_then(|()| std::fs::rename(&beside, path))
            .map_err(|source| {
                // The half-written file is of no use; the error worth telling is the first one.
                let _ = std::fs::remove_file(&beside);
                ViewError::Write {
                    path: path.to_path_buf(),
                    source,
                }
            })
    }
}

/// A name in the same folder (a rename does not cross file systems) that no other process uses.
fn beside(path: &Path) -> PathBuf {
    let mut name = path.file_name().unwrap_or_default().to_os_string();
    name.push(format!(".{}.partial", std::process::id()));
    path.with_file_name(name)
}

//! A picture in memory.

use crate::{Colour, ViewError};

/// The most pixels that one picture may have (2^27: 400 MB).
pub const MAX_PIXELS: u64 = 1 << 27;

/// An opaque picture: rows from the top, 8-bit sRGB.
///
/// ```
/// use physique_view::{Colour, Image};
/// let mut image = Image::new(4, 2, Colour::WHITE)?;
/// image.blend(3, 1, Colour::BLACK, 1.0);
/// assert_eq!(image.pixel(3, 1), Some(Colour::BLACK));
/// assert_eq!(image.pixel(4, 1), None);
/// # Ok::<(), physique_view::ViewError>(())
/// ```
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Image {
    width: u32,
    height: u32,
    pixels: Vec<Colour>,
}

impl Image {
    /// A picture of one colour.
    ///
    /// # Errors
    /// [`ViewError::BadSize`] if a side is zero or there are more than [`MAX_PIXELS`].
    pub fn new(width: u32, height: u32, colour: Colour) -> Result<Self, ViewError> {
        let count = u64::from(width) * u64::from(height);
        if count == 0 || count > MAX_PIXELS {
            return Err(ViewError::BadSize {
                width: width.into(),
                height: height.into(),
            });
        }
        Ok(Self {
            width,
            height,
            pixels: vec![colour; count as usize],
        })
    }

    /// Width in pixels, at least 1.
    #[must_use]
    pub fn width(&self) -> u32 {
        self.width
    }

    /// Height in pixels, at least 1.
    #[must_use]
    pub fn height(&self) -> u32 {
        self.height
    }

    /// The colour at a pixel, counted from the left and the top; `None` outside.
    #[must_use]
    pub fn pixel(&self, x: u32, y: u32) -> Option<Colour> {
        self.index(i64::from(x), i64::from(y))
            .map(|index| self.pixels[index])
    }

    /// All pixels, row by row from the top.
    #[must_use]
    pub fn pixels(&self) -> &[Colour] {
        &self.pixels
    }

    pub(crate) fn pixels_mut(&mut self) -> &mut [Colour] {
        &mut self.pixels
    }

    /// Lay a colour over a pixel, mixed in linear light; outside the picture nothing happens.
    pub fn blend(&mut self, x: i64, y: i64, colour: Colour, opacity: f32) {
        let Some(index) = self.index(x, y) else {
            return;
        };
        if opacity >= 1.0 {
            self.pixels[index] = colour;
        } else if opacity > 0.0 {
            self.pixels[index] = self.pixels[index].mix(colour, opacity);
        }
    }

    /// Copy another picture in, its top left corner at (`left`, `top`); what lies outside is cut off.
    pub fn paste(&mut self, other: &Self, left: i64, top: i64) {
        for (row, pixels) in other.pixels.chunks_exact(other.width as usize).enumerate() {
            let y = top + row as i64;
            for (column, &colour) in pixels.iter().enumerate() {
                if let Some(index) = self.index(left + column as i64, y) {
                    self.pixels[index] = colour;
                }
            }
        }
    }

    fn index(&self, x: i64, y: i64) -> Option<usize> {
        let inside =
            (0..i64::from(self.width)).contains(&x) && (0..i64::from(self.height)).contains(&y);
        inside.then(|| y as usize * self.width as usize + x as usize)
    }
}

//! Colours: stored as 8-bit sRGB, mixed in linear light.

use std::sync::LazyLock;

use glam::Vec3;

/// An opaque colour in sRGB, 8 bits a channel.
///
/// Three bytes, so that a colour for each vertex costs little. All mixing (shading,
/// anti-aliasing, transparency) happens in linear light: see [`Colour::linear`].
///
/// ```
/// use physique_view::Colour;
/// let teal = Colour::hex(0x008080);
/// assert_eq!(teal.srgb(), [0x00, 0x80, 0x80]);
/// assert_eq!(Colour::from_linear(teal.linear()), teal);
/// ```
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct Colour([u8; 3]);

impl Colour {
    /// White.
    pub const WHITE: Self = Self::hex(0xff_ff_ff);
    /// Black.
    pub const BLACK: Self = Self::hex(0x00_00_00);

    /// The colour written `#rrggbb` on the web.
    #[must_use]
    pub const fn hex(rgb: u32) -> Self {
        Self([(rgb >> 16) as u8, (rgb >> 8) as u8, rgb as u8])
    }

    /// The three sRGB bytes: red, green, blue.
    #[must_use]
    pub const fn srgb(self) -> [u8; 3] {
        self.0
    }

    /// Red, green and blue in linear light, 0 to 1 (IEC 61966-2-1).
    #[must_use]
    pub fn linear(self) -> Vec3 {
        let [r, g, b] = self.0.map(|byte| DECODE[usize::from(byte)]);
        Vec3::new(r, g, b)
    }

    /// The nearest colour to one in linear light; channels outside 0 to 1 are clamped, NaN is black.
    #[must_use]
    pub fn from_linear(linear: Vec3) -> Self {
        Self(linear.to_array().map(encode))
    }

    /// `self` where `t` is 0, `other` where it is 1, mixed in linear light.
    #[must_use]
    pub fn mix(self, other: Self, t: f32) -> Self {
        Self::from_linear(self.linear().lerp(other.linear(), t))
    }
}

const ENCODE_STEPS: usize = 1 << 14;

static DECODE: LazyLock<[f32; 256]> = LazyLock::new(|| {
    std::array::from_fn(|byte| {
        let value = byte as f32 / 255.0;
        if value <= 0.040_45 {
            value / 12.92
        } else {
            ((value + 0.055) / 1.055).powf(2.4)
        }
    })
});

/// sRGB bytes over even steps of linear light: fine enough that decoding and encoding is the identity.
static ENCODE: LazyLock<Vec<u8>> = LazyLock::new(|| {
    (0..=ENCODE_STEPS)
        .map(|step| {
            let linear = step as f32 / ENCODE_STEPS as f32;
            let value = if linear <= 0.003_130_8 {
                linear * 12.92
            } else {
                1.055 * linear.powf(1.0 / 2.4) - 0.055
            };
            (value * 255.0).round() as u8
        })
        .collect()
});

fn encode(linear: f32) -> u8 {
    // A cast from float saturates and takes NaN to 0, so the index is always inside the table.
    let step = (linear.clamp(0.0, 1.0) * ENCODE_STEPS as f32 + 0.5) as usize;
    ENCODE[step.min(ENCODE_STEPS)]
}

/// Colours that go together: for bodies, their sides, and what is wrong with them.
pub mod palette {
    use super::Colour;

    /// The body's middle: trunk and head.
    pub const CENTRE: Colour = Colour::hex(0xcf_c6_ba);
    /// The body's left side (its own left, +X at rest).
    pub const LEFT: Colour = Colour::hex(0x84_ac_d6);
    /// The body's right side.
    pub const RIGHT: Colour = Colour::hex(0xe2_a9_74);
    /// Surface that passes through other surface.
    pub const INTERSECTION: Colour = Colour::hex(0xe0_1b_24);
    /// Paths on the ground and joints.
    pub const TRAJECTORY: Colour = Colour::hex(0x5b_4a_a8);
    /// Behind everything.
    pub const PAPER: Colour = Colour::hex(0xff_ff_ff);
    /// Behind a body.
    pub const STAGE: Colour = Colour::hex(0xf4_f5_f7);
    /// The floor.
    pub const FLOOR: Colour = Colour::hex(0xe6_e8_ec);
    /// Lines on the floor.
    pub const GRID: Colour = Colour::hex(0x9f_a7_b3);
    /// Titles.
    pub const INK: Colour = Colour::hex(0x1b_1f_27);
    /// Captions and labels.
    pub const FAINT_INK: Colour = Colour::hex(0x62_69_76);
    /// Frames and ticks.
    pub const RULE: Colour = Colour::hex(0xd5_d9_df);
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_byte_survives_linear_light() {
        for byte in 0..=255u8 {
            let colour = Colour([byte, 255 - byte, byte / 2]);
            assert_eq!(Colour::from_linear(colour.linear()), colour);
        }
    }

    #[test]
    fn encoding_takes_any_number() {
        let odd = Vec3::new(f32::NAN, f32::INFINITY, -3.0);
        assert_eq!(Colour::from_linear(odd).srgb(), [0, 255, 0]);
    }

    #[test]
    fn half_of_black_and_white_is_half_the_light() {
        // 0.5 in linear light is 188 in sRGB, not 128.
        assert_eq!(Colour::BLACK.mix(Colour::WHITE, 0.5).srgb(), [188; 3]);
    }
}

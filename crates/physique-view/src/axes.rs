//! A small cross of axes in a picture's corner: which way a body faces.

use glam::Vec3;

use crate::camera::View;
use crate::{Align, Colour, Image, TextStyle, Weight};

const LENGTH: f32 = 17.0;
const AXES: [(Vec3, &str, Colour); 3] = [
    (Vec3::X, "x", Colour::hex(0xb0_6a_3c)),
    (Vec3::Y, "y", Colour::hex(0x5b_8a_4a)),
    (Vec3::Z, "z", Colour::hex(0x3f_6f_b5)),
];

/// Draw the world's axes as a view sees them, with their lower left corner at (`left`, `bottom`).
/// Axes along the line of sight are left out.
pub(crate) fn draw_axes(view: &View, left: f32, bottom: f32, image: &mut Image) {
    let up = view.up();
    let right = up.cross(view.towards_eye());
    let tips = AXES.map(|(axis, name, colour)| {
        (
            axis.dot(right) * LENGTH,
            -axis.dot(up) * LENGTH,
            name,
            colour,
        )
    });
    let seen = || {
        tips.iter()
            .filter(|(dx, dy, ..)| dx.hypot(*dy) > 0.3 * LENGTH)
    };
    let x = left
        - seen()
            .map(|(dx, ..)| dx + dx.signum() * 11.0)
            .fold(0.0, f32::min);
    let y = bottom
        - seen()
            .map(|(_, dy, ..)| dy + dy.signum() * 8.0)
            .fold(0.0, f32::max);
    for &(dx, dy, name, colour) in seen() {
        image.stroke(&[(x, y), (x + dx, y + dy)], 1.6, colour, 1.0);
        let reach = (dx.hypot(dy) + 6.5) / dx.hypot(dy);
        let style = TextStyle {
            size: 11.0,
            weight: Weight::SemiBold,
            colour,
            align: Align::Centre,
        };
        image.write_text(name, x + dx * reach, y + dy * reach + 3.5, &style);
    }
}

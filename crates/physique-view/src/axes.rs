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

/// Draw the world's axes as a view sees them, from (`x`, `y`). Axes along the line of sight are left out.
pub(crate) fn draw_axes(view: &View, x: f32, y: f32, image: &mut Image) {
    let up = view.up();
    let right = up.cross(view.towards_eye());
    for (axis, name, colour) in AXES {
        let (dx, dy) = (axis.dot(right) * LENGTH, -axis.dot(up) * LENGTH);
        let length = dx.hypot(dy);
        if length < 0.3 * LENGTH {
            continue;
        }
        image.stroke(&[(x, y), (x + dx, y + dy)], 1.6, colour, 1.0);
        let reach = (length + 6.5) / length;
        let style = TextStyle {
            size: 11.0,
            weight: Weight::SemiBold,
            colour,
            align: Align::Centre,
        };
        image.write_text(name, x + dx * reach, y + dy * reach + 3.5, &style);
    }
}

//! Text stands where it is asked to.

use physique_view::{Align, Colour, Image, TextStyle, Weight, text_width};

/// The first and last column, and the first and last row, that are not white.
fn ink(image: &Image) -> Option<[u32; 4]> {
    let inked = (0..image.height()).flat_map(|y| (0..image.width()).map(move |x| (x, y)));
    inked
        .filter(|&(x, y)| image.pixel(x, y) != Some(Colour::WHITE))
        .fold(None, |found, (x, y)| {
            let [left, right, top, bottom] = found.unwrap_or([x, x, y, y]);
            Some([left.min(x), right.max(x), top.min(y), bottom.max(y)])
        })
}

fn written(text: &str, align: Align) -> Image {
    let mut image = Image::new(200, 60, Colour::WHITE).expect("a picture");
    let style = TextStyle {
        size: 24.0,
        weight: Weight::Regular,
        colour: Colour::BLACK,
        align,
    };
    image.write_text(text, 100.0, 40.0, &style);
    image
}

#[test]
fn letters_begin_end_or_centre_at_x() {
    let width = text_width("Hamburg", 24.0, Weight::Regular);
    let [left, right, ..] = ink(&written("Hamburg", Align::Left)).expect("ink");
    assert!((100..=103).contains(&left) && (right as f32) <= 100.0 + width);
    let [left, right, ..] = ink(&written("Hamburg", Align::Right)).expect("ink");
    assert!((97..=100).contains(&right) && left as f32 >= 100.0 - width);
    let [left, right, ..] = ink(&written("Hamburg", Align::Centre)).expect("ink");
    assert!((left as f32 + right as f32 - 200.0).abs() < 4.0);
}

#[test]
fn capitals_stand_on_the_baseline_and_are_as_tall_as_the_typeface_says() {
    let [_, _, top, bottom] = ink(&written("HE", Align::Left)).expect("ink");
    assert!((39..=40).contains(&bottom), "{bottom}");
    // Inter's capitals are 0.727 em tall.
    assert!((top as f32 - (40.0 - 0.727 * 24.0)).abs() <= 1.5, "{top}");
}

#[test]
fn widths_add_up_and_grow_with_size() {
    let width = |text, size| text_width(text, size, Weight::Regular);
    assert!((width("ab", 16.0) - width("a", 16.0) - width("b", 16.0)).abs() < 1e-3);
    assert!((width("motion", 32.0) - 2.0 * width("motion", 16.0)).abs() < 1e-2);
    assert_eq!(width("", 16.0), 0.0);
}

#[test]
fn unknown_characters_show_and_control_characters_do_not() {
    assert!(ink(&written("漢", Align::Left)).is_some());
    assert!(ink(&written("\n\t\0", Align::Left)).is_none());
}

//! PNG files.

use physique_view::{Colour, Image, ViewError};

fn picture() -> Image {
    let mut image = Image::new(7, 5, Colour::hex(0x10_80_f0)).expect("a picture");
    image.blend(6, 4, Colour::hex(0xff_00_7f), 1.0);
    image
}

#[test]
fn a_written_picture_reads_back_the_same() {
    let folder = tempfile::tempdir().expect("a folder");
    let path = folder.path().join("picture.png");
    picture().write_png(&path).expect("written");
    let file = std::io::BufReader::new(std::fs::File::open(&path).expect("opened"));
    let mut reader = png::Decoder::new(file).read_info().expect("a PNG file");
    let mut bytes = vec![0; reader.output_buffer_size().expect("a size")];
    let frame = reader.next_frame(&mut bytes).expect("a frame");
    assert_eq!(
        (frame.width, frame.height, frame.color_type),
        (7, 5, png::ColorType::Rgb)
    );
    let expected: Vec<u8> = picture()
        .pixels()
        .iter()
        .flat_map(|colour| colour.srgb())
        .collect();
    assert_eq!(&bytes[..frame.buffer_size()], expected);
}

#[test]
fn an_older_file_is_replaced_and_nothing_else_is_left() {
    let folder = tempfile::tempdir().expect("a folder");
    let path = folder.path().join("picture.png");
    std::fs::write(&path, "old").expect("written");
    picture().write_png(&path).expect("written");
    assert_eq!(
        std::fs::read(&path).expect("read"),
        picture().encode_png().expect("encoded")
    );
    assert_eq!(std::fs::read_dir(folder.path()).expect("listed").count(), 1);
}

#[test]
fn a_folder_that_is_not_there_is_named() {
    let folder = tempfile::tempdir().expect("a folder");
    let path = folder.path().join("missing").join("picture.png");
    let error = picture().write_png(&path).expect_err("no such folder");
    assert!(matches!(error, ViewError::Write { .. }));
    assert!(error.to_string().contains("picture.png"), "{error}");
}

#[test]
fn a_folder_in_the_way_is_kept_and_no_half_file_stays() {
    let folder = tempfile::tempdir().expect("a folder");
    let path = folder.path().join("picture.png");
    std::fs::create_dir_all(path.join("inside")).expect("a folder in the way");
    picture()
        .write_png(&path)
        .expect_err("a folder is in the way");
    assert!(path.join("inside").is_dir());
    assert_eq!(std::fs::read_dir(folder.path()).expect("listed").count(), 1);
}

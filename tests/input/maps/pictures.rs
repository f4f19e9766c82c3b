//! Pictures from independent writers: greymaps written byte by byte, and PNG from the encoder of the crate that also
//! decodes.

use super::{assert_refused, folder};
use cplan::input::{InputError, Occupancy, OccupancyMap};
use png::{BitDepth, ColorType, Encoder};
use proptest::prelude::*;

const YAML: &str =
    "image: room.bin\nresolution: 0.1\norigin: [1, 2, 0]\nnegate: 0\noccupied_thresh: 0.65\nfree_thresh: 0.196\n";

/// Reads the map of this picture, with occupied above 0.65 and free below 0.196.
fn read(bytes: &[u8]) -> Result<OccupancyMap, InputError> {
    let folder = folder(&[("room.bin", bytes), ("room.yaml", YAML.as_bytes())]);
    OccupancyMap::read(&folder.path().join("room.yaml"))
}

/// Returns the occupancy of pixels with these values, of which `most` is the greatest possible one. Compares whole
/// numbers, while the program divides.
fn expected_occupancy(values: &[u32], most: u32) -> Vec<Occupancy> {
    let judge = |&value: &u32| {
        let dark = 1000 * u64::from(most - value);
        let most = u64::from(most);
        if dark > 650 * most {
            Occupancy::Occupied
        } else if dark < 196 * most {
            Occupancy::Free
        } else {
            Occupancy::Unknown
        }
    };
    values.iter().map(judge).collect()
}

fn greymap(width: usize, values: &[u32], most: u32, in_text: bool, comments: bool) -> Vec<u8> {
    let note = if comments { "# CREATOR: someone 0.05 m/pix\n#\n" } else { "" };
    let end = if comments { " # a note\n" } else { "\n" };
    let kind = if in_text { 2 } else { 5 };
    let mut bytes = format!("P{kind}{end}{note}{width}\t{}{end}{note}{most}", values.len() / width).into_bytes();
    if in_text {
        for (i, value) in values.iter().enumerate() {
            bytes.extend(format!("{}{value}", if i % 7 == 0 { "\r\n" } else { " " }).bytes());
            if comments && i % 5 == 0 {
                bytes.extend(b"# another\n");
            }
        }
    } else {
        // The white space that ends a comment after the greatest value also ends the header.
        bytes.extend(if comments { &b"# last\n"[..] } else { b"\n" });
        for &value in values {
            bytes.extend(if most > 255 { (value as u16).to_be_bytes().to_vec() } else { vec![value as u8] });
        }
    }
    bytes
}

fn encoded(width: u32, color: ColorType, depth: BitDepth, palette: Option<(&[u8], &[u8])>, data: &[u8]) -> Vec<u8> {
    let mut bytes = Vec::new();
    let row = (width as usize * color.samples() * depth as usize).div_ceil(8);
    let mut encoder = Encoder::new(&mut bytes, width, (data.len() / row) as u32);
    encoder.set_color(color);
    encoder.set_depth(depth);
    if let Some((colors, opacity)) = palette {
        encoder.set_palette(colors.to_vec());
        encoder.set_trns(opacity.to_vec());
    }
    encoder.write_header().unwrap().write_image_data(data).unwrap();
    bytes
}

proptest! {
    #![proptest_config(cplan_cases::cases(200))]

    #[test]
    fn greymaps_are_read(
        (width, values) in (1..9_usize, 1..9_usize)
            .prop_flat_map(|(w, h)| (Just(w), prop::collection::vec(any::<u16>(), w * h))),
        most in prop_oneof![Just(1_u32), Just(100), Just(255), Just(256), 1..=65535_u32],
        in_text: bool,
        comments: bool,
    ) {
        let values: Vec<u32> = values.iter().map(|v| u32::from(*v) % (most + 1)).collect();
        let map = read(&greymap(width, &values, most, in_text, comments)).unwrap();
        prop_assert_eq!(map.size, [width, values.len() / width]);
        prop_assert_eq!(map.cells, expected_occupancy(&values, most));
    }

    #[test]
    fn grey_and_coloured_pngs_are_read(width in 1..7_usize, data in prop::collection::vec(any::<u8>(), 300)) {
        let bytes = |per_pixel: usize| &data[..data.len() / (width * per_pixel) * width * per_pixel];
        let eight = BitDepth::Eight;
        let grey = read(&encoded(width as u32, ColorType::Grayscale, eight, None, bytes(1))).unwrap();
        let values: Vec<u32> = bytes(1).iter().map(|v| u32::from(*v)).collect();
        prop_assert_eq!(grey.cells, expected_occupancy(&values, 255));
        let wide = read(&encoded(width as u32, ColorType::Grayscale, BitDepth::Sixteen, None, bytes(2))).unwrap();
        let values: Vec<u32> = bytes(2).chunks(2).map(|b| 256 * u32::from(b[0]) + u32::from(b[1])).collect();
        prop_assert_eq!(wide.cells, expected_occupancy(&values, 65535));
        // The mean of three colours equals their sum as a part of three times as much.
        let color = read(&encoded(width as u32, ColorType::Rgb, eight, None, bytes(3))).unwrap();
        let values: Vec<u32> = bytes(3).chunks(3).map(|b| b.iter().map(|v| u32::from(*v)).sum()).collect();
        prop_assert_eq!(color.cells, expected_occupancy(&values, 3 * 255));
        // Transparent pixels are unknown.
        let veiled = |mut cells: Vec<Occupancy>, opacity: Vec<u8>| {
            cells.iter_mut().zip(opacity).filter(|(_, o)| *o < 255).for_each(|(c, _)| *c = Occupancy::Unknown);
            cells
        };
        let grey = read(&encoded(width as u32, ColorType::GrayscaleAlpha, eight, None, bytes(2))).unwrap();
        let values: Vec<u32> = bytes(2).chunks(2).map(|b| u32::from(b[0])).collect();
        prop_assert_eq!(grey.cells, veiled(expected_occupancy(&values, 255), bytes(2).chunks(2).map(|b| b[1]).collect()));
        let color = read(&encoded(width as u32, ColorType::Rgba, eight, None, bytes(4))).unwrap();
        let values: Vec<u32> = bytes(4).chunks(4).map(|b| b[..3].iter().map(|v| u32::from(*v)).sum()).collect();
        prop_assert_eq!(color.cells, veiled(expected_occupancy(&values, 765), bytes(4).chunks(4).map(|b| b[3]).collect()));
    }
}

#[test]
fn pngs_of_few_bits_and_palettes_are_read() {
    use Occupancy::{Free, Occupied, Unknown};
    // Eight pixels of one bit each; the second row has no bit set.
    let bits = encoded(8, ColorType::Grayscale, BitDepth::One, None, &[0b1010_0001, 0]);
    let first = [Free, Occupied, Free, Occupied, Occupied, Occupied, Occupied, Free];
    assert_eq!(read(&bits).unwrap().cells, [first, [Occupied; 8]].concat());
    let twos = encoded(4, ColorType::Grayscale, BitDepth::Two, None, &[0b0001_1011]);
    assert_eq!(read(&twos).unwrap().cells, expected_occupancy(&[0, 1, 2, 3], 3));
    let colors = [0, 0, 0, 255, 255, 255, 128, 128, 128, 255, 255, 255];
    let palette = encoded(4, ColorType::Indexed, BitDepth::Eight, Some((&colors, &[255, 255, 255, 7])), &[0, 1, 2, 3]);
    assert_eq!(read(&palette).unwrap().cells, [Occupied, Free, Unknown, Unknown]);
    // Indices outside the palette have no colour. The bits that fill up a row are no pixels.
    let two = Some((&colors[..6], &[255, 255][..]));
    let lacking = encoded(2, ColorType::Indexed, BitDepth::Two, two, &[0b0010_0000]);
    assert!(read(&lacking).unwrap_err().to_string().contains("a colour that is not in the palette"));
    let filled = encoded(2, ColorType::Indexed, BitDepth::Two, two, &[0b0001_1111]);
    assert_eq!(read(&filled).unwrap().cells, [Occupied, Free]);
}

#[test]
fn broken_greymaps_are_refused() {
    for (bytes, parts) in [
        (&b"P5 2 2 255\n\0\0\0"[..], &["room.bin", "ends early", "4 bytes, but the file has 3", "hint"][..]),
        (b"P5 2 2 255\n\0\0\0\0\0", &["continues after", "at byte 16"]),
        (b"P5 2 2 256\n\0\0\0\0", &["8 bytes, but the file has 4"]),
        (b"P5 2 2 255", &["has 0"]),
        (b"P5 2 2", &["ends early", "maxval"]),
        (b"P5 2 # 2 255\n", &["ends early", "height"]),
        (b"P5\n-2 2 255\n", &["width", "\"-2\"", "byte 4"]),
        (b"P5x 2 2 255\n", &["width", "\"x\""]),
        (b"P5 2 2 0\n\0\0\0\0", &["maxval is 0"]),
        (b"P5 2 2 65536\n", &["maxval is 65536"]),
        (b"P5 2 1 100\n\x64\x65", &["row 1, column 2", "101 exceeds the maxval, 100"]),
        (b"P5 0 2 255\n", &["no pixels: 0 x 2"]),
        (b"P5 1000000000 1 255\n", &["1000000000 x 1 pixels are too many", "hint"]),
        (b"P5 4294967296 4294967296 255\n", &["too many"]),
        (b"P5 99999999999999999999 1 255\n", &["not a whole number"]),
        (b"P2 2 2 255 1 2 3", &["ends early", "value 4 of 4"]),
        (b"P2 2 2 255 1 2 3 4 5", &["continues after", "at byte 20"]),
        (b"P2 2 2 255 1 2 x 4", &["value 3 of 4", "\"x\""]),
        (b"P2 2 2 255 1 2 1e2 4", &["value 3 of 4"]),
        (b"P2 30000 30000 255 1", &["too many"]),
        (b"P2 8000 8000 255 1", &["ends early", "value 2 of 64000000"]),
        (b"P6 1 1 255\n\0\0\0", &["colour (PPM)", "PGM or PNG"]),
        (b"P4 8 1\n\0", &["PBM"]),
        (b"P7\nWIDTH 1\n", &["PAM"]),
        (b"\xff\xd8\xff", &["JPEG"]),
        (b"GIF89a", &["neither PGM nor PNG"]),
        (b"", &["is empty"]),
    ] {
        assert_refused(read(bytes), parts);
    }
}

#[test]
fn broken_pngs_are_refused() {
    let good = encoded(4, ColorType::Grayscale, BitDepth::Eight, None, &[7; 64]);
    assert!(read(&good).is_ok());
    for length in 8..good.len() - 12 {
        assert_refused(read(&good[..length]), &["room.bin", "broken PNG", "hint"]);
    }
    assert_refused(read(b"\x89PNG\r\n"), &["broken PNG"]);
    // The header of a picture of 2^31 - 1 by 2^31 - 1 pixels, with a new checksum.
    let mut huge = good.clone();
    huge[16..24].copy_from_slice(&[0x7f, 0xff, 0xff, 0xff, 0x7f, 0xff, 0xff, 0xff]);
    let sum = crc(&huge[12..29]);
    huge[29..33].copy_from_slice(&sum.to_be_bytes());
    assert_refused(read(&huge), &["2147483647 x 2147483647 pixels are too many"]);
}

/// Returns the checksum of PNG's chunks, by its definition.
fn crc(bytes: &[u8]) -> u32 {
    !bytes.iter().fold(u32::MAX, |sum, byte| {
        (0..8).fold(sum ^ u32::from(*byte), |c, _| if c & 1 == 1 { 0xedb8_8320 ^ (c >> 1) } else { c >> 1 })
    })
}

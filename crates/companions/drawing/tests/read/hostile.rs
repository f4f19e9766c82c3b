//! Broken, cut, or endless files are refused, with the place of the defect.

use super::dxf::file;
use cplan_drawing::{Error, Format, MAX_POINTS, Settings, read};

fn refused(text: &str, format: Format) -> Error {
    let error = read(text.as_bytes(), format, &Settings::default()).expect_err(&text[..text.len().min(200)]);
    assert!(!error.cure.is_empty());
    error
}

#[test]
fn a_cut_dxf_is_never_taken_for_the_whole() {
    let text = include_str!("../../../../../workspaces/drawings/cell.dxf");
    let whole = text.trim_end().len();
    for end in (0..whole).step_by(97).chain(whole - 8..whole) {
        let error = refused(&text[..end], Format::Dxf);
        assert!(end == 0 || error.line.is_some(), "{error:?}");
    }
}

#[test]
fn broken_dxf_files_are_refused_with_their_place() {
    let entity = |text: &str| file("", text);
    let cases = [
        ("".to_owned(), "the file is empty", None),
        ("  \n\n".to_owned(), "the file is empty", None),
        ("AutoCAD Binary DXF\r\n\u{1a}\0".to_owned(), "the file is empty", None),
        ("AutoCAD Binary DXF\r\n\u{1a}\0\0SECTION\0\u{28}".to_owned(), "ends in the middle", None),
        ("AC1032\0\0".to_owned(), "DWG", None),
        ("<svg/>\n".to_owned(), "not a DXF file", Some(1)),
        ("0\nSECTION\n2\nENTITIES\nx\ny\n".to_owned(), "expected the code of a group", Some(5)),
        ("0\nSECTION\n2\nENTITIES\n0\nEOF\n".to_owned(), "does not end", Some(2)),
        ("0\nEOF\n".to_owned(), "no section ENTITIES", None),
        (entity("0 CIRCLE 8 a 10 nan 20 0 40 1"), "needs a number, found \"nan\"", Some(32)),
        (entity("0 CIRCLE 8 a 10 1e999 20 0 40 1"), "needs a number", Some(32)),
        (entity("0 CIRCLE 8 a 10 1 20 0"), "CIRCLE has no group 40", Some(28)),
        (entity("0 CIRCLE 8 a 10 1 20 0 40 -3"), "CIRCLE of size -3", Some(28)),
        (entity("0 LWPOLYLINE 8 a 10 1 20 0 10 3"), "2 coordinates x and 1", Some(28)),
        (entity("0 LINE 8 a 10 1.7e308 20 0 11 -1.7e308 21 1e300"), "too large", Some(28)),
        (entity("0 CIRCLE 8 a 10 1 20 0 40 1 0 ELLIPSE 8 a 10 0 20 0 11 1e9 21 0 40 1"), "too many", Some(38)),
        (entity("0 SPLINE 8 a 71 3 40 0 40 1 10 0 20 0 10 1 20 1"), "do not match", Some(28)),
    ];
    for (text, message, line) in cases {
        let error = refused(&text, Format::Dxf);
        assert!(error.message.contains(message), "{message}: {error:?}");
        assert_eq!(error.line, line, "{message}");
    }
}

#[test]
fn endless_nesting_of_blocks_is_refused() {
    let insert = |name: &str, rest: &str| format!("0 INSERT 8 a 2 {name} 10 0 20 0 {rest} ");
    let own = file(
        &format!("0 BLOCK 2 a {} 0 ENDBLK 0 BLOCK 2 b {} 0 ENDBLK", insert("b", ""), insert("A", "")),
        &insert("a", ""),
    );
    assert!(refused(&own, Format::Dxf).message.contains("contains itself"));
    let zero = file("0 BLOCK 2 a 0 LINE 10 0 20 0 11 1 21 1 0 ENDBLK", &insert("a", "41 0"));
    assert!(refused(&zero, Format::Dxf).message.contains("scale 0 by 1"));
    // Each block occurs twice in the next; also empty ones, and rows without number.
    for content in ["0 CIRCLE 8 a 10 0 20 0 40 1", ""] {
        let doubled: String = (0..40)
            .map(|k| {
                format!(
                    "0 BLOCK 2 b{} {} {} 0 ENDBLK ",
                    k + 1,
                    insert(&format!("b{k}"), ""),
                    insert(&format!("b{k}"), "")
                )
            })
            .collect();
        let blocks = format!("0 BLOCK 2 b0 {content} 0 ENDBLK {doubled}");
        assert!(refused(&file(&blocks, &insert("b40", "")), Format::Dxf).message.contains("entities"));
        let rows = insert("b0", "70 30000 71 30000 44 1 45 1");
        assert!(refused(&file(&blocks, &rows), Format::Dxf).message.contains("entities"));
    }
}

#[test]
fn broken_svg_files_are_refused_with_their_place() {
    let deep = "<g>".repeat(300_000) + &"</g>".repeat(300_000);
    let loops = "<g id='a'><use href='#a'/></g>";
    let doubled: String =
        (0..40).map(|k| format!("<g id='g{}'><use href='#g{k}'/><use href='#g{k}'/></g>", k + 1)).collect();
    let cases = [
        ("", "the file is empty", None),
        ("<html/>", "not an SVG file", Some(1)),
        ("<svg>\n<g>\n</svg>", "not well-formed XML", Some(3)),
        ("<svg><g></svg>", "not well-formed XML", Some(1)),
        ("<svg viewBox='0 0 0 5'/>", "viewBox", Some(1)),
        ("<svg>\n<rect width='x' height='1'/></svg>", "width=\"x\", which is not a valid value", Some(2)),
        ("<svg>\n<g transform='scale(0)'><rect width='1' height='1'/></g></svg>", "a scale that is 0", Some(2)),
        ("<svg>\n\n<path d='M0 0 L nan 3'/></svg>", "path data", Some(3)),
        ("<svg><circle r='1e300' transform='skewX(9)'/></svg>", "too many", Some(1)),
        ("<svg><circle r='1' cx='1e300' transform='scale(1e12)'/></svg>", "too large", Some(1)),
    ];
    for (text, message, line) in cases {
        let error = refused(text, Format::Svg);
        assert!(error.message.contains(message), "{text}: {error:?}");
        assert_eq!(error.line, line, "{text}");
    }
    for (inside, message) in
        [(deep.as_str(), "<g> is nested more than"), (loops, "contains itself"), (&doubled, "copies that <use> makes")]
    {
        assert!(refused(&format!("<svg>{inside}</svg>"), Format::Svg).message.contains(message), "{message}");
    }
    // Growing entities: the XML reader refuses them.
    let lol: String = (1..20).map(|k| format!("<!ENTITY l{k} '&l{0};&l{0};&l{0};'>", k - 1)).collect();
    let bomb = format!("<!DOCTYPE svg [<!ENTITY l0 'l'>{lol}]><svg><text>&l19;</text></svg>");
    assert!(refused(&bomb, Format::Svg).message.contains("XML"));
}

#[test]
fn a_hundred_thousand_lines_through_one_point_are_read() {
    let star: String = (1..100_000).map(|k| format!("0 LINE 8 a 10 0 20 0 11 {k} 21 1 ")).collect();
    let drawing = read(file("", &star).as_bytes(), Format::Dxf, &Settings::default()).unwrap();
    assert_eq!(drawing.shapes.len(), 99_999);
}

#[test]
fn files_with_too_many_points_are_refused() {
    let many: String = "0,0 1,1 ".repeat(MAX_POINTS / 2 + 1);
    let error = refused(&format!("<svg><polygon points='{many}'/></svg>"), Format::Svg);
    assert!(error.message.contains("points"), "{error:?}");
}

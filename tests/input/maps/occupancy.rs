//! Occupancy maps in the plane: obstacles compared with the pixels at each place, and errors.

use super::{assert_refused, folder, world_in};
use cplan::geometry::{Convex, Point};
use cplan::input::{Occupancy, OccupancyMap};
use cplan::model::Shape;
use proptest::prelude::*;

const YAML: &str = "image: room.pgm\nresolution: 0.5\norigin: [-1.0, -2.0, 0.0]\nnegate: 0\noccupied_thresh: 0.65\nfree_thresh: 0.196\n";
/// A picture of three columns and two rows: occupied, unknown, free; below that free, free, occupied.
const PGM: &[u8] = b"P2\n3 2\n255\n0 128 254 254 254 0\n";
const WORLD: &str = "[[obstacle]]\nname = \"room\"\nimage = \"room.yaml\"\n";

/// Returns the depth of a point inside a counter-clockwise polygon; negative outside.
fn depth(piece: &Convex, place: Point) -> f64 {
    let core = piece.core();
    let sides = (0..core.len()).map(|i| (core[i], core[(i + 1) % core.len()]));
    let depth = |(a, b): (Point, Point)| {
        let (along, to) = (b - a, place - a);
        (along.x * to.y - along.y * to.x) / along.norm()
    };
    sides.map(depth).fold(f64::INFINITY, f64::min)
}

proptest! {
    #![proptest_config(cplan_cases::cases(60))]

    #[test]
    fn obstacles_are_where_the_picture_is_dark(
        (width, values) in (1..9_usize, 1..9_usize)
            .prop_flat_map(|(w, h)| (Just(w), prop::collection::vec(prop::sample::select(vec![0_u8, 128, 254]), w * h))),
        resolution in 0.01..2.0_f64,
        (x, y, yaw) in (-5.0..5.0_f64, -5.0..5.0_f64, prop_oneof![Just(0.0), -4.0..4.0_f64]),
        negate: bool,
        unknown_is_free: bool,
    ) {
        let height = values.len() / width;
        let picture = [format!("P5 {width} {height} 255\n").as_bytes(), &values].concat();
        let yaml = format!("image: room.pgm\nresolution: {resolution}\norigin: [{x}, {y}, {yaw}]\nnegate: {}\n\
            occupied_thresh: 0.65\nfree_thresh: 0.196\nmode: scale\n", u8::from(negate));
        let folder = folder(&[("room.pgm", &picture), ("room.yaml", yaml.as_bytes())]);
        let map = OccupancyMap::read(&folder.path().join("room.yaml")).unwrap();
        let pieces = map.pieces(unknown_is_free, usize::MAX).unwrap();
        // Places by fractions of the picture's width and height, from beyond its lower left to beyond its upper right.
        let steps = 4 * width.max(height) + 3;
        for i in 0..=steps {
            for j in 0..=steps {
                let [u, v] = [i, j].map(|k| -0.13 + 1.26 * k as f64 / steps as f64);
                let (across, up) = (u * width as f64 * resolution, v * height as f64 * resolution);
                let place = Point::new(
                    x + across * yaw.cos() - up * yaw.sin(),
                    y + across * yaw.sin() + up * yaw.cos(),
                );
                let (column, row) = ((u * width as f64).floor(), (v * height as f64).floor());
                let inside = column >= 0.0 && row >= 0.0 && (column as usize) < width && (row as usize) < height;
                let expected = inside.then(|| {
                    let value = values[(height - 1 - row as usize) * width + column as usize];
                    match (value, negate) {
                        (128, _) => Occupancy::Unknown,
                        (0, false) | (254, true) => Occupancy::Occupied,
                        _ => Occupancy::Free,
                    }
                });
                // Places on the sides of pixels belong to both pixels.
                let off = |share: f64| (share - share.round()).abs() < 1e-9;
                if off(u * width as f64) || off(v * height as f64) {
                    continue;
                }
                prop_assert_eq!(map.at(place), expected);
                let solid = match expected {
                    Some(Occupancy::Occupied) => true,
                    Some(Occupancy::Unknown) => !unknown_is_free,
                    _ => false,
                };
                let deepest = pieces.iter().map(|piece| depth(piece, place)).fold(f64::NEG_INFINITY, f64::max);
                prop_assert_eq!(deepest > 0.0, solid, "({}, {}): {}", u, v, deepest);
            }
        }
    }
}

#[test]
fn a_world_has_the_picture_as_one_obstacle() {
    let files =
        |world: &str| folder(&[("room.pgm", PGM), ("room.yaml", YAML.as_bytes()), ("world.toml", world.as_bytes())]);
    let world = world_in(&files(&format!("{WORLD}height = [0, 1]\n"))).unwrap();
    let [obstacle] = &world.workspace.fixed.obstacles[..] else { panic!("one obstacle") };
    assert_eq!((obstacle.name.as_str(), &obstacle.shape, obstacle.heights.upper), ("room", &Shape::Pieces, 1.0));
    let area = |pieces: &[Convex]| pieces.iter().map(Convex::area).sum::<f64>();
    // Unknown cells are solid unless the world states otherwise.
    assert_eq!(area(&obstacle.pieces), 3.0 * 0.25);
    let world = world_in(&files(&format!("{WORLD}unknown = \"free\"\n"))).unwrap();
    let pieces = &world.workspace.fixed.obstacles[0].pieces;
    assert_eq!(area(pieces), 2.0 * 0.25);
    let lower_right = vec![(0.0, -2.0), (0.5, -2.0), (0.5, -1.5), (0.0, -1.5)];
    let corners = |p: &Convex| p.core().iter().map(|c| (c.x, c.y)).collect::<Vec<_>>();
    assert!(pieces.iter().any(|p| corners(p) == lower_right), "{pieces:?}");
}

#[test]
fn worlds_that_misuse_pictures_are_refused() {
    for (from, to, parts) in [
        ("room.yaml", "attic.yaml", &["world.toml: line 3, column 9", "no file", "attic.yaml", "relative"][..]),
        ("\"room.yaml\"", "\"room.pgm\"", &["world.toml: line 3", "must name the YAML"]),
        ("\"room.yaml\"", "\"room.yaml\"\nunknown = \"maybe\"", &["line 4", "\"solid\" or \"free\", not \"maybe\""]),
        ("\"room.yaml\"", "\"room.yaml\"\npolygon = []", &["exactly one shape, but has 2"]),
        (
            "image = \"room.yaml\"",
            "polyline = [[0, 0], [1, 1]]\nunknown = \"free\"",
            &["line 4", "`unknown` needs `image`"],
        ),
    ] {
        let world = WORLD.replace(from, to);
        let files = [("room.pgm", PGM), ("room.yaml", YAML.as_bytes()), ("world.toml", world.as_bytes())];
        assert_refused(world_in(&folder(&files)), parts);
    }
}

#[test]
fn descriptions_are_refused_with_their_line() {
    for (from, to, parts) in [
        ("resolution: 0.5", "resolution: 0", &["room.yaml: line 2, column 13", "0 is not a valid length", "hint"][..]),
        ("resolution: 0.5", "resolution: -1", &["line 2", "-1"]),
        ("resolution: 0.5", "resolution: .nan", &["line 2", "NaN"]),
        ("resolution: 0.5", "resolution: 9e5", &["3 x 2 pixels", "900000 m extends beyond"]),
        ("resolution: 0.5\n", "", &["resolution", "needs image, resolution"]),
        ("resolution: 0.5", "resolution: fine", &["line 2"]),
        ("[-1.0, -2.0, 0.0]", "[-1.0, -2.0]", &["line 3", "three numbers, found 2", "[x, y, yaw]"]),
        ("[-1.0, -2.0, 0.0]", "[-1.0, .inf, 0.0]", &["line 3", "not finite"]),
        ("negate: 0", "negate: maybe", &["line 4", "neither 0 nor 1"]),
        ("negate: 0", "negate: 0.0", &["line 4", "neither 0 nor 1"]),
        ("negate: 0", "negate: 0\nnegate: 1", &["line 5", "duplicate mapping key: negate not allowed here\n"]),
        ("0.196", "0.196\n---\nnegate: 1", &["only single YAML document expected but multiple found\n"]),
        ("image: room.pgm", "image: null", &["line 1, column 8", "null is not allowed here\n"]),
        ("negate: 0", "negate: 2", &["line 4", "neither 0 nor 1"]),
        ("0.65", "1.65", &["line 5", "occupied_thresh: 1.65", "between 0 and 1"]),
        ("0.196", "-0.1", &["line 6", "free_thresh: -0.1"]),
        ("0.196", "0.7", &["line 6", "above occupied_thresh, 0.65"]),
        ("negate: 0", "negate: 0\nmode: raw", &["line 5", "raw", "costs", "--mode trinary"]),
        ("negate: 0", "negate: 0\nmode: both", &["line 5", "\"both\" is unknown"]),
        ("room.pgm", "attic.pgm", &["room.yaml: line 1, column 8", "no file", "attic.pgm"]),
        ("image: room.pgm", "image: [", &["room.yaml"]),
    ] {
        assert!(YAML.contains(from), "{from}");
        let yaml = YAML.replacen(from, to, 1);
        let files = [("room.pgm", PGM), ("room.yaml", yaml.as_bytes()), ("world.toml", WORLD.as_bytes())];
        assert_refused(world_in(&folder(&files)), parts);
    }
    let broken = [("room.pgm", &PGM[..20]), ("room.yaml", YAML.as_bytes()), ("world.toml", WORLD.as_bytes())];
    assert_refused(world_in(&folder(&broken)), &["room.pgm: ends early"]);
}

#[test]
fn negate_may_be_a_word_and_modes_may_be_named() {
    for (from, to) in [("negate: 0", "negate: false"), ("negate: 0", "negate: 0\nmode: trinary")] {
        let yaml = YAML.replacen(from, to, 1);
        let folder = folder(&[("room.pgm", PGM), ("room.yaml", yaml.as_bytes())]);
        let map = OccupancyMap::read(&folder.path().join("room.yaml")).unwrap();
        assert_eq!(map.cells[..3], [Occupancy::Occupied, Occupancy::Unknown, Occupancy::Free]);
    }
}

/// Checks the shade 205, which map savers write for unseen cells with a `free_thresh` of 0.25. It is unknown, also with
/// 16 bits per pixel, and with `negate`.
#[test]
fn the_shade_of_unseen_cells_is_unknown_whatever_free_thresh() {
    for (picture, negate) in [
        (&b"P2\n3 1\n255\n0 205 206\n"[..], 0),
        (b"P2\n3 1\n65535\n0 52685 52700\n", 0),
        (b"P2\n3 1\n255\n254 50 49\n", 1),
    ] {
        for mode in ["trinary", "scale"] {
            let yaml = YAML.replace("0.196", "0.25").replace("negate: 0", &format!("negate: {negate}\nmode: {mode}"));
            let files = [("room.pgm", picture), ("room.yaml", yaml.as_bytes()), ("world.toml", WORLD.as_bytes())];
            let folder = folder(&files);
            let map = OccupancyMap::read(&folder.path().join("room.yaml")).unwrap();
            assert_eq!(map.cells, [Occupancy::Occupied, Occupancy::Unknown, Occupancy::Free], "{yaml}");
            let notes = world_in(&folder).unwrap().notes.join("\n");
            assert!(
                notes.contains("room") && notes.contains("although it would be free by free_thresh 0.25"),
                "{notes}"
            );
        }
    }
    // With the usual thresholds, it is unknown in any case.
    let files = [("room.pgm", PGM), ("room.yaml", YAML.as_bytes()), ("world.toml", WORLD.as_bytes())];
    assert_eq!(world_in(&folder(&files)).unwrap().notes, [""; 0]);
}

#[test]
fn keys_of_other_programs_are_noted() {
    let yaml = format!("{YAML}map_type: occupancy\nsaved_by: [x, {{y: 1}}]\n");
    let files = [("room.pgm", PGM), ("room.yaml", yaml.as_bytes()), ("world.toml", WORLD.as_bytes())];
    let notes = world_in(&folder(&files)).unwrap().notes.join("\n");
    assert!(notes.contains("unused keys: \"map_type\", \"saved_by\""), "{notes}");
}

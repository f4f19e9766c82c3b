//! Checks that damaged files are read, or refused with a message, and never crash the program.

use super::folder;
use cplan::input::{InputError, LineMap, OccupancyMap, PreferenceMap};
use proptest::prelude::*;
use std::path::Path;

fn read_shipped(name: &str) -> Vec<u8> {
    std::fs::read(Path::new(env!("CARGO_MANIFEST_DIR")).join("workspaces").join(name)).unwrap()
}

/// Changes, inserts or removes a byte for each entry of `damage`. The position in an entry is a fraction of the length,
/// and most of them are near the beginning.
fn damaged(mut bytes: Vec<u8>, damage: &[(f64, u8, u8)]) -> Vec<u8> {
    for &(share, kind, value) in damage {
        let at = (share * share * share * bytes.len() as f64) as usize;
        match kind {
            0 => bytes.insert(at, value),
            1 if at < bytes.len() => drop(bytes.remove(at)),
            2 => bytes.truncate(at + 1),
            _ if at < bytes.len() => bytes[at] = value,
            _ => {}
        }
    }
    bytes
}

fn assert_error_has_text<T>(read: Result<T, InputError>) {
    if let Err(error) = read {
        assert!(!error.to_string().is_empty());
    }
}

proptest! {
    #![proptest_config(cplan_cases::cases(300))]

    #[test]
    fn damaged_files_are_read_or_refused(damage in prop::collection::vec((0.0..1.0_f64, 0..40_u8, prop_oneof![
        any::<u8>(), prop::sample::select(b"0123456789-+.e# \n\t:[]".to_vec())
    ]), 1..6)) {
        let folder = folder(&[
            ("line.map", &damaged(read_shipped("store_room.map"), &damage)),
            ("wishes.map", &damaged(read_shipped("store_room_wishes.map"), &damage)),
            ("den.pgm", &read_shipped("den.pgm")),
            ("damaged.yaml", &damaged(read_shipped("den.yaml"), &damage)),
            ("bad.pgm", &damaged(read_shipped("den.pgm"), &damage)),
            ("bad.yaml", &String::from_utf8(read_shipped("den.yaml")).unwrap().replace("den.pgm", "bad.pgm").into_bytes()),
        ]);
        let path = |name: &str| folder.path().join(name);
        assert_error_has_text(LineMap::read(&path("line.map")).map(|map| map.chains()));
        assert_error_has_text(PreferenceMap::read(&path("wishes.map")));
        for name in ["damaged.yaml", "bad.yaml"] {
            let read = OccupancyMap::read(&path(name));
            if let Ok(map) = &read {
                prop_assert_eq!(map.cells.len(), map.size[0] * map.size[1]);
            }
            assert_error_has_text(read);
        }
    }
}

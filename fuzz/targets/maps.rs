//! Any bytes as a line map, as a preference file, and as the picture of an occupancy map.
#![no_main]

use cplan::input::{LineMap, OccupancyMap, PreferenceMap};
use cplan_fuzz::Files;
use libfuzzer_sys::fuzz_target;
use std::sync::LazyLock;

static FILES: LazyLock<Files> = LazyLock::new(Files::empty);

const YAML: &str =
    "image: picture\nresolution: 0.1\norigin: [0, 0, 0.5]\nnegate: 0\noccupied_thresh: 0.65\nfree_thresh: 0.2\n";

fuzz_target!(|bytes: &[u8]| {
    let file = FILES.write("picture", bytes);
    match LineMap::read(&file) {
        Ok(map) => {
            let numbered: usize = map.chains().iter().map(|c| c.lines[1] + 1 - c.lines[0]).sum();
            assert_eq!(numbered, map.lines.len());
        }
        Err(error) => assert!(!error.to_string().is_empty()),
    }
    if let Err(error) = PreferenceMap::read(&file) {
        assert!(!error.to_string().is_empty());
    }
    match OccupancyMap::read(&FILES.write("picture.yaml", YAML.as_bytes())) {
        Ok(map) => {
            assert_eq!(map.cells.len(), map.size[0] * map.size[1]);
            let area = map.pieces(false, 10_000).map(|pieces| pieces.iter().map(|p| p.area()).sum::<f64>());
            assert!(area.is_none_or(|area| area <= 0.0101 * map.cells.len() as f64));
        }
        Err(error) => assert!(!error.to_string().is_empty()),
    }
});

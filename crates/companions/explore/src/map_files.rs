//! The map in the format of ROS's map server. The key `image` of a world's obstacle reads the same format.

use super::survey::Survey;
use cplan_world::Occupancy;

/// Shades of free, unknown and occupied cells. A reader with the thresholds of [`map_description`] restores the same classes.
const CELL_SHADES: [u8; 3] = [254, 205, 0];

/// Returns the YAML description of a picture. `picture` is the file name of the picture in the same folder.
pub fn map_description(survey: &Survey, picture: &str) -> String {
    let map = survey.map();
    let origin = map.pose.translation;
    format!(
        "image: {}\nresolution: {}\norigin: [{}, {}, 0]\nnegate: 0\noccupied_thresh: 0.65\nfree_thresh: 0.196\n",
        // A JSON string is also a YAML string.
        serde_json::Value::from(picture),
        map.resolution,
        origin.x,
        origin.y
    )
}

/// Returns the picture as PGM (P5), with one pixel per cell, from the top row down.
pub fn map_picture(survey: &Survey) -> Vec<u8> {
    let map = survey.map();
    let mut bytes = format!("P5\n{} {}\n255\n", map.size[0], map.size[1]).into_bytes();
    bytes.extend(map.cells.iter().map(|cell| match cell {
        Occupancy::Free => CELL_SHADES[0],
        Occupancy::Unknown => CELL_SHADES[1],
        Occupancy::Occupied => CELL_SHADES[2],
    }));
    bytes
}

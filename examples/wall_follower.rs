//! A wall follower of the literature drives round two rooms and maps them.
//!
//! ```text
//! cargo run --example wall_follower [-- FOLDER]
//! ```
//!
//! With a folder, it writes a picture of each room there.

use cplan_testkit::mobile::floor::Floor;
use cplan_testkit::mobile::mission::followed;
use std::error::Error;
use std::path::PathBuf;

fn main() -> Result<(), Box<dyn Error>> {
    let folder = std::env::args().nth(1).map(PathBuf::from);
    println!("S. F. dos Reis Alves, Trabalho 2, section 2: a map after 3 minutes, all of the wall after 10");
    for name in ["hall", "house"] {
        let floor = Floor::load(&format!("explore/{name}.toml"))?;
        for minutes in [3, 5, 10] {
            let (map, way) = followed(&floor, 60.0 * f64::from(minutes));
            let [free, occupied, unknown] = map.counts();
            let known = 100.0 * (free + occupied) as f64 / (free + occupied + unknown) as f64;
            let length: f64 = way.windows(2).map(|pair| (pair[1] - pair[0]).norm()).sum();
            println!(
                "{name:<6} {minutes:>2} min  {length:6.1} m  {known:5.1} % of the cells known, {occupied} occupied"
            );
            if let Some(folder) = folder.as_ref().filter(|_| minutes == 10) {
                let picture = floor.picture("Wall follower, 10 minutes", &[], &[("way".to_owned(), way)]);
                std::fs::write(folder.join(format!("wall_follower_{name}.svg")), picture)?;
            }
        }
    }
    Ok(())
}

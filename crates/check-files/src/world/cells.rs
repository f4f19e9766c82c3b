//! Occupancy maps: the dark pixels of a picture are solid squares.

use super::picture::{self, Picture};
use crate::files::Files;
use cplan_check::decimal::Decimal;
use cplan_check::interval::{BITS, Interval, Point, minus, sum, turned};
use cplan_check::obstacle::Squares;
use cplan_check::{CheckError, Input};
use num_bigint::{BigInt, Sign};
use serde::Deserialize;
use std::path::Path;

/// The solid and free squares of a picture, which is an occupancy map. A square includes its sides.
pub struct Cells {
    size: [usize; 2],
    /// For each square, true if it is solid; row by row from below.
    solid: Vec<bool>,
    /// Length of a square's side.
    side: Decimal,
    /// Position of the picture's lower left corner. `turn` has the sine and cosine of the rotation about that corner.
    at: Point,
    turn: [Interval; 2],
}

/// Maximum number of border pieces. They need about a gigabyte of memory.
const MAX_PIECES: usize = 1 << 18;

/// Darkness, from 0 to 255, of pixels that are unknown for any thresholds. ROS's map savers write this value for unseen cells.
const UNSEEN_DARKNESS: i32 = 50;

/// The description of a map, as in the YAML file of ROS's map server. Numbers are exact. Unknown keys are ignored.
#[derive(Deserialize)]
struct Description {
    image: String,
    resolution: String,
    origin: Vec<String>,
    negate: String,
    occupied_thresh: String,
    free_thresh: String,
    mode: Option<String>,
}

impl Cells {
    /// Reads a description and its picture.
    ///
    /// # Errors
    /// If it is not a description, or if the picture is neither PGM nor PNG.
    pub fn read(files: &Files, yaml: &Path, unknown_is_solid: bool) -> Result<Self, CheckError> {
        let wrong = |path: &Path, why: &str| CheckError::in_file(Input::World, format!("{}: {why}", path.display()));
        let text = String::from_utf8(files.bytes(Input::World, yaml)?).map_err(|_| wrong(yaml, "it is not text"))?;
        let description = serde_saphyr::from_str::<Description>(&text);
        let Description { image, resolution, origin, negate, occupied_thresh, free_thresh, mode } =
            description.map_err(|error| wrong(yaml, &error.without_snippet().to_string()))?;
        let number = |text: &String| Decimal::read(text).map_err(|why| wrong(yaml, &why));
        let [occupied, free, side] = [number(&occupied_thresh)?, number(&free_thresh)?, number(&resolution)?];
        let is_share = |share: &Decimal| *share >= Decimal::whole(0) && *share <= Decimal::whole(1);
        if free > occupied
            || !is_share(&free)
            || !is_share(&occupied)
            || Interval::from(&side).lower.sign() != Sign::Plus
        {
            return Err(wrong(
                yaml,
                "wrong numbers: free_thresh and occupied_thresh must be from 0 to 1, free_thresh not the greater, resolution positive",
            ));
        }
        let [x, y, yaw] = &origin[..] else { return Err(wrong(yaml, "origin must be a list [x, y, yaw]")) };
        let [x, y, yaw] = [number(x)?, number(y)?, number(yaw)?];
        let is_light = match negate.to_lowercase().as_str() {
            "0" | "false" | "no" | "off" | "n" => false,
            "1" | "true" | "yes" | "on" | "y" => true,
            _ => return Err(wrong(yaml, "negate is neither 0 nor 1")),
        };
        if !mode.is_none_or(|mode| ["trinary", "scale"].contains(&mode.as_str())) {
            return Err(wrong(yaml, "the checker knows only the modes trinary and scale"));
        }
        let path = yaml.with_file_name(image);
        let Picture { size, white, shades } =
            picture::read(&files.bytes(Input::World, &path)?).map_err(|why| wrong(&path, &why))?;
        let whole = |n: u32| Decimal::whole(i32::try_from(n).expect("shades have 16 bits, three colours"));
        let is_solid = |shade: u32| {
            let dark = whole(if is_light { shade } else { white - shade });
            let above = |share: &Decimal| dark > share * &whole(white);
            let is_unseen = &dark * &Decimal::whole(255) == &whole(white) * &Decimal::whole(UNSEEN_DARKNESS);
            above(&occupied) || unknown_is_solid && (is_unseen || dark >= &free * &whole(white))
        };
        let table: Vec<bool> = (0..=white).map(is_solid).collect();
        let is_solid = |shade: &Option<u32>| shade.map_or(unknown_is_solid, |shade| table[shade as usize]);
        let solid = shades.chunks(size[0]).rev().flatten().map(is_solid).collect();
        Ok(Self { size, solid, side, at: [&x, &y].map(Interval::from), turn: Interval::from(&yaw).sin_cos() })
    }

    /// Returns true if the square with these indices exists and is solid.
    fn is_solid(&self, x: i64, y: i64) -> bool {
        let inside = |k: usize, n: i64| usize::try_from(n).ok().filter(|n| *n < self.size[k]);
        let (Some(x), Some(y)) = (inside(0, x), inside(1, y)) else { return false };
        self.solid[y * self.size[0] + x]
    }

    /// Returns the position of a corner of squares, given its indices, in the frame of the obstacle.
    fn corner(&self, [x, y]: [i64; 2]) -> Point {
        let along =
            [x, y].map(|n| Interval::from(&(&self.side * &Decimal::whole(i32::try_from(n).expect("few squares")))));
        sum(&self.at, &turned(&along, &self.turn))
    }

    /// Converts a point of the obstacle's frame to the frame of the squares, in which a square's side is 1.
    fn to_square_frame(&self, p: &Point) -> Point {
        let [sine, cosine] = &self.turn;
        let from_there = minus(p, &self.at);
        turned(&from_there, &[-sine, cosine.clone()]).map(|c| c.divided(&Interval::from(&self.side)))
    }
}

impl Squares for Cells {
    fn part(&self, given: &[Point]) -> Option<Vec<Point>> {
        let half = BigInt::from(1) << (BITS - 1);
        let nearest = |p: &Point| {
            let [x, y] = self.to_square_frame(p).map(|c| i64::try_from((c.middle().0 + &half) >> BITS).ok());
            Some([x?, y?])
        };
        let corners = given.iter().map(nearest).collect::<Option<Vec<[i64; 2]>>>()?;
        let [[left, low], .., [right, high]] = {
            let mut sorted = corners.clone();
            sorted.sort_unstable();
            <[[i64; 2]; 4]>::try_from(sorted).ok()?
        };
        let all = [[left, low], [right, low], [right, high], [left, high]];
        let is_one = left < right && low < high && all.iter().all(|corner| corners.contains(corner));
        // Squares outside the picture are not solid, so the loop ends at its border.
        let is_solid = is_one && (left..right).all(|x| (low..high).all(|y| self.is_solid(x, y)));
        is_solid.then(|| all.map(|corner| self.corner(corner)).to_vec())
    }

    fn border(&self) -> Result<Vec<[Point; 2]>, CheckError> {
        let [width, height] = self.size.map(|n| n as i64);
        let mut border = Vec::new();
        for (lines, steps, is_upright) in [(width, height, true), (height, width, false)] {
            for line in 0..=lines {
                let at = |step: i64| if is_upright { [line, step] } else { [step, line] };
                let is_border = |step: i64| {
                    let [x, y] = at(step);
                    let (beside_x, beside_y) = if is_upright { (x - 1, y) } else { (x, y - 1) };
                    self.is_solid(x, y) != self.is_solid(beside_x, beside_y)
                };
                let mut from = 0;
                for step in 0..=steps {
                    if step == steps || !is_border(step) {
                        border.extend((from < step).then(|| [at(from), at(step)]));
                        from = step + 1;
                    }
                }
            }
        }
        if border.len() > MAX_PIECES {
            let message =
                format!("the border of a picture has {} pieces; the checker allows at most {MAX_PIECES}", border.len());
            return Err(CheckError::in_file(Input::World, message));
        }
        Ok(border.into_iter().map(|ends| ends.map(|end| self.corner(end))).collect())
    }

    fn holds(&self, p: &Point) -> bool {
        let [x, y] = self.to_square_frame(p).map(|c| i64::try_from(c.middle().0 >> BITS).unwrap_or(-1));
        self.is_solid(x, y)
    }
}

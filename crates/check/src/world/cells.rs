//! Occupancy maps: the dark squares of a picture.

use crate::decimal::Decimal;
use crate::error::{CheckError, Input};
use crate::files::Files;
use crate::interval::{BITS, Interval, Point, sum, turned};
use num_bigint::{BigInt, Sign};
use std::collections::BTreeMap;
use std::path::Path;

/// The squares of a picture, closed.
pub struct Cells {
    size: [usize; 2],
    /// Row by row from below.
    solid: Vec<bool>,
    /// The length of a square's side.
    side: Decimal,
    /// Where the lower left corner of the picture lies, and sine and cosine of its turn about that.
    at: Point,
    turn: [Interval; 2],
}

/// Squares of the largest picture.
const MOST_CELLS: usize = 1 << 26;

/// All that a description can say.
const KEYS: [&str; 7] = ["image", "resolution", "origin", "negate", "occupied_thresh", "free_thresh", "mode"];

impl Cells {
    /// Reads a description, the YAML of ROS's map server, and the picture that it names.
    ///
    /// # Errors
    /// What is none, and pictures other than PGM.
    pub fn read(files: &Files, yaml: &Path, unknown_is_solid: bool) -> Result<Self, CheckError> {
        let wrong = |path: &Path, why: &str| CheckError::in_file(Input::World, format!("{}: {why}", path.display()));
        let text = String::from_utf8(files.bytes(Input::World, yaml)?).map_err(|_| wrong(yaml, "it is no text"))?;
        let keys = described(&text).map_err(|why| wrong(yaml, &why))?;
        let value = |key: &str| keys.get(key).copied().ok_or_else(|| wrong(yaml, &format!("{key} is missing")));
        let parsed = |text: &str| text.trim().parse::<Decimal>().map_err(|why| wrong(yaml, &why));
        let number = |key: &str| parsed(value(key)?);
        let [occupied, free, side] = [number("occupied_thresh")?, number("free_thresh")?, number("resolution")?];
        if free > occupied || Interval::from(&side).lower.sign() != Sign::Plus {
            return Err(wrong(yaml, "free_thresh is above occupied_thresh, or the resolution is no length"));
        }
        let origin = value("origin")?.strip_prefix('[').and_then(|list| list.strip_suffix(']'));
        let origin = origin.map(|list| list.split(',').map(parsed).collect::<Result<Vec<_>, _>>()).transpose()?;
        let Some([x, y, yaw]) = origin.as_deref() else {
            return Err(wrong(yaml, "origin is no list [x, y, yaw] on one line"));
        };
        let is_light = match value("negate")? {
            "0" | "false" => false,
            "1" | "true" => true,
            _ => return Err(wrong(yaml, "negate is neither 0 nor 1")),
        };
        if !matches!(keys.get("mode").copied().unwrap_or("trinary"), "trinary" | "scale") {
            return Err(wrong(yaml, "the checker knows the modes trinary and scale"));
        }
        let path = yaml.with_file_name(value("image")?);
        let bytes = files.bytes(Input::World, &path)?;
        let Greymap { size, most, shades } = Greymap::read(&bytes).map_err(|why| wrong(&path, &why))?;
        let whole = |n: usize| Decimal::whole(i32::try_from(n).expect("shades have 16 bits"));
        let is_solid = |shade: usize| {
            let dark = whole(if is_light { shade } else { most - shade });
            let above = |share: &Decimal| dark > share * &whole(most);
            above(&occupied) || unknown_is_solid && dark >= &free * &whole(most)
        };
        let table: Vec<bool> = (0..=most).map(is_solid).collect();
        let solid = shades.chunks(size[0]).rev().flatten().map(|shade| table[*shade]).collect();
        Ok(Self { size, solid, side, at: [x, y].map(Interval::from), turn: Interval::from(yaw).sin_cos() })
    }

    /// Whether a square is there and solid.
    fn is_solid(&self, x: i64, y: i64) -> bool {
        let inside = |k: usize, n: i64| usize::try_from(n).ok().filter(|n| *n < self.size[k]);
        let (Some(x), Some(y)) = (inside(0, x), inside(1, y)) else { return false };
        self.solid[y * self.size[0] + x]
    }

    /// Where a corner of squares is, in the frame of the obstacle.
    fn corner(&self, [x, y]: [i64; 2]) -> Point {
        let along =
            [x, y].map(|n| Interval::from(&(&self.side * &Decimal::whole(i32::try_from(n).expect("few squares")))));
        sum(&self.at, &turned(&along, &self.turn))
    }

    /// A point of the obstacle's frame in the squares' own, whose sides are 1.
    fn counted(&self, p: &Point) -> Point {
        let [sine, cosine] = &self.turn;
        let from_there = [0, 1].map(|k| &p[k] - &self.at[k]);
        turned(&from_there, &[-sine, cosine.clone()]).map(|c| c.divided(&Interval::from(&self.side)))
    }

    /// The rectangle of solid squares whose corners are those nearest to four points of the obstacle's frame.
    pub fn part(&self, given: &[Point]) -> Option<Vec<Point>> {
        let half = BigInt::from(1) << (BITS - 1);
        let nearest = |p: &Point| {
            let [x, y] = self.counted(p).map(|c| i64::try_from((c.middle().0 + &half) >> BITS).ok());
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
        // What is outside is not solid, so that the loop ends there.
        let is_solid = is_one && (left..right).all(|x| (low..high).all(|y| self.is_solid(x, y)));
        is_solid.then(|| all.map(|corner| self.corner(corner)).to_vec())
    }

    /// The border between what is solid and what is not, in straight pieces, in the frame of the obstacle.
    pub fn border(&self) -> Vec<[Point; 2]> {
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
                        border.extend((from < step).then(|| [at(from), at(step)].map(|end| self.corner(end))));
                        from = step + 1;
                    }
                }
            }
        }
        border
    }

    /// Whether a point of the obstacle's frame that is off the border is in something solid.
    pub fn holds(&self, p: &Point) -> bool {
        let [x, y] = self.counted(p).map(|c| i64::try_from(c.middle().0 >> BITS).unwrap_or(-1));
        self.is_solid(x, y)
    }
}

/// Keys and values of a YAML that has each on a line of its own.
fn described(text: &str) -> Result<BTreeMap<&str, &str>, String> {
    let mut keys = BTreeMap::new();
    for (number, line) in text.lines().enumerate() {
        let said = if line.starts_with('#') { "" } else { line.split(" #").next().unwrap_or_default().trim_end() };
        if said.is_empty() || said == "---" {
            continue;
        }
        let known = said.split_once(':').filter(|(key, value)| KEYS.contains(key) && !value.trim().is_empty());
        let Some((key, value)) = known else {
            return Err(format!(
                "line {}: expected one of {}, and its value on the same line",
                number + 1,
                KEYS.join(", ")
            ));
        };
        if keys.insert(key, value.trim().trim_matches(['"', '\''])).is_some() {
            return Err(format!("line {}: {key} for the second time", number + 1));
        }
    }
    Ok(keys)
}

/// A picture in grey: PGM, as text (P2) or bytes (P5).
struct Greymap {
    size: [usize; 2],
    /// White; black is 0.
    most: usize,
    /// Row by row from above.
    shades: Vec<usize>,
}

impl Greymap {
    fn read(bytes: &[u8]) -> Result<Self, String> {
        let is_text = match bytes.get(..2) {
            Some(b"P2") => true,
            Some(b"P5") => false,
            _ => return Err("the checker knows pictures as PGM (P2, P5): save it as one".into()),
        };
        let mut rest = &bytes[2..];
        let [width, height, most] = [number(&mut rest)?, number(&mut rest)?, number(&mut rest)?];
        let count = width.checked_mul(height).filter(|count| (1..=MOST_CELLS).contains(count));
        let count = count.ok_or("it has no size, or too large a one")?;
        if !(1..=65535).contains(&most) {
            return Err(format!("its maxval is {most}: it has to be from 1 to 65535"));
        }
        let shades: Vec<usize> = if is_text {
            let shades = (0..count).map(|_| number(&mut rest)).collect::<Result<_, _>>()?;
            skip(&mut rest);
            shades
        } else {
            // One white space ends the header.
            comment(&mut rest);
            let bytes_each = if most > 255 { 2 } else { 1 };
            let (raster, after) =
                rest.get(1..).unwrap_or_default().split_at_checked(bytes_each * count).ok_or("it ends early")?;
            rest = after;
            let shade = |bytes: &[u8]| bytes.iter().fold(0, |sum, byte| 256 * sum + usize::from(*byte));
            raster.chunks(bytes_each).map(shade).collect()
        };
        match shades.iter().all(|shade| *shade <= most) && rest.is_empty() {
            true => Ok(Self { size: [width, height], most, shades }),
            false => Err("a value exceeds its maxval, or something follows the picture".into()),
        }
    }
}

/// Passes over a comment up to the end of its line.
fn comment(rest: &mut &[u8]) {
    if rest.first() == Some(&b'#') {
        *rest = &rest[rest.iter().position(|byte| matches!(byte, b'\n' | b'\r')).unwrap_or(rest.len())..];
    }
}

/// Passes over white space and comments.
fn skip(rest: &mut &[u8]) {
    comment(rest);
    while rest.first().is_some_and(u8::is_ascii_whitespace) {
        *rest = &rest[1..];
        comment(rest);
    }
}

/// The next number of a greymap.
fn number(rest: &mut &[u8]) -> Result<usize, String> {
    skip(rest);
    let length = rest.iter().position(|byte| !byte.is_ascii_digit()).unwrap_or(rest.len());
    let (digits, after) = rest.split_at(length);
    *rest = after;
    let text = std::str::from_utf8(digits).unwrap_or_default();
    text.parse().map_err(|_| format!("\"{text}\" is no number, or it ends early"))
}

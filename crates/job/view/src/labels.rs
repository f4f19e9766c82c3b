//! The placer of names in a panel. A name lies within its shape, touches it, or has a line to it. It never lies on the arm, on a
//! marker or on another name, and avoids paths as far as possible. A name without a possible place is omitted.
//!
//! For pages, `view/assets/labels.js` has the same places in the same order with the same costs. Change both together.

use super::axes::Frame;
use super::figure::{Anchor, Item, Label, Rect, Step, Style, bold_text_width, shortened};
use super::named::{Named, in_pixels, outline_of};
use super::regions::RegionRaster;
use cplan_geometry::{Convex, separation};
use cplan_theme::{GRAY, INK, WHITE};

const NAME_SIZE: f64 = 12.0;
/// Greatest width of a name, in pixels.
const MAX_NAME_WIDTH: f64 = 160.0;
/// Height of a name's box, in pixels.
const NAME_HEIGHT: f64 = 15.0;
/// Distance between a name's box and the shape beside it, in pixels.
const NAME_GAP: f64 = 3.0;
/// Distances from the shape at which a name needs a line to its shape, in pixels.
const LEADER_GAPS: [f64; 3] = [18.0, 36.0, 58.0];
/// Greatest distance between a name's box and its shape without a line, in pixels, as across a corner, or beside the drawn line
/// of a wall.
const TOUCH: f64 = 5.0;
/// Distance between the points that represent a line, in pixels.
const LINE_STEP: f64 = 4.0;
/// Distance that a name keeps from the points of a line, in pixels, unless it has to cross the line.
const LINE_GAP: f64 = 2.0;

/// Places for a name relative to its object, in the order of preference: on it, above, below, beside it, at its
/// corners.
const NAME_PLACES: [[f64; 2]; 9] =
    [[0.0, 0.0], [0.0, -1.0], [0.0, 1.0], [1.0, 0.0], [-1.0, 0.0], [1.0, -1.0], [-1.0, -1.0], [1.0, 1.0], [-1.0, 1.0]];
/// Additional cost of each place compared with the one before it.
const PLACE_COST: f64 = 0.01;
/// Cost of crossing a path.
const CROSSING_COST: f64 = 3.0;
/// Cost of a line to the shape.
const LEADER_COST: f64 = 0.6;

/// A name and the surface that it names: an outline, filled by the non-zero rule.
pub struct NamedRegion {
    /// The name.
    pub text: String,
    /// The outline, of straight lines.
    pub outline: Vec<Step>,
}

/// Places the names of a panel one after the other; earlier names have the first choice.
pub struct Placer {
    page: Rect,
    boxes: Vec<Rect>,
    names: Vec<Rect>,
    /// Convex parts of arms, in pixels that count upwards, so that corners stay counter-clockwise.
    shapes: Vec<Convex>,
    /// Points on lines.
    points: Vec<[f64; 2]>,
    items: Vec<Item>,
}

impl Placer {
    pub fn new(page: Rect) -> Self {
        Self { page, boxes: Vec::new(), names: Vec::new(), shapes: Vec::new(), points: Vec::new(), items: Vec::new() }
    }

    /// Keeps names off a convex shape of the panel's plane, such as a part of the arm.
    pub fn block_shape(&mut self, frame: &Frame, shape: &Convex) {
        self.shapes.push(in_pixels(frame, shape));
    }

    /// Keeps names off a marker.
    pub fn block_spot(&mut self, spot: [f64; 2], half: f64) {
        self.boxes.push(centered_rect(spot, [2.0 * half; 2]));
    }

    /// Keeps names off a box.
    pub fn block_box(&mut self, place: Rect) {
        self.boxes.push(place);
    }

    /// Makes names dodge a line.
    pub fn block_line(&mut self, outline: &[Step]) {
        let (mut before, mut begin): (Option<[f64; 2]>, Option<[f64; 2]>) = (None, None);
        for step in outline {
            let (from, spot) = match *step {
                Step::Move(spot) => {
                    begin = Some(spot);
                    (None, spot)
                }
                Step::Line(spot) | Step::Arc(_, spot) => (before, spot),
                Step::Close => match begin {
                    Some(spot) => (before, spot),
                    None => continue,
                },
            };
            if let Some([x, y]) = from {
                let length = (spot[0] - x).hypot(spot[1] - y);
                let count = (length / LINE_STEP).ceil().clamp(1.0, 1e4) as usize;
                let part = |k: usize| k as f64 / count as f64;
                let between = (1..count).map(|k| [x + (spot[0] - x) * part(k), y + (spot[1] - y) * part(k)]);
                self.points.extend(between);
            }
            self.points.push(spot);
            before = Some(spot);
        }
    }

    /// Places names, each with the box of its shape. A name lies on its shape. If the shape is too small, the name lies beside
    /// it, where it covers the least of other shapes.
    pub fn beside(&mut self, names: &[Named]) {
        for (index, name) in names.iter().enumerate() {
            let others = names.iter().enumerate().filter(|(other, _)| *other != index).map(|(_, other)| &other.rect);
            let covered = |b: &Rect| others.clone().map(|other| covered_share(b, other)).sum::<f64>();
            self.put(name, |place, _| covered(place));
        }
    }

    /// Does the same as [`Placer::beside`], but each name covers as little of these regions as possible.
    pub fn beside_among(&mut self, names: &[Named], regions: &[NamedRegion]) {
        let raster = RegionRaster::new(self.page, regions.iter().map(|region| &region.outline[..]));
        names.iter().for_each(|name| self.put(name, |place, _| raster.covered_share(place, None)));
    }

    /// Places names on regions of any shape. A name lies within the visible part of its region, as far as possible from the
    /// outline. If that part is too small, the name lies beside it; if it would then cover another region, it has a line to its
    /// own. Later regions cover earlier ones.
    pub fn on_regions(&mut self, regions: &[NamedRegion]) {
        self.on_all(regions, true);
    }

    /// Does the same as [`Placer::on_regions`] for bars, which may be lower than letters: a name lies within its bar, above it or
    /// below it.
    pub fn on_bars(&mut self, regions: &[NamedRegion]) {
        self.on_all(regions, false);
    }

    fn on_all(&mut self, regions: &[NamedRegion], may_stick_out: bool) {
        if regions.is_empty() {
            return;
        }
        let mut raster = RegionRaster::new(self.page, regions.iter().map(|region| &region.outline[..]));
        self.boxes.iter().for_each(|place| raster.block(place));
        self.points.iter().for_each(|&spot| raster.block(&centered_rect(spot, [2.0 * LINE_GAP; 2])));
        let mut rest = Vec::new();
        for (index, region) in regions.iter().enumerate() {
            let name = shortened(&region.text, NAME_SIZE, MAX_NAME_WIDTH);
            let size = size(&name);
            let place = raster.roomiest(index, size, may_stick_out);
            let spot = |text: String, at: [f64; 2]| {
                let rect = if may_stick_out { centered_rect(at, [0.0; 2]) } else { raster.upright_part(index, at) };
                Named::of_box(text, rect)
            };
            if let Some((at, true)) = place {
                let place = moved_into_page(centered_rect(at, size), &self.page);
                // A name that sticks out of its region may meet another name that does.
                if self.is_blocked(&place) {
                    rest.push((index, spot(name, at)));
                } else {
                    self.write(name, place);
                }
            } else if let Some(at) = place.map(|(at, _)| at).or_else(|| raster.any_part(index)) {
                // Paths may cover all of a small region.
                rest.push((index, spot(name, at)));
            }
        }
        for (index, name) in rest {
            self.put(&name, |place, has_line| match raster.covered_share(place, Some(index)) {
                foreign if foreign > 0.0 && !has_line => f64::INFINITY,
                _ => raster.covered_share(place, None),
            });
        }
    }

    /// Returns the names as items: first the lines to distant shapes, then the names.
    pub fn into_items(self) -> Vec<Item> {
        let (lines, texts): (Vec<Item>, Vec<Item>) =
            self.items.into_iter().partition(|item| !matches!(item, Item::Text(_)));
        lines.into_iter().chain(texts).collect()
    }

    /// Returns true if a name in this box would lie on something.
    fn is_blocked(&self, place: &Rect) -> bool {
        if !is_within(place, &self.page) || self.boxes.iter().any(|other| overlap(place, other) > 0.0) {
            return true;
        }
        let own = outline_of(place, 1.0);
        self.shapes.iter().any(|shape| separation(&own, shape).distance <= 0.0)
    }

    /// Returns true if the line from a name to a place on its shape would cross another name.
    fn crosses_name(&self, place: &Rect, end: [f64; 2]) -> bool {
        let begin = clamped(end, place);
        let count = ((end[0] - begin[0]).hypot(end[1] - begin[1]) / LINE_STEP).ceil();
        let spot = |k: usize| [0, 1].map(|c| begin[c] + (end[c] - begin[c]) * k as f64 / count.max(1.0));
        (0..=count as usize).map(spot).any(|spot| self.names.iter().any(|name| holds(name, spot)))
    }

    fn crosses_line(&self, place: &Rect) -> bool {
        let [x, y] = [place.x - LINE_GAP..=place.right() + LINE_GAP, place.y - LINE_GAP..=place.bottom() + LINE_GAP];
        self.points.iter().any(|point| x.contains(&point[0]) && y.contains(&point[1]))
    }

    /// Places a name at the best of its free places, or omits it. `cost` is the additional cost of a box, with or without a line
    /// to the shape.
    fn put(&mut self, named: &Named, cost: impl Fn(&Rect, bool) -> f64) {
        let name = shortened(&named.text, NAME_SIZE, MAX_NAME_WIDTH);
        let (mut best, mut least) = (None, f64::INFINITY);
        for (index, (place, is_far)) in places(size(&name), &named.rect).into_iter().enumerate() {
            let known = PLACE_COST * index as f64;
            if known >= least || self.is_blocked(&place) {
                continue;
            }
            let (distance, end) = named.nearest(&place);
            let has_line = is_far || distance > TOUCH;
            if has_line && (!holds(&self.page, end) || self.crosses_name(&place, end)) {
                continue;
            }
            let crossing = if self.crosses_line(&place) { CROSSING_COST } else { 0.0 };
            let whole = known + if has_line { LEADER_COST } else { 0.0 } + crossing + cost(&place, has_line);
            if whole < least {
                (best, least) = (Some((place, has_line.then_some(end))), whole);
            }
        }
        let Some((place, end)) = best else { return };
        if let Some(end) = end {
            let steps = vec![Step::Move(clamped(end, &place)), Step::Line(end)];
            self.block_line(&steps);
            let pens = [(WHITE, 3.0), (GRAY, 1.0)];
            self.items.extend(pens.map(|(color, width)| Item::Outline(steps.clone(), Style::line(color, width))));
        }
        self.write(name, place);
    }

    fn write(&mut self, text: String, place: Rect) {
        let at = [place.x + place.width / 2.0, place.bottom() - 3.5];
        self.items.push(Item::Text(Label {
            at,
            text,
            size: NAME_SIZE,
            anchor: Anchor::Middle,
            upwards: false,
            color: INK,
            has_halo: true,
            is_bold: true,
        }));
        self.boxes.push(place);
        self.names.push(place);
    }
}

/// Returns the possible places of a name, nearest first. The flag is true if the place is so far from the shape that the name
/// needs a line.
fn places(size: [f64; 2], of: &Rect) -> Vec<(Rect, bool)> {
    let fits = size[0] <= of.width && size[1] <= of.height;
    let middle = [of.x + of.width / 2.0, of.y + of.height / 2.0];
    let at = |side: [f64; 2], gap: f64| {
        let away = [0, 1].map(|k| side[k] * (size[k] / 2.0 + gap + [of.width, of.height][k] / 2.0));
        centered_rect([middle[0] + away[0], middle[1] + away[1]], size)
    };
    let near = NAME_PLACES.into_iter().skip(usize::from(!fits)).map(|side| (at(side, NAME_GAP), false));
    let far = LEADER_GAPS.into_iter().flat_map(|gap| NAME_PLACES[1..].iter().map(move |&side| (side, gap)));
    near.chain(far.map(|(side, gap)| (at(side, gap), true))).collect()
}

/// Returns the point of a box that is nearest to a point.
fn clamped([x, y]: [f64; 2], to: &Rect) -> [f64; 2] {
    [x.clamp(to.x, to.right()), y.clamp(to.y, to.bottom())]
}

/// Returns the share of a shape's box that a name would cover. Hiding a part of a large shape is better than hiding a small one
/// wholly.
fn covered_share(place: &Rect, other: &Rect) -> f64 {
    overlap(place, other) / (other.width * other.height).max(NAME_HEIGHT * NAME_HEIGHT)
}

/// Returns a rectangle of this size, centred at a place.
pub fn centered_rect([x, y]: [f64; 2], [width, height]: [f64; 2]) -> Rect {
    Rect { x: x - width / 2.0, y: y - height / 2.0, width, height }
}

/// Returns the box for the name of a line from `from` to `tip`. The box lies beyond `tip`.
pub fn label_box_beyond(name: &str, tip: [f64; 2], from: [f64; 2]) -> Rect {
    let away = [tip[0] - from[0], tip[1] - from[1]];
    let length = away[0].hypot(away[1]).max(f64::MIN_POSITIVE);
    let size = size(name);
    centered_rect([0, 1].map(|k| tip[k] + away[k] / length * (size[k] / 2.0 + 2.0 * NAME_GAP)), size)
}

/// Returns the common area in square pixels.
pub fn overlap(a: &Rect, b: &Rect) -> f64 {
    let width = a.right().min(b.right()) - a.x.max(b.x);
    let height = a.bottom().min(b.bottom()) - a.y.max(b.y);
    width.max(0.0) * height.max(0.0)
}

/// Moves a box by the least distance that brings it onto the page.
fn moved_into_page(place: Rect, page: &Rect) -> Rect {
    let x = place.x.min(page.right() - place.width).max(page.x);
    let y = place.y.min(page.bottom() - place.height).max(page.y);
    Rect { x, y, ..place }
}

/// Returns true if a box lies in the page.
pub fn is_within(place: &Rect, page: &Rect) -> bool {
    place.x >= page.x && place.y >= page.y && place.right() <= page.right() && place.bottom() <= page.bottom()
}

fn holds(place: &Rect, [x, y]: [f64; 2]) -> bool {
    (place.x..=place.right()).contains(&x) && (place.y..=place.bottom()).contains(&y)
}

fn size(name: &str) -> [f64; 2] {
    [bold_text_width(name, NAME_SIZE) + 6.0, NAME_HEIGHT]
}

#[cfg(test)]
mod tests {
    use super::super::figure::rectangle;
    use super::*;
    use cplan_geometry::Point;

    const PAGE: Rect = Rect { x: 0.0, y: 0.0, width: 300.0, height: 300.0 };

    fn placed(placer: Placer) -> Vec<(String, [f64; 2])> {
        let text = |item: Item| if let Item::Text(label) = item { Some((label.text, label.at)) } else { None };
        let middle = |(text, [x, bottom]): (String, [f64; 2])| (text, [x, bottom + 3.5 - NAME_HEIGHT / 2.0]);
        placer.into_items().into_iter().filter_map(text).map(middle).collect()
    }

    fn named(name: &str, place: Rect) -> Named {
        Named::of_box(name.to_owned(), place)
    }

    #[test]
    fn the_name_of_an_arm_lies_beyond_its_tip() {
        for from in [[100.0, 150.0], [150.0, 250.0], [190.0, 100.0]] {
            let place = label_box_beyond("start", [150.0, 150.0], from);
            let middle = [place.x + place.width / 2.0, place.y + place.height / 2.0];
            let toward = (middle[0] - 150.0) * (150.0 - from[0]) + (middle[1] - 150.0) * (150.0 - from[1]);
            assert!(toward > 0.0 && overlap(&place, &centered_rect([150.0, 150.0], [1.0, 1.0])) == 0.0, "{place:?}");
        }
    }

    #[test]
    fn names_are_placed_beside_smaller_shapes() {
        let mut placer = Placer::new(PAGE);
        placer.beside(&[named("bottle", centered_rect([150.0, 150.0], [10.0, 10.0]))]);
        assert_eq!(placed(placer), [("bottle".to_owned(), [150.0, 150.0 - 5.0 - NAME_GAP - NAME_HEIGHT / 2.0])]);
    }

    #[test]
    fn names_avoid_arms_markers_and_lines() {
        let of = centered_rect([150.0, 150.0], [10.0, 10.0]);
        let frame = Frame::filling(PAGE, (0.0, 300.0), (0.0, 300.0));
        let arm = Convex::trusted(
            [[120.0, 160.0], [180.0, 160.0], [180.0, 185.0]].map(|[x, y]| Point::new(x, y)).to_vec(),
            1.0,
        );
        let mut placer = Placer::new(PAGE);
        // The arm is above the shape, the marker below it, and the line to its right.
        placer.block_shape(&frame, &arm);
        placer.block_spot([150.0, 166.0], 4.0);
        placer.block_line(&[Step::Move([175.0, 140.0]), Step::Line([175.0, 160.0])]);
        placer.beside(&[named("bottle", of)]);
        let [(_, [x, y])] = &placed(placer)[..] else { panic!("one name") };
        assert!(*x < 140.0 && (*y - 150.0).abs() < 1e-9, "{x}, {y}");
    }

    #[test]
    fn names_without_a_place_are_left_out() {
        let mut placer = Placer::new(PAGE);
        placer.block_spot([150.0, 150.0], 150.0);
        placer.beside(&[named("bottle", centered_rect([150.0, 150.0], [10.0, 10.0]))]);
        placer.on_regions(&[NamedRegion { text: "shelf".to_owned(), outline: rectangle(PAGE) }]);
        assert!(placed(placer).is_empty());
    }

    #[test]
    fn distant_names_have_lines() {
        let of = centered_rect([150.0, 150.0], [10.0, 10.0]);
        let mut placer = Placer::new(PAGE);
        placer.block_spot([150.0, 150.0], 24.0);
        placer.beside(&[named("bottle", of)]);
        let items = placer.into_items();
        let [Item::Outline(..), Item::Outline(steps, _), Item::Text(label)] = &items[..] else { panic!("{items:?}") };
        // The line ends at the corner of the shape that is nearest to the name.
        assert_eq!(steps[1], Step::Line([155.0, 145.0]));
        assert!(label.at[1] < 126.0);
    }

    /// The box around a hollow shape is no part of the shape, so a name that only touches the box has a line to the shape.
    #[test]
    fn lines_end_on_shapes() {
        let frame = Frame::filling(PAGE, (0.0, 300.0), (0.0, 300.0));
        let wall = |corners: [[f64; 2]; 4]| Convex::trusted(corners.map(|[x, y]| Point::new(x, y)).to_vec(), 0.0);
        // A U that opens upwards. All places except those between its ends are taken.
        let pieces = [
            wall([[100.0, 100.0], [200.0, 100.0], [200.0, 110.0], [100.0, 110.0]]),
            wall([[100.0, 100.0], [110.0, 100.0], [110.0, 200.0], [100.0, 200.0]]),
            wall([[190.0, 100.0], [200.0, 100.0], [200.0, 200.0], [190.0, 200.0]]),
        ];
        let rect = Rect { x: 100.0, y: 100.0, width: 100.0, height: 100.0 };
        let mut placer = Placer::new(PAGE);
        placer.block_box(Rect { x: 0.0, y: 99.0, width: 300.0, height: 201.0 });
        placer.block_box(Rect { x: 0.0, y: 0.0, width: 125.0, height: 99.0 });
        placer.block_box(Rect { x: 175.0, y: 0.0, width: 125.0, height: 99.0 });
        placer.beside(&[Named::of_pieces("box".to_owned(), rect, &frame, &pieces)]);
        let items = placer.into_items();
        let [Item::Outline(steps, _), _, Item::Text(label)] = &items[..] else { panic!("{items:?}") };
        assert!((label.at[0] - 150.0).abs() < 1.0, "{label:?}");
        let Step::Line([x, y]) = steps[1] else { panic!("{steps:?}") };
        assert!((x - 110.0).abs() < 1e-9 || (x - 190.0).abs() < 1e-9, "{x}");
        assert!((y - 100.0).abs() < 1e-9, "{y}");
    }

    /// A small region among others has a line to its name. Without it, the name would seem to belong to another region.
    #[test]
    fn names_on_other_regions_have_lines() {
        let region = |text: &str, place: Rect| NamedRegion { text: text.to_owned(), outline: rectangle(place) };
        let mut placer = Placer::new(PAGE);
        let small = Rect { x: 146.0, y: 146.0, width: 8.0, height: 8.0 };
        placer.on_regions(&[
            region("wide", Rect { x: 20.0, y: 20.0, width: 260.0, height: 260.0 }),
            region("narrow", small),
        ]);
        let items = placer.into_items();
        let [Item::Outline(..), Item::Outline(steps, _), Item::Text(_), Item::Text(_)] = &items[..] else {
            panic!("{items:?}")
        };
        let Step::Line([x, y]) = steps[1] else { panic!("{steps:?}") };
        assert!((146.0..=154.0).contains(&x) && (146.0..=154.0).contains(&y), "{x}, {y}");
    }

    /// If a bar is lower than letters, its name is above it; otherwise, the name is within it.
    #[test]
    fn names_do_not_cover_low_bars() {
        for (height, is_within) in [(13.0, false), (40.0, true)] {
            let mut placer = Placer::new(PAGE);
            let bar = Rect { x: 20.0, y: 100.0, width: 260.0, height };
            placer.on_bars(&[NamedRegion { text: "cart blocks".to_owned(), outline: rectangle(bar) }]);
            assert_eq!(placer.items.len(), 1, "no line");
            let [name] = placer.names[..] else { panic!("one name") };
            assert_eq!(overlap(&name, &bar) > 0.0, is_within, "{name:?}");
            assert!((name.bottom() - bar.y).abs() < 8.0 || is_within, "{name:?}");
        }
    }

    /// Crowded names lie on the page and apart from each other.
    #[test]
    fn names_keep_apart() {
        let mut placer = Placer::new(PAGE);
        let names: Vec<Named> = (0..30)
            .map(|k| {
                named(
                    &format!("part {k}"),
                    centered_rect([20.0 + 30.0 * f64::from(k % 6), 20.0 + 17.0 * f64::from(k / 6)], [8.0; 2]),
                )
            })
            .collect();
        placer.beside(&names);
        let boxes: Vec<Rect> = placer.boxes.clone();
        assert!(boxes.len() > 8);
        for (i, a) in boxes.iter().enumerate() {
            assert!(is_within(a, &PAGE) && boxes[i + 1..].iter().all(|b| overlap(a, b) == 0.0), "{a:?}");
        }
    }

    /// A name lies in the part of a region that a later one does not cover.
    #[test]
    fn names_of_regions_lie_in_their_visible_parts() {
        let region = |text: &str, x: f64, width: f64| NamedRegion {
            text: text.to_owned(),
            outline: rectangle(Rect { x, y: 60.0, width, height: 120.0 }),
        };
        let mut placer = Placer::new(PAGE);
        placer.on_regions(&[region("wide", 20.0, 260.0), region("upper", 20.0, 160.0)]);
        let [(_, [wide, _]), (_, [upper, _])] = placed(placer)[..] else { panic!("two names") };
        assert!((wide - 230.0).abs() < 5.0 && (upper - 100.0).abs() < 5.0, "{wide}, {upper}");
    }
}

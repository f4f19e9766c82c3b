//! The picture of an answer about a cell.

use super::motions::{ShownMotions, met, pairs_of_links};
use super::objects::ShownObject;
use super::{ARM_COLORS, Answer, REGION_PALENESS, arm_shapes, bases, rows, time_frame};
use crate::between::Between;
use cplan_geometry::{Convex, Point};
use cplan_model::space::Configuration;
use cplan_theme::{FAINT, GHOST, GRAY, INFEASIBLE, INK, ROBOT, Rgb, UNDECIDED, WHITE};
use cplan_view::figure::{
    Anchor, Figure, Item, Pen, Rect, Step, Style, bold, chain, label, lines, rectangle, text_width,
};
use cplan_view::{Frame, Unit, heading, shapes, titles, verdict};

/// Width of the picture, pixels.
const WIDTH: f64 = 1400.0;

/// Place of the cell in the picture.
const WORKSPACE: Rect = Rect { x: 84.0, y: 116.0, width: 570.0, height: 540.0 };

/// Place of the diagram in the picture.
const DIAGRAM: Rect = Rect { x: 790.0, ..WORKSPACE };

/// Distance between the panels and the signs below them, pixels.
const AXES_HEIGHT: f64 = 62.0;

/// Place of the rows of time. Their height depends on the number of handovers and signals.
const ROWS: Rect =
    Rect { x: 150.0, y: WORKSPACE.y + WORKSPACE.height + AXES_HEIGHT + 34.0, width: 1210.0, height: 0.0 };

/// Size of the text of signs, pixels.
const TEXT: f64 = 14.0;

/// Radius of the disc of a signal in the diagram, pixels.
const DISC: f64 = 8.0;

/// Number of places of the tip that are drawn for each step of an arm.
const PLACES_PER_STEP: usize = 160;

/// Number of places of the schedule, and of the tip of an arm without steps, that are drawn.
const PLACES: usize = 400;

impl Answer<'_> {
    /// Returns the answer as a picture.
    pub fn figure(&self) -> Figure {
        let pairs = pairs_of_links(self.cell);
        let motions = ShownMotions::of(self, &pairs);
        let result = self.facts.first().map_or("", |(_, result)| result.as_str());
        let objects = self.objects(motions.as_ref());
        // Waits would not fit into the title.
        let below = [self.cell.name.clone()].into_iter().chain(self.waits_in_words()).chain([result.to_owned()]);
        let lines = [self.sentence(), below.collect::<Vec<_>>().join(" \u{b7} ")];
        let status = self.plan.status();
        let mut items = titles(&lines, verdict(Some(status), cplan_view::output::status(status)), WIDTH);
        items.extend(self.workspace(motions.as_ref(), &objects, pairs.between([0, 0])));
        items.push(heading(WORKSPACE, WORKSPACE.y - 14.0, "Workspace"));
        let below = WORKSPACE.bottom() + AXES_HEIGHT;
        items.extend(signs([WORKSPACE.x, below], &self.signs_of_arms(&objects)));
        let Some(motions) = motions else {
            return Figure { width: WIDTH, height: below + 30.0, items, is_dark: false };
        };
        items.push(heading(DIAGRAM, DIAGRAM.y - 14.0, "Times of both arms on their paths"));
        items.extend(self.diagram(&motions));
        items.extend(signs([DIAGRAM.x, below], &self.signs_of_regions(&motions)));
        items.extend(self.rows(&motions, &objects, ROWS));
        let height = ROWS.y + rows::height(&motions) + 62.0;
        Figure { width: WIDTH, height, items, is_dark: false }
    }

    fn signs_of_arms(&self, objects: &[ShownObject]) -> Vec<(Rgb, String)> {
        let names = self.names();
        match objects.first() {
            None => [0, 1].map(|arm| (ARM_COLORS[arm], format!("{} (pale: at its start)", names[arm]))).to_vec(),
            Some(object) => {
                let arms = [0, 1].map(|arm| (ARM_COLORS[arm], format!("{} at its start", names[arm])));
                let objects = (object.color().lighter(0.25), "objects; dashed: where they are placed".to_owned());
                arms.into_iter().chain([objects]).collect()
            }
        }
    }

    fn signs_of_regions(&self, motions: &ShownMotions) -> Vec<(Rgb, String)> {
        if !motions.are_certified {
            return vec![(
                UNDECIDED,
                "too near to each other; dashed: both take their fastest paths at once".to_owned(),
            )];
        }
        let names = self.names();
        [0, 1].map(|arm| (region_color(arm), format!("too near; {} passes first", names[arm]))).to_vec()
    }

    /// Draws the cell with both arms: pale at their starts, opaque at their goals or where they collide. Arms with steps are
    /// opaque at their starts, where they often end.
    fn workspace(&self, motions: Option<&ShownMotions>, objects: &[ShownObject], between: &Between) -> Vec<Item> {
        let scenes = self.scenes();
        let [x, y] = self.extent(motions);
        let frame = Frame::filling(WORKSPACE, x, y);
        let union = |pieces: &[Convex], style: Style| shapes::union(&frame, pieces.iter().cloned(), style);
        let mut items = frame.grid([Unit::Meters; 2]);
        let solid = Style::line(ROBOT.darker(0.2), 1.2).filled(GHOST);
        items.extend(self.obstacles().map(|obstacle| union(&obstacle.pieces, solid)));
        let bases = scenes.into_iter().flat_map(bases);
        items.extend(bases.map(|base| union(&base.pieces, Style::line(ROBOT, 1.2).filled(FAINT))));
        // Without a motion, the arms are opaque at their starts.
        let shown = |motions: &ShownMotions| {
            let time = motions.collides.unwrap_or(motions.duration);
            [0, 1].map(|arm| motions.place(arm, time))
        };
        let ending = motions.filter(|_| objects.is_empty());
        let at = ending.map_or_else(|| self.starts(), shown);
        let hit = met(between, at).filter(|(distance, _)| *distance <= 0.0 || *distance < between.clearance);
        for (arm, color) in ARM_COLORS.into_iter().enumerate() {
            let pale = Style::line(color.lighter(0.3), 1.2).filled(color.lighter(0.8)).faded(0.6);
            items.extend(ending.map(|_| union(&arm_shapes(scenes[arm], self.starts()[arm]), pale)));
            let strong = Style::line(color.darker(0.2), 1.4).filled(color.lighter(0.45)).faded(0.8);
            let parts = arm_shapes(scenes[arm], at[arm]);
            items.push(union(&parts, strong));
            let struck = Style::line(INFEASIBLE, 2.0).filled(INFEASIBLE.lighter(0.5));
            items.extend(hit.map(|(_, pair)| union(&parts[pair[arm]..=pair[arm]], struck)));
        }
        let traces = motions.into_iter().flat_map(|motions| [(0, motions), (1, motions)]).map(|(arm, motions)| {
            let count = PLACES.max(PLACES_PER_STEP * motions.steps[arm].len());
            let tip = |time| scenes[arm].arm().tip_at(motions.place(arm, time));
            let tips: Vec<Point> = moments(motions, count).map(tip).collect();
            let steps = chain(tips.iter().map(|tip| frame.at(tip.x, tip.y)), false);
            // The paths of many steps cross each other.
            let (color, width) =
                if objects.is_empty() { (ARM_COLORS[arm], 2.0) } else { (ARM_COLORS[arm].lighter(0.4), 1.4) };
            (steps, Pen { color, width, dash: &[] })
        });
        items.extend(lines(traces));
        items.extend(objects.iter().flat_map(ShownObject::destinations).map(|object| shapes::dashed(&frame, &object)));
        items.extend(objects.iter().map(|object| shapes::solid(&frame, &object.at_first())));
        items.extend([0, 1].map(|arm| self.name_at_tip(arm, at[arm], &frame)));
        let mut items = vec![Item::Clip(frame.rect, items)];
        items.extend(frame.border([Unit::Meters; 2], ["x (m)", "y (m)"].map(str::to_owned), [false; 2]));
        items
    }

    fn name_at_tip(&self, arm: usize, q: Configuration, frame: &Frame) -> Item {
        let tip = self.scenes()[arm].arm().tip_at(q);
        let [x, y] = frame.at(tip.x, tip.y);
        let mut name = bold([x, y + 5.0], self.names()[arm], TEXT, Anchor::Middle, INK);
        if let Item::Text(text) = &mut name {
            text.has_halo = true;
        }
        name
    }

    /// Draws the diagram: how far each arm is on its motion, and where the arms could meet.
    fn diagram(&self, motions: &ShownMotions) -> Vec<Item> {
        let frame = time_frame(motions, DIAGRAM);
        let mut items = frame.grid([Unit::Seconds; 2]);
        for (first, sides) in motions.regions().iter().enumerate() {
            let rectangles = sides.iter().flat_map(|[x, y]| {
                let ([left, bottom], [right, top]) = (frame.at(x[0], y[0]), frame.at(x[1], y[1]));
                rectangle(Rect { x: left, y: top, width: right - left, height: bottom - top })
            });
            let filled: Vec<Step> = rectangles.collect();
            items.push(Item::Outline(filled, Style::fill(region_color(first))));
        }
        let route = |shift: f64| {
            let place = |time: f64| frame.at(motions.moved(0, (time + shift).max(0.0)), motions.moved(1, time));
            chain(moments(motions, PLACES).map(place).collect::<Vec<_>>(), false)
        };
        let beside = Pen { color: INK, width: 0.8, dash: &[4.0, 3.0] };
        if motions.are_certified {
            let schedule = (route(0.0), Pen { color: INK, width: 2.2, dash: &[] });
            items.extend(lines([(route(-self.skew), beside), (route(self.skew), beside), schedule]));
        } else {
            items.extend(lines([(route(0.0), beside)]));
        }
        let mut discs: Vec<[f64; 2]> = Vec::new();
        for (number, signal) in motions.signals.iter().enumerate() {
            let mut times = [signal.at; 2];
            times[1 - signal.waits] = signal.set;
            let [mut x, y] = frame.at(motions.moved(0, times[0]), motions.moved(1, times[1]));
            // Discs at one place stand side by side.
            while discs.iter().any(|disc| (disc[0] - x).hypot(disc[1] - y) < 2.0 * DISC + 2.0) {
                x += 1.0;
            }
            discs.push([x, y]);
            items.push(Item::Disc([x, y], DISC, Style::fill(ARM_COLORS[signal.waits])));
            items.push(bold([x, y + 4.0], (number + 1).to_string(), 11.0, Anchor::Middle, WHITE));
        }
        let at = motions.collides.map(|time| frame.at(motions.moved(0, time), motions.moved(1, time)));
        items.extend(at.map(|at| Item::Disc(at, 6.0, Style::line(WHITE, 1.5).filled(INFEASIBLE))));
        let mut items = vec![Item::Clip(frame.rect, items)];
        let title = |arm: usize| format!("{}: time on its path (s)", self.names()[arm]);
        items.extend(frame.border([Unit::Seconds; 2], [title(0), title(1)], [false; 2]));
        items
    }
}

/// Returns the colour of the regions that an arm passes first; grey for those that neither passes first.
fn region_color(first: usize) -> Rgb {
    ARM_COLORS.get(first).map_or(UNDECIDED, |color| color.lighter(REGION_PALENESS))
}

/// Returns times in `count` equal steps, from the beginning to the end.
fn moments(motions: &ShownMotions, count: usize) -> impl Iterator<Item = f64> {
    let duration = motions.duration;
    (0..=count).map(move |k| duration * k as f64 / count as f64)
}

/// Draws coloured squares with their meaning, in a row that begins at a place.
fn signs([mut x, y]: [f64; 2], all: &[(Rgb, String)]) -> Vec<Item> {
    let mut items = Vec::new();
    for (color, text) in all {
        let square = Rect { x, y: y - 11.0, width: 18.0, height: 13.0 };
        items.push(Item::Outline(rectangle(square), Style::line(GRAY, 0.8).filled(*color)));
        items.push(label([x + 26.0, y], text.as_str(), TEXT, Anchor::Start, INK));
        x += 26.0 + text_width(text, TEXT) + 24.0;
    }
    items
}

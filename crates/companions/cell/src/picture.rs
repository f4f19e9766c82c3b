//! The picture of a cell: both arms, the diagram of their times, and a row of time for each arm.

use crate::{Cell, CellPlan, Coordination};
use cplan_geometry::{Convex, Point};
use cplan_model::space::Configuration;
use cplan_model::{Carrier, Outcome, Scene};
use cplan_theme::{ACCENT, FAINT, GHOST, GRAY, INK, PROOF, ROBOT, Rgb, UNDECIDED};
use cplan_view::figure::{Anchor, Figure, Item, Pen, Rect, Step, Style, bold, chain, label, lines, rectangle};
use cplan_view::{Frame, Unit, bounding_box, sealed, shapes};
use serde_json::{Value, json};

/// Size of the picture, pixels.
const SIZE: [f64; 2] = [1400.0, 870.0];

/// Place of the cell in the picture.
const WORKSPACE: Rect = Rect { x: 70.0, y: 90.0, width: 600.0, height: 560.0 };

/// Place of the diagram in the picture.
const DIAGRAM: Rect = Rect { x: 790.0, y: 90.0, width: 560.0, height: 560.0 };

/// Place of the rows of time.
const ROWS: Rect = Rect { x: 150.0, y: 745.0, width: 1200.0, height: 70.0 };

/// Colours of the arms.
const ARM_COLORS: [Rgb; 2] = [ACCENT, PROOF];

/// Number of places of the tip that are drawn.
const TIP_PLACES: usize = 200;

/// Number of times for which the page draws the arms.
const PAGE_PLACES: usize = 240;

/// Number of times at which the arms are within the picture.
const FRAME_PLACES: usize = 40;

/// Margin around the cell, as a share of its size.
const MARGIN: f64 = 0.04;

/// Draws the answer about a cell. `skew` is the difference of the clocks for which the motions are certified, seconds.
pub fn figure(cell: &Cell, plan: &CellPlan, skew: f64) -> Figure {
    let title = [
        bold([WORKSPACE.x, 40.0], &cell.name, 20.0, Anchor::Start, INK),
        label([WORKSPACE.x, 64.0], result(plan), 15.0, Anchor::Start, GRAY),
    ];
    let mut figure = untitled(cell, plan, skew);
    figure.items.extend(title);
    figure
}

/// Draws the same without a title.
fn untitled(cell: &Cell, plan: &CellPlan, skew: f64) -> Figure {
    let found = plan.outcome.found();
    let mut items = workspace(cell, found);
    if let Some(found) = found {
        items.extend(diagram(cell, found, skew));
        items.extend(rows(cell, found));
    }
    Figure { width: SIZE[0], height: SIZE[1], items, is_dark: false }
}

/// Returns a page that shows the answer about a cell. The reader chooses the time at which both arms are drawn.
pub fn page(cell: &Cell, plan: &CellPlan, skew: f64) -> String {
    let mut colors: Vec<Rgb> = Vec::new();
    let svg = cplan_theme::recolored(&untitled(cell, plan, skew).svg(), |color| {
        let name = cplan_theme::variable(color).unwrap_or_else(|| {
            if !colors.contains(&color) {
                colors.push(color);
            }
            format!("x{}", &color.to_string()[1..])
        });
        format!("var(--{name})")
    });
    let variables = |is_dark: bool| -> String {
        let variable = |color: &Rgb| {
            let shown = if is_dark { cplan_theme::on_dark(*color) } else { *color };
            format!(" --x{}: {shown};", &color.to_string()[1..])
        };
        colors.iter().map(variable).collect()
    };
    let style = format!(
        ":root {{{} }}\n@media (prefers-color-scheme: dark) {{ :root {{{} }} }}\n{}",
        variables(false),
        variables(true),
        include_str!("assets/cell.css")
    );
    let data = json!({
        "name": cell.name,
        "result": result(plan),
        "ending": plan.status().name(),
        "svg": svg,
        "motion": plan.outcome.found().map(|found| motion(cell, found)),
    });
    sealed(&cell.name, &style, "cell", &data.to_string(), include_str!("assets/cell.js"))
}

/// Returns the data with which the page draws the motions.
fn motion(cell: &Cell, found: &Coordination) -> Value {
    let scenes = cell.arms.each_ref().map(|arm| arm.problem.scene());
    let space = workspace_frame(cell, Some(found));
    let scale = space.scale();
    let path = |shape: &Convex| {
        let corners = shape.core().iter().map(|p| format!("{:.5},{:.5}", p.x, p.y)).collect::<Vec<_>>().join("L");
        json!({ "d": format!("M{corners}Z"), "width": short(2.0 * shape.radius()) })
    };
    let arms = [0, 1].map(|arm| {
        let links = scenes[arm].arm().links.each_ref();
        let links = links.map(|link| link.parts.iter().map(|part| path(&part.shape)).collect::<Vec<_>>());
        json!({ "color": cplan_theme::variable(ARM_COLORS[arm]), "links": links })
    });
    let (diagram, rows) = (diagram_frame(found), row_frame(found));
    let places: Vec<Value> = (0..=PAGE_PLACES)
        .map(|k| {
            let time = found.duration * k as f64 / PAGE_PLACES as f64;
            let links = [0, 1].map(|arm| {
                scenes[arm].arm().poses(found.place(arm, time)).map(|pose| {
                    let (turn, [x, y]) = (pose.rotation, space.at(pose.translation.x, pose.translation.y));
                    let (sin, cos) = turn.angle().sin_cos();
                    [cos * scale, -sin * scale, -sin * scale, -cos * scale, x, y].map(short)
                })
            });
            let at = diagram.at(moved(found, 0, time), moved(found, 1, time)).map(short);
            let row = [rows.at(time, 0.0)[0], ROWS.y, ROWS.bottom()].map(short);
            json!({ "links": links, "diagram": at, "row": row })
        })
        .collect();
    let Rect { x, y, .. } = diagram.rect;
    let frame = [x, y, diagram.rect.right(), diagram.rect.bottom()];
    json!({ "duration": found.duration, "arms": arms, "places": places, "frame": frame })
}

/// Rounds a number for the page.
fn short(value: f64) -> f64 {
    (value * 1e3).round() / 1e3 + 0.0
}

/// Returns the answer in words.
fn result(plan: &CellPlan) -> String {
    match &plan.outcome {
        Outcome::Found(found) => format!("found, certified: {:.3} s", found.duration),
        Outcome::Infeasible(_) => "infeasible: proven".into(),
        Outcome::Unknown(_) => "unknown".into(),
    }
}

/// Returns the shapes of an arm at a configuration.
fn arm_shapes(scene: &Scene, q: Configuration) -> Vec<Convex> {
    let poses = scene.arm().poses(q);
    let links = scene.arm().links.iter().zip(poses);
    links.flat_map(|(link, pose)| link.parts.iter().map(move |part| part.shape.at(&pose))).collect()
}

/// Returns the base of an arm's robot.
fn base(scene: &Scene) -> Vec<Convex> {
    let own = scene.arm().self_obstacles.iter().filter(|own| own.carrier == Carrier::Base);
    own.flat_map(|own| own.obstacle.pieces.clone()).collect()
}

/// Returns places of the tip of an arm, from its start to its goal.
fn tips(scene: &Scene, found: &Coordination, arm: usize) -> Vec<Point> {
    let at = |k: usize| scene.arm().tip_at(found.place(arm, found.duration * k as f64 / TIP_PLACES as f64));
    (0..=TIP_PLACES).map(at).collect()
}

/// Returns the frame that shows the cell and the whole motions.
fn workspace_frame(cell: &Cell, found: Option<&Coordination>) -> Frame {
    let mut shapes: Vec<Convex> = Vec::new();
    for (arm, own) in cell.arms.iter().enumerate() {
        let scene = own.problem.scene();
        shapes.extend(base(scene));
        shapes.extend(arm_shapes(scene, own.problem.query().start()));
        shapes.extend(scene.workspace().obstacles.iter().flat_map(|obstacle| obstacle.pieces.iter().cloned()));
        if let Some(found) = found {
            let times = (0..=FRAME_PLACES).map(|k| found.duration * k as f64 / FRAME_PLACES as f64);
            shapes.extend(times.flat_map(|time| arm_shapes(scene, found.place(arm, time))));
        }
    }
    let sides = bounding_box(&shapes);
    let size = sides.iter().map(|(low, high)| high - low).fold(f64::MIN_POSITIVE, f64::max);
    let [x, y] = sides.map(|(low, high)| (low - MARGIN * size, high + MARGIN * size));
    Frame::filling(WORKSPACE, x, y)
}

/// Draws the cell with both arms: at their starts pale, at their goals opaque, and the paths of their tips.
fn workspace(cell: &Cell, found: Option<&Coordination>) -> Vec<Item> {
    let scenes = cell.arms.each_ref().map(|arm| arm.problem.scene());
    let frame = workspace_frame(cell, found);
    // The base of the other arm is an obstacle as well.
    let obstacles = scenes[0].workspace().obstacles.iter().flat_map(|obstacle| &obstacle.pieces);
    let union = |pieces: &[Convex], style: Style| shapes::union(&frame, pieces.iter().cloned(), style);
    let mut items = frame.grid([Unit::Meters; 2]);
    let solid = Style::line(ROBOT.darker(0.2), 1.2).filled(GHOST);
    items.extend(obstacles.map(|piece| union(std::slice::from_ref(piece), solid)));
    items.extend(scenes.map(|scene| union(&base(scene), Style::line(ROBOT, 1.2).filled(FAINT))));
    for (arm, color) in ARM_COLORS.into_iter().enumerate() {
        let pale = Style::line(color.lighter(0.3), 1.2).filled(color.lighter(0.8)).faded(0.6);
        items.push(union(&arm_shapes(scenes[arm], cell.arms[arm].problem.query().start()), pale));
        let strong = Style::line(color.darker(0.2), 1.4).filled(color.lighter(0.45)).faded(0.8);
        let goal = found.map(|found| found.place(arm, found.duration));
        items.extend(goal.map(|goal| union(&arm_shapes(scenes[arm], goal), strong)));
    }
    let paths = found.into_iter().flat_map(|found| [(0, found), (1, found)]).map(|(arm, found)| {
        let tips = tips(scenes[arm], found, arm);
        (
            chain(tips.iter().map(|tip| frame.at(tip.x, tip.y)), false),
            Pen { color: ARM_COLORS[arm], width: 2.0, dash: &[] },
        )
    });
    items.extend(lines(paths));
    let mut items = vec![Item::Clip(frame.rect, items)];
    items.extend(frame.border([Unit::Meters; 2], ["x (m)", "y (m)"].map(str::to_owned), [false; 2]));
    for (arm, color) in ARM_COLORS.into_iter().enumerate() {
        let right = WORKSPACE.right() - 160.0 * (1 - arm) as f64;
        items.push(label([right, 64.0], &cell.arms[arm].name, 15.0, Anchor::End, color));
    }
    items
}

/// Returns the time for which an arm has moved until a time on the clock, without its waits.
fn moved(found: &Coordination, arm: usize, time: f64) -> f64 {
    let waited: f64 = found.waits[arm].iter().map(|wait| (time.min(wait.to) - wait.from).max(0.0)).sum();
    let end = found.motions[arm].trajectory.duration();
    time.min(end) - waited
}

fn diagram_frame(found: &Coordination) -> Frame {
    let [x, y] = [0, 1].map(|arm| (0.0, moved(found, arm, found.duration).max(1e-3)));
    Frame::fitted(DIAGRAM, x, y, false)
}

fn row_frame(found: &Coordination) -> Frame {
    Frame::fitted(ROWS, (0.0, found.duration.max(1e-3)), (0.0, 2.0), false)
}

/// Draws the diagram: how far each arm is on its motion, and where the arms could meet.
fn diagram(cell: &Cell, found: &Coordination, skew: f64) -> Vec<Item> {
    let frame = diagram_frame(found);
    let mut items = frame.grid([Unit::Seconds; 2]);
    let rectangles = found.diagram.iter().filter_map(|times| {
        let [x, y] = [0, 1].map(|arm| times[arm].map(|time| moved(found, arm, time)));
        let ([left, bottom], [right, top]) = (frame.at(x[0], y[0]), frame.at(x[1], y[1]));
        (right > left && bottom > top)
            .then(|| rectangle(Rect { x: left, y: top, width: right - left, height: bottom - top }))
    });
    let filled: Vec<Step> = rectangles.flatten().collect();
    items.push(Item::Titled(
        "the arms may be too near to each other".into(),
        vec![Item::Outline(filled, Style::fill(UNDECIDED))],
    ));
    let route = |shift: f64| {
        let places = (0..=2 * TIP_PLACES).map(|k| {
            let time = found.duration * k as f64 / (2 * TIP_PLACES) as f64;
            frame.at(moved(found, 0, (time + shift).max(0.0)), moved(found, 1, time))
        });
        chain(places.collect::<Vec<_>>(), false)
    };
    let beside = Pen { color: INK, width: 0.8, dash: &[4.0, 3.0] };
    items.extend(lines([
        (route(-skew), beside),
        (route(skew), beside),
        (route(0.0), Pen { color: INK, width: 2.2, dash: &[] }),
    ]));
    for interlock in found.interlocks.iter().flatten() {
        let mut times = [interlock.at; 2];
        times[1 - interlock.waits] = interlock.set;
        let spot = frame.at(moved(found, 0, times[0]), moved(found, 1, times[1]));
        items.push(Item::Disc(spot, 5.0, Style::fill(ARM_COLORS[interlock.waits])));
    }
    let mut items = vec![Item::Clip(frame.rect, items)];
    let title = |arm: usize| format!("{}: time on its path (s)", cell.arms[arm].name);
    items.extend(frame.border([Unit::Seconds; 2], [title(0), title(1)], [false; 2]));
    items
}

/// Draws a row of time for each arm: motion, waits and signals.
fn rows(cell: &Cell, found: &Coordination) -> Vec<Item> {
    let frame = row_frame(found);
    let middle = |arm: usize| 1.5 - arm as f64;
    let mut items = Vec::new();
    for (arm, color) in ARM_COLORS.into_iter().enumerate() {
        let bar = |from: f64, to: f64| {
            let [left, y] = frame.at(from, middle(arm));
            let [right, _] = frame.at(to, middle(arm));
            rectangle(Rect { x: left, y: y - 11.0, width: right - left, height: 22.0 })
        };
        let end = found.motions[arm].trajectory.duration();
        items.push(Item::Outline(bar(0.0, end), Style::fill(color.lighter(0.35))));
        for wait in &found.waits[arm] {
            let text = format!("{} waits from {:.3} s to {:.3} s", cell.arms[arm].name, wait.from, wait.to);
            let pale = Style::line(color, 1.0).filled(FAINT);
            items.push(Item::Titled(text, vec![Item::Outline(bar(wait.from, wait.to), pale)]));
        }
        for step in &found.steps[arm] {
            let Some(at) = step.event else { continue };
            let text = format!("{}, step {}: {}, {at:.3} s", cell.arms[arm].name, step.number, step.action);
            let spot = Item::Disc(frame.at(at, middle(arm)), 5.0, Style::line(INK, 1.0).filled(color.lighter(0.8)));
            items.push(Item::Titled(text, vec![spot]));
        }
        let [_, y] = frame.at(0.0, middle(arm));
        items.push(label([ROWS.x - 12.0, y + 5.0], &cell.arms[arm].name, 14.0, Anchor::End, color));
    }
    for (number, interlock) in found.interlocks.iter().flatten().enumerate() {
        let from = frame.at(interlock.set, middle(1 - interlock.waits));
        let to = frame.at(interlock.at, middle(interlock.waits));
        let [waits, sets] = [interlock.waits, 1 - interlock.waits].map(|arm| &cell.arms[arm].name);
        let text = format!("{waits} waits for signal {}, which {sets} sets", number + 1);
        let line = Item::Outline(vec![Step::Move(from), Step::Line(to)], Style::line(INK, 1.4));
        let ends = [
            Item::Disc(from, 3.0, Style::fill(INK)),
            Item::Disc(to, 4.5, Style::line(INK, 1.4).filled(ARM_COLORS[interlock.waits])),
        ];
        items.push(Item::Titled(text, [line].into_iter().chain(ends).collect()));
        // The numbers stand outside the rows.
        let y = if interlock.waits == 0 { ROWS.y - 6.0 } else { ROWS.y - 20.0 };
        items.push(label([to[0], y], (number + 1).to_string(), 12.0, Anchor::Middle, INK));
    }
    let has_signals = found.interlocks.as_ref().is_some_and(|interlocks| !interlocks.is_empty());
    items.extend(has_signals.then(|| label([ROWS.x - 12.0, ROWS.y - 8.0], "signal", 12.0, Anchor::End, GRAY)));
    let sides = [false; 2];
    items.extend(frame.sides(sides));
    items.extend(frame.tick_marks([Unit::Seconds; 2], [true, false]));
    items.push(label([ROWS.right(), ROWS.bottom() + 38.0], "time (s)", 14.0, Anchor::End, INK));
    items
}

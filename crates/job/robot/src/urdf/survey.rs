//! Examines a robot stage by stage, as far as possible.

use super::advice;
use super::bodies::Outlines;
use super::chain::{self, Chain, is_movable};
use super::document::Document;
use super::limits::{Limits, MissingRates, Range, Rates};
use super::plane;
use super::reduction::{Bounds, Reduction};
use super::tree::{self, Tree};
use super::{help, ignored};
use crate::error::InputError;
use crate::inspection::{
    BodyEntry, Frame, Inspection, JointEntry, LimitEntry, LimitSource, LinkEntry, MotorEntry, OutlineEntry, PairEntry,
    PlaneEntry, RateEntry, RateSource, ReachEntry, Role, SelfObstacleEntry, source_name,
};
use crate::quantity::find;
use crate::robot_file::RobotFile;
use crate::robot_table::RobotTable;
use crate::settings::RobotSettings;
use cplan_model::space::{Configuration, JointRange};
use cplan_model::{Arm, Carrier, Link, OutlineSource, Plane, Scene, SelfObstacle, Workspace};
use nalgebra::Vector3;
use urdf_rs::JointType;

/// Examines a robot, beyond its first defect. The report's scene contains only the arm, as placed by the URDF.
pub fn survey(robot: &RobotFile, settings: RobotSettings) -> Inspection {
    let mut report = Inspection { urdf: robot.path.display().to_string(), ..Inspection::default() };
    report.files.push(robot.path.clone());
    let document = match robot.read().and_then(Document::read) {
        Ok(document) => document,
        Err(error) => {
            report.errors.push(error);
            return report;
        }
    };
    report.errors.extend(InputError::check(document.diagnostics.clone()).err());
    report.robot = Some(document.robot.name.clone()).filter(|name| !name.is_empty());
    report.ignored = ignored::elements(&document);
    report.links = document.robot.links.iter().map(link).collect();
    let limits = Limits { document: &document, settings };
    report.joints = (0..document.robot.joints.len()).map(|j| joint(&limits, j)).collect();
    match Tree::build(&document) {
        Ok(tree) => in_tree(&mut report, &document, &tree, settings),
        // If elements were omitted, defects of the tree may be due to that, and are not reported.
        Err(error) if document.tree_is_sound => report.errors.push(error),
        Err(_) => {}
    }
    report.files = document.files();
    report
}

/// Examines the tree: the possible pairs of joints, and the reduction of one of them.
fn in_tree(report: &mut Inspection, document: &Document, tree: &Tree, settings: RobotSettings) {
    report.root = Some(tree.links[tree.root].clone());
    let names = |j: usize| document.robot.joints[j].name.clone();
    for (entry, above) in report.links.iter_mut().zip(&tree.above) {
        entry.above = above.map(names);
    }
    if !document.tree_is_sound {
        return;
    }
    let pairs = chain::pairs(document, tree);
    report.pairs = pairs.iter().map(|p| pair(document, tree, settings, *p)).collect();
    let planar: Vec<[usize; 2]> =
        pairs.iter().zip(&report.pairs).filter(|(_, entry)| entry.planar).map(|(p, _)| *p).collect();
    // If no joints can be chosen, entries that choose a planar pair are still useful.
    let named = chain::joints(document, tree, settings);
    let likely = named.filter(|p| planar.contains(p)).or(planar.first().copied());
    let trial = |p: [usize; 2]| {
        let table = neutral(document, settings.table, p);
        chain::with_joints(document, tree, RobotSettings { table: &table, ..settings }, p).ok()
    };
    let chain = match chain::choose(document, tree, settings) {
        Ok(chain) => Some(chain),
        Err(error) => {
            report.errors.push(error);
            report.assumed = likely.is_some() && likely != named;
            likely.and_then(trial)
        }
    };
    let directions = match &chain {
        Some(chain) => tree.poses(&document.robot, &chain.values),
        None => tree.poses(&document.robot, &vec![0.0; document.robot.joints.len()]),
    };
    for (j, entry) in report.joints.iter_mut().enumerate().filter(|(_, entry)| entry.axis.is_some()) {
        let direction = directions[tree.child[j]] * tree::axis(&document.robot.joints[j]);
        entry.direction = Some(array(direction.into_inner()));
    }
    if let Some(chain) = &chain {
        examine_pair(report, &Reduction::new(document, tree, settings, chain));
    }
    if !report.is_plannable()
        && document.diagnostics.is_empty()
        && let Some(pair) = likely.filter(|p| chain::admits(document, tree, settings, *p))
        && let Some(chain) = trial(pair)
    {
        let reduction = Reduction::new(document, tree, settings, &chain);
        report.help = reduction.plane().ok().and_then(|plane| help::entries(&reduction, &plane));
    }
}

/// Examines two joints.
fn examine_pair(report: &mut Inspection, reduction: &Reduction) {
    let Reduction { document, tree, chain, .. } = reduction;
    report.chosen = Some(chain.joints.map(|j| document.robot.joints[j].name.clone()));
    report.tip = Some(tree.links[chain.tip].clone());
    for (j, entry) in report.joints.iter_mut().enumerate() {
        entry.role = role(reduction, j);
        entry.value = (entry.role != Role::Rigid).then(|| chain.values[j]);
    }
    report.ignored.extend(ignored::beside_the_arm(reduction));
    let plane = reduction.plane();
    let bounds = reduction.bounds();
    // The outline would be wrong if a shape was omitted because of a defect.
    let sound = document.diagnostics.is_empty();
    let outlines = plane.as_ref().ok().filter(|_| sound).map(|plane| reduction.outlines(plane));
    report.errors.extend(plane.as_ref().err().cloned());
    report.errors.extend(bounds.as_ref().err().cloned());
    let Ok(plane) = plane else { return };
    report.plane = Some(PlaneEntry {
        u: array(plane.u),
        v: array(plane.v),
        normal: array(plane.normal),
        words: plane::describe(&plane, &tree.links[tree.root]),
    });
    let outlines = match outlines {
        Some(Ok(outlines)) => {
            report.ignored.extend(ignored::visuals(reduction, &outlines.links));
            report.warnings.extend(outlines.warnings.iter().cloned());
            report.outlines = outlines.links.iter().map(outline).collect();
            outlines
        }
        Some(Err(error)) => {
            report.errors.push(error);
            links_without_outlines(reduction)
        }
        None => links_without_outlines(reduction),
    };
    let sizeless = outlines.sizeless.clone();
    let (arm, _, unknown) = reduction.arm(plane, bounds.unwrap_or_else(|_| unbounded(reduction)), outlines);
    report.errors.extend(unknown.filter(|_| reduction.settings.table.dynamics).map(InputError::from));
    report.ignored.extend(sizeless);
    report.self_obstacles = arm.self_obstacles.iter().map(|own| self_obstacle(&arm, own)).collect();
    report.warnings.extend(advice::warnings(reduction, &arm));
    report.reach = Some(reach(&arm));
    report.frames = frames(reduction, &plane);
    let words = arm.motors.as_ref().map_or_else(String::new, |motors| reduction.describe_motors(motors));
    report.motors = MotorEntry::new(&arm, words);
    report.scene = Some(Scene::trusted(arm, Workspace::new([])));
}

fn link(link: &urdf_rs::Link) -> LinkEntry {
    LinkEntry { name: link.name.clone(), above: None, collision: link.collision.len(), visual: link.visual.len() }
}

fn joint(limits: &Limits, index: usize) -> JointEntry {
    let joint = &limits.document.robot.joints[index];
    let movable = is_movable(joint);
    let rates = if movable { limits.rates(index).ok() } else { None };
    let table = limits.settings.table;
    let given = |in_world: bool| if in_world { RateSource::World } else { RateSource::Urdf };
    JointEntry {
        name: joint.name.clone(),
        kind: chain::type_name(joint),
        slides: joint.joint_type == JointType::Prismatic,
        line: limits.document.joint_line(index),
        parent: joint.parent.link.clone(),
        child: joint.child.link.clone(),
        axis: movable.then(|| array(tree::axis(joint).into_inner())),
        direction: None,
        mimics: joint.mimic.as_ref().map(|m| m.joint.clone()),
        role: if movable { Role::Undecided } else { Role::Rigid },
        value: None,
        limits: movable.then(|| range(limits, index)),
        velocity: rates.as_ref().map(|r| RateEntry {
            value: r.velocity,
            source: match r.assumed.velocity {
                true => RateSource::Default,
                false => given(find(&table.velocity, &joint.name).is_some()),
            },
        }),
        acceleration: rates.as_ref().map(|r| RateEntry {
            value: r.acceleration,
            source: match r.assumed.acceleration {
                true => RateSource::Default,
                false => given(find(&table.acceleration, &joint.name).is_some()),
            },
        }),
        jerk: rates.as_ref().and_then(|r| r.jerk).map(|value| RateEntry { value, source: RateSource::World }),
    }
}

fn range(limits: &Limits, index: usize) -> LimitEntry {
    let joint = &limits.document.robot.joints[index];
    let of = |source, range| LimitEntry { source, range };
    match limits.range(index) {
        Ok(Range::Known(JointRange::Circle) | Range::Taken(JointRange::Circle, _)) => of(LimitSource::Continuous, None),
        Ok(Range::Known(JointRange::Interval { lower, upper })) => {
            let source = if find(&limits.settings.table.limits, &joint.name).is_some() {
                LimitSource::World
            } else if [lower, upper] == [joint.limit.lower, joint.limit.upper] {
                LimitSource::Urdf
            } else {
                LimitSource::Soft
            };
            of(source, Some([lower, upper]))
        }
        Ok(Range::Taken(JointRange::Interval { lower, upper }, _)) => of(LimitSource::Urdf, Some([lower, upper])),
        Ok(Range::Unset(_)) | Err(_) => of(LimitSource::Unset, None),
    }
}

/// Returns the table without the entries for joints and tip, and without values for these two joints.
fn neutral(document: &Document, table: &RobotTable, joints: [usize; 2]) -> RobotTable {
    let mut table = RobotTable { joints: None, tip: None, ..table.clone() };
    table.fixed.retain(|name, _| joints.iter().all(|j| document.robot.joints[*j].name != *name.get_ref()));
    table
}

fn pair(document: &Document, tree: &Tree, settings: RobotSettings, joints: [usize; 2]) -> PairEntry {
    let letter = |j: usize| if document.robot.joints[j].joint_type == JointType::Prismatic { 'P' } else { 'R' };
    let table = neutral(document, settings.table, joints);
    let settings = RobotSettings { table: &table, ..settings };
    let tried = chain::with_joints(document, tree, settings, joints)
        .map_err(|error| error.diagnostics().first().map(|d| d.message.clone()).unwrap_or_default())
        .and_then(|chain| Reduction::new(document, tree, settings, &chain).common_plane());
    let (planar, reason) = match &tried {
        Ok(plane) => (true, plane::describe(plane, &tree.links[tree.root])),
        Err(reason) => (false, reason.clone()),
    };
    PairEntry {
        joints: joints.map(|j| document.robot.joints[j].name.clone()),
        kind: joints.iter().map(|j| letter(*j)).collect(),
        planar,
        reason,
    }
}

fn role(reduction: &Reduction, index: usize) -> Role {
    let Reduction { document, chain, .. } = reduction;
    let joint = &document.robot.joints[index];
    match () {
        () if chain.joints.contains(&index) => Role::Moves,
        () if !is_movable(joint) => Role::Rigid,
        () if !ignored::concerns_the_arm(reduction, index) => Role::Ignored,
        () if joint.mimic.is_some() => Role::Follows,
        () => Role::Held,
    }
}

fn outline(link: &Link) -> OutlineEntry {
    let mut bodies: Vec<BodyEntry> = Vec::new();
    for part in &link.parts {
        match bodies.iter_mut().find(|b| b.link == part.body) {
            Some(body) => {
                body.parts += 1;
                body.area += part.shape.area();
            }
            None => bodies.push(BodyEntry { link: part.body.clone(), parts: 1, area: part.shape.area() }),
        }
    }
    let lower = link.parts.iter().map(|p| p.heights.lower).fold(f64::INFINITY, f64::min);
    let upper = link.parts.iter().map(|p| p.heights.upper).fold(f64::NEG_INFINITY, f64::max);
    OutlineEntry {
        link: link.name.clone(),
        source: source_name(link.source),
        parts: link.parts.len(),
        area: bodies.iter().map(|b| b.area).sum(),
        heights: (lower <= upper).then_some([lower, upper]),
        bodies,
    }
}

fn self_obstacle(arm: &Arm, own: &SelfObstacle) -> SelfObstacleEntry {
    let permanent =
        own.permanent.iter().zip(&arm.links).flat_map(|(parts, link)| parts.iter().map(|p| &link.parts[*p].body));
    let mut ignored: Vec<String> = own.ignored.iter().chain(permanent).cloned().collect();
    ignored.sort();
    ignored.dedup();
    SelfObstacleEntry {
        link: own.obstacle.name.clone(),
        moves: own.carrier == Carrier::FirstJoint,
        heights: [own.obstacle.heights.lower, own.obstacle.heights.upper],
        ignored,
    }
}

fn reach(arm: &Arm) -> ReachEntry {
    let tip = arm.tip_at(Configuration::zeros());
    let (upper, fore) = (arm.offset.norm(), arm.tip.norm());
    ReachEntry {
        tip: [tip.x, tip.y],
        distances: arm.only_turns().then_some([(upper - fore).abs(), upper + fore]),
        outline: arm.reach(),
    }
}

/// Returns the frames of the links that the joints move, with the names of the joints, and the frame of the tip's link.
fn frames(reduction: &Reduction, plane: &Plane) -> Vec<Frame> {
    let Reduction { document, tree, chain, poses, .. } = reduction;
    let frame = |name: &str, link: usize| {
        let seen = |axis: Vector3<f64>| {
            let axis = poses[link] * axis;
            Vector3::new(axis.dot(&plane.u), axis.dot(&plane.v), axis.dot(&plane.normal))
        };
        Frame {
            name: name.to_owned(),
            at: reduction.at(plane, link),
            axes: [Vector3::x(), Vector3::y(), Vector3::z()].map(seen),
        }
    };
    let joints = chain.joints.map(|j| frame(&document.robot.joints[j].name, tree.child[j]));
    joints.into_iter().chain([frame(&tree.links[chain.tip], chain.tip)]).collect()
}

/// Returns links without outlines, for pictures of arms that have none.
fn links_without_outlines(reduction: &Reduction) -> Outlines {
    let Reduction { tree, chain, .. } = reduction;
    let links = chain.joints.map(|j| Link {
        name: tree.links[tree.child[j]].clone(),
        parts: Vec::new(),
        source: OutlineSource::None,
    });
    Outlines {
        links,
        self_obstacles: Vec::new(),
        geometry: Vec::new(),
        notes: Vec::new(),
        sizeless: Vec::new(),
        warnings: Vec::new(),
    }
}

/// Returns ranges for the picture of an arm. An unknown range becomes a whole turn, or zero for a prismatic joint.
fn unbounded(reduction: &Reduction) -> [Bounds; 2] {
    let Chain { joints, .. } = reduction.chain;
    let limits = Limits { document: reduction.document, settings: reduction.settings };
    joints.map(|j| {
        let slides = reduction.document.robot.joints[j].joint_type == JointType::Prismatic;
        let rest = if slides { JointRange::Interval { lower: 0.0, upper: 0.0 } } else { JointRange::Circle };
        Bounds {
            range: limits.planned_range(j).unwrap_or(rest),
            rates: Rates { velocity: 1.0, acceleration: 1.0, jerk: None, assumed: MissingRates::default() },
        }
    })
}

fn array(v: Vector3<f64>) -> [f64; 3] {
    // Adding 0 turns -0 into 0.
    [v.x + 0.0, v.y + 0.0, v.z + 0.0]
}

//! The outlines of the two arm links, from the URDF's geometry.

use super::chain::Chain;
use super::document::Document;
use super::plane::project;
use super::self_collision::{Group, SelfCollision, group};
use super::shapes::{GatheredShapes, PlacedShape};
use super::solid::capsule;
use super::tree::Tree;
use crate::error::{Diagnostic, InputError, quoted};
use crate::settings::RobotSettings;
use cplan_geometry::{Convex, Point, Pose, separation};
use cplan_model::{Heights, Link, OutlineSource, Part, Plane, SelfObstacle};
use cplan_text::counted;
use nalgebra::Isometry3;
use std::collections::BTreeSet;

/// Largest number of corners of an outline that remains a single shape. The time of queries grows with this number.
const MAX_CORNERS: usize = 1024;

pub(super) struct Bodies<'a> {
    pub document: &'a Document,
    pub tree: &'a Tree,
    pub chain: &'a Chain,
    pub settings: RobotSettings<'a>,
    pub plane: &'a Plane,
    /// Poses of all links in the root frame, with the two arm joints at 0.
    pub poses: &'a [Isometry3<f64>],
}

/// Returns a region that contains the shape whatever its orientation about a point. Also returns a region that the shape contains
/// in every orientation, if there is one. `certain` is a region that certainly lies within the shape.
fn all_round(axis: Point, shape: &Convex, certain: &Convex) -> Option<(Convex, Option<Convex>)> {
    let is_disc = |convex: &Convex| convex.core().len() == 1 && (convex.core()[0] - axis).norm() <= AXIS_TOLERANCE;
    if is_disc(shape) && is_disc(certain) {
        return Some((shape.clone(), (certain != shape).then(|| certain.clone())));
    }
    let within = -separation(&Convex::point(axis), certain).distance * (1.0 - AXIS_TOLERANCE);
    let disc = |radius: f64| Convex::trusted(vec![axis], radius);
    (within > 0.0).then(|| (disc(shape.reach_from(axis)), Some(disc(within))))
}

/// Tolerance for shapes that count as discs about an axis. For a disc, it limits the distance of the centre from the axis, in
/// metres; for other shapes, it is relative.
const AXIS_TOLERANCE: f64 = 1e-9;

/// The outlines of both links, the robot's links that are obstacles, and notes for the user.
pub(super) struct Outlines {
    pub links: [Link; 2],
    pub self_obstacles: Vec<SelfObstacle>,
    pub geometry: Vec<String>,
    pub notes: Vec<String>,
    /// Notes about shapes of size zero.
    pub sizeless: Vec<String>,
    pub warnings: Vec<String>,
}

fn describe_unread_mesh(unread: &Diagnostic) -> String {
    format!("{}; this link is ignored in planning, so it may collide with the arm", unread.message)
}

/// Names those URDF links of an arm link whose visual geometry is used, although others have collision geometry. `None` if there
/// are none.
fn visual_links(link: &Link) -> Option<String> {
    let mut names: Vec<&str> = link.parts.iter().filter(|part| part.is_visual).map(|part| part.body.as_str()).collect();
    names.dedup();
    let named =
        || format!("no collision geometry, so the outline is that of the visual geometry: {}", quoted(names.iter()));
    (!names.is_empty()).then(named)
}

impl Bodies<'_> {
    /// Returns the outlines of both links in their frames, whose origins are at the joints, and the fixed links as obstacles for
    /// them.
    ///
    /// # Errors
    /// A mesh that cannot be used, unless the world requests a bar instead; two links without outlines; unknown names of links in
    /// the world.
    pub fn outlines(&self) -> Result<Outlines, InputError> {
        let bar = self.bar()?;
        let (mut notes, mut sizeless, mut warnings) = (Vec::new(), Vec::new(), Vec::new());
        let mut gathered = [0, 1].map(|index| self.gather(self.bodies(index)));
        let mut fixed = self.gather(self.fixed_links());
        let mut all = std::mem::take(&mut fixed.shapes);
        all.extend(gathered.iter_mut().flat_map(|of_link| std::mem::take(&mut of_link.shapes)));
        let mut solid: BTreeSet<usize> = all.iter().map(|shape| shape.link).collect();
        for (index, of_link) in gathered.iter().enumerate().filter(|_| bar.is_some()) {
            let links = self.bodies(index);
            if !of_link.unread.is_empty() || !links.iter().any(|link| solid.contains(link)) {
                solid.insert(self.tree.child[self.chain.joints[index]]);
            }
        }
        let own = SelfCollision::new(self, solid)?;
        let mut links = Vec::new();
        for (index, gathered) in gathered.into_iter().enumerate() {
            let mut parts = Vec::new();
            for shape in all.iter().filter(|shape| self.bodies(index).contains(&shape.link)) {
                parts.extend(self.parts(index, shape, &own.cuts(shape.link, &all))?);
            }
            let ignored = self.sizeless(index, &gathered.empty);
            notes.extend(ignored.clone());
            sizeless.extend(ignored);
            links.push(self.link(index, parts, gathered, bar, &mut notes, &mut warnings)?);
        }
        let links: [Link; 2] = links.try_into().expect("two links");
        if links.iter().all(|l| l.source == OutlineSource::None) {
            let message = format!(
                "links \"{}\" and \"{}\" have neither collision nor visual geometry, so the arm cannot collide with anything",
                links[0].name, links[1].name
            );
            let help = "add <collision> geometry to the URDF, or replace the links by bars between the joints, in the \
                        world file: [robot] bar = 0.05 (radius of the bars in metres)";
            return Err(self.document.source.diagnostic(message).help(help).into());
        }
        let geometry = links.iter().enumerate().map(|(index, link)| self.describe_part(index, link)).collect();
        let self_obstacles = own.obstacles(&all);
        if self.settings.table.own_body_is_obstacle() {
            warnings.extend(fixed.unread.iter().chain(&fixed.unseen).map(describe_unread_mesh));
        }
        Ok(Outlines { links, self_obstacles, geometry, notes, sizeless, warnings })
    }

    fn bar(&self) -> Result<Option<f64>, Diagnostic> {
        let Some(bar) = &self.settings.table.bar else { return Ok(None) };
        let radius = bar.get_ref().0;
        if radius.is_finite() && radius > 0.0 {
            return Ok(Some(radius));
        }
        let message = format!("[robot] bar: the radius must be positive, is {radius}");
        Err(self.settings.source.diagnostic_at(bar.span(), message).help("bar = 0.05, metres"))
    }

    fn name(&self, index: usize) -> &str {
        &self.tree.links[self.tree.child[self.chain.joints[index]]]
    }

    /// Names those bodies of a link that have shapes of size zero. `None` if there are none.
    fn sizeless(&self, index: usize, bodies: &[String]) -> Option<String> {
        let (link, name, bodies) = (index + 1, self.name(index), bodies.join(", "));
        (!bodies.is_empty()).then(|| format!("link {link} \"{name}\": shapes of size zero are ignored (in {bodies})"))
    }

    /// Creates an arm link from these parts, which lack the shapes that could not be read.
    fn link(
        &self,
        index: usize,
        mut parts: Vec<Part>,
        gathered: GatheredShapes,
        bar: Option<f64>,
        notes: &mut Vec<String>,
        warnings: &mut Vec<String>,
    ) -> Result<Link, InputError> {
        let name = self.name(index).to_owned();
        let GatheredShapes { mut unread, unseen, .. } = gathered;
        let has_collision = parts.iter().any(|part| !part.is_visual);
        if has_collision {
            warnings.extend(unseen.iter().map(describe_unread_mesh));
        } else {
            unread.extend(unseen);
        }
        let mut source = if has_collision { OutlineSource::Collision } else { OutlineSource::Visual };
        if !unread.is_empty() || parts.is_empty() {
            match bar {
                Some(radius) => {
                    for diagnostic in &unread {
                        warnings.push(format!("{}; the bar replaces it", diagnostic.message));
                    }
                    parts.push(self.bar_part(index, radius, &name));
                    source = OutlineSource::Bar;
                }
                None => {
                    InputError::check(unread)?;
                    source = OutlineSource::None;
                }
            }
        }
        if source == OutlineSource::None {
            warnings.push(format!(
                "link {} \"{name}\" has no geometry, so it cannot collide; [robot] bar = RADIUS adds a bar",
                index + 1
            ));
        }
        let link = Link { name, parts, source };
        if matches!(source, OutlineSource::Visual | OutlineSource::Bar) {
            notes.push(self.describe_part(index, &link));
        } else {
            notes.extend(visual_links(&link));
        }
        Ok(link)
    }

    fn describe_part(&self, index: usize, Link { name, parts, source }: &Link) -> String {
        format!("link {} \"{name}\": {}", index + 1, self.summary(*source, parts))
    }

    fn summary(&self, source: OutlineSource, parts: &[Part]) -> String {
        let shapes = counted(parts.len(), "shape");
        match source {
            OutlineSource::Collision => format!("outline from the collision geometry ({shapes})"),
            OutlineSource::Visual => {
                format!("outline from the visual geometry, because there is no collision geometry ({shapes})")
            }
            OutlineSource::Bar if parts.len() > 1 => {
                format!("outline from the collision geometry and a bar ({shapes})")
            }
            OutlineSource::Bar => "outline is a bar between the joints, as the world file requests".to_owned(),
            OutlineSource::None => "no outline: it has no geometry".to_owned(),
        }
    }

    /// Returns the URDF links that form arm link `index`, in the order of the file.
    pub fn bodies(&self, index: usize) -> Vec<usize> {
        let [first, second] = self.chain.joints;
        (0..self.document.robot.links.len())
            .filter(|l| match index {
                0 => self.tree.carries(first, *l) && !self.tree.carries(second, *l),
                _ => self.tree.carries(second, *l),
            })
            .collect()
    }

    /// Iterates over the fixed URDF links, in the order of the file.
    fn fixed_links(&self) -> impl Iterator<Item = usize> + '_ {
        let is_fixed = |link: &usize| group(self.document, self.tree, self.chain, *link) == Some(Group::Fixed);
        (0..self.document.robot.links.len()).filter(is_fixed)
    }

    /// Returns a shape as parts of arm link `index`, in the link's frame. There is one part for each layer between the heights
    /// `cuts`.
    ///
    /// # Errors
    /// A shape that turns with the wrist and does not cover the same region at all angles.
    fn parts(&self, index: usize, shape: &PlacedShape, cuts: &[f64]) -> Result<Vec<Part>, Diagnostic> {
        let PlacedShape { link, number, is_visual, solid, pose, .. } = shape;
        let joint = self.joint_at(index).0;
        let to_link = Pose::translation(-joint);
        let body = &self.document.robot.links[*link].name;
        let part = |shape, inner, heights| Part {
            padding: 0.0,
            shape,
            inner,
            number: *number,
            is_visual: *is_visual,
            heights,
            body: body.clone(),
        };
        let Some(axis) = self.wrist_axis(*link).map(|axis| axis - joint) else {
            let inner = solid.inner(pose, self.plane).map(|inner| inner.at(&to_link));
            let layers = solid.layers(pose, self.plane, cuts).into_iter();
            let layers = layers.map(|(outline, heights)| (outline.at(&to_link), heights));
            let in_pieces = |(outline, heights): (Convex, Heights)| {
                let pieces = if outline.core().len() > MAX_CORNERS { outline.cut_up() } else { vec![outline] };
                pieces.into_iter().map(move |piece| (piece, heights))
            };
            return Ok(layers
                .flat_map(in_pieces)
                .map(|(piece, heights)| part(piece, inner.clone(), heights))
                .collect());
        };
        let outline = solid.outline(pose, self.plane).at(&to_link);
        let inner = solid.inner(pose, self.plane).map(|inner| inner.at(&to_link));
        match all_round(axis, &outline, inner.as_ref().unwrap_or(&outline)) {
            Some((outline, inner)) => Ok(vec![part(outline, inner, shape.heights)]),
            None => {
                let message = format!(
                    "link \"{body}\" turns with the wrist, but its shape is not centred on the wrist's axis, so it covers a different area at each angle"
                );
                let help =
                    "add <collision> geometry that covers all angles: a <cylinder> along the axis of the wrist's joint";
                Err(self.document.diagnostic_at(&shape.at, message).help(help))
            }
        }
    }

    /// Returns the position of the wrist's axis in the plane, if the link `body` turns about it during motions.
    fn wrist_axis(&self, body: usize) -> Option<Point> {
        let name = self.settings.table.wrist_joint().filter(|_| self.settings.wrist_turns)?;
        let joint = self.document.robot.joints.iter().position(|joint| joint.name == *name.get_ref())?;
        self.tree.carries(joint, body).then(|| self.at(self.tree.child[joint]).0)
    }

    /// Returns the position of a joint in the plane, and its height.
    pub fn joint_at(&self, index: usize) -> (Point, f64) {
        self.at(self.tree.child[self.chain.joints[index]])
    }

    fn at(&self, link: usize) -> (Point, f64) {
        let at = self.poses[link].translation.vector;
        (project(self.plane, &at), at.dot(&self.plane.normal))
    }

    /// Returns the capsule from joint 1 to joint 2, or from joint 2 to the tip.
    fn bar_part(&self, index: usize, radius: f64, body: &str) -> Part {
        let (from, low) = self.joint_at(index);
        let (to, high) = if index == 0 { self.joint_at(1) } else { self.at(self.chain.tip) };
        Part {
            inner: None,
            padding: 0.0,
            number: 0,
            is_visual: false,
            shape: capsule(Point::zeros(), to - from, radius),
            heights: Heights { lower: low.min(high) - radius, upper: low.max(high) + radius },
            body: body.to_owned(),
        }
    }
}

//! Checks the values of a world file.

use super::goal_table::GoalTable;
use super::joint_pair::JointPair;
use super::notes::Corrections;
use cplan_geometry::{Point, Pose, Vector};
use cplan_model::space::Configuration;
use cplan_model::{Elbow, Goal, Heights};
use cplan_robot::{Diagnostic, Lengths, Number, Source, Spanned, Written, nearest_file};
use std::cell::RefCell;
use std::ops::Range;
use std::path::{Path, PathBuf};

/// Checks the values of a world file, and quotes the file in messages.
pub(super) struct Reader<'a> {
    pub source: &'a Source,
    /// Corrections of input.
    pub taken: Corrections,
    /// Joint values that are written in degrees.
    pub in_degrees: RefCell<Vec<JointPair>>,
    /// Paths of the files that the world names, and of the files that those name.
    pub files: RefCell<Vec<PathBuf>>,
}

impl<'a> Reader<'a> {
    pub fn new(source: &'a Source) -> Self {
        Self { source, taken: Corrections::default(), in_degrees: RefCell::default(), files: RefCell::default() }
    }
}

impl Reader<'_> {
    /// Returns a number.
    ///
    /// # Errors
    /// A negative number.
    pub fn not_negative<T: Copy + Into<f64>>(&self, number: &Spanned<T>, what: &str) -> Result<f64, Diagnostic> {
        let value = self.source.finite(number, what)?;
        if value < 0.0 {
            let message = format!("{what} must not be negative, is {value}");
            return Err(self.source.diagnostic_at(number.span(), message).help("write 0 or more"));
        }
        Ok(value)
    }

    /// Returns two numbers.
    ///
    /// # Errors
    /// A list that does not have two numbers.
    pub fn number_pair<T: Copy + Into<f64>>(
        &self,
        numbers: &Spanned<Vec<Spanned<T>>>,
        what: &str,
    ) -> Result<[f64; 2], Diagnostic> {
        match numbers.get_ref().as_slice() {
            [a, b] => Ok([self.source.finite(a, what)?, self.source.finite(b, what)?]),
            other => {
                let message = format!("{what}: expected two numbers, found {}", other.len());
                Err(self.source.diagnostic_at(numbers.span(), message).help("write [a, b]"))
            }
        }
    }

    /// Returns an angle or a joint's value.
    pub fn quantity(&self, written: &Written, what: &str) -> Result<f64, Diagnostic> {
        self.source.finite(&Number::new(written.span(), written.get_ref().value), what)
    }

    /// Returns values of both joints.
    pub fn joint_pair(&self, written: &Spanned<Vec<Written>>, what: &str) -> Result<JointPair, Diagnostic> {
        let [a, b] = &written.get_ref()[..] else {
            let message = format!("{what}: expected two numbers, found {}", written.get_ref().len());
            return Err(self.source.diagnostic_at(written.span(), message).help("joints = [q1, q2], base to tip"));
        };
        let values = [self.quantity(a, what)?, self.quantity(b, what)?];
        Ok(JointPair { values, degrees: [a, b].map(|w| w.get_ref().in_degrees.then(|| w.span())) })
    }
    /// Returns a point of the plane.
    pub fn point(&self, numbers: &Lengths, what: &str) -> Result<Point, Diagnostic> {
        self.number_pair(numbers, what).map(Point::from)
    }

    /// Returns the pose of a frame, or `None` if neither position nor angle is given.
    pub fn pose(&self, at: Option<&Lengths>, angle: Option<&Written>, what: &str) -> Result<Option<Pose>, Diagnostic> {
        let at = at.map(|at| self.point(at, &format!("{what}, at"))).transpose()?;
        let angle = angle.map(|angle| self.quantity(angle, &format!("{what}, angle"))).transpose()?;
        let is_given = at.is_some() || angle.is_some();
        let place = || Pose::new(at.unwrap_or_else(Vector::zeros), angle.unwrap_or(0.0));
        Ok(is_given.then(place))
    }

    /// Returns the alternative goals of a table, and their position in the file.
    pub fn goals(&self, goal: &GoalTable, at: Range<usize>) -> Result<(Vec<Goal>, Range<usize>), Diagnostic> {
        let Some(areas) = &goal.areas else {
            let (goal, at) = self.goal(goal, at, "goal")?;
            return Ok((vec![goal], at));
        };
        if goal.joints.is_some() || goal.tip.is_some() {
            let diagnostic = self.source.diagnostic_at(at, "the goal has `areas` together with `joints` or `tip`");
            return Err(diagnostic.help("keep one of `joints`, `tip` and `areas`"));
        }
        if let Some(elbow) = &goal.elbow {
            let diagnostic = self.source.diagnostic_at(elbow.span(), "a goal with `areas` cannot have `elbow`");
            return Err(diagnostic.help("remove `elbow`, or give `tip`"));
        }
        let area = |corners: &Spanned<Vec<Lengths>>| match corners.get_ref().as_slice() {
            [a, b] => {
                let [a, b] = [self.point(a, "goal area")?, self.point(b, "goal area")?];
                Ok(Goal::Area([a.inf(&b), a.sup(&b)]))
            }
            other => {
                let message = format!("goal area: expected two opposite corners, found {}", other.len());
                Err(self.source.diagnostic_at(corners.span(), message).help("write [[x, y], [x, y]]"))
            }
        };
        let found = areas.get_ref().iter().map(area).collect::<Result<Vec<_>, _>>()?;
        if found.is_empty() {
            let diagnostic = self.source.diagnostic_at(areas.span(), "the goal has no area");
            return Err(diagnostic.help("areas = [[[x, y], [x, y]]]: two opposite corners each"));
        }
        Ok((found, areas.span()))
    }

    /// Returns joint values or a point for the tip, and its position in the file.
    pub fn goal(&self, goal: &GoalTable, at: Range<usize>, what: &str) -> Result<(Goal, Range<usize>), Diagnostic> {
        if let Some(areas) = &goal.areas {
            let diagnostic = self.source.diagnostic_at(areas.span(), format!("{what}: a step cannot have areas"));
            return Err(diagnostic.help("joints = [q1, q2], or tip = [x, y]"));
        }
        let of_tool = [goal.stroke.as_ref().map(Spanned::span), goal.wrist.as_ref().map(Spanned::span)];
        if let (Some(at), true) = (of_tool.into_iter().flatten().next(), what != "goal") {
            let message = format!("{what}: a step cannot have values of the tool's joints");
            let help = "only [start] and [goal] of a world without steps have `stroke` and `wrist`";
            return Err(self.source.diagnostic_at(at, message).help(help));
        }
        let (place, at) = self.place(goal.joints.as_ref(), goal.tip.as_ref(), at, what)?;
        match (place, self.elbow(goal.elbow.as_ref())?, &goal.elbow) {
            (Goal::Tip(tip), Some(elbow), _) => Ok((Goal::TipAndElbow(tip, elbow), at)),
            (Goal::Joints(_), Some(_), Some(elbow)) => {
                let message =
                    format!("the {what} has `elbow`, but its joint values already determine the side of the elbow");
                Err(self.source.diagnostic_at(elbow.span(), message).help("remove `elbow`, or give `tip`"))
            }
            (place, ..) => Ok((place, at)),
        }
    }

    /// Returns a side of the elbow.
    pub fn elbow(&self, elbow: Option<&Spanned<String>>) -> Result<Option<Elbow>, Diagnostic> {
        let read = |elbow: &Spanned<String>| {
            let unknown = |message: String| self.source.diagnostic_at(elbow.span(), message).help("elbow = \"left\"");
            elbow.get_ref().parse::<Elbow>().map_err(unknown)
        };
        elbow.map(read).transpose()
    }

    /// Returns joint values or a point for the tip. Exactly one of the two keys must be present.
    pub fn place(
        &self,
        joints: Option<&Spanned<Vec<Written>>>,
        tip: Option<&Lengths>,
        at: Range<usize>,
        what: &str,
    ) -> Result<(Goal, Range<usize>), Diagnostic> {
        match (joints, tip) {
            (Some(joints), None) => {
                let pair = self.joint_pair(joints, &format!("{what} joints"))?;
                let goal = Goal::Joints(Configuration::from(pair.values));
                if pair.degrees.iter().any(Option::is_some) {
                    self.in_degrees.borrow_mut().push(pair);
                }
                Ok((goal, joints.span()))
            }
            (None, Some(tip)) => Ok((Goal::Tip(self.point(tip, &format!("{what} tip"))?), tip.span())),
            (joints, _) => {
                let found = if joints.is_some() { "both" } else { "neither" };
                let message = format!("the {what} needs either `joints` or `tip`, but has {found}");
                Err(self.source.diagnostic_at(at, message).help("joints = [q1, q2], or tip = [x, y]"))
            }
        }
    }

    pub fn path_of_named_file(&self, name: &Spanned<String>, what: &str) -> Result<PathBuf, Diagnostic> {
        let anchor = self.source.anchor();
        let anchor = anchor.map_err(|why| {
            let help = format!("save the world as a file: \"{}\" is found relative to it", name.get_ref());
            self.source.diagnostic_at(name.span(), format!("{what}: {why}")).help(help)
        })?;
        let path = anchor.with_file_name(name.get_ref());
        if path.is_file() {
            self.files.borrow_mut().push(path.clone());
            return Ok(path);
        }
        let near = nearest_file(&path).and_then(|near| near.strip_prefix(anchor.parent()?).ok().map(Path::to_owned));
        let help = near.map_or_else(
            || "paths are relative to the world file".to_owned(),
            |near| format!("did you mean \"{}\"?", near.display()),
        );
        let message = format!("{what}: there is no file {}", path.display());
        Err(self.source.diagnostic_at(name.span(), message).help(help))
    }

    /// Returns the stated heights, or all heights if the key is missing.
    pub fn heights(&self, height: Option<&Lengths>, what: &str) -> Result<Heights, Diagnostic> {
        let Some(height) = height else { return Ok(Heights::ALL) };
        let [lower, upper] = self.number_pair(height, &format!("{what}, height"))?;
        if lower > upper {
            let message = format!("{what}: height [{lower}, {upper}] is empty");
            return Err(self.source.diagnostic_at(height.span(), message).help("write the lower end first"));
        }
        Ok(Heights { lower, upper })
    }
}

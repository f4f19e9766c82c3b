//! What became of one problem, for pictures.

use super::failure::Failure;
use super::output::{self, PictureFormat};
use super::summary;
use crate::check::CertifiedCurve;
use crate::cspace::CObstacle;
use crate::draw::{Ending, Picture, View, page};
use crate::engine::{Answer, Verdict};
use crate::model::Problem;
use crate::motion::{Report, write_whole};
use crate::planner::FieldPlanner;
use std::path::Path;

/// A verdict in a word or two.
pub fn status(verdict: &Verdict) -> &'static str {
    match verdict {
        Verdict::Found(_) => "found, certified",
        Verdict::Infeasible(_) => "no path: proven",
        Verdict::Unknown(_) => "unknown",
    }
}

/// The answer to one problem.
pub struct Planned<'a> {
    pub problem: &'a Problem,
    pub answer: &'a Answer,
    /// What the motion follows, if there is one.
    pub curve: Option<&'a CertifiedCurve>,
    pub report: &'a Report,
    /// The field that was chosen, if one was.
    pub field: Option<&'a FieldPlanner>,
}

impl Planned<'_> {
    /// Writes a picture of it.
    ///
    /// # Errors
    /// I/O, or a picture that cannot be made of pixels.
    pub fn save(&self, format: PictureFormat, path: &Path) -> Result<(), Failure> {
        Ok(write_whole(path, &self.bytes(format)?)?)
    }

    /// A picture of it as a file holds it.
    ///
    /// # Errors
    /// A picture that cannot be made of pixels.
    pub fn bytes(&self, format: PictureFormat) -> Result<Vec<u8>, Failure> {
        match format {
            PictureFormat::Html => Ok(page(&self.view()).into_bytes()),
            _ => {
                let contours = output::contours(self.problem.scene());
                self.with_picture(&contours, |picture| output::drawn(format, picture))
            }
        }
    }

    /// What a page shows of it.
    pub fn view(&self) -> View {
        self.view_among(&output::contours(self.problem.scene()))
    }

    /// The same, where the contours of the C-obstacles are known.
    pub fn view_among(&self, contours: &[CObstacle]) -> View {
        let ending = match self.answer.verdict {
            Verdict::Found(_) => Ending::Found,
            Verdict::Infeasible(_) => Ending::Infeasible,
            Verdict::Unknown(_) => Ending::Unknown,
        };
        let trajectory = self.report.trajectory.as_ref();
        let view = |picture: &Picture| View::of_picture(picture, ending, summary::facts(self), trajectory);
        self.with_picture(contours, view)
    }

    fn with_picture<T>(&self, contours: &[CObstacle], show: impl FnOnce(&Picture) -> T) -> T {
        let Self { problem, answer, report, .. } = self;
        let scene = problem.scene();
        let outline = self.curve.map(|curve| curve.curve().outline());
        let detail = match report.length {
            Some(length) => {
                let clearance =
                    report.clearance.map_or("nothing to hit".into(), |c| format!("proven clearance {c:.6} m"));
                format!("{}: length {length:.4}, {clearance}", answer.method)
            }
            None => answer.method.to_string(),
        };
        show(&Picture {
            title: vec![output::title(problem), detail],
            status: status(&answer.verdict).into(),
            scene,
            start: problem.start(),
            goals: problem.goals().pieces(),
            paths: outline.iter().map(|path| (answer.method.to_string(), path)).collect(),
            trace: Some(&answer.drawn()),
            proof: answer.verdict.proof(),
            c_obstacles: contours,
        })
    }
}

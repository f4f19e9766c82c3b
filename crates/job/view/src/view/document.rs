//! The document of a view, which the page's code reads.

use super::content::{StillContent, View};
use super::numbers::RoundingSteps;
use super::world::ObstacleView;
use crate::blocking::BlockingView;
use crate::checked::CheckedView;
use crate::section::{self, Section};
use crate::{Object, followed, legend};
use serde::Serialize;

/// The data of a page: a view, its legend, the obstacles that block the motion, the sections of companions, the findings
/// about a checked configuration, and the line that the tip should follow.
#[derive(Serialize)]
struct Document<'a> {
    #[serde(flatten)]
    view: &'a View,
    legend: Vec<Object>,
    #[serde(skip_serializing_if = "Option::is_none")]
    stuck: Option<&'a BlockingView>,
    #[serde(flatten, serialize_with = "section::by_name")]
    sections: &'a [Section],
    #[serde(skip_serializing_if = "Option::is_none")]
    checked: Option<&'a CheckedView>,
    #[serde(skip_serializing_if = "Option::is_none")]
    line: Option<Object>,
    /// Objects where the task puts them.
    #[serde(skip_serializing_if = "<[_]>::is_empty")]
    places: &'a [ObstacleView],
}

impl View {
    /// Returns the document that the page's code reads.
    ///
    /// # Panics
    /// Never: all keys are strings.
    pub fn json(&self) -> String {
        let line = self.still.line.as_ref().map(|line| followed::document(line, RoundingSteps::of(&self.arm)));
        let StillContent { stuck, sections, checked, placed: places, .. } = &self.still;
        let (stuck, checked) = (stuck.as_ref(), checked.as_ref());
        let document = Document { view: self, legend: legend::on_pages(self), stuck, sections, checked, line, places };
        serde_json::to_string(&document).expect("numbers and strings")
    }
}

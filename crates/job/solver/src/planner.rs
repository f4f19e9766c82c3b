//! A planner with its settings.

use super::{CellCounts, Criterion, GridSpace, Method, Setting, Settings};
use cplan_fields::{FieldChoice, FieldPlanner};
use cplan_model::Arm;
use cplan_model::space::Metric;
use cplan_planners::planner::{PathKind, RoadmapSearch, VisibilityGraph};
use cplan_planners::waves::search::Order;
use serde::de::Error;
use serde::ser::SerializeMap;
use serde::{Deserialize, Deserializer, Serialize, Serializer};
use serde_json::Value;

/// A planner with the settings that it reads. In JSON it is the planner's name, or the name with settings, as in
/// `{"trapezoid": {"path": "taut", ...}}`. Missing settings have their defaults.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Planner {
    method: Method,
    settings: Settings,
}

impl Planner {
    /// Returns the planner with its default settings.
    pub fn named(method: Method) -> Self {
        Self { method, settings: (method.descriptor().defaults)() }
    }

    /// Returns the planner's method.
    pub fn method(&self) -> Method {
        self.method
    }

    /// Returns the planner's settings.
    pub fn settings(&self) -> &Settings {
        &self.settings
    }

    /// Changes one setting, if the planner reads it.
    #[must_use]
    pub fn with(mut self, setting: Setting, change: impl FnOnce(&mut Settings)) -> Self {
        if self.method.reads(setting) {
            change(&mut self.settings);
        }
        self
    }

    /// Sets the kind of path, if the planner has several.
    #[must_use]
    pub fn with_path(self, kind: PathKind) -> Self {
        self.with(Setting::Path, |settings| settings.path = kind)
    }

    /// Sets the criterion for short paths, if the planner minimises length.
    #[must_use]
    pub fn with_criterion(self, criterion: Criterion) -> Self {
        self.with(Setting::Criterion, |settings| settings.criterion = criterion)
    }

    /// Sets the gap, a share of the optimum, if the planner minimises length.
    #[must_use]
    pub fn with_gap(self, share: f64) -> Self {
        self.with(Setting::Gap, |settings| settings.gap = Some(share))
    }

    /// Sets the margin of the first level, a share of the arm's reach, if the planner plans among polygons.
    #[must_use]
    pub fn with_margin(self, share: f64) -> Self {
        self.with(Setting::Margin, |settings| settings.margin = share)
    }

    /// Sets the number of cells along each axis on the first level, if the planner has cells.
    #[must_use]
    pub fn with_cells(self, n: usize) -> Self {
        self.with_cell_counts(CellCounts::square(n))
    }

    /// Sets the numbers of cells along both axes on the first level, if the planner has cells.
    #[must_use]
    pub fn with_cell_counts(self, counts: CellCounts) -> Self {
        self.with(Setting::Cells, |settings| settings.cells = Some(counts))
    }

    /// Sets the search of the roadmap, if the planner has one.
    #[must_use]
    pub fn with_search(self, search: RoadmapSearch) -> Self {
        self.with(Setting::Search, |settings| settings.search = search)
    }

    /// Sets the test of cells, if the planner has cells.
    #[must_use]
    pub fn with_space(self, space: GridSpace) -> Self {
        self.with(Setting::Space, |settings| settings.space = space)
    }

    /// Returns the kind of the planner's paths.
    pub fn path_kind(&self) -> PathKind {
        self.settings.path
    }

    /// Returns true if files, pictures and the first attempt should have the exact polygons of a gantry.
    pub fn is_exact(&self) -> bool {
        self.settings.margin == 0.0
    }

    /// Returns the numbers of cells along the axes on the first level. `None` if they are not given.
    pub fn cells(&self) -> Option<CellCounts> {
        self.settings.cells
    }

    /// Returns the kind of visibility graph that the planner searches. `None` if it searches none.
    pub fn graph(&self) -> Option<VisibilityGraph> {
        self.value_if_read(Setting::Graph, self.settings.graph)
    }

    /// Returns the metric in which the planner measures paths of an arm.
    pub fn metric(&self, arm: &Arm) -> Metric {
        self.settings.criterion.metric(arm)
    }

    /// Returns the requested gap. `None` if none was requested, or if the planner does not minimise length.
    pub fn gap(&self) -> Option<f64> {
        self.settings.gap
    }

    /// Returns the search of the planner's roadmap. `None` if it has no roadmap.
    pub fn search(&self) -> Option<RoadmapSearch> {
        self.value_if_read(Setting::Search, self.settings.search)
    }

    /// Returns true if the planner minimises length.
    pub fn optimizes(&self) -> bool {
        self.method.optimizes() && self.settings.search.order.is_optimal()
    }

    /// Returns the test of the cells of the planner's grid. `None` if it has no grid.
    pub fn space(&self) -> Option<GridSpace> {
        self.value_if_read(Setting::Space, self.settings.space)
    }

    /// Returns the field that the planner follows. `None` for the plain harmonic field, and for planners without a
    /// field.
    pub fn field(&self) -> Option<&FieldPlanner> {
        self.settings.field.as_ref()
    }

    /// Returns true if the planner computes a potential, with values between those of goals and obstacles.
    pub fn has_potential(&self) -> bool {
        let is_relaxed = |field: &FieldPlanner| matches!(field.field, FieldChoice::Relaxed { .. });
        self.method.reads(Setting::Field) && self.field().is_none_or(is_relaxed)
    }

    /// Returns true if the planner's search of a grid estimates remaining costs.
    pub fn estimates_costs(&self) -> bool {
        let order = self.settings.grid_search.order(self.settings.ties);
        self.method.reads(Setting::GridSearch) && order.is_some_and(Order::estimates)
    }

    fn value_if_read<T>(&self, setting: Setting, value: T) -> Option<T> {
        self.method.reads(setting).then_some(value)
    }
}

impl Serialize for Planner {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        if self.method.descriptor().settings.is_empty() {
            return serializer.serialize_str(self.method.name());
        }
        let mut planner = serializer.serialize_map(Some(1))?;
        planner.serialize_entry(self.method.name(), &ReadSettings(self))?;
        planner.end()
    }
}

/// The settings that a planner reads.
struct ReadSettings<'a>(&'a Planner);

impl Serialize for ReadSettings<'_> {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        let Planner { method, settings } = self.0;
        let mut map = serializer.serialize_map(None)?;
        for &setting in method.descriptor().settings {
            let is_left_out = match setting {
                Setting::Ties => settings.ties.is_default(),
                Setting::Forward => !settings.forward,
                _ => false,
            };
            if !is_left_out {
                settings.write(setting, &mut map)?;
            }
        }
        map.end()
    }
}

impl<'de> Deserialize<'de> for Planner {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        let named = |name: &str| Ok(Self::named(name.parse().map_err(D::Error::custom)?));
        let one = match Value::deserialize(deserializer)? {
            Value::String(name) => return named(&name),
            Value::Object(map) if map.len() == 1 => map.into_iter().next(),
            _ => None,
        };
        let Some((name, Value::Object(mut given))) = one else {
            return Err(D::Error::custom("write a planner as its name, or as an object whose only key is the name"));
        };
        let mut planner: Self = named(&name)?;
        for &setting in planner.method.descriptor().settings {
            let Some(value) = given.remove(setting.key()) else { continue };
            let wrong = |error| D::Error::custom(format_args!("{}: {error}", setting.key()));
            planner.settings.read(setting, value).map_err(wrong)?;
        }
        Ok(planner)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn json_has_the_settings_that_a_planner_reads() {
        let roadmap = r#""search":{"order":"a_star","backward":false}"#;
        for (method, expected) in [
            (Method::Shortest, r#"{"shortest":{"criterion":"euclidean","gap":null,"margin":0.001}}"#.to_owned()),
            (Method::Trapezoid, format!(r#"{{"trapezoid":{{"path":"taut","margin":0.001,{roadmap}}}}}"#)),
            (Method::Voronoi, format!(r#"{{"voronoi":{{"path":"own","margin":0.001,{roadmap}}}}}"#)),
            (
                Method::Wavefront,
                r#"{"wavefront":{"search":"wave","neighborhood":"four","space":"rows","path":"taut","cells":256}}"#
                    .into(),
            ),
            (Method::Harmonic, r#"{"harmonic":{"field":null,"space":"rows","path":"own","cells":null}}"#.into()),
            (Method::Subdivision, r#"{"subdivision":{"path":"taut"}}"#.into()),
            (Method::First, r#""first""#.into()),
        ] {
            assert_eq!(serde_json::to_string(&Planner::named(method)).unwrap(), expected);
        }
    }

    #[test]
    fn each_setting_is_read_as_it_was_written() {
        let planner = Planner::named(Method::Wavefront).with_cell_counts(CellCounts([64, 32]));
        let planner = planner.with_path(PathKind::Own).with(Setting::Forward, |settings| settings.forward = true);
        let text = serde_json::to_string(&planner).unwrap();
        assert!(text.contains(r#""forward":true"#), "{text}");
        assert_eq!(serde_json::from_str::<Planner>(&text).unwrap(), planner);
        for wrong in ["{}", "[]", r#""fastest""#, r#"{"prm":{"seed":-1}}"#, r#"{"prm":{},"first":{}}"#] {
            assert!(serde_json::from_str::<Planner>(wrong).is_err(), "{wrong}");
        }
    }

    #[test]
    fn unread_settings_keep_their_defaults() {
        let first = Planner::named(Method::First);
        assert_eq!(first.with_margin(0.0).with_cells(64).with_path(PathKind::Own).with_gap(0.1), first);
    }

    #[test]
    fn a_descriptor_is_consistent() {
        for method in Method::ALL {
            let descriptor = method.descriptor();
            assert!(descriptor.paths.contains(&method.path_kind()), "{method}");
            assert_eq!(descriptor.paths.len() > 1, method.reads(Setting::Path), "{method}");
            assert_eq!(method.name().parse(), Ok(method));
        }
    }
}

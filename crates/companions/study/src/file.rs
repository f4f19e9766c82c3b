//! Reads study files.

use super::Study;
use super::address::{Step, entry_in, is_angle};
use super::measure::{Condition, Measure, Objective};
use super::parameter::{Design, Parameter, Values};
use super::schema::{ParameterTable, StudyFile, Text};
use super::template::{Place, Setting, Template, place};
use cplan_robot::{Diagnostic, InputError, Quantity, RobotFile, Source, Spanned};
use cplan_solver::Options;
use cplan_world::{Overrides, scene_from};
use std::ops::Range;
use std::path::{Path, PathBuf};

/// Largest number of layouts of a study.
const MAX_LAYOUTS: usize = 20_000_000;

/// A function that parses planning options such as `--planner=first`. The options are those of the main command.
pub type ReadOptions<'a> = &'a dyn Fn(&[String]) -> Result<(Options, Overrides), String>;

/// A function that reads a file that a study names. The second argument is the file's name, if the study states one.
type OpenFile<'a> = &'a dyn Fn(NamedFile, Option<&str>) -> Result<Source, InputError>;

struct Reader<'a> {
    source: &'a Source,
}

/// Reads a study and the two files that it names.
///
/// # Errors
/// All defects of the files, with line, column and hint.
pub(super) fn load(
    path: &Path,
    read_options: ReadOptions,
    robot: &dyn Fn(PathBuf) -> RobotFile,
) -> Result<Study, InputError> {
    let study = Source::read(path)?;
    let beside = |which: NamedFile, name: Option<&str>| {
        let missing = || {
            let (key, example) = match which {
                NamedFile::Robot => ("robot", "arm.urdf"),
                NamedFile::World => ("world", "world.toml"),
            };
            study
                .diagnostic(format!("the study does not name a {key}"))
                .help(format!("write {key} = \"{example}\" at its beginning"))
        };
        let path = path.with_file_name(name.ok_or_else(missing)?);
        match which {
            NamedFile::Robot => robot(path).read(),
            NamedFile::World => Source::read(&path),
        }
    };
    read(&study, read_options, &beside)
}

/// The files that a study names.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum NamedFile {
    Robot,
    World,
}

/// Reads a study from its text. Reads the files that it names with `open`.
pub(super) fn read(source: &Source, read_options: ReadOptions, open: OpenFile) -> Result<Study, InputError> {
    let reader = Reader { source };
    let file = reader.parse()?;
    let urdf = reader.named(NamedFile::Robot, file.robot.as_ref(), open)?;
    let world = reader.named(NamedFile::World, file.world.as_ref(), open)?;
    let (options, overrides) = match &file.options {
        None => (Options::default(), Overrides::default()),
        Some(words) => read_options(words.get_ref()).map_err(|why| reader.options(words, &why))?,
    };
    let parameters = reader.parameters(&file.parameter)?;
    let seed = file.seed.unwrap_or(0);
    let design = reader.design(&file, &parameters, seed)?;
    let [world, urdf] = reader.templates(&file.parameter, world, urdf)?;
    let base = scene_from(urdf.source().clone(), world.source().clone())?;
    if let (Some(why), Some(words)) = (options.error(base.is_task()), &file.options) {
        return Err(reader.wrong(words.span(), format!("options: {why}"), "leave the option out").into());
    }
    let (measures, conditions, objective) = reader.goals(&file, base.is_task())?;
    let searched =
        file.search.as_ref().map(|table| reader.search(&table.layouts, &parameters, objective)).transpose()?;
    let stem = source.stem().unwrap_or_else(|| "study".to_owned());
    Ok(Study {
        name: file.name.unwrap_or(stem),
        parameters,
        measures,
        conditions,
        objective,
        searched: searched.unwrap_or(0),
        seed,
        source: source.clone(),
        design,
        world,
        urdf,
        base,
        options,
        words: file.options.map(Spanned::into_inner).unwrap_or_default(),
        may_overlap: file.overlap,
        overrides,
    })
}

/// Measures, conditions and objective of a study.
type Goals = (Vec<Measure>, Vec<Condition>, Option<Objective>);

/// Returns the objective of a study that states none: duration if it is measured, otherwise length, otherwise the first
/// measure.
fn usual_objective(measures: &[Measure]) -> Option<Objective> {
    let preferred = [Measure::Duration, Measure::Length].into_iter().find(|measure| measures.contains(measure));
    let measure = preferred.or(measures.first().copied())?;
    Some(Objective { measure, most: measure == Measure::Clearance })
}

impl Reader<'_> {
    fn parse(&self) -> Result<StudyFile, Diagnostic> {
        let hint = "`cplan help study` shows a study; `cplan schema study` prints the schema for editors";
        self.source.toml(&|_, _| hint)
    }

    fn parameters(&self, tables: &[Spanned<ParameterTable>]) -> Result<Vec<Parameter>, Diagnostic> {
        let parameters = tables.iter().map(|table| self.parameter(table.get_ref(), table.span()));
        let parameters = parameters.collect::<Result<Vec<_>, _>>()?;
        self.distinct(tables)?;
        Ok(parameters)
    }

    fn design(&self, file: &StudyFile, parameters: &[Parameter], seed: u64) -> Result<Design, Diagnostic> {
        let drawn = parameters.iter().position(|parameter| matches!(parameter.values, Values::Drawn { .. }));
        let draws = self.draws(file, drawn)?;
        let design = Design::new(parameters, draws, seed).filter(|design| design.count() <= MAX_LAYOUTS);
        design.ok_or_else(|| {
            let message = format!("the values of the parameters give more than {MAX_LAYOUTS} layouts");
            self.source.diagnostic(message).help("list fewer values, or draw some of them")
        })
    }

    /// Reads measures, conditions and the objective. Worlds with steps have no lower bounds on lengths.
    fn goals(&self, file: &StudyFile, has_steps: bool) -> Result<Goals, Diagnostic> {
        let named: Vec<Measure> = match &file.measure {
            None => Measure::ALL.to_vec(),
            Some(names) => names.iter().map(|name| self.word(name, Measure::named)).collect::<Result<_, _>>()?,
        };
        let conditions: Vec<Condition> =
            file.conditions.iter().map(|text| self.word(text, Condition::parse)).collect::<Result<_, _>>()?;
        let objective = file.objective.as_ref().map(|text| self.word(text, Objective::parse)).transpose()?;
        let objective = objective.or_else(|| usual_objective(&named));
        let of_conditions = || conditions.iter().map(|condition| condition.measure);
        let of_objective = || objective.map(|objective| objective.measure);
        let texts = file.conditions.iter().zip(of_conditions()).chain(file.objective.iter().zip(of_objective()));
        for (text, measure) in texts {
            if has_steps && [Measure::OverBound, Measure::LowerBound].contains(&measure) {
                let message = format!("`{}` is not available in a world with steps", measure.name());
                return Err(self.wrong(text.span(), message, "use `duration`, which has a proven bound"));
            }
        }
        let mut measures: Vec<Measure> = Vec::new();
        for measure in named.into_iter().chain(of_conditions()).chain(of_objective()) {
            if !measures.contains(&measure) {
                measures.push(measure);
            }
        }
        Ok((measures, conditions, objective))
    }

    fn wrong(&self, at: Range<usize>, message: impl Into<String>, help: &str) -> Diagnostic {
        self.source.diagnostic_at(at, message).help(help)
    }

    fn options(&self, words: &Spanned<Vec<String>>, why: &str) -> Diagnostic {
        let reasons: Vec<&str> = why.lines().map(str::trim).filter(|line| !line.is_empty()).collect();
        let help = "`options` contains planning options (`cplan help plan`); name output files on the command line of `cplan study`";
        self.wrong(words.span(), format!("options: {}", reasons.join("; ")), help)
    }

    fn named(&self, which: NamedFile, name: Option<&Text>, open: OpenFile) -> Result<Source, InputError> {
        let named = name.map(|name| name.get_ref().as_str());
        open(which, named).map_err(|error| match (name, error.diagnostics()) {
            (Some(name), [only]) => {
                let message = format!("{}: {}", name.get_ref(), only.message);
                self.wrong(name.span(), message, "paths are relative to the study").into()
            }
            _ => error,
        })
    }

    /// Parses a text of the study file with `read`.
    fn word<T>(&self, text: &Text, read: fn(&str) -> Result<T, String>) -> Result<T, Diagnostic> {
        let help = "write conditions as in \"clearance >= 0.01\", and objectives as in \"least duration\"";
        read(text.get_ref()).map_err(|why| self.wrong(text.span(), why, help))
    }

    fn parameter(&self, table: &ParameterTable, at: Range<usize>) -> Result<Parameter, Diagnostic> {
        let name = table.name.get_ref().clone();
        let wrong = |at, message: String, help: &str| {
            self.wrong(at, format!("parameter \"{}\"{message}", table.name.get_ref()), help)
        };
        if name.trim().is_empty() || name.contains(['\n', '\r']) {
            return Err(self.wrong(table.name.span(), "a parameter needs a name on one line", "name = \"base x\""));
        }
        let sets = table.sets.get_ref().all();
        if sets.is_empty() {
            return Err(wrong(table.sets.span(), " sets nothing".into(), "sets = \"world.clearance\""));
        }
        if let Some(at) = table.degrees()
            && let Some((address, ..)) = sets.into_iter().find(|(address, ..)| !is_angle(address))
        {
            let message = format!(": values in degrees do not fit {address}, which is not an angle");
            return Err(wrong(at, message, "write numbers, as in 0.1"));
        }
        let finite = |value: &Spanned<Quantity>| match value.get_ref().value {
            value if value.is_finite() => Ok(value),
            other => Err(wrong(value.span(), format!(": {other} is not finite"), "write a number")),
        };
        let ends = match (&table.from, &table.to) {
            (Some(given), Some(to)) => {
                let (from, to) = (finite(given)?, finite(to)?);
                if !(to - from).is_finite() {
                    let message = format!(": the range from {from} to {to} is too wide");
                    return Err(wrong(given.span(), message, "write a smaller range"));
                }
                if from > to {
                    let message = format!(": {from} is more than {to}");
                    return Err(wrong(given.span(), message, "write the lesser value as `from`"));
                }
                Some((from, to))
            }
            (None, None) => None,
            _ => return Err(wrong(at, " has only one of `from` and `to`".into(), "give both")),
        };
        let values = match (&table.values, ends, &table.steps, &table.draw) {
            (Some(values), None, None, None) => {
                let given: Vec<f64> = values.get_ref().iter().map(|value| value.value).collect();
                if given.is_empty() || given.iter().any(|value| !value.is_finite()) {
                    return Err(wrong(values.span(), " needs values, all finite".into(), "values = [0.1, 0.2]"));
                }
                Values::Listed(given)
            }
            (None, Some((from, to)), Some(steps), None) => match *steps.get_ref() {
                n @ 1..=1_000_000 if n > 1 || from == to => Values::Stepped { from, to, count: n as usize },
                n => {
                    let message = format!(": the number of steps from {from} to {to} is {n}");
                    return Err(wrong(steps.span(), message, "use 2 to a million steps"));
                }
            },
            (None, Some((from, to)), None, Some(draw)) => match draw.get_ref().as_str() {
                "uniform" | "latin" if from == to => {
                    let message = format!(": the range from {from} to {to} has only one value to draw");
                    let help = format!("write values = [{from}], or a wider range");
                    return Err(wrong(draw.span(), message, &help));
                }
                word @ ("uniform" | "latin") => Values::Drawn { from, to, latin: word == "latin" },
                other => {
                    let message = format!(": draw must be \"uniform\" or \"latin\", not \"{other}\"");
                    return Err(wrong(draw.span(), message, "write draw = \"latin\""));
                }
            },
            _ => {
                let help = "values = [...]; or from, to and steps; or from, to and draw = \"uniform\" or \"latin\"";
                return Err(wrong(at, " needs values, steps or draw".into(), help));
            }
        };
        let unit = table.unit.clone().or_else(|| table.degrees().map(|_| "rad".into()));
        Ok(Parameter { name, unit, values })
    }

    /// Checks that the names of parameters differ from each other and from those of other columns.
    fn distinct(&self, tables: &[Spanned<ParameterTable>]) -> Result<(), Diagnostic> {
        let names = || tables.iter().map(|table| &table.get_ref().name);
        for (number, name) in names().enumerate() {
            let taken = ["layout", "outcome", "reason", "fits"].contains(&name.get_ref().as_str())
                || Measure::named(name.get_ref()).is_ok();
            if taken || names().take(number).any(|other| other.get_ref() == name.get_ref()) {
                let message = format!("there is another column \"{}\"", name.get_ref());
                return Err(self.wrong(name.span(), message, "give each parameter a unique name"));
            }
        }
        match tables {
            [] => Err(self.source.diagnostic("the study has no parameters").help("add a [[parameter]]")),
            _ => Ok(()),
        }
    }

    fn draws(&self, file: &StudyFile, drawn: Option<usize>) -> Result<usize, Diagnostic> {
        match (&file.draws, drawn) {
            (None, None) => Ok(1),
            (Some(draws), Some(_)) => match *draws.get_ref() {
                n @ 1.. if n <= MAX_LAYOUTS as u64 => Ok(n as usize),
                n => Err(self.wrong(draws.span(), format!("{n} draws"), "give it 1 to 20 million")),
            },
            (Some(draws), None) => Err(self.wrong(
                draws.span(),
                "no parameter is drawn",
                "remove `draws`, or give a parameter draw = \"latin\"",
            )),
            (None, Some(number)) => {
                let name = &file.parameter[number].get_ref().name;
                let message = format!(
                    "parameter \"{}\" is drawn at random, but the study does not state the number of draws",
                    name.get_ref()
                );
                Err(self.wrong(name.span(), message, "write draws = 1000 above the first [[parameter]]"))
            }
        }
    }

    /// Returns the templates of world and robot, with placeholders for the numbers that the parameters set.
    fn templates(
        &self,
        tables: &[Spanned<ParameterTable>],
        world: Source,
        urdf: Source,
    ) -> Result<[Template; 2], Diagnostic> {
        let mut settings = [Vec::new(), Vec::new()];
        let mut owners = [Vec::new(), Vec::new()];
        for (parameter, table) in tables.iter().enumerate() {
            for (number, (address, factor, offset)) in table.get_ref().sets.get_ref().all().into_iter().enumerate() {
                let at = || self.target(tables, parameter, number);
                let (file, steps) = place(address).map_err(|why| {
                    self.wrong(at(), why, "as in \"world.robot.at[0]\" or \"urdf.joint.elbow.origin.xyz[0]\"")
                })?;
                if !(factor.is_finite() && offset.is_finite()) {
                    return Err(self.wrong(at(), "factor and offset must be finite", "write numbers"));
                }
                settings[file as usize].push((steps, Setting { parameter, factor, offset }));
                owners[file as usize].push((parameter, number, address));
            }
        }
        let template = |source: Source, file: Place| {
            let name = source.name();
            let text = source.text().to_owned();
            Template::new(source, file, &settings[file as usize]).map_err(|(which, why)| {
                let (parameter, number, address) = owners[file as usize][which];
                let message = format!("{address}: {why} (in {name})");
                let near = file.nearest(&text, address);
                let help = match near {
                    Some(near) if near == *address => "remove the address here, or from the other \"sets\"".into(),
                    Some(near) => format!("{near} is a number that exists in the file"),
                    None => "name a number that exists in the file".into(),
                };
                self.wrong(self.target(tables, parameter, number), message, &help)
            })
        };
        Ok([template(world, Place::World)?, template(urdf, Place::Urdf)?])
    }

    /// Returns the position, in the study file, of the address with this number among those that a parameter sets.
    fn target(&self, tables: &[Spanned<ParameterTable>], parameter: usize, number: usize) -> Range<usize> {
        let sets = &tables[parameter].get_ref().sets;
        let entry =
            [Step::Name("parameter".into()), Step::Number(parameter), Step::Name("sets".into()), Step::Number(number)];
        entry_in(self.source.text(), &entry).unwrap_or(sets.span())
    }

    fn search(
        &self,
        layouts: &Spanned<u64>,
        parameters: &[Parameter],
        objective: Option<Objective>,
    ) -> Result<usize, Diagnostic> {
        let has_room = parameters.iter().any(|parameter| parameter.values.range()[0] < parameter.values.range()[1]);
        match *layouts.get_ref() {
            _ if objective.is_none() => {
                Err(self.wrong(layouts.span(), "a search needs an objective", "objective = \"least duration\""))
            }
            _ if !has_room => Err(self.wrong(layouts.span(), "no parameter has more than one value", "widen a range")),
            n @ 1.. if n <= MAX_LAYOUTS as u64 => Ok(n as usize),
            n => Err(self.wrong(layouts.span(), format!("{n} layouts"), "give it 1 to 20 million")),
        }
    }
}

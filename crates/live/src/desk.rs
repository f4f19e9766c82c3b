//! The session of one page: a text, edited by the page, and the answers to its requests.

use super::Host;
use super::blocked;
use super::contours::Contours;
use super::document::Document;
use super::files;
use super::menus;
use super::options::Options;
use super::protocol::{
    About, AnswerReply, Ask, Begin, Files, JointReply, Message, Pair, PieceReply, Reply, Request, WorldReply,
};
use super::result;
use cplan_core::model::{Arm, Goal, Scene, inverse, within};
use cplan_core::space::{Configuration, JointRange, Measure, Metric, Segment};
use cplan_engine::{Method, Problem};
use cplan_geometry::Point;
use cplan_interrupt::{Instant, Interrupt, Interrupted};
use cplan_world::{LoadedScene, Overrides};
use serde::Deserialize;
use std::cell::Cell;
use std::sync::Arc;
use std::time::Duration;

/// Time for a plan during a drag. Drawing the picture, with or without a plan, takes a little longer. In total, a page
/// should be updated ten times per second.
const DRAG_TIME: Duration = Duration::from_millis(60);

/// Number of requests during a drag for which no plan is tried, after a plan that was not finished in time.
const UNTRIED: u32 = 7;

/// Time for the picture without a plan, when the time for the plan is up: as much again, but within these limits.
const SHOW_TIME: [Duration; 2] = [Duration::from_secs(1), Duration::from_secs(5)];

/// Number of bisection steps towards a place that the tip does not reach.
const BISECTIONS: usize = 24;

/// The stages of a request whose time is up already. Some hosts can stop slow work only by ending the program with all
/// its state; a new instance then does the rest of the request.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum Spent {
    /// No stage: do everything.
    #[default]
    Nothing,
    /// The time for the plan: show the picture without a plan.
    Plan,
    /// The time for everything.
    All,
}

/// The remaining time, from now on.
struct Left {
    /// Time for a plan during a drag.
    drag: Duration,
    /// Time for a plan.
    plan: Duration,
    /// Time for a plan and for the picture that is shown instead.
    show: Duration,
}

impl Spent {
    /// Returns the remaining time if a plan may take `time`.
    fn left(self, time: Duration) -> Left {
        let show = time.clamp(SHOW_TIME[0], SHOW_TIME[1]);
        match self {
            Self::Nothing => Left { drag: DRAG_TIME, plan: time, show: time + show },
            Self::Plan => Left { drag: Duration::ZERO, plan: Duration::ZERO, show },
            Self::All => Left { drag: Duration::ZERO, plan: Duration::ZERO, show: Duration::ZERO },
        }
    }
}

/// A page's text and its content.
pub struct Desk {
    /// Initial state of the program.
    own: Arc<Host>,
    /// Initial state of the page.
    host: Arc<Host>,
    /// Number of the text.
    base: u64,
    document: Document,
    scene: LoadedScene,
    contours: Contours,
    pace: Pace,
}

/// A record of whether plans keep up with a drag. Plans that do not would only delay the rest of the page.
#[derive(Default)]
struct Pace {
    untried: Cell<u32>,
}

impl Pace {
    /// Plans, unless recent plans were too slow.
    fn tries<T>(&self, plan: impl FnOnce() -> Result<T, Interrupted>) -> Option<Result<T, Interrupted>> {
        if self.untried.get() > 0 {
            self.untried.update(|left| left - 1);
            return None;
        }
        let result = plan();
        if matches!(result, Err(Interrupted::TimeUp)) {
            self.untried.set(UNTRIED);
        }
        Some(result)
    }
}

impl Desk {
    /// Creates the session of a new page, with the host's own world.
    #[must_use]
    pub fn new(host: Arc<Host>) -> Self {
        let (document, scene) = (host.document.clone(), host.scene.clone());
        Self {
            own: Arc::clone(&host),
            host,
            base: 1,
            document,
            scene,
            contours: Contours::default(),
            pace: Pace::default(),
        }
    }

    /// Continues with the text that a page works on, and its number.
    ///
    /// # Errors
    /// The reason, with the place.
    pub fn hold(&mut self, base: u64, text: &str) -> Result<(), String> {
        let (document, scene) = self.host.read(text)?;
        (self.base, self.document, self.scene) = (base, document, scene);
        Ok(())
    }

    /// Handles a request, and passes the messages for the page to `tell`.
    pub fn take(&mut self, request: &Request, interrupt: &Interrupt, spent: Spent, tell: &mut dyn FnMut(Message)) {
        let mut reply = |reply: Reply| tell(Message::from(&reply));
        match request {
            Request::Open { id, files } => reply(match self.open(files.as_ref(), spent) {
                Ok(()) => self.world(*id, true),
                Err(error) => Reply::Failed { id: *id, error },
            }),
            Request::Plan(ask) => self.plan(ask, interrupt, spent, &mut reply),
            Request::Load { id, text, options } => self.load(*id, text, options, (interrupt, spent), &mut reply),
            Request::Download { ask, format } => match self.download(ask, format, interrupt, spent) {
                Ok((name, content)) => tell(Message::file(ask.id, &name, &content)),
                Err(error) => reply(Reply::Failed { id: ask.id, error }),
            },
        }
    }

    /// Returns the message with the world; `begins` is true for a world that was opened, and not loaded as a text.
    pub fn world(&self, id: u64, begins: bool) -> Reply {
        let arm = self.scene.scene.arm();
        let names = self.scene.scene.workspace().obstacles.iter().map(|obstacle| obstacle.name.clone());
        let pieces = names.zip(self.document.forms());
        let limits = |axis: &JointRange| match *axis {
            JointRange::Circle => None,
            JointRange::Interval { lower, upper } => Some([lower, upper]),
        };
        let joint = |k: usize| {
            let joint = &arm.joints[k];
            JointReply { name: joint.name.clone(), unit: joint.unit(), limits: limits(&joint.range) }
        };
        Reply::World(Box::new(WorldReply {
            id,
            base: self.base,
            name: self.scene.scene.workspace().name.clone(),
            robot: format!("{} ({})", arm.name, arm.kind()),
            obstacles: pieces.map(|(name, shape)| PieceReply { name, shape }).collect(),
            start: self.document.start(),
            goal: self.document.goal(),
            clearance: self.scene.scene.workspace().clearance,
            has_steps: self.scene.has_steps(),
            joints: [0, 1].map(joint),
            reach: arm.reach(),
            planners: Method::ALL.iter().map(|method| method.name()).collect(),
            menus: menus::planners(),
            options: begins.then(|| self.host.options.clone()),
            urdf: (begins && self.host.is_whole).then(|| self.host.urdf.text().to_owned()),
            toml: self.document.text().to_owned(),
        }))
    }

    /// Starts again, with the files of the page or with the program's initial ones.
    ///
    /// # Errors
    /// The reason, with the place.
    fn open(&mut self, files: Option<&Files>, spent: Spent) -> Result<(), String> {
        let own = Arc::clone(&self.own);
        let host = match files {
            None => Arc::clone(&own),
            Some(files) => {
                let limited = Interrupt::new().by(Instant::now() + spent.left(own.time).plan);
                let brought = limited.run(|| Host::brought(files.clone(), own.time));
                Arc::new(brought.unwrap_or_else(|_| Err(time_up(own.time)))?)
            }
        };
        *self = Self { own, ..Self::new(host) };
        Ok(())
    }

    /// Loads another text, if it is a world, and plans in it.
    fn load(
        &mut self,
        id: u64,
        text: &str,
        options: &str,
        (interrupt, spent): (&Interrupt, Spent),
        tell: &mut dyn FnMut(Reply),
    ) {
        // Newer requests do not stop it, because they may refer to the text that it loads.
        let limited = Interrupt::new().by(Instant::now() + spent.left(self.host.time).plan);
        let read = limited.run(|| self.host.read(text)).unwrap_or_else(|_| Err(time_up(self.host.time)));
        match read {
            Ok((document, scene)) => {
                (self.document, self.scene) = (document, scene);
                self.base += 1;
                tell(self.world(id, false));
                let ask =
                    Ask { id, base: self.base, is_final: true, state: None, options: options.to_owned(), think: false };
                self.plan(&ask, interrupt, spent, tell);
            }
            Err(error) => tell(Reply::Failed { id, error }),
        }
    }

    /// Plans, and reports the answer; reports nothing if it was interrupted.
    fn plan(&self, ask: &Ask, interrupt: &Interrupt, spent: Spent, tell: &mut dyn FnMut(Reply)) {
        let begun = Instant::now();
        let id = ask.id;
        let mut tell = |mut answer: AnswerReply| {
            (answer.id, answer.is_final) = (id, ask.is_final);
            answer.figures.milliseconds = begun.elapsed().as_secs_f64() * 1e3;
            tell(Reply::Answer(Box::new(answer)));
        };
        if let Ok(answer) = self.answer(ask, interrupt, spent, &mut tell) {
            tell(AnswerReply { done: true, ..answer });
        }
    }

    /// Returns the answer, unless it was interrupted. Reports the configuration space before it searches a path, which
    /// can take long.
    fn answer(
        &self,
        ask: &Ask,
        interrupt: &Interrupt,
        spent: Spent,
        tell: &mut dyn FnMut(AnswerReply),
    ) -> Result<AnswerReply, Interrupted> {
        let (begun, left) = (Instant::now(), spent.left(self.host.time));
        let refused = |about: About, error: String| {
            Ok(AnswerReply { error: Some(error), about: Some(about), ..AnswerReply::default() })
        };
        let options = match Options::parse(&ask.options) {
            Ok(options) => options,
            Err(error) => return refused(About::Options, error),
        };
        let text = match self.text(ask) {
            Ok(text) => text,
            Err(error) => return refused(About::World, error),
        };
        let source = self.host.world.with_text(text.as_str());
        let limited = interrupt.clone().by(begun + left.plan);
        // A picture that replaces an answer must not take much longer than the answer would have.
        let showing = interrupt.clone().by(begun + left.show);
        let late = || Ok(late(self.host.time));
        let loaded = match showing.run(|| self.scene.edited(&self.host.urdf, source)) {
            Ok(Ok(loaded)) => loaded,
            Ok(Err(error)) => return Ok(blocked::unread(&error)),
            Err(stopped) => return or_late(stopped, late),
        };
        let toml = ask.is_final.then_some(text);
        let options = match options.within(&loaded.scene) {
            Ok(options) => options,
            Err(error) => return refused(About::Options, error),
        };
        if loaded.has_steps() {
            let problem = match Problem::of_scene(loaded, &Overrides::default()) {
                Ok(problem) => problem,
                Err(error) => return refused(About::World, error.to_string()),
            };
            return match limited.run(|| result::in_full(&problem, options, &self.contours, ask.think)) {
                Ok(Ok(answer)) => Ok(AnswerReply { toml, ..answer }),
                Ok(Err(error)) => refused(About::Options, error),
                Err(stopped) => Ok(AnswerReply { toml, ..or_late(stopped, late)? }),
            };
        }
        let bare = |scene: &Scene, ends: (Configuration, &[Segment]), status: &str| {
            let shown = showing.run(|| result::bare(scene, ends, status, &self.contours));
            shown.or_else(|stopped| or_late(stopped, || Ok(AnswerReply::default())))
        };
        let asked = loaded.clone().problem(&Overrides::default());
        let problem = match asked.map(Problem::from) {
            Ok(problem) => problem,
            Err(error) => {
                let start =
                    ask.state.as_ref().and_then(|state| self.begin(state.start)).or_else(|| self.document.start());
                let at = start.map_or_else(Configuration::zeros, Configuration::from);
                let refusal = blocked::refusal(&loaded, &error, at);
                let goal: Vec<_> = match loaded.given() {
                    [_, Some(Goal::Joints(q))] => vec![Segment::point(q)],
                    _ => Vec::new(),
                };
                let shown = bare(&loaded.scene, (at, &goal), "not planned")?;
                return Ok(AnswerReply { toml, start, view: shown.view, ..refusal });
            }
        };
        let Some(motion) = problem.motion() else { return refused(About::World, "this world has steps".into()) };
        let (start, goals) = (motion.start(), motion.goals().pieces());
        let places = |answer: AnswerReply| {
            let goals = goals.iter().map(|goal| goal.nearest(Measure::from(Metric::Euclidean), start).into()).collect();
            AnswerReply { start: Some(start.into()), goals, ..answer }
        };
        let (scene, ends) = (problem.scene(), (start, goals));
        if !ask.is_final {
            let planning = interrupt.clone().by(begun + left.drag);
            let plan = || result::quick(&problem, options, &self.contours);
            return match self.pace.tries(|| planning.run(plan)) {
                Some(Ok(Ok(answer))) => Ok(places(answer)),
                Some(Ok(Err(error))) => refused(About::Options, error),
                Some(Err(Interrupted::Set)) => Err(Interrupted::Set),
                None | Some(Err(Interrupted::TimeUp)) => {
                    let reason = Some("not decided while something moves".into());
                    Ok(places(AnswerReply { reason, ..bare(scene, ends, "planning")? }))
                }
            };
        }
        match limited.run(|| result::bare(scene, ends, "planning", &self.contours)) {
            Ok(shown) => tell(places(shown)),
            Err(Interrupted::TimeUp) => {}
            Err(Interrupted::Set) => return Err(Interrupted::Set),
        }
        match limited.run(|| result::in_full(&problem, options, &self.contours, ask.think)) {
            Ok(Ok(answer)) => Ok(AnswerReply { toml, ..places(answer) }),
            Ok(Err(error)) => refused(About::Options, error),
            Err(stopped) => {
                let AnswerReply { verdict, reason, .. } = or_late(stopped, late)?;
                Ok(places(AnswerReply { verdict, reason, toml, ..bare(scene, ends, "unknown")? }))
            }
        }
    }

    /// Returns the result as a file: its name and content.
    ///
    /// # Errors
    /// The reason, for display.
    fn download(
        &self,
        ask: &Ask,
        format: &str,
        interrupt: &Interrupt,
        spent: Spent,
    ) -> Result<(String, Vec<u8>), String> {
        let text = self.text(ask)?;
        if format == "toml" {
            return Ok(("world.toml".into(), text.into_bytes()));
        }
        let options = Options::parse(&ask.options)?;
        let source = self.host.world.with_text(text.as_str());
        let loaded = self.scene.edited(&self.host.urdf, source).map_err(|error| error.to_string())?;
        let limited = interrupt.clone().by(Instant::now() + spent.left(self.host.time).plan);
        match limited.run(|| files::content(loaded, &options, format)) {
            Ok(content) => Ok((format!("plan.{format}"), content?)),
            Err(Interrupted::Set) => Err("the file is not made: the page has changed since".into()),
            Err(Interrupted::TimeUp) => Err(format!("the file is not made: {}", time_up(self.host.time))),
        }
    }

    /// Returns the text of the world that the page shows.
    fn text(&self, ask: &Ask) -> Result<String, String> {
        if ask.base != self.base {
            return Err(format!("the page speaks of world {}, this is world {}", ask.base, self.base));
        }
        match &ask.state {
            None => Ok(self.document.text().to_owned()),
            Some(_) if self.scene.has_steps() => Err("a world with steps is shown, not changed; edit its text".into()),
            Some(state) => self.document.changed(state, self.begin(state.start)),
        }
    }

    /// Returns the joint values of the start.
    fn begin(&self, start: Option<Begin>) -> Option<Pair> {
        Some(match start? {
            Begin::Joints { joints } => joints,
            Begin::Tip { tip, near } => follow(self.scene.scene.arm(), tip.into(), near.into()).into(),
        })
    }
}

/// Returns the answer if the time is up.
fn late(limit: Duration) -> AnswerReply {
    AnswerReply { verdict: Some("unknown"), reason: Some(time_up(limit)), ..AnswerReply::default() }
}

/// Calls `late` if the time is up. Returns the interruption if there is a newer request.
fn or_late<T>(stopped: Interrupted, late: impl FnOnce() -> Result<T, Interrupted>) -> Result<T, Interrupted> {
    if stopped == Interrupted::TimeUp { late() } else { Err(stopped) }
}

fn time_up(limit: Duration) -> String {
    format!("not decided within {} s", limit.as_secs_f64())
}

/// Returns the IK solution within the limits that puts the tip at a place and is nearest to `near`. If there is none,
/// it follows the straight line from the current place of the tip as far as the tip can follow.
fn follow(arm: &Arm, tip: Point, near: Configuration) -> Configuration {
    let reached = |tip: Point| nearest_ik_solution(arm, tip, near);
    if let Some(q) = reached(tip) {
        return q;
    }
    let from = arm.tip_at(near);
    let (mut best, mut low, mut high) = (near, 0.0, 1.0);
    for _ in 0..BISECTIONS {
        let middle = f64::midpoint(low, high);
        match reached(from + (tip - from) * middle) {
            Some(q) => (best, low) = (q, middle),
            None => high = middle,
        }
    }
    best
}

fn nearest_ik_solution(arm: &Arm, tip: Point, near: Configuration) -> Option<Configuration> {
    let topology = arm.topology();
    let values = |q: Configuration, k: usize| within(arm.joints[k].range, arm.joints[k].joint_type.is_revolute(), q[k]);
    let branches = inverse(arm, tip, near).branches.into_iter().flat_map(|q| {
        let second = values(q, 1);
        values(q, 0).into_iter().flat_map(move |a| second.clone().into_iter().map(move |b| Configuration::new(a, b)))
    });
    branches.min_by(|&a, &b| topology.distance(a, near).total_cmp(&topology.distance(b, near)))
}

//! The session of one page: a text that the page edits, and the answers to the page's requests.

use super::Host;
use super::answer::{Answering, Deadlines, TimeSpent, refused, time_up};
use super::blocked;
use super::contours::Contours;
use super::document::Document;
use super::options::Options;
use super::pace::Pace;
use super::protocol::{AnswerReply, Begin, Files, Form, Message, Pair, PlanRequest, Reply, Request};
use super::{explain, files, menus};
use cplan_geometry::Point;
use cplan_interrupt::{Instant, Interrupt, Interrupted};
use cplan_model::space::{Configuration, JointRange};
use cplan_model::{Arm, equivalent_values, inverse};
use cplan_solver::Method;
use cplan_world::{LoadedScene, Overrides, Rules};
use serde_json::json;
use serde_json::value::RawValue;
use std::sync::Arc;

/// Number of bisection steps of a move of the tip towards a place that it cannot reach.
const REACH_BISECTIONS: usize = 24;

/// A page's text, and the world that it describes.
pub struct LiveSession {
    /// The program's initial state.
    own: Arc<Host>,
    /// The page's initial state.
    host: Arc<Host>,
    /// Number of the current text.
    base: u64,
    document: Document,
    scene: LoadedScene,
    contours: Contours,
    pace: Pace,
}

impl LiveSession {
    /// Creates the session of a new page with the host's initial world.
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

    /// Continues a session with the text that a page has, and with its number.
    ///
    /// # Errors
    /// The reason, with its position in the text.
    pub fn resume(&mut self, base: u64, text: &str) -> Result<(), String> {
        let (document, scene) = self.host.read(text)?;
        (self.base, self.document, self.scene) = (base, document, scene);
        Ok(())
    }

    /// Handles a request, and passes the messages for the page to `send`.
    pub fn handle(
        &mut self,
        request: &Request,
        interrupt: &Interrupt,
        spent: TimeSpent,
        send: &mut dyn FnMut(Message),
    ) {
        let mut reply = |reply: Reply| send(Message::from(&reply));
        let deadlines = Deadlines::new(interrupt, spent, self.host.time);
        match request {
            Request::Open { id, files } => reply(match self.open(files.as_ref(), spent) {
                Ok(()) => self.world(*id, true),
                Err(error) => Reply::Failed { id: *id, error },
            }),
            Request::Plan(ask) => self.plan(ask, &deadlines, &mut reply),
            Request::Explain(ask) => match self.explain(ask, &deadlines) {
                Ok(Some(explanation)) => reply(Reply::Explanation { id: ask.id, explanation }),
                // A newer request has arrived.
                Ok(None) => {}
                Err(error) => reply(Reply::Failed { id: ask.id, error }),
            },
            Request::Load { id, text, options } => self.load(*id, text, options, (interrupt, spent), &mut reply),
            Request::Download { ask, format } => match self.download(ask, format, &deadlines) {
                Ok((name, content)) => send(Message::file(ask.id, &name, &content)),
                Err(error) => reply(Reply::Failed { id: ask.id, error }),
            },
        }
    }

    /// Returns the message with the world. `begins` is true if the world was opened, and false if it was loaded as a text.
    pub fn world(&self, id: u64, begins: bool) -> Reply {
        let arm = self.scene.scene.arm();
        let names = self.scene.scene.workspace().obstacles.iter().map(|obstacle| obstacle.name.clone());
        let pieces = names.zip(self.document.forms());
        let piece = |(name, shape): (String, Option<Form>)| {
            let mut piece = json!(shape);
            piece["name"] = json!(name);
            piece
        };
        let joint = |k: usize| {
            let joint = &arm.joints[k];
            let limits = match joint.range {
                JointRange::Circle => None,
                JointRange::Interval { lower, upper } => Some([lower, upper]),
            };
            json!({ "name": joint.name, "unit": joint.unit(), "limits": limits })
        };
        Reply::World(json!({
            "id": id,
            "base": self.base,
            "name": self.scene.scene.workspace().name,
            "robot": format!("{} ({})", arm.name, arm.kind()),
            "obstacles": pieces.map(piece).collect::<Vec<_>>(),
            "start": self.document.start(),
            "goal": self.document.goal(),
            "clearance": self.scene.scene.workspace().clearance,
            "has_steps": self.scene.is_task(),
            "joints": ([0, 1].map(joint)),
            "reach": arm.reach(),
            "planners": Method::ALL.map(Method::name),
            "menus": menus::planners(),
            "options": begins.then_some(&self.host.options),
            "urdf": (begins && self.host.is_whole).then(|| self.host.urdf.text()),
            "toml": self.document.text(),
        }))
    }

    /// Starts again with the files that the page sent, or with the program's initial files.
    ///
    /// # Errors
    /// The reason, with its position in the text.
    fn open(&mut self, files: Option<&Files>, spent: TimeSpent) -> Result<(), String> {
        let own = Arc::clone(&self.own);
        let host = match files {
            None => Arc::clone(&own),
            Some(files) => {
                let deadlines = Deadlines::new(&Interrupt::new(), spent, own.time);
                let brought = deadlines.plan.run(|| Host::from_texts(files.clone(), own.time));
                Arc::new(brought.unwrap_or_else(|_| Err(time_up(own.time)))?)
            }
        };
        *self = Self { own, ..Self::new(host) };
        Ok(())
    }

    /// Replaces the world by another text, and plans in it. An invalid text leaves the old world in place.
    fn load(
        &mut self,
        id: u64,
        text: &str,
        options: &str,
        (interrupt, spent): (&Interrupt, TimeSpent),
        send: &mut dyn FnMut(Reply),
    ) {
        // Newer requests must not stop the loading, because they may refer to the new text.
        let deadlines = Deadlines::new(&Interrupt::new(), spent, self.host.time);
        let read = deadlines.plan.run(|| self.host.read(text)).unwrap_or_else(|_| Err(time_up(self.host.time)));
        match read {
            Ok((document, scene)) => {
                (self.document, self.scene) = (document, scene);
                self.base += 1;
                send(self.world(id, false));
                let ask = PlanRequest {
                    id,
                    base: self.base,
                    is_final: true,
                    state: None,
                    options: options.to_owned(),
                    think: false,
                };
                self.plan(&ask, &Deadlines::new(interrupt, spent, self.host.time), send);
            }
            Err(error) => send(Reply::Failed { id, error }),
        }
    }

    /// Plans, and sends the answer. Sends nothing after an interruption.
    fn plan(&self, ask: &PlanRequest, deadlines: &Deadlines, send: &mut dyn FnMut(Reply)) {
        let begun = Instant::now();
        let id = ask.id;
        let mut send = |mut answer: AnswerReply| {
            (answer.id, answer.is_final) = (id, ask.is_final);
            answer.figures.milliseconds = begun.elapsed().as_secs_f64() * 1e3;
            send(Reply::Answer(Box::new(answer)));
        };
        if let Ok(answer) = self.answer(ask, deadlines, &mut send) {
            send(AnswerReply { done: true, ..answer });
        }
    }

    /// Returns the answer, unless it was interrupted. Sends the configuration space first, because the search for a
    /// path may take long.
    fn answer(
        &self,
        ask: &PlanRequest,
        deadlines: &Deadlines,
        send: &mut dyn FnMut(AnswerReply),
    ) -> Result<AnswerReply, Interrupted> {
        let (options, text) = match (Options::parse(&ask.options), self.text(ask)) {
            (Ok(options), Ok(text)) => (options, text),
            (Err(error), _) => return Ok(refused("options", error)),
            (_, Err(error)) => return Ok(refused("world", error)),
        };
        let source = self.host.world.with_text(text.as_str());
        let loaded = match deadlines.show.run(|| self.scene.with_world_text(&self.host.urdf, source)) {
            Ok(Ok(loaded)) => loaded,
            Ok(Err(error)) => return Ok(refused("world", blocked::without_places(&error))),
            Err(stopped) => return deadlines.timed_out(stopped),
        };
        let options = match options.for_scene(&loaded.scene) {
            Ok(options) => options,
            Err(error) => return Ok(refused("options", error)),
        };
        let toml = ask.is_final.then_some(text);
        let (contours, think) = (&self.contours, ask.think);
        let answering = Answering { options, contours, deadlines, think, toml };
        match loaded.clone().resolve(&Overrides::default(), Rules::Plan) {
            Ok(problem) if problem.task.is_some() => answering.task(&problem.into()),
            Ok(problem) if ask.is_final => answering.full_answer(problem, send),
            Ok(problem) => answering.quick_answer(problem, &self.pace),
            Err(error) if loaded.is_task() => Ok(refused("world", error.to_string())),
            Err(error) => {
                let start = ask.state.as_ref().and_then(|state| self.begin(state.start));
                answering.blocked(&loaded, &error, start.or_else(|| self.document.start()))
            }
        }
    }

    /// Returns the reasons why there is no path. `None` if a newer request has arrived.
    ///
    /// # Errors
    /// The reason why there is no explanation.
    fn explain(&self, ask: &PlanRequest, deadlines: &Deadlines) -> Result<Option<Box<RawValue>>, String> {
        let source = self.host.world.with_text(self.text(ask)?.as_str());
        let loaded =
            self.scene.with_world_text(&self.host.urdf, source).map_err(|error| blocked::without_places(&error))?;
        match deadlines.plan.run(|| explain::explanation(loaded, self.host.time)) {
            Ok(explanation) => explanation.map(Some),
            Err(Interrupted::Set) => Ok(None),
            Err(Interrupted::TimeUp) => Err(format!("There is no explanation yet: {}.", time_up(self.host.time))),
        }
    }

    /// Returns the result as a file, with its name and content.
    ///
    /// # Errors
    /// The reason, for display.
    fn download(&self, ask: &PlanRequest, format: &str, deadlines: &Deadlines) -> Result<(String, Vec<u8>), String> {
        let text = self.text(ask)?;
        if format == "toml" {
            return Ok(("world.toml".into(), text.into_bytes()));
        }
        let options = Options::parse(&ask.options)?;
        let source = self.host.world.with_text(text.as_str());
        let loaded = self.scene.with_world_text(&self.host.urdf, source).map_err(|error| error.to_string())?;
        match deadlines.plan.run(|| files::content(loaded, &options, format)) {
            Ok(content) => Ok((format!("plan.{format}"), content?)),
            Err(Interrupted::Set) => {
                Err("the file is not written, because the page has changed in the meantime".into())
            }
            Err(Interrupted::TimeUp) => Err(format!("the file is not written: {}", time_up(self.host.time))),
        }
    }

    /// Returns the text of the world that the page shows.
    fn text(&self, ask: &PlanRequest) -> Result<String, String> {
        if ask.base != self.base {
            return Err(format!("the request is about world {}, but the server has world {}", ask.base, self.base));
        }
        match &ask.state {
            None => Ok(self.document.text().to_owned()),
            Some(_) if self.scene.is_task() => {
                Err("a world with steps or values of the tool can only be changed in its text".into())
            }
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

/// Returns the IK solution within the limits that puts the tip at a place and is nearest to `near`. If the place is out
/// of reach, the tip moves towards it on a straight line as far as possible.
fn follow(arm: &Arm, tip: Point, near: Configuration) -> Configuration {
    let reached = |tip: Point| nearest_ik_solution(arm, tip, near);
    if let Some(q) = reached(tip) {
        return q;
    }
    let from = arm.tip_at(near);
    let (mut best, mut low, mut high) = (near, 0.0, 1.0);
    for _ in 0..REACH_BISECTIONS {
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
    let values = |q: Configuration, k: usize| {
        equivalent_values(arm.joints[k].range, arm.joints[k].joint_type.is_revolute(), q[k])
    };
    let branches = inverse(arm, tip, near).branches.into_iter().flat_map(|q| {
        let second = values(q, 1);
        values(q, 0).into_iter().flat_map(move |a| second.clone().into_iter().map(move |b| Configuration::new(a, b)))
    });
    branches.min_by(|&a, &b| topology.distance(a, near).total_cmp(&topology.distance(b, near)))
}

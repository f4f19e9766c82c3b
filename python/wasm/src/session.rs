//! The objects that Python holds, and the requests about them.

use crate::answer::{Answer, encoded};
use crate::request::{Corners, Envelope, Id, PlanText, Request, TableContent};
use cplan::output::CSpaceFormat;
use cplan::study::{Journal, Row, Study, Summary, pictures};
use cplan::{Plan, PlanOutput as _, Problem};
use cplan_calls::{Arm, Refusal, World};
use serde_json::json;
use std::collections::BTreeMap;
use std::ffi::OsString;
use std::path::Path;
use std::time::Instant;

type Answered = Result<Answer, Refusal>;

/// A function that receives lines about the progress of long work.
type Progress<'a> = &'a mut dyn FnMut(&str);

/// Everything that Python holds by number.
#[derive(Default)]
pub struct Session {
    last: Id,
    problems: BTreeMap<Id, Problem>,
    plans: BTreeMap<Id, Plan>,
    studies: BTreeMap<Id, Study>,
    journals: BTreeMap<Id, Journal>,
}

fn held<T>(objects: &BTreeMap<Id, T>, id: Id) -> Result<&T, Refusal> {
    objects.get(&id).ok_or_else(|| Refusal::value(format!("there is no object {id}")))
}

impl Session {
    /// Answers a request, given as JSON.
    pub fn answer(&mut self, request: &[u8], progress: Progress) -> Vec<u8> {
        let read = serde_json::from_slice(request).map_err(Refusal::value);
        encoded(read.and_then(|envelope: Envelope| {
            // Files with relative paths are not found from a folder that does not exist, which their errors report.
            let _ = std::env::set_current_dir(&envelope.folder);
            for id in envelope.released {
                let _ = (self.problems.remove(&id), self.plans.remove(&id));
                let _ = (self.studies.remove(&id), self.journals.remove(&id));
            }
            self.handle(envelope.request, progress)
        }))
    }

    fn handle(&mut self, request: Request, progress: Progress) -> Answered {
        match request {
            Request::ReadArm { path, arguments } => arm(&Arm::read(path, arguments)?),
            Request::ArmOfText { text, name } => arm(&Arm::of_text(text, &name)),
            Request::Rr { lengths, width, numbers } => arm(&Arm::rr(lengths, width, &numbers)?),
            Request::Scara { links, stroke, numbers } => arm(&Arm::scara(links, stroke, &numbers)?),
            Request::ArmRestored { arm: restored } => arm(&restored),
            Request::Joints { arm, world } => Answer::json(&arm.joints(&world)?),
            Request::ReadWorld { path } => world(&World::read(path)?),
            Request::WorldOfText { text, name } => world(&World::of_text(text, &name)),
            Request::WorldOfKeys { keys } => world(&World::of_keys(&keys)?),
            Request::WorldRestored { world: restored } => world(&restored),
            Request::Options { options } => {
                cplan_calls::Options::parse(options).map_err(Refusal::value)?;
                Answer::json(&())
            }
            Request::Problem { arm, world, options } => {
                let options = cplan_calls::Options::parse(options).map_err(Refusal::value)?;
                self.keep_problem(cplan_calls::problem(&arm, &world, &options)?)
            }
            Request::ProblemRestored { data } => {
                self.keep_problem(serde_json::from_str(&data).map_err(Refusal::value)?)
            }
            Request::ProblemStored { problem } => Answer::json(held(&self.problems, problem)?),
            Request::Plan { problem, options } => {
                self.keep_plan(cplan_calls::plan(held(&self.problems, problem)?, &options, progress)?)
            }
            Request::PlanRestored { data } => self.keep_plan(cplan_calls::restored(data.as_bytes())?),
            Request::SecondsInRust { problem, options, count } => {
                let (problem, begun) = (held(&self.problems, problem)?, Instant::now());
                for _ in 0..count {
                    std::hint::black_box(cplan::plan(problem, &options.options).map_err(Refusal::value)?);
                }
                Answer::json(&(begun.elapsed().as_secs_f64() / f64::from(count)))
            }
            Request::PlanText { plan, content } => plan_text(held(&self.plans, plan)?, &content),
            Request::Path { plan } => Answer::json(&held(&self.plans, plan)?.waypoints()),
            Request::Trajectory { plan } => Answer::json(&cplan_calls::trajectory(held(&self.plans, plan)?)),
            Request::Save { plan, path } => {
                Answer::json(&held(&self.plans, plan)?.save(path).map_err(Refusal::system)?)
            }
            Request::Check { arm, world, at, clearance } => {
                Answer::text(cplan_calls::check(&arm, &world, &at, clearance)?)
            }
            Request::Slices { arm, world, q1 } => {
                let q1: Vec<f64> = q1.into_iter().map(|value| value.unwrap_or(f64::NAN)).collect();
                Answer::json(&cplan_calls::slices(&arm, &world, &q1)?)
            }
            Request::Verify { arm, world, motion, options, anywhere, unwrap } => {
                Answer::text(cplan_calls::verify(&arm, &world, &motion, &options, anywhere, unwrap)?)
            }
            Request::Compare { arm, world, words } => Answer::json(&cplan_calls::compare(&arm, &world, &words)?),
            Request::ComparedProblems { arm, world, words } => {
                Answer::json(&cplan_calls::compared_problems(&arm, &world, &words)?)
            }
            Request::Explain { arm, world, options, time } => {
                Answer::json(&cplan_calls::explanation(&arm, &world, &options, time)?)
            }
            Request::ExplainDrawn { arm, world, options, page, time } => {
                Answer::text(cplan_calls::explanation_drawn(&arm, &world, &options, page, time)?)
            }
            Request::PenetrationDepth { a, b } => {
                Answer::json(&cplan_calls::penetration_depth(&corners(a), &corners(b))?)
            }
            Request::PolygonTest { a, b } => Answer::json(&cplan_calls::polygon_test(&corners(a), &corners(b))?),
            Request::MinkowskiDifference { a, b } => {
                Answer::json(&cplan_calls::minkowski_difference(&corners(a), &corners(b))?)
            }
            Request::JointRanges { arm, world } => Answer::json(&cplan_calls::joint_ranges(&arm, &world)?),
            Request::JudgeBoxes { arm, world, boxes, colliding } => {
                Answer::json(&cplan_calls::judge_boxes(&arm, &world, &boxes, colliding)?)
            }
            Request::Separate { arm, world, boxes } => Answer::json(&cplan_calls::separate(&arm, &world, &boxes)?),
            Request::Drawn { arm, world, answer } => Answer::text(cplan_calls::drawn(&arm, &world, answer)?),
            Request::Run { arguments } => {
                let arguments = arguments.into_iter().map(OsString::from).collect();
                Answer::json(&cplan::cli::run_with(arguments, None))
            }
            other => self.handle_study(other),
        }
    }

    fn handle_study(&mut self, request: Request) -> Answered {
        match request {
            Request::ReadStudy { path } => self.keep_study(cplan_calls::read_study(path)?),
            Request::StudyOfSources { sources } => self.keep_study(cplan_calls::study_of_sources(&sources)?),
            Request::StudySources { text, arm, world } => Answer::text(cplan_calls::study_sources(text, &arm, &world)?),
            Request::StudyStored { study } => Answer::json(&held(&self.studies, study)?.sources()),
            Request::Values { study, layout } => {
                Answer::json(&cplan_calls::layout_values(held(&self.studies, study)?, layout)?)
            }
            Request::Layout { study, values } => {
                let (arm, world) = cplan_calls::layout(held(&self.studies, study)?, &values)?;
                Answer::json(&(described_arm(&arm), described_world(&world)))
            }
            Request::Rows { study, first, last } => {
                let study = held(&self.studies, study)?;
                let last = last.min(study.count());
                collected(|each| study.rows(first..last.max(first), 1, each))
            }
            Request::Search { study, known, done } => {
                let study = held(&self.studies, study)?;
                collected(|each| study.search(&known, &done, 1, each))
            }
            Request::Table { study, rows, content } => table(held(&self.studies, study)?, &rows, &content),
            Request::OpenJournal { study, path, fresh } => self.open_journal(study, &path, fresh),
            Request::AddRows { journal, rows } => {
                let journal =
                    self.journals.get_mut(&journal).ok_or_else(|| Refusal::value("the journal is removed"))?;
                rows.iter()
                    .try_for_each(|row| journal.add(row))
                    .and_then(|()| journal.flush())
                    .map_err(Refusal::system)?;
                Answer::json(&())
            }
            Request::RemoveJournal { journal } => {
                self.journals.remove(&journal).map_or(Ok(()), Journal::remove).map_err(Refusal::system)?;
                Answer::json(&())
            }
            _ => Err(Refusal::value("this request is not about a study")),
        }
    }

    fn keep_problem(&mut self, problem: Problem) -> Answered {
        self.last += 1;
        let arm = problem.scene().arm();
        let goals: Vec<[f64; 2]> = problem.query().goals().points().map(Into::into).collect();
        let answer = Answer::json(&json!({
            "id": self.last, "kind": arm.kind(), "notes": cplan_calls::notes(&problem),
            "joints": arm.joints.each_ref().map(|joint| &joint.name),
            "start": <[f64; 2]>::from(problem.query().start()), "goals": goals,
        }));
        self.problems.insert(self.last, problem);
        answer
    }

    fn keep_plan(&mut self, plan: Plan) -> Answered {
        self.last += 1;
        let bound = plan.bound();
        let answer = Answer::json(&json!({
            "id": self.last, "status": plan.status().name(), "planner": plan.options().planner.method().name(),
            "reason": plan.reason(), "verdict": plan.verdict(), "notes": cplan_calls::notes(plan.problem()),
            "length": plan.length(), "duration": plan.duration(), "clearance": plan.clearance(),
            "lower_bound": bound.map(|bound| bound.lower),
            "gap": bound.map(|bound| bound.gap()).filter(|gap| gap.is_finite()),
        }));
        self.plans.insert(self.last, plan);
        answer
    }

    fn keep_study(&mut self, study: Study) -> Answered {
        self.last += 1;
        let answer = Answer::json(&json!({
            "id": self.last, "name": study.name, "parameters": cplan_calls::parameter_names(&study),
            "searched": study.searched, "options": study.options(), "count": study.count(),
            "description": cplan_calls::study_description(&study),
        }));
        self.studies.insert(self.last, study);
        answer
    }

    fn open_journal(&mut self, study: Id, path: &Path, fresh: bool) -> Answered {
        let (journal, rows) = Journal::open(path, held(&self.studies, study)?, fresh).map_err(Refusal::system)?;
        self.last += 1;
        self.journals.insert(self.last, journal);
        Answer::json(&json!({ "id": self.last, "rows": rows }))
    }
}

fn arm(arm: &Arm) -> Answered {
    Answer::json(&described_arm(arm))
}

fn world(world: &World) -> Answered {
    Answer::json(&described_world(world))
}

fn described_arm(arm: &Arm) -> serde_json::Value {
    json!({ "data": arm, "text": arm.source().map(|source| source.text()), "description": arm.description() })
}

fn described_world(world: &World) -> serde_json::Value {
    json!({ "data": world, "text": world.source().text(), "description": world.description() })
}

fn corners(corners: Corners) -> Vec<[f64; 2]> {
    corners.into_iter().map(|corner| corner.map(|value| value.unwrap_or(f64::NAN))).collect()
}

fn plan_text(plan: &Plan, content: &PlanText) -> Answered {
    Answer::text(match content {
        PlanText::Summary => plan.summary(),
        PlanText::Json => plan.to_json(),
        PlanText::Svg => plan.svg(),
        PlanText::Html => plan.html(),
        PlanText::CSpaces => CSpaceFormat::Json.text(&plan.cspaces()).unwrap_or_default(),
        PlanText::Stored => serde_json::to_string(plan).map_err(Refusal::value)?,
    })
}

fn table(study: &Study, rows: &[Row], content: &TableContent) -> Answered {
    match content {
        TableContent::Summary => Answer::text(Summary::new(study, rows).to_text(false)),
        TableContent::Json => Answer::text(Summary::new(study, rows).to_json().to_string()),
        TableContent::Csv => Answer::text(study.csv(rows)),
        TableContent::Parquet => study.parquet(rows).map(Answer::Bytes).map_err(Refusal::value),
        TableContent::Html => Answer::text(study.html(rows, &pictures(study, rows))),
        TableContent::Columns => Answer::json(&cplan_calls::table(study, rows)),
    }
}

/// Returns all rows that `work` reports.
fn collected(work: impl FnOnce(&mut dyn FnMut(Row) -> Result<(), ()>) -> Result<(), ()>) -> Answered {
    let mut rows = Vec::new();
    // This callback never fails.
    let _ = work(&mut |row| {
        rows.push(row);
        cplan::interrupt::checkpoint();
        Ok(())
    });
    Answer::json(&rows)
}

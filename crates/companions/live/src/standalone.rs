//! The live page with the program inside. The program has no server, threads or files, and cannot be interrupted.

use super::{Files, Host, LiveSession, Message, Reply, Request, TimeSpent};
use cplan_interrupt::Interrupt;
use serde::Deserialize;
use std::sync::Arc;
use std::time::Duration;

/// A message from a page with the program inside.
#[derive(Debug, Deserialize)]
#[serde(tag = "do", rename_all = "lowercase", deny_unknown_fields)]
enum Order {
    /// Opens these files. The reply is the world.
    Open {
        /// Number of the request. Its answers repeat this number.
        id: u64,
        files: Files,
        /// Time limit of a plan, in seconds.
        seconds: f64,
        /// The text that the page already has. If it is given, there is no reply.
        held: Option<NumberedText>,
    },
    /// Handles a request of the protocol.
    Take {
        request: Request,
        #[serde(default)]
        spent: TimeSpent,
    },
}

/// A text of a world, with its number.
#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
struct NumberedText {
    base: u64,
    text: String,
}

/// The program inside one page.
#[derive(Default)]
pub struct StandalonePage {
    session: Option<LiveSession>,
}

impl StandalonePage {
    /// Executes an order and passes its results to `send`.
    pub fn execute(&mut self, order: &str, send: &mut dyn FnMut(Message)) {
        let failed = |error: String| Message::from(&Reply::Failed { id: 0, error });
        match (serde_json::from_str(order), &mut self.session) {
            (Err(error), _) => send(failed(format!("no order: {error}"))),
            (Ok(Order::Take { request, spent }), Some(session)) => {
                session.handle(&request, &Interrupt::new(), spent, send)
            }
            (Ok(Order::Take { .. }), None) => send(failed("no world is open".into())),
            (Ok(Order::Open { id, files, seconds, held }), place) => {
                let is_new = held.is_none();
                match open_session(files, seconds, held) {
                    Ok(session) => {
                        if is_new {
                            send(Message::from(&session.world(id, true)));
                        }
                        *place = Some(session);
                    }
                    Err(error) => send(Message::from(&Reply::Failed { id, error })),
                }
            }
        }
    }
}

/// Creates a session with its own initial world.
///
/// # Errors
/// The defects of the files.
fn open_session(files: Files, seconds: f64, held: Option<NumberedText>) -> Result<LiveSession, String> {
    let time = Duration::try_from_secs_f64(seconds).map_err(|error| format!("seconds: {error}"))?;
    let host = Host::from_texts(files, time)?;
    let mut session = LiveSession::new(Arc::new(host));
    held.map_or(Ok(()), |NumberedText { base, text }| session.resume(base, &text))?;
    Ok(session)
}

#[cfg(test)]
mod tests {
    use super::*;
    use serde_json::{Value, json};

    const URDF: &str = include_str!("../../../../robots/planar_2r.urdf");
    const WORLD: &str = include_str!("../../../../workspaces/shelf.toml");

    /// Returns the messages that an order produces, as JSON.
    fn replies_to(alone: &mut StandalonePage, order: &Value) -> Vec<Value> {
        let mut replies = Vec::new();
        alone.execute(&order.to_string(), &mut |message| match message {
            Message::Text(text) => replies.push(serde_json::from_str(&text).unwrap()),
            Message::Binary(bytes) => replies.push(json!({ "bytes": bytes.len() })),
        });
        replies
    }

    fn open(held: Value) -> Value {
        let files = json!({ "urdf": URDF, "world": WORLD, "options": "shortest" });
        json!({ "do": "open", "id": 1, "files": files, "seconds": 3600, "held": held })
    }

    fn plan(base: u64, spent: &str) -> Value {
        let ask = json!({ "do": "plan", "id": 7, "base": base, "final": true, "state": null, "options": "shortest" });
        json!({ "do": "take", "request": ask, "spent": spent })
    }

    #[test]
    fn the_page_receives_the_world_and_a_plan() {
        let mut alone = StandalonePage::default();
        let world = replies_to(&mut alone, &open(Value::Null));
        assert_eq!((world.len(), &world[0]["kind"], &world[0]["base"]), (1, &json!("world"), &json!(1)));
        let replies = replies_to(&mut alone, &plan(1, "nothing"));
        let last = replies.last().unwrap();
        assert_eq!(
            (&last["verdict"], &last["done"], &last["certified"]),
            (&json!("found"), &json!(true), &json!(true))
        );
    }

    #[test]
    fn a_session_continues_from_the_text_of_another() {
        let mut alone = StandalonePage::default();
        let other = WORLD.replace("name = \"", "name = \"other ");
        assert!(replies_to(&mut alone, &open(json!({ "base": 5, "text": other }))).is_empty());
        let last = replies_to(&mut alone, &plan(5, "nothing")).pop().unwrap();
        assert!(last["toml"].as_str().unwrap().contains("other ") && last["verdict"] == "found");
    }

    #[test]
    fn late_answers_have_no_plan() {
        let mut alone = StandalonePage::default();
        replies_to(&mut alone, &open(Value::Null));
        let shown = replies_to(&mut alone, &plan(1, "plan")).pop().unwrap();
        assert_eq!((&shown["verdict"], shown["view"].is_object()), (&json!("unknown"), true));
        assert!(shown["reason"].as_str().unwrap().contains("not decided within"));
        let late = replies_to(&mut alone, &plan(1, "all")).pop().unwrap();
        assert_eq!((&late["verdict"], &late["view"], &late["done"]), (&json!("unknown"), &Value::Null, &json!(true)));
    }

    #[test]
    fn invalid_orders_are_reported() {
        let mut alone = StandalonePage::default();
        let error = |replies: Vec<Value>| replies[0]["error"].as_str().unwrap().to_owned();
        assert_eq!(error(replies_to(&mut alone, &plan(1, "nothing"))), "no world is open");
        assert!(error(replies_to(&mut alone, &json!({ "do": "sing" }))).starts_with("no order: "));
        let mut wrong = open(Value::Null);
        wrong["files"]["world"] = json!("image = \"den.yaml\"");
        assert!(error(replies_to(&mut alone, &wrong)).contains("world.toml"));
    }
}

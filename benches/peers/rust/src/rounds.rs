//! Runs contenders in turn, so that other load on the machine affects all of them alike.

use serde_json::{Map, Value, json};
use std::hint::black_box;
use std::time::Instant;

/// Milliseconds of each contender, one list per name.
#[derive(Default)]
pub struct Rounds(Map<String, Value>);

impl Rounds {
    /// Runs `work` and adds its time to the list of `name`.
    pub fn time<T>(&mut self, name: &str, work: impl FnOnce() -> T) -> T {
        let start = Instant::now();
        let result = black_box(work());
        let milliseconds = start.elapsed().as_secs_f64() * 1e3;
        let list = self.0.entry(name).or_insert_with(|| json!([]));
        list.as_array_mut().expect("lists only").push(json!(milliseconds));
        result
    }

    pub fn into_json(self) -> Value {
        Value::Object(self.0)
    }
}

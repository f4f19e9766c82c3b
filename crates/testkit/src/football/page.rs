//! The page that replays a match, in one file that loads nothing.

use super::play::{BALL, BODY, CELLS, DEPTH, Frame, INFLUENCE, MOUTH, PER_CM, RATE};
use cplan::field::{Cell, MovingField};
use serde_json::{Value, json};

/// Number of frames from one picture of the fields to the next (`EVERY`), and number of cells from one arrow to the next.
const EVERY: usize = 4;
const APART: usize = 3;
/// Number of points of a curve that are skipped between two that are shown.
const SPARSE: usize = 6;
/// Letters for the directions of arrows. Each stands for an equal step of a turn. A dot stands for no direction.
const TURN: &[u8] = b"ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+-";
/// Letters per power of ten for the values of a field, which are from 0 to 1. A letter stands for the logarithm of a value's
/// distance from 1.
const A_POWER: f64 = 4.0;

/// A recorded match.
#[derive(Default)]
pub struct Film {
    frames: Vec<Value>,
    fields: Vec<Value>,
}

impl Film {
    /// Adds a frame. `fields` guide the robots in the frame, and `score` is the score after it.
    pub fn add_frame(&mut self, frame: &Frame, fields: &[MovingField], score: [usize; 2]) {
        let places = frame.robots.iter().chain([&frame.ball]).flatten().map(|&x| rounded(x));
        self.frames.push(json!([places.collect::<Vec<_>>(), frame.seekers, score]));
        if (self.frames.len() - 1).is_multiple_of(EVERY) {
            let ways = frame.robots.iter().enumerate().map(|(robot, &at)| streamline(&fields[robot.min(3)], at));
            let shown: Vec<Value> = fields.iter().map(picture).collect();
            let drifts = frame.moments.iter().flat_map(|moment| &moment.robots).map(|robot| robot.drift.map(rounded));
            self.fields.push(json!([shown, ways.collect::<Vec<_>>(), drifts.collect::<Vec<_>>()]));
        }
    }

    /// Returns the page.
    pub fn page(&self, seed: u64) -> String {
        let data = json!({
            "cells": CELLS, "depth": DEPTH, "mouth": MOUTH, "body": BODY, "ball": BALL, "influence": INFLUENCE, "perCm": PER_CM,
            "rate": RATE, "every": EVERY, "apart": APART, "frames": self.frames, "fields": self.fields, "seed": seed,
        });
        let data = data.to_string().replace('<', "\\u003c");
        include_str!("page.html").replace("/*data*/", &data)
    }
}

/// Encodes directions and values as letters, for every third cell, row by row.
fn picture(field: &MovingField) -> Value {
    let (mut arrows, mut values) = (String::new(), String::new());
    let shown = |n: usize| (1..n).step_by(APART);
    for i in shown(CELLS[0]) {
        for j in shown(CELLS[1]) {
            let cell = i * CELLS[1] + j;
            let letter = match (field.domain().kinds()[cell], field.direction([i as f64, j as f64])) {
                (Cell::Free, Some([x, y])) => {
                    let turn = y.atan2(x) / std::f64::consts::TAU;
                    TURN[(turn.rem_euclid(1.0) * TURN.len() as f64) as usize % TURN.len()]
                }
                _ => b'.',
            };
            arrows.push(char::from(letter));
            let depth = -(1.0 - field.values()[cell]).max(1e-15).log10();
            values.push(char::from(TURN[((A_POWER * depth.max(0.0)) as usize).min(TURN.len() - 1)]));
        }
    }
    json!([arrows, values])
}

/// Returns the curve that a robot would follow in a static world.
fn streamline(field: &MovingField, at: [f64; 2]) -> Vec<f64> {
    let is_free = field.direction(at).is_some();
    let way = is_free.then(|| field.follow(at).ok()).flatten();
    let points = way.map(|way| way.points).unwrap_or_default();
    let last = points.last().copied();
    points.into_iter().step_by(SPARSE).chain(last).flatten().map(rounded).collect()
}

fn rounded(x: f64) -> f64 {
    (100.0 * x).round() / 100.0
}

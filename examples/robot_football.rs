//! Robots of a team, their shared or own fields, and the cost of computing these again for each frame: section 3.4 and
//! chapters 5 and 6 of M. Oliveira da Silva, *Campos potenciais modificados aplicados ao controle de múltiplos robôs*
//! (ICMC-USP 2011).
//!
//! ```text
//! cargo run --release --example robot_football [-- --frames 600] [--seed 1] [--page match.html]
//! ```
//!
//! The program plays a match, prints published figures beside ours, and writes a page that replays it.

use cplan_testkit::football::{measure, page, play};
use std::error::Error;
use std::process::ExitCode;

/// The options on the command line.
struct MatchOptions {
    frames: usize,
    seed: u64,
    page: Option<String>,
}

fn parse_options(mut arguments: impl Iterator<Item = String>) -> Result<MatchOptions, String> {
    let mut asked = MatchOptions { frames: 600, seed: 1, page: None };
    while let Some(key) = arguments.next() {
        let value =
            arguments.next().ok_or_else(|| format!("{key} needs a value: --frames N, --seed N, --page FILE"))?;
        let number =
            |value: &str| value.parse::<u32>().map_err(|_| format!("{key} needs a whole number, not {value:?}"));
        match key.as_str() {
            "--frames" => asked.frames = number(&value)? as usize,
            "--seed" => asked.seed = u64::from(number(&value)?),
            "--page" => asked.page = Some(value),
            _ => return Err(format!("{key:?} is no option: there are --frames N, --seed N, --page FILE")),
        }
    }
    if asked.frames == 0 { Err("--frames must be at least 1".into()) } else { Ok(asked) }
}

fn main() -> Result<ExitCode, Box<dyn Error>> {
    let asked = match parse_options(std::env::args().skip(1)) {
        Ok(asked) => asked,
        Err(message) => {
            eprintln!("{message}");
            return Ok(ExitCode::from(2));
        }
    };
    let mut game = play::Match::new(asked.seed)?;
    let (mut frames, mut film) = (Vec::new(), page::Film::default());
    for _ in 0..asked.frames {
        let frame = game.next_frame()?;
        film.add_frame(&frame, game.fields(), game.score);
        frames.push(frame);
    }
    println!("blue {} : {} red", game.score[0], game.score[1]);
    println!("ways cut short by another robot: {} of blue, {} of red", game.refused[0], game.refused[1]);
    println!("no direction: {} of blue, {} of red\n", game.lost[0], game.lost[1]);
    if let Some(path) = asked.page {
        std::fs::write(&path, film.page(asked.seed))
            .map_err(|e| format!("{path}: {e}; name a file that can be written"))?;
    }
    measure::report(&frames)?;
    Ok(ExitCode::SUCCESS)
}

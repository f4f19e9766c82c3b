//! The search for a placement of the line.

use super::{FollowArgs, refused};
use crate::cli::failure::Failure;
use crate::cli::progress::Progress;
use crate::model::Scene;
use crate::text::length_down;
use cplan_follow::{Fitted, Settings, fit};
use cplan_toolpath::{Placement, Toolpath};
use serde_json::{Value, json};

/// Number of turns that are tried.
const TURNS: u32 = 36;

/// The freedom of the search for a placement.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Freedom {
    /// The position of the line.
    Move,
    /// The position and the angle.
    Turn,
}

/// The placement found, with the options that repeat it.
pub struct Placed {
    placement: Placement,
    /// Approximate distance of the line from places that the arm cannot reach, metres.
    room: f64,
    /// The options that state the placement.
    pub options: String,
}

/// Searches for a placement of a line.
///
/// # Errors
/// An angle on the command line although the angle is searched for, and the errors of following the line.
pub fn search(
    args: &FollowArgs,
    freedom: Freedom,
    scene: &Scene,
    path: &Toolpath,
    settings: &Settings,
) -> Result<(Fitted, Option<Placed>), Failure> {
    let stated = args.stated_placement();
    if freedom == Freedom::Turn && stated.turn != 0.0 {
        return Err(Failure::Usage("--fit=turn searches for the angle itself; leave out --turn, or use --fit".into()));
    }
    let degrees = |k: u32| f64::from(360 / TURNS * k);
    let turns: Vec<f64> = match freedom {
        Freedom::Move => vec![stated.turn],
        Freedom::Turn => (0..TURNS).map(|k| degrees(k).to_radians()).collect(),
    };
    let progress = Progress::new(turns.len(), "turns", true, args.print.quiet);
    progress.begin("the line", "placement");
    let fitted = fit(scene, path, &stated, &turns, settings, &mut || {
        progress.done();
        progress.begin("the line", "placement");
    });
    progress.end();
    let fitted = fitted.map_err(refused)?;
    let placed = fitted.room.map(|room| {
        let Placement { turn, shift: [x, y], scale, .. } = fitted.placement;
        let shown = (0..TURNS).map(degrees).find(|shown| freedom == Freedom::Turn && shown.to_radians() == turn);
        let turn_option = match shown {
            _ if turn == 0.0 => String::new(),
            Some(shown) => format!("--turn {shown}deg "),
            None => format!("--turn {turn} "),
        };
        let unit = args.unit.map_or_else(String::new, |unit| format!("--unit {unit} "));
        let scale = if scale == 1.0 { String::new() } else { format!("--scale {scale} ") };
        let options = format!("{unit}{scale}{turn_option}--move {x},{y}");
        Placed { placement: fitted.placement, room, options }
    });
    Ok((fitted, placed))
}

impl Placed {
    /// Describes the placement.
    pub fn describe(&self) -> String {
        let Self { options, room, .. } = self;
        format!("{options}; about {} of room to places that the arm cannot reach", length_down(*room))
    }

    /// Returns the placement as JSON.
    pub fn to_json(&self) -> Value {
        let Placement { turn, shift, scale, .. } = self.placement;
        json!({ "scale": scale, "turn": turn, "move": shift, "room": self.room, "options": self.options })
    }
}

//! Places in rows and columns, objects on them, and frames that move all of them.

use super::errors::all_refused;
use super::{LoadedTask, step_texts, task_of};
use cplan::input::Overrides;
use cplan::model::Item;
use std::f64::consts::FRAC_PI_2;

/// A pallet that is turned by a right angle, with parts on it, and a tray.
const CELL: &str = r#"[robot]
payload = "level"
[start]
joints = [0.0, 0.5]
[[obstacle]]
name = "post"
circle = { center = [-1.0, 1.0], radius = 0.1 }
[[pallet]]
name = "store"
rows = 2
columns = 3
pitch = [0.1, 0.2]
at = [0.5, 0.75]
angle = 1.5707963267948966
[[pallet]]
name = "tray"
rows = 3
columns = 2
pitch = [0.1, -0.125]
at = [0.75, -0.5]
[[object]]
name = "part"
pallet = "store"
angle = 0.25
circle = { center = [0.01, 0], radius = 0.02 }
grasp = [0.01, 0.0]
"#;

const TRANSFER: &str = "[[step]]\ntransfer = { objects = \"part\", to = \"tray\" }\ndwell = 0.5\nspeed = 0.5\n";

#[test]
fn objects_lie_on_the_places_of_a_pallet() {
    let loaded = task_of(&format!("{CELL}{TRANSFER}"), &Overrides::default()).unwrap();
    let expected = [
        ("part 1,1", [0.5, 0.75]),
        ("part 1,2", [0.5, 0.85]),
        ("part 1,3", [0.5, 0.95]),
        ("part 2,1", [0.3, 0.75]),
        ("part 2,2", [0.3, 0.85]),
        ("part 2,3", [0.3, 0.95]),
    ];
    assert_eq!(loaded.task.objects.len(), expected.len());
    for (object, (name, [x, y])) in loaded.task.objects.iter().zip(expected) {
        assert_eq!(object.name, name);
        let at = object.at.translation;
        assert!((at.x - x).hypot(at.y - y) < 1e-12, "{name}: {at}");
        assert!((object.at.rotation.angle() - FRAC_PI_2 - 0.25).abs() < 1e-12, "{name}");
    }
}

#[test]
fn a_transfer_is_its_picks_and_places_written_out() {
    let places = [[0.75, -0.5], [0.85, -0.5], [0.75, -0.625], [0.85, -0.625], [0.75, -0.75], [0.85, -0.75]];
    let parts = ["1,1", "1,2", "1,3", "2,1", "2,2", "2,3"];
    let names = ["1,1", "1,2", "2,1", "2,2", "3,1", "3,2"];
    for order in ["fixed", "free"] {
        let task = format!("[task]\norder = \"{order}\"\n");
        let short = task_of(&format!("{CELL}{TRANSFER}{task}"), &Overrides::default()).unwrap();
        let written = |place: &dyn Fn(usize) -> String| {
            let pair = |i: usize| {
                let pace = "dwell = 0.5\nspeed = 0.5\n";
                format!("[[step]]\npick = \"part {}\"\n{pace}[[step]]\nplace = {{ {} }}\n{pace}", parts[i], place(i))
            };
            let steps: String = (0..6).map(pair).collect();
            task_of(&format!("{CELL}{steps}{task}"), &Overrides::default()).unwrap()
        };
        let on = written(&|i| format!("on = \"tray {}\"", names[i]));
        let at = written(&|i| format!("at = [{}, {}]", places[i][0], places[i][1]));
        assert_eq!(step_texts(&short), step_texts(&on));
        assert_eq!(step_texts(&short), step_texts(&at));
        let same = |a: &LoadedTask, b: &LoadedTask| {
            let steps = a.task.steps().zip(b.task.steps());
            steps.for_each(|(a, b)| {
                assert_eq!(
                    (&a.action, a.number, a.cycle, a.speed, a.dwell),
                    (&b.action, b.number, b.cycle, b.speed, b.dwell)
                );
            });
            assert_eq!((a.task.steps().count(), b.task.steps().count()), (12, 12));
        };
        same(&short, &on);
        let is_group = matches!(short.task.items[..], [Item::AnyOrder(_)]);
        assert_eq!(is_group, order == "free");
    }
}

#[test]
fn a_transfer_goes_with_other_steps_of_its_group() {
    let more = "[[object]]\nname = \"lid\"\ncircle = { center = [0, 0], radius = 0.02 }\nat = [0.5, 1.2]\n\
                [task]\norder = \"free\"\n[[step]]\npick = \"lid\"\n[[step]]\nplace = { at = [1.2, 0.0] }\n";
    let loaded = task_of(&format!("{CELL}{more}{TRANSFER}"), &Overrides::default()).unwrap();
    let Item::AnyOrder(pairs) = &loaded.task.items[0] else { panic!("one group") };
    assert_eq!(pairs.len(), 7);
    assert_eq!(pairs.iter().flatten().map(|step| step.number).collect::<Vec<_>>(), (1..=14).collect::<Vec<_>>());
}

#[test]
fn invalid_pallets_are_refused() {
    let table = r#"
rows = 2 => rows = 0 => line 10, column 8 ... pallet "store": rows must be 1 or more, is 0 ... hint: 
columns = 3 => columns = -3 => line 11 ... columns must be 1 or more, is -3 ... hint: 
rows = 2 => rows = 20000 => line 10 ... has 60000 places (at most 10000) ... hint: 
" => rows = 9223372036854775807 => line 10 ... places (at most 10000)
" => rows = 2.5 => line 10
pitch = [0.1, 0.2] => pitch = [0.1, 0.0] => line 12 ... from one row to the next is 0 ... hint: 
" => pitch = [0.0, 0.2] => line 12 ... from one column to the next is 0
" => pitch = 0.1 => line 12
" => pitch = [0.1, nan] => line 12 ... not a finite number
pitch = [0.1, 0.2]\n => nothing => line 8 ... missing key `pitch`
angle = 1.5 => angel = 1.5 => line 14 ... unknown key `angel`
name = "tray" => name = "store" => line 16, column 8 ... a second pallet is named "store" ... hint: 
pallet = "store" => pallet = "stor" => there is no pallet "stor" ... hint: the pallets are "store", "tray"
" => pallet = "store"\nat = [1, 1] => either `at` or `pallet`, but has both ... hint: 
pallet = "store"\n => nothing => either `at` or `pallet`, but has neither ... hint: 
name = "post" => name = "part" => an obstacle is named "part" ... hint: 
" => name = "part 2,3" => an obstacle is named "part ... hint: 
[[step]]\n => TWICE\nat = [1, 1]\n[[step]]\n => a second object is named "part"
" => TWICE\npallet = "tray"\n[[step]]\n => a second object is named "part 1,1"
"#;
    let twice = "[[object]]\\nname = \"part\"\\ncircle = { center = [0, 0], radius = 0.01 }";
    all_refused(&format!("{CELL}{TRANSFER}"), &table.replace("TWICE", twice));
}

#[test]
fn invalid_transfers_and_places_are_refused() {
    let table = r#"
TRANSFER => transfer = { objects = "pat", to = "tray" }
    => no objects "pat" on a pallet ... hint: the objects on pallets are "part"
" => transfer = { objects = "part 1,1", to = "tray" } => no objects "part 1,1" ... hint: "part 1,1" is a single object
" => transfer = { objects = "part", to = "try" } => no pallet "try" ... hint: the pallets are
" => transfer = { objects = "part" } => missing key `to`
" => transfer = { objects = "part", to = "tray", at = [0, 0] } => unknown key `at`
" => transfer = "part" => a table
" => pick = "part" => there is no object "part" ... hint: 6 of this name are on a pallet ... "part 1,1" ... transfer = 
" => pick = "part 9,1" => no object "part 9,1" ... hint: the objects are "part"
" => pick = "part 1,1"\nTRANSFER => exactly one of ... but has 2
" => grasp = [0, 0]\nTRANSFER => only a pick has a `grasp` ... hint: 
" => PICK\nplace = { on = "tray 4,1" } => no place "tray 4,1" ... rows 1 to 3 and columns 1 to 2
" => PICK\nplace = { on = "tray" } => no place "tray" ... "tray 1,1" to "tray 3,2"
" => PICK\nplace = { on = "desk 1,1" } => no place "desk 1,1" ... hint: the pallets are "store", "tray"
" => PICK\nplace = { on = "tray 1,1", at = [0, 0] } => either `at` or `on`, but has both ... hint: 
" => PICK\nplace = { angle = 1.0 } => either `at` or `on`, but has neither ... hint: 
columns = 2\n => columns = 3\n => 6 objects "part" ... "tray" has 9 places ... hint: 
"#;
    let table = table.replace("TRANSFER", "transfer = { objects = \"part\", to = \"tray\" }");
    all_refused(&format!("{CELL}{TRANSFER}"), &table.replace("PICK", "pick = \"part 1,1\"\\n[[step]]"));
}

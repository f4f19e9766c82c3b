//! Invalid objects and steps. They are refused with the place, the defect, and a hint.

use super::{CELL, task_of, with_world};
use crate::{changes, fits, with_change};
use cplan::input::{Inspection, Overrides, Rules, inspect, load};

/// Steps for the cell. The first one is on line 24.
const STEPS: &str = r#"[[step]]
pick = "part"
[[step]]
place = { at = [0.5, 1.5] }
[[step]]
pick = "cup"
[[step]]
place = { at = [0.5, 1.0], angle = 1.5 }
[[step]]
move = { joints = [0.1, 0.2] }
"#;

fn valid_world() -> String {
    format!("{CELL}{STEPS}")
}

/// Returns the number of steps of a task whose world must be valid.
fn steps_of(world: &str, overrides: &Overrides) -> usize {
    task_of(world, overrides).unwrap_or_else(|error| panic!("{error}")).task.steps().count()
}

#[track_caller]
pub fn refused(world: &str, overrides: &Overrides, pattern: &str) {
    fits(&task_of(world, overrides).expect_err("should be refused").to_string(), pattern);
}

/// Checks that a world is refused after each change of a table, with a message about a place in it.
#[track_caller]
pub fn all_refused(world: &str, table: &str) {
    for row in changes(table) {
        let pattern = format!("world.toml: line  ... ^ ... {}", row[2]);
        refused(&with_change(world, &row[0], &row[1]), &Overrides::default(), &pattern);
    }
}

#[test]
fn the_healthy_cell_loads() {
    assert_eq!(task_of(&valid_world(), &Overrides::default()).unwrap().task.items.len(), 5);
}

#[test]
fn invalid_objects_are_refused() {
    let table = r#"
name = "part"\n => nothing => line 9 ... missing key `name`
at = [1.0, 1.0]\n => nothing => line 9 ... needs either `at` or `pallet`, but has neither ... hint: 
at = [1.0, 1.0] => at = [1.0] => line 12, column 6 ... object "part", at: expected two numbers
" => at = [1.0, inf] => line 12, column 12 ... not a finite number
angle = 0.5 => angle = nan => line 19 ... object "cup", angle ... not a finite number
" => angel = 0.5 => line 19 ... unknown key `angel`
POLYGON => nothing => line 9 ... object "part" needs exactly one shape, but has 0 ... hint: give it a polygon
" => polygon = [[0, 0], [1, 0], [1, 1]]\ncircle = { center = [0, 0], radius = 1 } => line 9 ... has 2
" => polygon = [[0, 0], [1, 1], [1, 0], [0, 1]] => line 11, column 11 ... not a simple polygon ... hint: 
" => polyline = [[0, 0], [1, 1]] => line 11 ... unknown key `polyline`
radius = 0.03 => radius = 0 => line 17 ... object "cup": the radius must be positive
height = [0.0, 0.1] => height = [0.1, 0.0] => line 20 ... empty ... hint: write the lower end first
lift = 0.05 => lift = -0.05 => line 21 ... object "cup": lift must not be negative
payload = "level" => payload = "stiff" => line 22 ... "rigid" or "level", not "stiff" ... hint: 
[robot] => [robot]\npayload = "up" => line 3 ... "rigid" or "level", not "up"
grasp = [0.01, 0.0] => grasp = 0.01 => line 23, column 9
renew = true => renew = "yes" => line 14 ... boolean
name = "cup" => name = "part" => line 16, column 8 ... a second object is named "part" ... hint: 
" => name = "table" => line 16, column 8 ... an obstacle is named "table" ... hint: 
[[object]]\n => [[obstacle]]\nname = "cup"\ncircle = { center = [9, 9], radius = 0.1 }\nmotion = { velocity = [0.1, 0] }\n
    [[object]]\n => line 20, column 8 ... an obstacle is named "cup" ... hint: 
supports = ["table"] => supports = ["tabel"] => line 13, column 13 ... no obstacle and no object "tabel"
    ... hint: there are "table", "cup", "part"
" => supports = ["part"] => line 13, column 12 ... "part" cannot rest on itself ... hint: remove it
velocity = 6.0 => velocity = 0 => line 3 ... [robot] wrist: velocity must be positive, is 0 ... hint: 
acceleration = 60.0 => acceleration = -1 => line 3 ... acceleration must be positive
" => jerk = -1 => line 3 ... jerk must be positive
" => snap = 60.0 => line 3 ... unknown key `snap`
velocity = 6.0,  => nothing => line 3 ... missing key `velocity`
"#;
    let polygon = "polygon = [[-0.02, -0.02], [0.02, -0.02], [0.02, 0.02], [-0.02, 0.02]]";
    all_refused(&valid_world(), &table.replace("POLYGON", polygon));
}

#[test]
fn steps_without_exactly_one_action_are_refused() {
    let table = r#"
pick = "part" => nothing => line 24 ... exactly one of `pick`, `place`, `move`, `follow`, `transfer` and `steps`
    ... but has 0 ... hint: 
" => pick = "part"\nmove = { tip = [1, 1] } => line 24 ... but has 2
" => pick = "part"\nfollow = { points = [[1, 1], [1, 0]] } => line 24 ... but has 2
" => grab = "part" => line 25, column 1 ... unknown key `grab`
" => pick = 1 => line 25, column 8
" => pick = "prat" => line 25, column 8 ... no object "prat" ... hint: the objects are "cup", "part"
" => pick = "table" => line 25 ... no object "table" ... hint: "table" is an obstacle ... [[object]]
" => pick = "part"\ngrasp = [0, 0, 0] => line 26, column 9 ... expected two numbers, found 3
" => pick = "part"\nspeed = 0 => line 26, column 9 ... speed must be greater than 0 ... hint: 
" => pick = "part"\nspeed = 1.5 => line 26 ... at most 1, is 1.5
" => pick = "part"\nspeed = nan => line 26 ... not a finite number
" => pick = "part"\ndwell = -1 => line 26, column 9 ... dwell must not be negative
" => pick = "part"\nrepeat = 2 => line 26, column 10 ... only a group of steps can be repeated ... hint: 
" => pick = "part"\norder = "free" => line 26, column 9 ... only a group of steps has an `order`
" => steps = [] => line 24 ... no steps ... hint: 
place = { at = [0.5, 1.5] } => PLACE\ngrasp = [0, 0] => line 28, column 9 ... only a pick has a `grasp`
" => PLACE\nsupports = [] => line 28 ... only a pick has `supports` ... hint: remove the key; a place has the form place = { at = [x, y], supports = 
" => place = [0.5, 1.5] => line 27, column 9 ... sequence, expected a table: { key = value }
" => place = { angle = 1 } => line 26 ... either `at` or `on`, but has neither
" => place = { at = [0.5, 1.5], speed = 1 } => line 27 ... unknown key `speed`
move = { joints = [0.1, 0.2] } => move = [0.1, 0.2] => line 33, column 8 ... expected a table
" => move = {} => line 33, column 8 ... the move needs either ... neither
"#;
    all_refused(&valid_world(), &table.replace("PLACE", "place = { at = [0.5, 1.5] }"));
}

#[test]
fn invalid_tasks_and_groups_are_refused() {
    let table = r#"
[[obstacle]] => [task]\nrepeat = 0\n[[obstacle]] => line 7, column 10 ... must be 1 or more, is 0 ... hint: 
" => [task]\nrepeat = -3\n[[obstacle]] => line 7 ... must be 1 or more, is -3
" => [task]\nrepeat = 1.5\n[[obstacle]] => line 7 ... expected a whole number
" => [task]\nrepeat = 20001\n[[obstacle]] => line 7, column 10 ... the repetitions make 100005 steps (at most 100000) ... hint: 
" => [task]\nrepeat = 9223372036854775807\n[[obstacle]] => line 7 ... at most 100000
" => [task]\norder = "any"\n[[obstacle]] => line 7, column 9 ... "fixed" or "free", not "any"
" => [task]\norder = "free"\n[[obstacle]] => line 35 ... this step must be a pick ... hint: 
" => [task]\nspeed = 2\n[[obstacle]] => line 7 ... speed must be
" => [task]\ncount = 2\n[[obstacle]] => line 7 ... unknown key `count`
"#;
    all_refused(&valid_world(), table);
    let none = Overrides::default();
    let single = format!("{CELL}[step]\npick = \"part\"\n");
    refused(&single, &none, "line 24 ... one table, expected a list of tables: [[...]] ... ^");
    refused(&format!("{CELL}[task]\nrepeat = 2\n"), &none, "line 24 ... there are none ... hint: ");

    let pair = "{ pick = \"part\" }, { place = { at = [0.5, 1.5] } }";
    for (steps, pattern) in [
        ("{ pick = \"part\" }", "this pick has no place"),
        ("{ pick = \"part\" }, { pick = \"cup\" }", "column 38 ... must be a place"),
        (&format!("{{ steps = [{pair}] }}"), "must be a pick"),
        (&format!("{pair}, {pair}"), "object \"part\" is picked twice"),
    ] {
        let world = format!("{CELL}[[step]]\norder = \"free\"\nsteps = [{steps}]\n");
        refused(&world, &none, &format!("line 26, column ... hint:  ... {pattern}"));
    }

    let deep = format!("{CELL}[[step]]\n{}pick = \"part\"{}\n", "steps = [{ ".repeat(2000), " }]".repeat(2000));
    refused(&deep, &none, "world.toml: line 25 ... recurs");
    let nested = "[[step.steps]]\nrepeat = 1000\n[[step.steps.steps]]\nrepeat = 1000\n[[step.steps.steps.steps]]\n";
    let many = format!("{CELL}[[step]]\nrepeat = 1000\n{nested}move = {{ joints = [0, 0] }}\n");
    refused(&many, &none, "line 27, column 10 ... 1000000 steps");
}

#[test]
fn contradictory_sequences_are_refused() {
    let none = Overrides::default();
    let table = r#"
[[step]]\nplace = { at = [0.5, 1.5] }\n => nothing
    => line 27, column 8 ... step 2 picks "cup" while "part" is carried ... hint: place
[[step]]\npick = "part"\n => nothing
    => line 25, column 16 ... step 1 places an object, but the tool carries none ... hint: pick
wrist = { velocity = 6.0, acceleration = 60.0 } => nothing
    => line 31 ... "cup" must be turned from 0.5 to 1.5 rad ... no wrist ... hint: add [robot] wrist = { velocity = 
place = { at = [0.5, 1.5] } => place = { at = [0.5, 1.5], angle = 1.0 }
    => line 27, column 36 ... "part" is held rigidly ... hint: write payload = "level"
" => place = { at = [0.5, 1.5], supports = ["table", "part"] } => line 27, column 39 ... "part" cannot rest on itself
" => place = { at = [0.5, 1.5], supports = ["desk"] } => line 27, column 40 ... no object "desk"
"#;
    all_refused(&valid_world(), table);
    let pick = "[[step]]\npick = \"part\"\n";
    let end = "line 27, column 10 ... the arm carries nothing at their beginning and \"part\" ... hint: ";
    refused(&format!("{CELL}{pick}[task]\nrepeat = 2\n"), &none, end);
    let inner = "[[step]]\nrepeat = 3\nsteps = [{ place = { at = [0.5, 1.5] } }, { pick = \"part\" }]\n";
    let carrying = format!("{CELL}{pick}{inner}");
    refused(&carrying, &none, "line 27, column 10 ... \"part\" is still carried when it is renewed");
    assert_eq!(steps_of(&carrying.replace("renew = true\n", ""), &none), 7);
}

#[test]
fn an_orientation_is_that_of_the_last_place() {
    let again = "[[step]]\npick = \"cup\"\n[[step]]\nplace = { at = [0.6, 1.0], angle = 0.5 }\n";
    let once = "angle = 1.5 }\n";
    let world = valid_world().replace(once, &format!("{once}{again}"));
    assert_eq!(steps_of(&world, &Overrides::default()), 7);
    // Without a wrist, the first turn fails. Without the first turn, the second would be none.
    let still = world.replace("wrist = { velocity = 6.0, acceleration = 60.0 }", "").replace(", angle = 1.5", "");
    assert_eq!(steps_of(&still, &Overrides::default()), 7);
}

#[test]
fn infeasible_steps_are_refused() {
    let table = r#"
move = { joints = [0.1, 0.2] } => move = { joints = [0.1, 3.2] }
    => line 33, column 19 ... step 5 is outside the joint limits ... "elbow" at 3.2 rad ... hint: 
" => move = { tip = [1.0, 1.6] }
    => line 33, column 16 ... step 5: (1, 1.6) m is out of reach ... from 0.2000 to 1.8000 m ... hint: 
" => move = { tip = [0.0, 0.1] } => out of reach
" => move = { tip = [0.21, 0.0] } => no IK solution ... within the joint limits ... "elbow" ... hint: 
at = [1.0, 1.0] => at = [5.0, 1.0] => line 25, column 8 ... step 1: (5, 1) m is out of reach
at = [0.5, 1.5] => at = [2.5, 1.5] => line 27, column 16 ... step 2: (2.5, 1.5) m is out of reach
at = [0.5, 1.0] => at = [0.0, 1.795] => line 31 ... step 4: (0.000707 ... out of reach
[[-0.02, -0.02], [0.02, -0.02], [0.02, 0.02], [-0.02, 0.02]] => [[-0.02, 0], [0.02, 0], [0.02, 0.0003]]
    => line 13, column 12 ... step 1: object "part" is too thin to rest on a support ... 1.8 ... hint: 
joints = [0.0, 0.5]\n => joints = [0.0, 3.5]\n => line 5 ... the start is outside the joint limits
at = [1.0, 1.0] => at = [1.0, 0.0] => line 5 ... the start ... hits obstacle "part" ... hint: choose a configuration away
"#;
    all_refused(&valid_world(), table);
    let no_start = valid_world().replace("[start]\njoints = [0.0, 0.5]\n", "");
    refused(&no_start, &Overrides::default(), "there is no start");
    // A grasp off the origin of a rigid payload with unknown orientation may or may not be within reach.
    let far = valid_world()
        .replace("at = [0.5, 1.5]", "at = [0.0, 1.81]")
        .replace("pick = \"part\"", "pick = \"part\"\ngrasp = [0.02, 0]");
    assert_eq!(steps_of(&far, &Overrides::default()), 5);
    // The clearance does not apply to the support.
    let clearance = Overrides { clearance: Some(0.02), ..Overrides::default() };
    assert_eq!(steps_of(&valid_world(), &clearance), 5);
    // The error names each step once, however often the task repeats it.
    let many =
        valid_world().replace("[[obstacle]]", "[task]\nrepeat = 50\n[[obstacle]]").replace("[0.1, 0.2]", "[0.1, 3.2]");
    let error = task_of(&many, &Overrides::default()).unwrap_err();
    assert_eq!(error.diagnostics().len(), 1, "{error}");
    // That the object cannot be picked is a consequence of where it was placed.
    let repeated = many.replace("3.2", "0.2").replace("renew = true\n", "").replace("[0.5, 1.5]", "[2.5, 1.5]");
    let error = task_of(&repeated, &Overrides::default()).unwrap_err();
    assert_eq!(error.diagnostics().len(), 1, "{error}");
}

#[test]
fn a_world_has_either_steps_or_a_goal() {
    let none = Overrides::default();
    let both = format!("{}[goal]\njoints = [1, 1]\n", valid_world());
    refused(&both, &none, "line 34, column 1 ... either a goal or steps ... hint: remove [goal]");
    let as_problem = |overrides: &Overrides, pattern: &str| {
        fits(&with_world(&valid_world(), |u, w| load(u, w, overrides)).unwrap_err().to_string(), pattern);
    };
    as_problem(&none, "line 24, column 1 ... this world has steps, not a goal ... hint: ");
    let goal = Overrides { goal: Some("0,0".parse().unwrap()), ..Overrides::default() };
    as_problem(&goal, "--goal: this world has steps, not a goal ... hint: leave the option out");
    refused(&valid_world(), &goal, "--goal: this world has steps");
    let tip = Overrides { goal_tip: Some("1,1".parse().unwrap()), ..Overrides::default() };
    refused(&valid_world(), &tip, "--goal-tip: this world has steps");
    refused(CELL, &none, "world.toml: there is no goal ... hint: ");
}

#[test]
fn an_inspection_warns_of_infeasible_steps() {
    let warnings = |world: &str| {
        let inspection: Inspection = with_world(world, |u, w| inspect(u, Some(w)));
        assert!(inspection.is_plannable(), "{:?}", inspection.errors);
        inspection.warnings
    };
    assert!(warnings(&valid_world()).is_empty());
    let far = warnings(&valid_world().replace("at = [0.5, 1.5]", "at = [2.5, 1.5]"));
    assert!(far.iter().any(|w| w.starts_with("task: step 2: (2.5, 1.5) m is out of reach")), "{far:?}");
}

#[test]
fn invalid_lines_are_refused() {
    let table = r#"
nothing => needs exactly one of `file`, `points`, `arc` and `spline`, but has 0 ... hint: follow = {
points = [[1, 0], [1, 1]], file = "a.svg" => but has 2
points = [[1, 0]] => a line needs two points or more, not 1
points = [[1, 0], [1, 0]] => points 1 and 2 of this line are equal ... hint: remove one
points = [[1, 0], [1, 1, 2]] => expected two numbers, found 3
points = [[1, 0], [1, 1], [0, 1]], radius = 1.5 => do not fit ... hint: a radius of 1.000000 m fits
points = [[1, 0], [1, 1]], radius = -1 => radius must not be negative
spline = [[1, 0], [1, 1]], radius = 0.1 => only a line with `points` has a `radius`
spline = [[1, 0], [1, 1]], unit = "mm" => only a line with a `file` has a `unit`
arc = [[1, 0], [1, 1]] => an arc needs three points, not 2
arc = [[1, 0], [1, 1], [1, 2]] => on a straight line ... hint: write the straight line as points
points = [[1, 0], [1, 1]], speed = 0 => speed must be positive
points = [[1, 0], [1, 1]], scale = -1 => scale must be positive
points = [[1, 0], [1, 1]], tolerance = 0 => tolerance must be positive
points = [[1, 0], [1, 1]], tolerance = 1e-9 => less than 0.000001 m
points = [[1, 0], [1, 1]], turn = "1 rad" => an angle such as
points = [[1, 0], [1, 1]], pace = 1 => unknown key `pace`
file = "a.gcode" => there is no file ... hint: paths are relative to the world file
points = [[19, 0], [20, 0]] => step ... out of reach
"#;
    for row in table.trim().lines() {
        let (line, pattern) = row.split_once(" => ").unwrap();
        let line = line.replace("nothing", "");
        let step = "move = { joints = [0.1, 0.2] }";
        all_refused(&valid_world(), &format!("{step} => follow = {{ {line} }} => {pattern}"));
    }
}

/// Defects of a line's file are reported with its name and the place in it.
#[test]
fn defects_of_the_file_of_a_line_are_reported_there() {
    let folder = tempfile::tempdir().unwrap();
    let write = |name: &str, text: &str| std::fs::write(folder.path().join(name), text).unwrap();
    let urdf = concat!(env!("CARGO_MANIFEST_DIR"), "/robots/planar_2r.urdf");
    let load = |file: &str| {
        write("world.toml", &format!("[start]\njoints = [0.3, 1.2]\n[[step]]\nfollow = {{ file = \"{file}\" }}\n"));
        let scene = cplan::input::load_scene(std::path::Path::new(urdf), &folder.path().join("world.toml"));
        scene.and_then(|scene| scene.resolve(&Overrides::default(), Rules::Plan)).map_err(|error| error.to_string())
    };
    write("good.gcode", "G21 G0 X1100 Y0\nG1 X1200\n");
    write("bad.gcode", "G21 G0 X1100 Y0\nG1 X1200 A90\n");
    write("line.txt", "");
    assert_eq!(load("good.gcode").unwrap().task.unwrap().items.len(), 2);
    let error = load("bad.gcode").unwrap_err();
    assert!(error.contains("bad.gcode: line 2, column 10: A turns the tool"), "{error}");
    let error = load("line.txt").unwrap_err();
    assert!(
        error.contains("world.toml: line 4") && error.contains("the format of the line's file is unknown"),
        "{error}"
    );
    let error = load("none.svg").unwrap_err();
    assert!(error.contains("there is no file") && error.contains("none.svg"), "{error}");
}

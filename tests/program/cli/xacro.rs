//! Robots in xacro: accepted wherever a URDF is, and written as URDF for programs that read only that.

use super::*;
const WORLD: &str = "[start]\njoints = [-0.9, 0.4]\n[goal]\njoints = [1.5, -0.4]\n[[obstacle]]\nname = \"post\"\n\
                     circle = { center = [0.5, 0.1], radius = 0.03 }\n";

/// Returns a folder with the shipped robot in xacro and a world for it.
fn place() -> Place {
    Place::new()
        .with("scara.urdf.xacro", std::fs::read(shipped("robots/scara.urdf.xacro")).unwrap())
        .with("world.toml", WORLD)
}

const FILES: [&str; 2] = ["scara.urdf.xacro", "world.toml"];

#[test]
fn every_command_that_takes_a_urdf_takes_xacro_with_arguments() {
    let place = place();
    let argument = "--xacro-arg reach=0.66";
    let reach = |options: &str| {
        let done = place.run(&["inspect", FILES[0]], &format!("--json {options}"));
        done.json()["reach"]["distances"][1].as_f64().unwrap()
    };
    assert!((reach("") - 0.55).abs() < 1e-9 && (reach(argument) - 0.66).abs() < 1e-9);
    assert!((reach("--xacro-arg reach=0.6 --xacro-arg reach:=0.7") - 0.7).abs() < 1e-9);
    place.run(&FILES, &format!("--output plan.csv --quiet {argument}")).exits(0);
    for (command, options) in [
        ("verify", "plan.csv"),
        ("check", "--at 0.1,0.2"),
        ("explain", ""),
        ("reach", "--json"),
        ("compare", "--planner shortest"),
    ] {
        place.run(&[command, FILES[0], FILES[1]], &format!("{options} {argument}")).exits(0);
    }
    place.write(
        "lines.jsonl",
        r#"{"urdf": "scara.urdf.xacro", "xacro_args": {"reach": "0.66"}, "world": "world.toml"}"#,
    );
    let done = place.run(&["batch", "lines.jsonl"], "--fields status");
    assert_eq!((done.code, done.stdout.contains("found")), (0, true), "{}{}", done.stdout, done.stderr);
}

#[test]
fn arguments_that_a_robot_does_not_have_are_refused() {
    let place = place();
    place.run(&FILES, "--xacro-arg raech=1").refused(1, &["no argument \"raech\"", "its arguments are reach"]);
    place.run(&FILES, "--xacro-arg reach").refused(2, &["NAME=VALUE"]);
    place
        .run(&[&shipped("robots/scara.urdf"), "world.toml"], "--xacro-arg reach=1")
        .refused(1, &["plain URDF, not xacro, so it has no argument \"reach\"", "leave --xacro-arg out"]);
    place.run(&FILES, "--xacro-arg reach=wide").refused(1, &["scara.urdf.xacro: line 5", "no property \"wide\""]);
}

/// Checks that messages about the URDF name the file and the line of the element in xacro.
#[test]
fn messages_name_the_place_in_the_xacro_file() {
    let place = place();
    let main = "<robot name=\"r\" xmlns:xacro=\"http://www.ros.org/wiki/xacro\">\n<xacro:include filename=\"parts.xacro\"/>\n\
                <xacro:arm length=\"abc\"/>\n</robot>\n";
    let parts = "<robot xmlns:xacro=\"http://www.ros.org/wiki/xacro\">\n<xacro:macro name=\"arm\" params=\"length\">\n<link name=\"a\"/>\n\
                 <link name=\"b\">\n<collision><geometry>\n<box size=\"${length} 0.1 0.1\"/>\n</geometry></collision></link>\n\
                 </xacro:macro>\n</robot>\n";
    place.write("r.xacro", main);
    place.write("parts.xacro", parts);
    place
        .run(&["r.xacro", "world.toml"], "")
        .refused(1, &["parts.xacro: line 6", "link \"b\", collision", "6 | <box size=\"${length} 0.1 0.1\"/>"]);
}

/// Checks that the checker refuses xacro, that it explains how to write the URDF, and that it accepts that URDF.
#[test]
fn certificates_are_checked_against_the_expanded_urdf() {
    let place = place();
    let argument = "--xacro-arg reach=0.66";
    place.run(&FILES, &format!("--certificate c.json --quiet {argument}")).exits(0);
    let check = |urdf: &str| check_files(&place.path(urdf), &place.path("world.toml"), &place.path("c.json"));
    place.write("copy.urdf", place.read(FILES[0]));
    let whole = std::fs::read_to_string(place.path("c.json")).unwrap();
    let without = whole.lines().filter(|line| !line.contains("\"urdf\"")).collect::<Vec<_>>().join("\n");
    place.write("c.json", &without);
    let Err(CheckError::Input { message, .. }) = check("copy.urdf") else { panic!("xacro is no URDF") };
    assert!(message.contains("cplan inspect FILE --expanded robot.urdf"), "{message}");
    place.write("c.json", &whole);
    place.run(&["inspect", FILES[0]], &format!("--expanded robot.urdf {argument}")).succeeds_silently();
    check("robot.urdf").unwrap();
    // The written file is the robot, without arguments.
    place.run(&["robot.urdf", "world.toml"], "--quiet").exits(0);
    place
        .run(&["inspect", "robot.urdf"], "--expanded again.urdf")
        .refused_after_report(&["nothing to expand", "leave --expanded out"]);
    place.run(&["inspect", FILES[0]], "--expanded scara.urdf.xacro").exits(1);
}

impl super::Done {
    fn refused_after_report(&self, parts: &[&str]) {
        assert_eq!(self.code, 1, "{}", self.stdout);
        parts.iter().for_each(|part| assert!(self.stderr.contains(part), "{}", self.stderr));
    }
}

//! Hundreds of files with a typing error. Each is read, or refused with position and hint. Reading never panics, and
//! its result is never far larger than the file.

use cplan::input::{InputError, Overrides, Source, load_recording, robot, scene_from};
use cplan_cases::slips::slipped;
use cplan_cases::{dice, times};

const ARM: &str = include_str!("../../robots/planar_2r.urdf");

const WORLD: &str = r#"name = "cell"
clearance = 0.0
[robot]
tip = "tool0"
limits = { elbow = ["-120deg", 2.1] }
velocity = { elbow = 1.0 }
[start]
joints = [-0.9, 0.5]
[goal]
tip = [0.6, 1.2]
[[obstacle]]
name = "frame"
polygon = [[1.0, 1.0], [2.0, 1.0], [2.0, 2.0], [1.0, 2.0], [1.0, 1.0]]
holes = [[[1.2, 1.2], [1.8, 1.2], [1.5, 1.8]]]
[[obstacle]]
polygon = [[[3, 3], [4, 3], [4, 4], [3, 4]], [[3, 3], [3.5, 3.2], [3.2, 3.5]]]
height = [0.0, 0.2]
[[obstacle]]
circle = { center = [0.1, -0.7], radius = 0.05 }
[[obstacle]]
polyline = [[-0.5, -0.8], [-0.5, -0.8], [-0.5, 0.8]]
[[preference]]
epsilon = 0.1
polygon = [[0.2, 0.3], [0.5, 0.3], [0.5, 0.6]]
"#;

/// Largest number of convex pieces that obstacles with a few corners may have.
const MAX_PIECES: usize = 100;

/// Largest size of the plain URDF that a few macros may produce, in bytes.
const LONGEST: usize = 1 << 16;

fn is_helpful(error: &InputError, text: &str) {
    assert!(!error.diagnostics().is_empty());
    for diagnostic in error.diagnostics() {
        assert!(!diagnostic.message.is_empty() && !diagnostic.origin.is_empty(), "{diagnostic}\n{text}");
        assert!(diagnostic.help.as_ref().is_some_and(|help| !help.is_empty()), "no cure: {diagnostic}\n{text}");
    }
}

#[test]
fn slips_in_worlds_and_robots_are_read_or_refused() {
    let (mut read, mut refused) = (0, 0);
    let mut dice = dice(13);
    for k in 0..times(1500) {
        let (urdf, world) = match k % 2 {
            0 => (ARM.to_owned(), slipped(&mut dice, WORLD)),
            _ => (slipped(&mut dice, ARM), WORLD.to_owned()),
        };
        let scene = scene_from(Source::in_memory("arm.urdf", &*urdf), Source::in_memory("world.toml", &*world));
        let loaded = scene.and_then(|scene| match scene.is_task() {
            true => Ok(0),
            false => scene.problem(&Overrides::default()).map(|loaded| {
                let obstacles = &loaded.problem.scene().workspace().obstacles;
                obstacles.iter().map(|obstacle| obstacle.pieces.len()).sum::<usize>()
            }),
        });
        match loaded {
            Ok(pieces) => {
                read += 1;
                assert!(pieces <= MAX_PIECES, "{pieces} pieces\n{urdf}{world}");
            }
            Err(error) => {
                refused += 1;
                is_helpful(&error, if k % 2 == 0 { &world } else { &urdf });
            }
        }
    }
    assert!(read > refused / 20 && refused > read / 20, "{read} {refused}");
}

#[test]
fn slips_in_tables_are_read_or_refused() {
    let folder = tempfile::tempdir().unwrap();
    let scene = scene_from(Source::in_memory("arm.urdf", ARM), Source::in_memory("world.toml", WORLD)).unwrap();
    let table =
        "# logged\ntime;shoulder;elbow;elbow_velocity\n0;-0.9;0.5;0\n1;-0.8;0.4;0.1\n1;-0.8;0.4;0.1\n2;-0.7;0.4;0\n";
    let mut dice = dice(14);
    let (mut read, mut refused) = (0, 0);
    for _ in 0..times(600) {
        let table = slipped(&mut dice, table);
        let path = folder.path().join("m.csv");
        std::fs::write(&path, &table).unwrap();
        match load_recording(&path, &scene) {
            Ok(loaded) => {
                read += 1;
                assert!(loaded.recording.times().is_none_or(|times| times.windows(2).all(|w| w[0] < w[1])), "{table}");
            }
            Err(error) => {
                refused += 1;
                is_helpful(&error, &table);
            }
        }
    }
    assert!(read > refused / 20 && refused > read / 20, "{read} {refused}");
}

/// A robot that uses most features of xacro, and a file that it includes.
const XACRO: [(&str, &str); 2] = [
    ("arm.urdf.xacro", include_str!("../../robots/scara.urdf.xacro")),
    (
        "parts.xacro",
        r#"<robot xmlns:xacro="http://www.ros.org/wiki/xacro">
  <xacro:property name="sizes" value="${dict(a=[1, 2.5], b='x')}"/>
  <xacro:macro name="turn" params="n *block **more e:=^|3">
    <xacro:if value="${n > 0 and not sizes['b'] == 'y'}"><xacro:turn n="${n - 1}"><a/><b><c/></b></xacro:turn></xacro:if>
    <xacro:unless value="false"><xacro:insert_block name="block"/><xacro:insert_block name="more"/></xacro:unless>
    <link name="l${n}_$(arg reach)" v="${max(sizes.a) ** 2 if e else -radians(90)} $(optenv NOTHING 1)"/>
  </xacro:macro>
  <xacro:turn n="3"><a/><b><c/></b></xacro:turn>
</robot>"#,
    ),
];

#[test]
fn slips_in_xacro_are_read_or_refused() {
    let (mut read, mut refused) = (0, 0);
    let mut dice = dice(29);
    let folder = tempfile::tempdir().unwrap();
    let main = folder.path().join(XACRO[0].0);
    for k in 0..times(1500) {
        let slip = usize::from(k % 2 == 1);
        let included = XACRO[0].1.replace("<link name=\"base_link\"/>", "<xacro:include filename=\"parts.xacro\"/>");
        let mut texts = [if slip == 0 { XACRO[0].1.to_owned() } else { included }, XACRO[1].1.to_owned()];
        texts[slip] = slipped(&mut dice, &texts[slip]);
        for ((name, _), text) in XACRO.iter().zip(&texts) {
            std::fs::write(folder.path().join(name), text).unwrap();
        }
        match robot(&main).read() {
            Ok(source) => {
                read += 1;
                assert!(source.text().len() <= LONGEST, "{} bytes of {texts:?}", source.text().len());
            }
            Err(error) => {
                refused += 1;
                is_helpful(&error, &texts[slip]);
            }
        }
    }
    assert!(read > refused / 20 && refused > read / 20, "{read} {refused}");
}

//! Tests of expansion. Each expected text is the output of ROS's own xacro (2.1.1) for the same file, except for
//! blanks, and except for `abs`, `max`, `min`, `round`, `int`, `sum` and `list`, which some of its versions only have
//! as `python.abs` and so on.

use crate::common::{Files, content, robot};

fn expand(text: &str) -> String {
    let expansion = Files::new(&[("r.urdf.xacro", &robot(text))]).expand(&[]);
    content(&expansion.unwrap_or_else(|error| panic!("{error}\n{text}")).text)
}

#[track_caller]
fn check_expansion(text: &str, expected: &str) {
    assert_eq!(expand(text), expected, "{text}");
}

/// Evaluates an expression with some properties.
fn value(expression: &str) -> String {
    let text = format!(
        "<xacro:property name=\"a\" value=\"2\"/><xacro:property name=\"b\" value=\"0.5\"/><xacro:property name=\"s\" value=\"left\"/>\
         <xacro:property name=\"n\" value=\"${{[1, 2.5, 'x']}}\"/><xacro:property name=\"d\" value=\"${{dict(k=1, m=dict(z=3))}}\"/>\
         <v v=\"{expression}\"/>"
    );
    let text = expand(&text);
    text.trim_start_matches("<v v=\"").trim_end_matches("\"/>").to_owned()
}

#[test]
fn expressions_have_the_values_that_python_gives_them() {
    for (expression, expected) in [
        ("${a + b * 4}", "4.0"),
        ("${-a ** 2}", "-4"),
        ("${(a + b) / 4}", "0.625"),
        ("${7 // 2} ${-7 // 2} ${-7 % 3} ${7.5 % 2}", "3 -4 2 1.5"),
        ("${1 / 2} ${4 / 2} ${2 ** -1}", "0.5 2.0 0.5"),
        ("${pi / 2}", "1.5707963267948966"),
        ("${radians(180)} ${degrees(pi)}", "3.141592653589793 180.0"),
        ("${sin(0)} ${cos(0)} ${sqrt(16)} ${atan2(0, -1)}", "0.0 1.0 4.0 3.141592653589793"),
        ("${math.pi == pi}", "True"),
        ("${0.1 + 0.2} ${1e-5} ${1e20}", "0.30000000000000004 1e-05 1e+20"),
        ("${abs(-a)} ${max(1, a, b)} ${min(n[0:2])} ${round(2.5)} ${int(3.9)} ${floor(-1.5)}", "2 2 1 2 3 -2"),
        ("${len(n)} ${n[0]} ${n[-1]} ${n[1:]} ${d['k']} ${d['m']['z']}", "3 1 x [2.5, 'x'] 1 3"),
        ("${s + '_arm'} ${s == 'left'} ${'eft' in s} ${s[0]} ${s.upper()}", "left_arm True True l LEFT"),
        ("${1 if a &gt; 1 else 0} ${not a} ${a and b} ${0 or s}", "1 False 0.5 left"),
        ("${1 &lt; a &lt;= 2} ${a != 2} ${a not in [1, 3]}", "True False True"),
        ("${(1, 2)[1]} ${sum([1, 2, 3])} ${list(range(3))}", "2 6 [0, 1, 2]"),
        ("$${a} $$(arg x) 5$ ${a}", "${a} $(arg x) 5$ 2"),
        ("${str(a) + 'x'} ${float('1.5')} ${int('7')}", "2x 1.5 7"),
    ] {
        assert_eq!(value(expression), expected, "{expression}");
    }
}

#[test]
fn properties_are_evaluated_when_they_are_asked_for() {
    check_expansion(
        "<xacro:property name=\"x\" value=\"${y * 2}\"/><xacro:property name=\"y\" value=\"3\"/><v v=\"${x}\"/>",
        "<v v=\"6\"/>",
    );
    check_expansion(
        "<xacro:property name=\"y\" value=\"1\"/><xacro:property name=\"x\" value=\"${y}\" lazy_eval=\"false\"/>\
         <xacro:property name=\"y\" value=\"3\"/><xacro:property name=\"y\" default=\"4\"/><v v=\"${x} ${y}\"/>",
        "<v v=\"1 3\"/>",
    );
    check_expansion(
        "<xacro:property name=\"origin\"><origin xyz=\"${z} 0 0\"/></xacro:property><xacro:property name=\"z\" value=\"1\"/>\
         <a><xacro:insert_block name=\"origin\"/></a>",
        "<a><origin xyz=\"1 0 0\"/></a>",
    );
    check_expansion(
        "<xacro:property name=\"flag\" value=\"true\"/><v v=\"${flag} ${flag == True}\"/>",
        "<v v=\"True True\"/>",
    );
}

#[test]
fn properties_have_the_scopes_of_xacro() {
    check_expansion(
        "<xacro:property name=\"p\" value=\"1\"/>\
         <xacro:macro name=\"m\" params=\"\"><xacro:property name=\"p\" value=\"2\"/><i v=\"${p}\"/>\
         <xacro:property name=\"q\" value=\"${p + 1}\" scope=\"parent\"/><xacro:property name=\"g\" value=\"7\" scope=\"global\"/></xacro:macro>\
         <xacro:m/><o v=\"${p} ${q} ${g}\"/>",
        "<i v=\"2\"/><o v=\"1 3 7\"/>",
    );
}

#[test]
fn macros_take_values_defaults_and_blocks() {
    check_expansion(
        "<xacro:property name=\"c\" value=\"9\"/>\
         <xacro:macro name=\"m\" params=\"a b:=2 c:=^ d:=^|5 e:='x y' *one **more\">\
         <v v=\"${a} ${b} ${c} ${d} ${e}\"/><xacro:insert_block name=\"one\"/><in><xacro:insert_block name=\"more\"/></in></xacro:macro>\
         <xacro:m a=\"${1 + 2}\"><origin xyz=\"${c} 0 0\"/><group><x/><y n=\"${c}\"/></group></xacro:m>",
        "<v v=\"3 2 9 5 x y\"/><origin xyz=\"9 0 0\"/><in><x/><y n=\"9\"/></in>",
    );
    // A macro may call itself, and be called by a name that is computed.
    check_expansion(
        "<xacro:macro name=\"count\" params=\"n\"><v v=\"${n}\"/>\
         <xacro:if value=\"${n &gt; 1}\"><xacro:call macro=\"co${'unt'}\" n=\"${n - 1}\"/></xacro:if></xacro:macro><xacro:count n=\"3\"/>",
        "<v v=\"3\"/><v v=\"2\"/><v v=\"1\"/>",
    );
}

#[test]
fn conditions_select_elements() {
    check_expansion(
        "<xacro:if value=\"true\"><a/></xacro:if><xacro:unless value=\"${1 == 2}\"><b/></xacro:unless>\
         <xacro:if value=\"0\"><c/></xacro:if><xacro:if value=\"${'x' in ['x']}\"><d/></xacro:if>",
        "<a/><b/><d/>",
    );
}

#[test]
fn arguments_come_from_outside_or_have_defaults() {
    let text = robot(
        "<xacro:arg name=\"reach\" default=\"${1 + 1}\"/><xacro:arg name=\"prefix\" default=\"\"/>\
         <xacro:property name=\"half\" value=\"${$(arg reach) / 2}\"/><v n=\"$(arg prefix)arm\" v=\"${half} ${xacro.arg('reach')}\"/>",
    );
    let files = Files::new(&[("r.xacro", &text)]);
    assert_eq!(content(&files.expand(&[]).unwrap().text), "<v n=\"arm\" v=\"1.0 2\"/>");
    let given = files.expand(&[("reach", "0.5"), ("prefix", "left_")]).unwrap();
    assert_eq!(content(&given.text), "<v n=\"left_arm\" v=\"0.25 0.5\"/>");
}

#[test]
fn files_are_included_beside_and_by_package() {
    let main = robot(
        "<xacro:include filename=\"parts/a.xacro\"/><xacro:include filename=\"$(find other_pkg)/b.xacro\" ns=\"b\"/>\
         <xacro:include filename=\"none.xacro\" optional=\"true\"/><xacro:bar/><xacro:b.bar/><v v=\"${b.size} $(dirname)\"/>",
    );
    let library = |size: &str| {
        robot(&format!(
            "<xacro:property name=\"size\" value=\"{size}\"/><xacro:macro name=\"bar\"><bar v=\"${{size}}\"/></xacro:macro>"
        ))
    };
    let manifest = "<package><name>other_pkg</name></package>";
    let files = Files::new(&[
        ("repo/mine/r.xacro", &main),
        ("repo/mine/parts/a.xacro", &library("1")),
        ("repo/elsewhere/b.xacro", &library("2")),
        ("repo/elsewhere/package.xml", manifest),
    ]);
    let folder = files.folder.path().join("repo/mine").canonicalize().unwrap();
    let expected = format!("<bar v=\"1\"/><bar v=\"1\"/><v v=\"2 {}\"/>", folder.display());
    assert_eq!(content(&files.expand(&[]).unwrap().text), expected);
}

#[test]
fn numbers_come_from_yaml() {
    let main = robot(
        "<xacro:property name=\"c\" value=\"${xacro.load_yaml('c.yaml')}\"/><v v=\"${c['arm']['lengths'][1]} ${c['flag']} ${c.arm.name}\"/>",
    );
    let files =
        Files::new(&[("r.xacro", &main), ("c.yaml", "arm:\n  lengths: [0.3, 0.25]\n  name: left\nflag: true\n")]);
    assert_eq!(content(&files.expand(&[]).unwrap().text), "<v v=\"0.25 True left\"/>");
}

/// Checks that other namespaces, text and escaped characters stay unchanged.
#[test]
fn plain_urdf_stays_unchanged() {
    let text = "<robot name=\"r\" xmlns:xacro=\"http://wiki.ros.org/xacro\" xmlns:s=\"http://x/s\"><!-- gone -->\
                <s:a b=\"&lt;&quot;&amp;\">1 &lt; ${1 + 1}</s:a><plugin><p>x</p></plugin></robot>";
    let expansion = Files::new(&[("r.xacro", text)]).expand(&[]).unwrap();
    assert_eq!(content(&expansion.text), "<s:a b=\"&lt;&quot;&amp;\">1 &lt; 2</s:a><plugin><p>x</p></plugin>");
    assert!(expansion.text.contains("xmlns:s=\"http://x/s\"") && !expansion.text.contains("xmlns:xacro"));
    roxmltree::Document::parse(&expansion.text).unwrap();
}

#[test]
fn each_part_knows_where_it_comes_from() {
    let main = robot("<xacro:include filename=\"a.xacro\"/>\n<xacro:link name=\"l\"/>");
    let included = robot(
        "<xacro:macro name=\"link\" params=\"name\">\n<link name=\"${name}\">\n<x y=\"1\"/></link></xacro:macro>",
    );
    let files = Files::new(&[("r.xacro", &main), ("a.xacro", &included)]);
    let expansion = files.expand(&[]).unwrap();
    let line = |part: &str| {
        let place = expansion.place(expansion.text.find(part).unwrap()).unwrap();
        let file = &expansion.files[place.file];
        let name = file.path.file_name().unwrap().to_string_lossy().into_owned();
        (name, file.line(place.range.start), file.text[place.range.clone()].to_owned())
    };
    let expected = |line: usize, text: &str| ("a.xacro".to_owned(), line, text.to_owned());
    assert_eq!(line("<link"), expected(3, "<link name=\"${name}\">"));
    assert_eq!(line("name=\"l\""), expected(3, "name=\"${name}\""));
    assert_eq!(line("y=\"1\""), expected(4, "y=\"1\""));
}

//! Tests of refused files: with file, line and a hint, and quickly.

use crate::common::{Files, robot};
use std::time::{Duration, Instant};

/// Returns the error message. The message must contain all parts. It must come quickly, and the program must not need
/// more than a stack of ordinary size.
fn refused(files: &[(&str, &str)], arguments: &[(&str, &str)], parts: &[&str]) {
    let begun = Instant::now();
    let message = std::thread::scope(|scope| {
        let expand = || Files::new(files).expand(arguments).expect_err("should be refused").to_string();
        std::thread::Builder::new().stack_size(2 << 20).spawn_scoped(scope, expand).unwrap().join().unwrap()
    });
    assert!(begun.elapsed() < Duration::from_secs(30), "{:?}", begun.elapsed());
    for part in parts {
        assert!(message.contains(part), "no {part:?} in {message}");
    }
}

#[test]
fn mistakes_are_named_with_file_line_and_hint() {
    for (text, parts) in [
        ("\n<v v=\"${nothing}\"/>", &["r.xacro:3:", "no property \"nothing\"", "xacro:property"][..]),
        ("<v v=\"${sin}\"/>", &["the name of a function"]),
        ("<v v=\"${1 +}\"/>", &["the expression is incomplete"]),
        ("<v v=\"${(1\"/>", &["\"${\" has no closing }"]),
        ("<v v=\"${1 / 0}\"/>", &["divides by zero"]),
        ("<v v=\"${'a' + 1}\"/>", &["'a' (text) and '1' (int)", "str(...)"]),
        ("<v v=\"${[x for x in [1]]}\"/>", &["comprehensions", "ROS's own xacro"]),
        ("<v v=\"${open('x')}\"/>", &["the function open() is unknown", "radians"]),
        ("<v v=\"${[1][5]}\"/>", &["index 5 is out of range: the sequence has 1 items"]),
        ("<v v=\"$(find nowhere_pkg)/a\"/>", &["package \"nowhere_pkg\" was not found", "ROS_PACKAGE_PATH"]),
        ("<v v=\"$(arg x)\"/>", &["the argument \"x\" has no value", "--xacro-arg x=VALUE"]),
        ("<v v=\"$(env NO_SUCH_VARIABLE_HERE)\"/>", &["NO_SUCH_VARIABLE_HERE"]),
        ("<v v=\"$(anon x)\"/>", &["\"$(anon x)\" is not known", "$(find PACKAGE)"]),
        ("<xacro:if value=\"maybe\"/>", &["'maybe' is not a condition"]),
        ("<xacro:if/>", &["<xacro:if> has no value"]),
        ("<xacro:wheel/>", &["there is no macro \"wheel\""]),
        ("<xacro:macro name=\"m\" params=\"a\"/><xacro:m b=\"1\"/>", &["no parameter \"b\"", "its parameters are a"]),
        ("<xacro:macro name=\"m\" params=\"a\"/><xacro:m/>", &["called without \"a\""]),
        ("<xacro:macro name=\"m\" params=\"*a\"/><xacro:m/>", &["lacks the element for its block \"*a\""]),
        ("<xacro:macro name=\"m\"/><xacro:m><x/></xacro:m>", &["takes no element such as <x>"]),
        (
            "<xacro:macro name=\"m\">\n<v v=\"${q}\"/></xacro:macro>\n<xacro:m/>",
            &["r.xacro:3:", "in macro \"m\", called at", ":4)"],
        ),
        ("<xacro:insert_block name=\"b\"/>", &["there is no block \"b\""]),
        ("<xacro:property name=\"a b\" value=\"1\"/>", &["\"a b\" is not a valid name of a property"]),
        ("<xacro:property name=\"a\" value=\"${a}\"/><v v=\"${a}\"/>", &["depends on itself"]),
        ("<xacro:element xacro:name=\"x\"/>", &["does not read xacro:element"]),
        ("<xacro:include filename=\"none.xacro\"/>", &["none.xacro cannot be read", "relative to this file"]),
        ("<xacro:include filename=\"*.xacro\"/>", &["does not read patterns"]),
        ("<macro name=\"m\" params=\"\"/>", &["<macro> without the prefix", "<xacro:macro"]),
        ("<v v=\"${load_yaml('none.yaml')}\"/>", &["none.yaml cannot be read"]),
        ("<link>", &["not well-formed XML"]),
    ] {
        refused(&[("r.xacro", &robot(text))], &[], parts);
    }
    refused(&[("r.xacro", "<robot><xacro:m/></robot>")], &[], &["prefix \"xacro\" is not declared", "xmlns:xacro="]);
    let text = robot("<xacro:arg name=\"reach\" default=\"1\"/>");
    refused(&[("r.xacro", &text)], &[("raech", "1")], &["no argument \"raech\"", "its arguments are reach"]);
    let entities = "<!DOCTYPE r [<!ENTITY a \"b\">]><robot>&a;</robot>";
    refused(&[("r.xacro", entities)], &[], &["defines entities"]);
}

#[test]
fn a_macro_that_is_never_called_is_named_with_a_call_that_works() {
    let arm = "<xacro:macro name=\"arm\" params=\"\">\n<link name=\"base\"/>\n</xacro:macro>";
    let message = "the macro \"arm\" is defined and never called, so the robot has no link";
    refused(&[("r.xacro", &robot(arm))], &[], &["r.xacro:2:", message, "before </robot>: <xacro:arm/>"]);
    let called = Files::new(&[("r.xacro", &robot(&format!("{arm}<xacro:arm/>")))]).expand(&[]).unwrap();
    assert!(called.text.contains("<link name=\"base\"/>"));
    let other = "<xacro:macro name=\"arm\" params=\"parent reach:=1 *origin\"><link name=\"base\"/></xacro:macro>";
    let call = "<xacro:arm parent=\"...\">...</xacro:arm> with elements for *origin";
    refused(&[("r.xacro", &robot(&format!("<material name=\"m\"/>{other}")))], &[], &[call]);
    // The robot's own macros come before those of included files.
    let files = [
        ("r.xacro", &*robot(&format!("{arm}<xacro:include filename=\"b.xacro\"/>"))),
        ("b.xacro", &*robot("<xacro:macro name=\"b\"/>")),
    ];
    refused(&files, &[], &[message]);
    // A robot with a link may leave macros uncalled.
    assert!(Files::new(&[("r.xacro", &robot(&format!("{arm}<link name=\"a\"/>")))]).expand(&[]).is_ok());
}

#[test]
fn endless_expansion_is_refused_early() {
    let deep = "<a>".repeat(100_000) + &"</a>".repeat(100_000);
    let parens = format!("<v v=\"${{{}1{}}}\"/>", "(".repeat(5000), ")".repeat(5000));
    let nots = format!("<v v=\"${{{} 1}}\"/>", "not ".repeat(900));
    let powers = format!("<v v=\"${{{}1}}\"/>", "2 ** ".repeat(400));
    let sum = format!("<v v=\"${{{}nothing}}\"/>", "1 + ".repeat(400));
    let chain: String =
        (0..5000).map(|k| format!("<xacro:property name=\"p{k}\" value=\"${{-(1 * -p{})}}\"/>", k + 1)).collect();
    let doubling: String = (0..60)
        .map(|k| format!("<xacro:property name=\"p{k}\" value=\"${{p{0} + p{0}}}\"/>", k + 1))
        .collect::<String>()
        + &format!("<xacro:property name=\"p30\" value=\"{}\"/><v v=\"${{p0}}\"/>", "x".repeat(9000));
    let branching = "<xacro:macro name=\"m\" params=\"n\"><xacro:if value=\"${n &gt; 0}\"><xacro:m n=\"${n - 1}\"/><xacro:m n=\"${n - 1}\"/>\
                     </xacro:if><a/></xacro:macro><xacro:m n=\"60\"/>";
    for (text, part) in [
        ("<xacro:macro name=\"m\"><xacro:m/></xacro:macro><xacro:m/>", "nested more than"),
        (branching, "the expansion"),
        (&deep, "nested"),
        (&parens, "words"),
        (&nots, "True"),
        (&powers, "nested more than"),
        (&sum, "no property \"nothing\""),
        (&(chain + "<v v=\"${p0}\"/>"), "nested more than"),
        (&doubling, "is larger than"),
        ("<v v=\"${'x' * 10 ** 12}\"/>", "too large"),
        ("<v v=\"${list(range(10 ** 12))}\"/>", "too long"),
        ("<v v=\"${9 ** 9 ** 9}\"/>", "too large"),
    ] {
        if part != "True" {
            refused(&[("r.xacro", &robot(text))], &[], &[part]);
        } else {
            assert!(Files::new(&[("r.xacro", &robot(text))]).expand(&[]).unwrap().text.contains(part));
        }
    }
    let [a, b] = ["b", "a"].map(|name| robot(&format!("<xacro:include filename=\"{name}.xacro\"/>")));
    refused(&[("a.xacro", &a), ("b.xacro", &b)], &[], &["b.xacro:2:", "a.xacro includes itself"]);
}

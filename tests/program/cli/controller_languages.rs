//! Readers of the parts of SPEL+ and RAPID that the shipped templates write. They share no code with cplan.

/// A statement of a program.
#[derive(Debug, Clone, PartialEq)]
pub enum Statement {
    /// A joint move: degrees and millimetres.
    Move(Vec<f64>),
    /// The gripper closes (true) or opens.
    Grip(bool),
    /// Seconds.
    Wait(f64),
    /// Percent of the top speed.
    Speed(f64),
    /// The number of a signal that the program sets.
    SetSignal(usize),
    /// The number of a signal for which the program waits.
    WaitForSignal(usize),
}

pub fn numbers(list: &str) -> Vec<f64> {
    list.split(',')
        .map(|number| number.trim().parse().unwrap_or_else(|_| panic!("{number:?} is not a number")))
        .collect()
}

/// Reads the part of SPEL+ that the template writes. Panics at anything else.
pub fn read_spel(text: &str) -> Vec<Statement> {
    let mut lines = text.lines().map(str::trim).filter(|line| !line.starts_with('\''));
    assert_eq!((lines.next(), lines.next()), (Some("Function main"), Some("Motor On")));
    let mut statements = Vec::new();
    for line in lines {
        let (word, rest) = line.split_once(' ').unwrap_or((line, ""));
        statements.push(match word {
            "Go" => {
                let values =
                    numbers(rest.strip_prefix("JA(").and_then(|rest| rest.strip_suffix(')')).expect("JA(...)"));
                assert!(values.len() == 4 || values.len() == 6, "{line}");
                Statement::Move(values)
            }
            "On" if rest.starts_with("doSignal") => Statement::SetSignal(rest["doSignal".len()..].parse().unwrap()),
            "On" | "Off" => {
                assert_eq!(rest, "8");
                Statement::Grip(word == "On")
            }
            "Wait" if rest.starts_with("Sw(") => {
                let signal = rest.strip_prefix("Sw(diSignal").and_then(|rest| rest.strip_suffix(") = On"));
                Statement::WaitForSignal(signal.expect("an input").parse().unwrap())
            }
            "Wait" => Statement::Wait(rest.parse().unwrap()),
            "Speed" => Statement::Speed(rest.parse().unwrap()),
            "Fend" => return statements,
            _ => panic!("unknown statement: {line}"),
        });
    }
    panic!("no Fend");
}

/// Reads the part of RAPID that the template writes. Panics at anything else.
pub fn read_rapid(text: &str) -> Vec<Statement> {
    let mut lines = text.lines().map(str::trim).filter(|line| !line.starts_with('!'));
    let name = lines.next().and_then(|line| line.strip_prefix("MODULE ")).expect("a module");
    assert!(name.len() <= 32 && name.starts_with(|c: char| c.is_ascii_alphabetic()), "{name}");
    assert!(name.chars().all(|c| c.is_ascii_alphanumeric() || c == '_'), "{name}");
    assert_eq!(lines.next(), Some("PROC main()"));
    let mut statements = Vec::new();
    for line in lines {
        if line == "ENDPROC" || line == "ENDMODULE" {
            continue;
        }
        let (word, rest) = line.strip_suffix(';').and_then(|line| line.split_once(' ')).expect("a statement");
        statements.push(match word {
            "MoveAbsJ" => {
                let target = rest.strip_suffix(", vmax, fine, tool0").expect("speed, zone and tool");
                let target =
                    target.strip_prefix("[[").and_then(|target| target.strip_suffix("]]")).expect("a jointtarget");
                let (axes, external) = target.split_once("], [").expect("robax and extax");
                let (axes, external) = (numbers(axes), numbers(external));
                assert_eq!((axes.len(), external), (6, vec![9e9; 6]));
                Statement::Move(axes)
            }
            "SetDO" | "WaitDI" if rest.contains("Signal") => {
                let direction = if word == "SetDO" { "doSignal" } else { "diSignal" };
                let signal = rest.strip_prefix(direction).and_then(|rest| rest.strip_suffix(", 1")).expect("a signal");
                let signal = signal.parse().unwrap();
                if word == "SetDO" { Statement::SetSignal(signal) } else { Statement::WaitForSignal(signal) }
            }
            "SetDO" => Statement::Grip(rest.ends_with(", 1")),
            "WaitTime" => Statement::Wait(rest.parse().unwrap()),
            "VelSet" => Statement::Speed(rest.strip_suffix(", 7000").expect("a top speed").parse().unwrap()),
            _ => panic!("unknown statement: {line}"),
        });
    }
    statements
}

pub fn targets(statements: &[Statement]) -> Vec<Vec<f64>> {
    let values = |statement: &Statement| match statement {
        Statement::Move(values) => Some(values.clone()),
        _ => None,
    };
    statements.iter().filter_map(values).collect()
}

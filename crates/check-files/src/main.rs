//! The command line program `cplan-check URDF WORLD CERTIFICATE`.
#![forbid(unsafe_code)]

use cplan_check_files::{CheckError, Input, check_files};
use std::process::ExitCode;

const USAGE: &str = "Checks a certificate of cplan in exact arithmetic.

Usage: cplan-check URDF WORLD CERTIFICATE

Exit codes: 0 the certificate proves its answer, 1 a file is wrong or contains something that the checker does not
know, 2 wrong command line, 3 the certificate does not prove its answer.";

/// Exit code if the certificate does not hold.
const EXIT_INVALID: u8 = 3;

fn main() -> ExitCode {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    let paths = match &arguments[..] {
        [urdf, world, certificate] => [urdf, world, certificate],
        [help] if help == "--help" || help == "-h" => {
            println!("{USAGE}");
            return ExitCode::SUCCESS;
        }
        _ => {
            eprintln!("{USAGE}");
            return ExitCode::from(2);
        }
    };
    match check_files(paths[0].as_ref(), paths[1].as_ref(), paths[2].as_ref()) {
        Ok(proven) => {
            println!("holds: {proven}");
            ExitCode::SUCCESS
        }
        Err(CheckError::Fails(why)) => {
            println!("does not hold: {why}");
            ExitCode::from(EXIT_INVALID)
        }
        Err(CheckError::Input { input, line, message }) => {
            let path = match input {
                Input::Urdf => paths[0],
                Input::World => paths[1],
                Input::Certificate => paths[2],
            };
            let line = line.map_or_else(String::new, |line| format!(":{line}"));
            eprintln!("{path}{line}: {message}");
            ExitCode::FAILURE
        }
    }
}

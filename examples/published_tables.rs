//! Sweep counts from the literature beside the counts of this library: match, close, or unmatched and why.
//!
//! ```text
//! cargo run --release --example published_tables [-- 100]
//! ```
//!
//! With the argument 100, the program measures only the smaller scale of Tables 17 to 19, which takes seconds. Both
//! scales take some minutes of CPU time.
//! The maps printed in the source of Tables 17 to 19 are the worlds in `workspaces/maps`. The exit code is 1 if a count
//! stated as a match, or as close, is not.

use cplan_testkit::published::row::Count;
use cplan_testkit::published::{alves, deicu, row, silva};
use std::error::Error;
use std::process::ExitCode;

fn main() -> Result<ExitCode, Box<dyn Error>> {
    let mut claims = Claims::default();
    deicu_tables(&mut claims)?;
    println!("Room of 40 m x 20 m (S. F. dos Reis Alves): index of the last sweep, counted from 0");
    for (name, count) in alves::rows() {
        println!("  {name:<27} {count}");
        claims.check(&count);
    }
    print_notes(alves::NOTES);
    println!("Robot soccer, 85 x 65 cells (M. Oliveira da Silva 2011): mean sweeps a state");
    let tables = std::thread::scope(|scope| {
        let threads = silva::TABLES.each_ref().map(|table| scope.spawn(|| silva::rows(table)));
        threads.map(|thread| thread.join().expect("no panic"))
    });
    for (table, rows) in silva::TABLES.iter().zip(tables) {
        println!("{}", table.title);
        for (name, count) in rows {
            println!("  {name:<27} {count}");
            claims.check(&count);
        }
    }
    print_notes(silva::NOTES);
    println!("{claims}");
    Ok(if claims.broken == 0 { ExitCode::SUCCESS } else { ExitCode::FAILURE })
}

/// Prints Tables 17 to 19.
fn deicu_tables(claims: &mut Claims) -> Result<(), Box<dyn Error>> {
    let small = std::env::args().nth(1).is_some_and(|scale| scale == "100");
    let scales: &[usize] = if small { &[0] } else { &[0, 1] };
    for table in &deicu::TABLES {
        println!("{} (L. E. Deicu 2012): sweeps, published and measured", table.title);
        println!("algorithm              cells  before preferences                   in all");
        let scene = deicu::scene(table)?;
        for line in deicu::lines(table, &scene, scales) {
            println!("{line}");
            line.counts().for_each(|count| claims.check(count));
        }
        print_notes(table.notes);
    }
    print_notes(deicu::METHOD);
    Ok(())
}

fn print_notes(notes: &[&str]) {
    for note in notes {
        println!("  {note}");
    }
    println!();
}

/// The number of published counts for each claim.
#[derive(Default)]
struct Claims {
    matching: usize,
    close: usize,
    unmatched: usize,
    broken: usize,
}

impl Claims {
    fn check(&mut self, count: &Count) {
        let kind = match count.claim {
            _ if !count.holds() => &mut self.broken,
            row::Claim::Match => &mut self.matching,
            row::Claim::Close(_) => &mut self.close,
            row::Claim::Unmatched => &mut self.unmatched,
        };
        *kind += 1;
    }
}

impl std::fmt::Display for Claims {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        let Self { matching, close, unmatched, broken } = self;
        write!(f, "{matching} match, {close} are close, {unmatched} are unmatched; {broken} are not as claimed")
    }
}

//! Checks that `deny.toml` lists exactly those packages that have several versions in `Cargo.lock`.

use std::collections::{BTreeMap, BTreeSet};
use std::path::Path;
use std::process::Command;

fn table(file: &str) -> toml::Table {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join(file);
    toml::from_str(&std::fs::read_to_string(path).unwrap()).unwrap()
}

#[test]
fn duplicate_dependencies_are_known() {
    let (lock, deny) = (table("Cargo.lock"), table("deny.toml"));
    let names = |list: &toml::Value| -> Vec<String> {
        let entries = list.as_array().expect("a list").iter();
        entries.map(|entry| entry["name"].as_str().expect("a name").to_owned()).collect()
    };
    let mut versions: BTreeMap<String, usize> = BTreeMap::new();
    for name in names(&lock["package"]) {
        *versions.entry(name).or_default() += 1;
    }
    assert!(versions.len() > 100, "{versions:?}");
    let twice: BTreeSet<String> = versions.into_iter().filter(|(_, count)| *count > 1).map(|(name, _)| name).collect();
    let skipped: BTreeSet<String> = names(&deny["bans"]["skip"]).into_iter().collect();
    assert_eq!(skipped, twice, "left what deny.toml skips, right what Cargo.lock has more than once");
    for name in names(&deny["bans"]["deny"]) {
        assert!(!names(&lock["package"]).contains(&name), "{name} is banned");
    }
}

/// Packages of the default build, and the packages that each of them uses.
struct Build {
    uses: BTreeMap<String, BTreeSet<String>>,
}

impl Build {
    /// Runs `cargo tree` for the system to which the tables in `deny.toml` refer.
    fn of_cargo() -> Self {
        let arguments =
            "tree --locked --package cplan --edges normal,build --prefix depth --target x86_64-unknown-linux-gnu";
        let mut cargo = Command::new(env!("CARGO"));
        let done = cargo.args(arguments.split(' ')).current_dir(env!("CARGO_MANIFEST_DIR")).output().unwrap();
        assert!(done.status.success(), "{}", String::from_utf8_lossy(&done.stderr));
        let (mut uses, mut above) = (BTreeMap::<String, BTreeSet<String>>::new(), Vec::new());
        for line in String::from_utf8(done.stdout).unwrap().lines() {
            // A line such as "2serde v1.0.229 (*)".
            let start = line.find(|c: char| !c.is_ascii_digit()).expect("a name");
            let (depth, name) = (line[..start].parse::<usize>().unwrap(), &line[start..]);
            let package = name.split(' ').take(2).collect::<Vec<_>>().join(" ");
            above.truncate(depth);
            uses.entry(package.clone()).or_default();
            if let Some(user) = above.last() {
                uses.entry(String::clone(user)).or_default().insert(package.clone());
            }
            above.push(package);
        }
        Self { uses }
    }

    /// Returns true if a package is a crate of this repository.
    fn is_workspace_crate(package: &str) -> bool {
        package.starts_with("cplan")
    }

    /// Returns the name of a package without its version.
    fn name(package: &str) -> &str {
        package.split(' ').next().unwrap_or_default()
    }

    /// Removes the packages that the crate `features` uses. Other crates use these packages too; `features` only turns
    /// on features of them.
    fn forget_features(&mut self) {
        let features = self.uses.iter_mut().find(|(package, _)| Self::name(package) == "cplan-features");
        features.expect("the crate").1.clear();
    }

    /// Returns the names of external packages that our crates use.
    fn direct(&self) -> BTreeSet<&str> {
        let ours = self.uses.iter().filter(|(package, _)| Self::is_workspace_crate(package));
        let used = ours.flat_map(|(_, used)| used).filter(|package| !Self::is_workspace_crate(package));
        used.map(|package| Self::name(package)).collect()
    }

    /// Returns the packages that the build would still have if no crate of ours used those in `names`.
    fn without(&self, names: &[&str]) -> BTreeSet<&str> {
        let root = self.uses.keys().find(|package| Self::name(package) == "cplan").expect("the program");
        let (mut left, mut next) = (BTreeSet::from([root.as_str()]), vec![root]);
        while let Some(user) = next.pop() {
            for used in &self.uses[user] {
                let is_out = Self::is_workspace_crate(user) && names.contains(&Self::name(used));
                if !is_out && left.insert(used) {
                    next.push(used);
                }
            }
        }
        left
    }
}

#[test]
fn dependency_tables_agree_with_cargo() {
    let page = std::fs::read_to_string(Path::new(env!("CARGO_MANIFEST_DIR")).join("docs/dependencies.md")).unwrap();
    let mut build = Build::of_cargo();
    let all = build.without(&[]);
    let ours = all.iter().filter(|package| Build::is_workspace_crate(package)).count();
    let total = format!("compiles {} packages from crates.io and {ours} crates of this repository", all.len() - ours);
    assert!(page.contains(&total), "docs/dependencies.md does not say: {total}");
    build.forget_features();
    let all = build.without(&[]);
    let (mut listed, mut wrong) = (Vec::new(), Vec::new());
    for row in page.lines().filter(|line| line.starts_with("| `")) {
        let cells: Vec<&str> = row.split('|').map(str::trim).collect();
        let names: Vec<&str> = cells[1].split(", ").map(|name| name.trim_matches('`')).collect();
        let gone = all.len() - build.without(&names).len();
        if cells[3] != gone.to_string() {
            wrong.push(format!("{}: {gone}, not {}", cells[1], cells[3]));
        }
        match names[..] {
            [name] => listed.push(name),
            _ => assert!(names.iter().all(|name| listed.contains(name)), "{} have no rows of their own", cells[1]),
        }
    }
    assert!(wrong.is_empty(), "packages in docs/dependencies.md:\n{}", wrong.join("\n"));
    assert_eq!(listed, Vec::from_iter(build.direct()), "left rows of docs/dependencies.md, right what our crates use");
}

//! Holds the list of what comes twice: `deny.toml` names it all, and nothing that comes once by now.

use std::collections::{BTreeMap, BTreeSet};
use std::path::Path;

fn table(file: &str) -> toml::Table {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join(file);
    toml::from_str(&std::fs::read_to_string(path).unwrap()).unwrap()
}

#[test]
fn what_comes_twice_is_known() {
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

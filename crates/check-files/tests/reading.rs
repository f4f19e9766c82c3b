//! What the documentation says of how much there is to read.

use std::collections::BTreeSet;
use std::path::Path;

/// Greatest number of lines that an answer about one motion may rest on: as much as can be read in a few days.
const MOST: usize = 3130;

/// Lines of code of a file, without comments and tests.
fn lines(path: &Path) -> usize {
    let text = std::fs::read_to_string(path).unwrap_or_else(|why| panic!("{}: {why}", path.display()));
    let code = text.split("#[cfg(test)]").next().unwrap().lines().map(str::trim);
    code.filter(|line| !line.is_empty() && !line.starts_with("//")).count()
}

/// All files of a folder, as the table names them.
fn sources(folder: &Path, root: &Path) -> BTreeSet<String> {
    let mut found = BTreeSet::new();
    for entry in std::fs::read_dir(folder).unwrap() {
        let path = entry.unwrap().path();
        if path.is_dir() {
            found.extend(sources(&path, root));
        } else {
            found.insert(path.strip_prefix(root).unwrap().with_extension("").display().to_string());
        }
    }
    found
}

/// The table of the page names each file once, and is off by no more than a twentieth.
#[test]
fn the_page_says_how_much_there_is_to_read() {
    let own = Path::new(env!("CARGO_MANIFEST_DIR"));
    let page = std::fs::read_to_string(own.join("../../docs/certificate_checks.md")).unwrap();
    let table = page.split("## How much there is to read").nth(1).unwrap().split("\n## ").next().unwrap();
    let rows: Vec<Vec<&str>> =
        table.lines().filter(|line| line.starts_with("| ")).skip(1).map(|line| line.split('|').collect()).collect();
    let root = own.join("src");
    let mut left = sources(&root, &root);
    let mut sums = Vec::new();
    for row in &rows {
        let [_, what, files, said, _] = row[..] else { panic!("{row:?}") };
        let said: usize = said.trim().parse().unwrap();
        let mut count = 0;
        for file in files.split(',').map(|file| file.trim().trim_matches('`')) {
            assert!(left.remove(file), "{file} is not there, or for the second time");
            count += lines(&root.join(file).with_extension("rs"));
        }
        assert!(said.abs_diff(count) * 20 <= count, "{what}: the page has {said} lines, there are {count}");
        sums.push(said);
    }
    assert!(left.is_empty(), "the page does not name {left:?}");
    // What it says of sums is of the same rows, and no answer about one motion grows beyond what the page says.
    let below: usize = sums[..4].iter().sum();
    let answers = [(sums[4], "on 2 683 lines"), (sums[5], "on 2 977"), (sums[4] + sums[6], "on 3 124")];
    for (answer, said) in answers {
        let digits: usize = said.chars().filter(char::is_ascii_digit).collect::<String>().parse().unwrap();
        assert!(table.contains(said) && (below + answer).abs_diff(digits) < 10 && digits <= MOST, "{said}");
    }
}

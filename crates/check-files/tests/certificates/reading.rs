//! Checks the documentation's statements about the amount of code to read.

use std::collections::BTreeSet;
use std::path::Path;

/// Maximum number of lines of code on which an answer about one motion may depend. A person can read so many in a few
/// days.
const MOST: usize = 3500;

/// Maximum number of lines of code of the crate `cplan-check`.
const MAX_OF_THE_JUDGE: usize = 3200;

/// Maximum number of lines of code on which an answer about a motion along a line may depend.
const MOST_FOR_A_LINE: usize = 3700;

/// Counts the lines of code of a file, without comments and tests.
fn lines(path: &Path) -> usize {
    let text = std::fs::read_to_string(path).unwrap_or_else(|why| panic!("{}: {why}", path.display()));
    let code = text.split("#[cfg(test)]").next().unwrap().lines().map(str::trim);
    code.filter(|line| !line.is_empty() && !line.starts_with("//")).count()
}

/// Returns all files of a folder, named as in the table.
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

/// Returns the numbers of a table, and the number of lines of each file. Checks that the table names each file of a
/// crate once, and that its numbers are right to within a twentieth.
fn numbers(section: &str, folder: &str) -> (Vec<usize>, usize) {
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("..").join(folder).join("src");
    let heading = format!("| subject | files in `crates/{folder}/src` | lines |\n");
    let table = section.split(&heading).nth(1).expect("a table of each crate").split("\n\n").next().unwrap();
    let mut left = sources(&root, &root);
    let (mut numbers, mut all) = (Vec::new(), 0);
    for row in table.lines().skip(1) {
        let [_, what, files, report, _] = row.split('|').collect::<Vec<_>>()[..] else { panic!("{row:?}") };
        let report: usize = report.trim().parse().unwrap();
        let mut count = 0;
        for file in files.split(',').map(|file| file.trim().trim_matches('`')) {
            assert!(left.remove(file), "{file} is not there, or for the second time");
            count += lines(&root.join(file).with_extension("rs"));
        }
        assert!(report.abs_diff(count) * 20 <= count, "{what}: the page has {report} lines, there are {count}");
        numbers.push(report);
        all += count;
    }
    assert!(left.is_empty(), "the page does not name {left:?}");
    (numbers, all)
}

#[test]
fn the_page_states_the_lines_of_code() {
    let page = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../docs/certificate_checks.md");
    let page = std::fs::read_to_string(page).unwrap();
    let section = page.split("## How much there is to read").nth(1).unwrap().split("\n## ").next().unwrap();
    let (judge, all) = numbers(section, "check");
    let (files, _) = numbers(section, "check-files");
    let (line, _) = numbers(section, "check-line");
    assert!(all <= MAX_OF_THE_JUDGE, "{all} lines judge one motion");
    // Stated sums use the same rows, and no answer about one motion may exceed the number on the page.
    let below: usize = judge[..3].iter().chain(&files[..3]).sum();
    let answers = [
        (judge[3], "on 2 917 lines", MOST),
        (judge[4], "on 3 220", MOST),
        (judge[3] + judge[5], "on 3 439", MOST),
        (judge[4] + line[0] + line[1], "on 3 644", MOST_FOR_A_LINE),
        (judge[3] + line[0] + line[2], "on 3 483", MOST_FOR_A_LINE),
    ];
    for (answer, report, most) in answers {
        let digits: usize = report.chars().filter(char::is_ascii_digit).collect::<String>().parse().unwrap();
        assert!(section.contains(report) && (below + answer).abs_diff(digits) < 10 && digits <= most, "{report}");
    }
}

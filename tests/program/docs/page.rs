//! A page of Markdown, as far as the tests look: its blocks of code, its links, its headings.

use super::root;
use std::path::{Path, PathBuf};

/// A file of Markdown.
pub struct Page {
    /// Path from the repository's root.
    pub name: String,
    pub file: PathBuf,
    text: String,
}

/// Lines between fences.
pub struct Block {
    /// Number of the first line within the block, from 1.
    pub line: usize,
    pub language: String,
    pub text: String,
    /// Texts of the comments directly above the block, such as `exit: 3` for `<!-- exit: 3 -->`.
    pub marks: Vec<String>,
}

impl Block {
    /// Returns the text after `key: ` in a mark. Returns `None` if no mark has this key.
    pub fn mark(&self, key: &str) -> Option<&str> {
        self.marks.iter().find_map(|mark| mark.strip_prefix(key)?.strip_prefix(": "))
    }
}

/// A link of a page.
pub struct Link {
    pub line: usize,
    pub target: String,
}

impl Page {
    pub fn read(file: &Path) -> Self {
        let name = file.strip_prefix(root()).unwrap().display().to_string().replace('\\', "/");
        Self { name, file: file.to_owned(), text: std::fs::read_to_string(file).unwrap().replace("\r\n", "\n") }
    }

    /// Returns the blocks of code, in order.
    pub fn blocks(&self) -> Vec<Block> {
        let (mut blocks, mut marks, mut open): (Vec<Block>, Vec<String>, Option<Block>) = Default::default();
        for (number, line) in (1..).zip(self.text.lines()) {
            if let Some(block) = &mut open {
                if line.starts_with("```") {
                    blocks.extend(open.take());
                } else {
                    block.text.push_str(&format!("{line}\n"));
                }
            } else if let Some(language) = line.strip_prefix("```") {
                let marks = std::mem::take(&mut marks);
                open = Some(Block { line: number + 1, language: language.into(), text: String::new(), marks });
            } else if let Some(mark) = line.strip_prefix("<!-- ").and_then(|rest| rest.strip_suffix(" -->")) {
                marks.push(mark.into());
            } else {
                marks.clear();
            }
        }
        assert!(open.is_none(), "{}: a fence that is not closed", self.name);
        blocks
    }

    /// Returns the lines of prose with their numbers, without blocks of code.
    pub fn prose(&self) -> Vec<(usize, &str)> {
        let mut within = false;
        let lines = (1..).zip(self.text.lines());
        let prose = lines.filter(|(_, line)| {
            let fence = line.starts_with("```");
            within ^= fence;
            !within && !fence
        });
        prose.collect()
    }

    /// Returns the targets of links and pictures. A link must be on one line.
    pub fn links(&self) -> Vec<Link> {
        let mut links = Vec::new();
        for (line, text) in self.prose() {
            let plain: String = text.split('`').step_by(2).collect();
            for (at, _) in plain.match_indices("](") {
                let target = plain[at + 2..].split(')').next().expect("at least an empty part");
                links.push(Link { line, target: target.into() });
            }
        }
        links
    }

    /// Returns the anchor of each heading, as GitHub and mdBook generate it.
    pub fn anchors(&self) -> Vec<String> {
        let prose = self.prose();
        let headings =
            prose.iter().filter(|(_, line)| line.starts_with('#')).map(|(_, line)| line.trim_start_matches('#').trim());
        let kept = |c: &char| c.is_alphanumeric() || [' ', '-', '_'].contains(c);
        headings
            .map(|heading| heading.to_lowercase().chars().filter(kept).collect::<String>().replace(' ', "-"))
            .collect()
    }
}

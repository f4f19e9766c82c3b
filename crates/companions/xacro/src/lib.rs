//! Reads xacro, the macro language in which most robot descriptions are written, and writes plain URDF.
//!
//! ```
//! use cplan_xacro::{Settings, expand};
//!
//! # let folder = tempfile::tempdir().unwrap();
//! let file = folder.path().join("arm.urdf.xacro");
//! std::fs::write(&file, r#"<robot name="arm" xmlns:xacro="http://www.ros.org/wiki/xacro">
//!   <xacro:arg name="reach" default="0.8"/>
//!   <xacro:property name="half" value="${$(arg reach) / 2}"/>
//!   <xacro:macro name="bar" params="name"><link name="${name}"/></xacro:macro>
//!   <xacro:bar name="upper_${half}"/>
//! </robot>"#).unwrap();
//! let settings = Settings { arguments: vec![("reach".into(), "1.2".into())], ..Settings::default() };
//! let expansion = expand(&file, &settings).unwrap();
//! assert!(expansion.text.contains(r#"<link name="upper_0.6"/>"#));
//! ```
//!
//! # Supported elements
//!
//! | element or word | meaning |
//! |---|---|
//! | `xacro:property` | a value, or a block of elements; with `default`, `scope` (`parent` or `global`), `lazy_eval`, `remove` |
//! | `xacro:arg` | a value that [`Settings::arguments`] may replace |
//! | `xacro:macro`, `xacro:call` | parameters with defaults (`a:=1`, `a:=^`, `a:=^\|1`), and blocks (`*a`, `**a`) |
//! | `xacro:insert_block` | a block, or the elements in it |
//! | `xacro:if`, `xacro:unless` | elements under a condition |
//! | `xacro:include` | another file, also with `ns` and `optional` |
//! | `${...}` | Python's expressions, without comprehensions and lambdas: numbers, text, lists, dicts, the functions of `math` |
//! | `$(arg ...)`, `$(find ...)`, `$(env ...)`, `$(optenv ...)`, `$(dirname)` | substitutions; packages are found by their `package.xml` |
//!
//! Everything else is an [`Error`] with its place and a hint.
//!
//! # Guarantees
//!
//! The same files and arguments give the same text. Every start tag and attribute of the text has the [`Place`] from which it
//! comes. No file makes the expansion take long: nesting, the number of steps and the size of the output are bounded.
#![forbid(unsafe_code)]

mod block;
mod document;
mod error;
mod expander;
mod expression;
mod include;
mod limits;
mod macros;
mod property;
mod scope;
mod substitution;
mod value;
mod writer;
mod yaml;

pub use cplan_packages::packages;
pub use document::{File, Place};
pub use error::Error;
pub use writer::Span;

use std::io;
use std::path::{Path, PathBuf};

/// Settings of an expansion.
#[derive(Debug, Clone)]
pub struct Settings {
    /// Names and values of arguments. If a name occurs several times, its last value counts.
    pub arguments: Vec<(String, String)>,
    /// Function that reads a file: the robot, an included file, or a YAML file.
    pub read: fn(&Path) -> io::Result<Vec<u8>>,
}

impl Default for Settings {
    fn default() -> Self {
        Self { arguments: Vec::new(), read: |path| std::fs::read(path) }
    }
}

/// A plain URDF, with the places in the files from which its parts come.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Expansion {
    /// The URDF.
    pub text: String,
    /// The XML files that were read, the robot's own first.
    pub files: Vec<File>,
    /// Paths of the YAML files that were read, in order.
    pub yaml: Vec<PathBuf>,
    /// Start tags and attributes of the text, in ascending order. Attributes follow their start tag.
    pub spans: Vec<Span>,
    /// Notes about omitted parts, for the user.
    pub notes: Vec<String>,
}

impl Expansion {
    /// Returns the place from which a byte of the text comes: that of the attribute around it, or else that of the last
    /// start tag before it.
    pub fn place(&self, offset: usize) -> Option<&Place> {
        let begun = self.spans.partition_point(|span| span.range.start <= offset);
        let before = &self.spans[..begun];
        before.iter().rev().take_while(|span| !span.is_tag).find(|span| span.range.contains(&offset)).map_or_else(
            || before.iter().rev().find(|span| span.is_tag).map(|span| &span.place),
            |span| Some(&span.place),
        )
    }
}

/// Expands a file, which may also be a plain URDF.
///
/// # Errors
/// A file that cannot be read, is not XML, or is invalid for xacro, too. A file that uses unsupported features, or
/// whose expansion exceeds the limits.
pub fn expand(path: &Path, settings: &Settings) -> Result<Expansion, Error> {
    expander::Expander::new(settings).run(path.to_owned())
}

/// Returns true if a text uses xacro: an element or attribute in its namespace, or an expression in an attribute. A
/// declaration of the namespace alone does not count.
pub fn is_xacro(text: &str) -> bool {
    document::uses_xacro(text)
}

/// Returns the path of a file relative to another file's folder.
fn path_beside(file: &Path, name: &str) -> PathBuf {
    file.with_file_name("").join(name)
}

//! Files for tests.

use cplan_xacro::{Error, Expansion, Settings, expand};
use std::path::Path;
use tempfile::TempDir;

/// A folder with files. The first is the robot.
pub struct Files {
    pub folder: TempDir,
    main: String,
}

impl Files {
    pub fn new(files: &[(&str, &str)]) -> Self {
        let folder = tempfile::tempdir().unwrap();
        for (name, text) in files {
            let path = folder.path().join(name);
            std::fs::create_dir_all(path.parent().unwrap()).unwrap();
            std::fs::write(path, text).unwrap();
        }
        Self { folder, main: files[0].0.to_owned() }
    }

    pub fn expand(&self, arguments: &[(&str, &str)]) -> Result<Expansion, Error> {
        let arguments = arguments.iter().map(|(name, value)| ((*name).to_owned(), (*value).to_owned())).collect();
        expand(&Path::new(self.folder.path()).join(&self.main), &Settings { arguments, ..Settings::default() })
    }
}

/// Returns a robot with this content.
pub fn robot(content: &str) -> String {
    format!("<robot name=\"r\" xmlns:xacro=\"http://www.ros.org/wiki/xacro\">\n{content}\n</robot>")
}

/// Returns the expanded content of a robot, without blanks between elements.
pub fn content(text: &str) -> String {
    let whole: String = text.lines().map(str::trim).collect();
    let begin = whole.find("<robot").map_or(0, |at| at + whole[at..].find('>').unwrap() + 1);
    whole[begin..].trim_end_matches("</robot>").to_owned()
}

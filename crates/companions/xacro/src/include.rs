//! The directive `xacro:include`.

use crate::document::{Element, Node};
use crate::error::{Error, Fault};
use crate::expander::Expander;
use crate::path_beside;
use std::path::Path;

impl Expander<'_> {
    pub(crate) fn include(&mut self, element: &Element, scope: usize, out: &mut Vec<Node>) -> Result<(), Error> {
        let [filename] = self.required(element, ["filename"])?;
        let named = self.value(&filename, scope)?.printed();
        let named = named.trim().strip_prefix("file://").unwrap_or(named.trim());
        let path = match named.strip_prefix("package://").and_then(|rest| rest.split_once('/')) {
            None => path_beside(&self.files[filename.place.file].path, named),
            Some((package, inside)) => {
                let folder = self.package(package, filename.place.file);
                Path::new(&folder.map_err(|fault| self.error(&filename.place, fault))?).join(inside)
            }
        };
        let same = path.canonicalize().unwrap_or_else(|_| path.clone());
        if self.open_files.contains(&same) {
            let message = format!("{} includes itself", path.display());
            return Err(self.error(&filename.place, Fault::with_hint(message, "remove the include")));
        }
        let is_optional =
            element.attribute("optional").is_some_and(|o| ["true", "True", "1"].contains(&o.value.as_str()));
        let root = match self.open(path.clone())? {
            Ok(root) => root,
            Err(_) if is_optional => return Ok(()),
            Err(why) => return Err(self.error(&filename.place, self.unread(&path, &why))),
        };
        let inner = match element.attribute("ns") {
            None => scope,
            Some(namespace) => {
                let name = self.value(namespace, scope)?.printed();
                self.scopes.open_namespace(scope, &name)
            }
        };
        self.open_files.push(same);
        self.nodes(&root.children, inner, out)?;
        self.open_files.pop();
        Ok(())
    }

    fn unread(&self, path: &Path, why: &str) -> Fault {
        let hint = match path.to_string_lossy().contains(['*', '?', '[']) {
            true => "cplan does not read patterns: include each file by its name",
            false => "correct the path, which is relative to this file",
        };
        Fault::with_hint(format!("{} {why}", path.display()), hint)
    }
}

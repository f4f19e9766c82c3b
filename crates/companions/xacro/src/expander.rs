//! Expands the elements of a file.

use crate::document::{self, Attribute, Element, File, Node, Place};
use crate::error::{Error, Fault};
use crate::limits::Budget;
use crate::scope::{GLOBAL_SCOPE, Scopes};
use crate::value::Value;
use crate::{Expansion, Settings, writer};
use std::collections::{BTreeMap, BTreeSet};
use std::path::PathBuf;
use std::rc::Rc;

/// Directives that old versions of xacro accepted without the prefix.
const OLD_DIRECTIVES: [&str; 3] = ["include", "macro", "property"];

/// The state of an expansion.
pub(crate) struct Expander<'s> {
    pub settings: &'s Settings,
    pub files: Vec<File>,
    pub scopes: Scopes,
    pub budget: Budget,
    /// Values of arguments that the settings state, by name.
    pub given: BTreeMap<String, String>,
    /// Values of the arguments that are declared.
    pub arguments: BTreeMap<String, String>,
    /// Names of the arguments that the files use.
    pub asked_arguments: BTreeSet<String>,
    /// Folders of packages, by the name of the package and the index of the file that refers to it.
    pub packages: BTreeMap<(String, usize), String>,
    /// Files that are being included.
    pub open_files: Vec<PathBuf>,
    /// Macros that are being called, with the place of the call.
    pub calls: Vec<(String, Place)>,
    /// Names and definitions of macros without a call so far.
    pub uncalled: Vec<(String, Rc<Element>)>,
    /// Paths of the YAML files that were read.
    pub yaml: Vec<PathBuf>,
    pub notes: Vec<String>,
    namespaces: Vec<(String, String)>,
}

impl<'s> Expander<'s> {
    pub fn new(settings: &'s Settings) -> Self {
        Self {
            settings,
            files: Vec::new(),
            scopes: Scopes::new(),
            budget: Budget::default(),
            given: settings.arguments.iter().cloned().collect(),
            arguments: BTreeMap::new(),
            asked_arguments: BTreeSet::new(),
            packages: BTreeMap::new(),
            open_files: Vec::new(),
            calls: Vec::new(),
            uncalled: Vec::new(),
            yaml: Vec::new(),
            notes: Vec::new(),
            namespaces: Vec::new(),
        }
    }

    pub fn run(mut self, path: PathBuf) -> Result<Expansion, Error> {
        let whole = |message: String, hint: &str| Error {
            path: path.clone(),
            place: None,
            message,
            hint: Some(hint.to_owned()),
        };
        let root = self.open(path.clone())?.map_err(|why| whole(why, "check the path and the file's permissions"))?;
        self.open_files.push(path.canonicalize().unwrap_or_else(|_| path.clone()));
        let mut children = Vec::new();
        self.nodes(&root.children, GLOBAL_SCOPE, &mut children)?;
        // Evaluate the attributes after the content, because they may use names that it defines.
        let attributes = self.attributes(&root, GLOBAL_SCOPE)?;
        let unused =
            self.given.keys().find(|name| !self.arguments.contains_key(*name) && !self.asked_arguments.contains(*name));
        if let Some(name) = unused {
            let known: Vec<&str> = self.arguments.keys().map(String::as_str).collect();
            let hint = match known.is_empty() {
                true => "leave --xacro-arg out".to_owned(),
                false => format!("its arguments are {}", known.join(", ")),
            };
            return Err(whole(format!("the robot has no argument \"{name}\""), &hint));
        }
        self.require_link(&children)?;
        let root = Element { name: root.name.clone(), attributes, children, place: root.place.clone() };
        let (text, spans) = writer::write(&root, &self.namespaces);
        Ok(Expansion { text, spans, files: self.files, yaml: self.yaml, notes: self.notes })
    }

    /// Reads and parses a file. The inner error states why the file cannot be read.
    pub fn open(&mut self, path: PathBuf) -> Result<Result<Rc<Element>, String>, Error> {
        let text = match document::text(&path, self.settings.read) {
            Ok(text) => text,
            Err(why) => return Ok(Err(why)),
        };
        let file = File { path, text: text.into() };
        let tree = document::read(&file, self.files.len())?;
        self.files.push(file);
        for (prefix, uri) in tree.namespaces {
            if !self.namespaces.iter().any(|(known, _)| *known == prefix) {
                self.namespaces.push((prefix, uri));
            }
        }
        Ok(Ok(tree.root))
    }

    /// Converts a fault to an error at a place.
    pub fn error(&self, place: &Place, fault: Fault) -> Error {
        let (message, hint) = match fault {
            Fault::Elsewhere(error) => return *error,
            Fault::Here(message, hint) => (message, hint),
        };
        let file = &self.files[place.file];
        let message = match self.calls.last() {
            None => message,
            Some((name, at)) => {
                let caller = &self.files[at.file];
                let line = caller.line(at.range.start);
                format!("{message} (in macro \"{name}\", called at {}:{line})", caller.path.display())
            }
        };
        Error { path: file.path.clone(), place: Some(Box::new((file.clone(), place.clone()))), message, hint }
    }

    pub fn value(&mut self, attribute: &Attribute, scope: usize) -> Result<Value, Error> {
        let value = self.text(&attribute.value, Self::context(scope, &attribute.place));
        value.map_err(|fault| self.error(&attribute.place, fault))
    }

    /// Evaluates the attributes of an element, except declarations of xacro's namespace.
    fn attributes(&mut self, element: &Element, scope: usize) -> Result<Vec<Attribute>, Error> {
        let mut attributes = Vec::new();
        for attribute in &element.attributes {
            let value = self.value(attribute, scope)?.printed();
            attributes.push(Attribute { value, ..attribute.clone() });
        }
        Ok(attributes)
    }

    /// Expands nodes and appends the result to `out`.
    pub fn nodes(&mut self, nodes: &[Node], scope: usize, out: &mut Vec<Node>) -> Result<(), Error> {
        for node in nodes {
            match node {
                Node::Element(element) => self.element(element, scope, out)?,
                Node::Text(text, place) if !text.trim().is_empty() => {
                    let text = self.text(text.trim(), Self::context(scope, place));
                    let text = text.map_err(|fault| self.error(place, fault))?.printed();
                    out.push(Node::Text(text.into(), place.clone()));
                }
                Node::Text(..) => {}
            }
        }
        Ok(())
    }

    fn element(&mut self, element: &Rc<Element>, scope: usize, out: &mut Vec<Node>) -> Result<(), Error> {
        let entered = self.budget.enter().and_then(|()| self.budget.spend(0));
        entered.map_err(|fault| self.error(&element.place, fault))?;
        match element.directive() {
            Some(name) => self.directive(name, element, scope, out)?,
            None => {
                self.check_prefix(element)?;
                let attributes = self.attributes(element, scope)?;
                let mut children = Vec::new();
                self.nodes(&element.children, scope, &mut children)?;
                let (name, place) = (element.name.clone(), element.place.clone());
                out.push(Node::Element(Rc::new(Element { name, attributes, children, place })));
            }
        }
        self.budget.leave();
        Ok(())
    }

    /// Refuses directives without the prefix, which only old versions of xacro accept.
    fn check_prefix(&self, element: &Element) -> Result<(), Error> {
        let is_old = match element.name.as_str() {
            "include" => element.attribute("filename").is_some(),
            "macro" => element.attribute("params").is_some(),
            "property" => element.attribute("name").is_some() && element.attribute("value").is_some(),
            _ => false,
        };
        match OLD_DIRECTIVES.into_iter().find(|name| is_old && *name == element.name) {
            None => Ok(()),
            Some(name) => {
                let message = format!("<{name}> without the prefix xacro: is not a directive in today's xacro");
                Err(self.error(&element.place, Fault::with_hint(message, format!("write <xacro:{name} ...>"))))
            }
        }
    }

    fn directive(&mut self, name: &str, element: &Rc<Element>, scope: usize, out: &mut Vec<Node>) -> Result<(), Error> {
        match name {
            "property" => self.property_element(element, scope),
            "arg" => self.arg_element(element, scope),
            "macro" => self.macro_element(element, scope),
            "insert_block" => self.insert_block(element, scope, out),
            "include" => self.include(element, scope, out),
            "if" | "unless" => {
                let [condition] = self.required(element, ["value"])?;
                let value = self.value(&condition, scope)?;
                let is_true = value.condition().ok_or_else(|| {
                    let message = format!("'{}' is not a condition", value.printed());
                    self.error(
                        &condition.place,
                        Fault::with_hint(message, "write true, false, or an expression: ${a == 1}"),
                    )
                })?;
                if is_true == (name == "if") { self.nodes(&element.children, scope, out) } else { Ok(()) }
            }
            "element" | "attribute" => {
                let message = format!("cplan does not read xacro:{name}");
                Err(self.error(
                    &element.place,
                    Fault::with_hint(message, "write the resulting element directly, inside xacro:if if necessary"),
                ))
            }
            "call" => {
                let [called] = self.required(element, ["macro"])?;
                let name = self.value(&called, scope)?.printed();
                self.call(&name, element, scope, out)
            }
            name => self.call(name, element, scope, out),
        }
    }

    /// Returns the attributes that an element must have.
    ///
    /// # Errors
    /// If one of them is missing.
    pub fn required<const N: usize>(&self, element: &Element, names: [&str; N]) -> Result<[Attribute; N], Error> {
        let missing = names.iter().find(|name| element.attribute(name).is_none());
        if let Some(name) = missing {
            let message = format!("<{}> has no {name}=\"...\"", element.name);
            return Err(self.error(&element.place, message.into()));
        }
        Ok(names.map(|name| {
            element.attribute(name).cloned().unwrap_or_else(|| Attribute {
                name: name.to_owned(),
                value: String::new(),
                place: element.place.clone(),
            })
        }))
    }
}

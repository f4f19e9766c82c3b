//! The directive `xacro:macro`, and calls of macros.

use crate::document::{Attribute, Element, Node, Place};
use crate::error::{Error, Fault};
use crate::expander::Expander;
use crate::scope::{Block, Slot};
use crate::value::Value;
use std::rc::Rc;

#[derive(Debug)]
pub(crate) struct Macro {
    parameters: Vec<Parameter>,
    body: Rc<Element>,
}

#[derive(Debug, PartialEq, Eq)]
struct Parameter {
    /// Name of the parameter, with the stars if it is a block.
    name: String,
    default: Option<Default>,
}

#[derive(Debug, PartialEq, Eq)]
struct Default {
    /// True if the default is the caller's property of the same name. If the caller has no such property, `text` is used.
    is_forwarded: bool,
    /// Text of the default, evaluated in the caller's scope. `None` if the default can only be the caller's property.
    text: Option<String>,
}

/// Parses the parameters in `params="a b:=1 c:=^ d:=^|2 *e **f"`.
fn parameters(text: &str) -> Vec<Parameter> {
    words(text)
        .into_iter()
        .map(|word| {
            let (name, default) = match word.split_once('=') {
                None => (word, None),
                Some((name, default)) => (name.strip_suffix(':').unwrap_or(name), Some(default)),
            };
            let default = default.map(|default| match default.strip_prefix('^') {
                None => Default { is_forwarded: false, text: Some(default.to_owned()) },
                Some(rest) => Default { is_forwarded: true, text: rest.strip_prefix('|').map(str::to_owned) },
            });
            Parameter { name: name.to_owned(), default }
        })
        .collect()
}

/// Splits a text at blanks, except within quotes and `${...}`.
fn words(text: &str) -> Vec<&str> {
    let (mut words, mut begin, mut closing) = (Vec::new(), None, None);
    for (at, c) in text.char_indices() {
        match (closing, c) {
            (Some(close), c) if c == close => closing = None,
            (Some(_), _) => {}
            (None, '\'' | '"') => closing = Some(c),
            (None, '{') => closing = Some('}'),
            (None, c) if c.is_whitespace() => words.extend(begin.take().map(|from: usize| &text[from..at])),
            (None, _) => {}
        }
        if begin.is_none() && !c.is_whitespace() {
            begin = Some(at);
        }
    }
    words.extend(begin.map(|from| &text[from..]));
    words
}

impl Expander<'_> {
    pub(crate) fn macro_element(&mut self, element: &Rc<Element>, scope: usize) -> Result<(), Error> {
        let [name] = self.required(element, ["name"])?;
        // In some files, the name in the definition also has the prefix.
        let name = name.value.strip_prefix("xacro:").unwrap_or(&name.value).to_owned();
        let params = element.attribute("params").map_or("", |params| params.value.as_str());
        let defined = Macro { parameters: parameters(params), body: Rc::clone(element) };
        self.scopes.set_macro(scope, &name, defined);
        self.uncalled.push((name, Rc::clone(element)));
        Ok(())
    }

    /// Refuses a file that defines a robot as a macro but never calls it.
    ///
    /// # Errors
    /// If the expanded robot has no link, and a macro is never called.
    pub(crate) fn require_link(&self, content: &[Node]) -> Result<(), Error> {
        let has_link = content.iter().filter_map(Node::element).any(|element| element.name == "link");
        // Included files usually define parts that the main file joins.
        let is_own = |(_, body): &&(String, Rc<Element>)| body.place.file == 0;
        let own = self.uncalled.iter().rfind(is_own).or(self.uncalled.last());
        let Some((name, body)) = own.filter(|_| !has_link) else { return Ok(()) };
        let list = parameters(body.attribute("params").map_or("", |params| params.value.as_str()));
        let needed = list.iter().filter(|parameter| parameter.default.is_none());
        let (blocks, values): (Vec<_>, Vec<_>) =
            needed.map(|p| p.name.as_str()).partition(|name| name.starts_with('*'));
        let values: String = values.iter().map(|value| format!(" {value}=\"...\"")).collect();
        let call = match blocks.is_empty() {
            true => format!("<xacro:{name}{values}/>"),
            false => format!("<xacro:{name}{values}>...</xacro:{name}> with elements for {}", blocks.join(", ")),
        };
        let message = format!("the macro \"{name}\" is defined and never called, so the robot has no link");
        Err(self.error(&body.place, Fault::with_hint(message, format!("call the macro before </robot>: {call}"))))
    }

    /// Replaces a call by the expansion of its macro.
    pub(crate) fn call(
        &mut self,
        name: &str,
        element: &Rc<Element>,
        scope: usize,
        out: &mut Vec<Node>,
    ) -> Result<(), Error> {
        let Some(called) = self.scopes.find_macro(scope, name) else {
            let known = self.scopes.macro_names(scope);
            let hint = match known.is_empty() {
                true => "define the macro before this call, or include the file that defines it".to_owned(),
                false => format!("defined before this call: {}", known.join(", ")),
            };
            return Err(self.error(&element.place, Fault::with_hint(format!("there is no macro \"{name}\""), hint)));
        };
        self.uncalled.retain(|(_, body)| !Rc::ptr_eq(body, &called.body));
        let inner = self.scopes.open(scope);
        let given: Vec<&Attribute> =
            element.attributes.iter().filter(|a| !(element.name == "xacro:call" && a.name == "macro")).collect();
        for attribute in &given {
            if !called.parameters.iter().any(|p| p.name == attribute.name) {
                let known: Vec<&str> = called.parameters.iter().map(|p| p.name.as_str()).collect();
                let message = format!("the macro \"{name}\" has no parameter \"{}\"", attribute.name);
                let hint = match known.is_empty() {
                    true => "it has no parameters".to_owned(),
                    false => format!("its parameters are {}", known.join(", ")),
                };
                return Err(self.error(&attribute.place, Fault::with_hint(message, hint)));
            }
            let value = self.value(attribute, scope)?.literal();
            self.scopes.set(inner, &attribute.name, Slot::Value(value));
        }
        self.blocks(&called, (name, element), [scope, inner])?;
        for parameter in called.parameters.iter().filter(|p| !p.name.starts_with('*')) {
            if given.iter().any(|attribute| attribute.name == parameter.name) {
                continue;
            }
            let value = self.default(parameter, scope, &element.place, &called.body.place)?;
            let value = value.ok_or_else(|| {
                let message =
                    format!("the macro \"{name}\" is called without \"{}\", which has no default", parameter.name);
                self.error(
                    &element.place,
                    Fault::with_hint(message, format!("write {}=\"...\" in the call", parameter.name)),
                )
            })?;
            self.scopes.set(inner, &parameter.name, Slot::Value(value.literal()));
        }
        self.calls.push((name.to_owned(), element.place.clone()));
        self.nodes(&called.body.children, inner, out)?;
        self.calls.pop();
        Ok(())
    }

    fn default(
        &mut self,
        parameter: &Parameter,
        scope: usize,
        call: &Place,
        defined: &Place,
    ) -> Result<Option<Value>, Error> {
        let Some(default) = &parameter.default else { return Ok(None) };
        if default.is_forwarded {
            let value = self.forwarded(scope, &parameter.name).map_err(|fault| self.error(call, fault))?;
            if value.is_some() {
                return Ok(value);
            }
        }
        let Some(text) = &default.text else { return Ok(None) };
        let value = self.text(text, Self::context(scope, defined));
        value.map(Some).map_err(|fault| self.error(defined, fault))
    }

    /// Assigns the elements in a call to the blocks of the macro, in order, after expanding them in the caller's scope.
    fn blocks(
        &mut self,
        called: &Macro,
        (name, element): (&str, &Element),
        [scope, inner]: [usize; 2],
    ) -> Result<(), Error> {
        let mut children = Vec::new();
        self.nodes(&element.children, scope, &mut children)?;
        let mut elements = children.iter().filter_map(Node::element);
        for parameter in called.parameters.iter().filter(|p| p.name.starts_with('*')) {
            let Some(block) = elements.next() else {
                let message =
                    format!("the call of the macro \"{name}\" lacks the element for its block \"{}\"", parameter.name);
                return Err(self.error(&element.place, Fault::with_hint(message, "write the element into the call")));
            };
            let nodes = match parameter.name.starts_with("**") {
                true => block.children.clone(),
                false => vec![Node::Element(Rc::clone(block))],
            };
            self.scopes.set_block(inner, parameter.name.clone(), Block { nodes, is_source: false });
        }
        match elements.next() {
            None => Ok(()),
            Some(extra) => {
                let message = format!("the macro \"{name}\" takes no element such as <{}>", extra.name);
                Err(self
                    .error(&extra.place, Fault::with_hint(message, "a macro names its blocks in params, with a star")))
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn parameters_have_defaults_blocks_and_forwards() {
        let found = parameters("a  b:=1 c='x y' d:=^ e:=^|${1 + 2} *f **g");
        let names: Vec<&str> = found.iter().map(|p| p.name.as_str()).collect();
        assert_eq!(names, ["a", "b", "c", "d", "e", "*f", "**g"]);
        let default = |at: usize| found[at].default.as_ref().map(|d| (d.is_forwarded, d.text.as_deref()));
        let expected = [None, Some((false, Some("1"))), Some((false, Some("'x y'"))), Some((true, None))];
        assert_eq!([0, 1, 2, 3].map(default), expected);
        assert_eq!(default(4), Some((true, Some("${1 + 2}"))));
    }
}

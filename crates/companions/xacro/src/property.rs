//! The directives `xacro:property` and `xacro:arg`.

use crate::document::Element;
use crate::error::{Error, Fault};
use crate::expander::Expander;
use crate::scope::{Block, GLOBAL_SCOPE, Slot};

impl Expander<'_> {
    pub(crate) fn property_element(&mut self, element: &Element, scope: usize) -> Result<(), Error> {
        let [name] = self.required(element, ["name"])?;
        let is_name = name.value.starts_with(|c: char| c.is_alphabetic() || c == '_')
            && name.value.chars().all(|c| c.is_alphanumeric() || c == '_');
        if !is_name {
            let message = format!("\"{}\" is not a valid name of a property", name.value);
            return Err(self.error(&name.place, Fault::with_hint(message, "names consist of letters, digits and _")));
        }
        let (name, words) = (name.value.as_str(), ["true", "True", "1"]);
        if element.attribute("remove").is_some_and(|remove| words.contains(&remove.value.as_str())) {
            self.scopes.remove(scope, name);
            return Ok(());
        }
        let wanted = element.attribute("scope");
        let target = match wanted.map(|wanted| wanted.value.as_str()) {
            None => scope,
            Some("global") => GLOBAL_SCOPE,
            Some("parent") => self.scopes.parent(scope).unwrap_or(GLOBAL_SCOPE),
            Some(other) => {
                let message = format!("scope=\"{other}\" is neither \"parent\" nor \"global\"");
                return Err(self.error(&element.place, message.into()));
            }
        };
        let default = element.attribute("default");
        if default.is_some() && self.scopes.find(scope, name).is_some() {
            return Ok(());
        }
        let Some(value) = element.attribute("value").or(default) else {
            let block = Block { nodes: element.children.clone(), is_source: true };
            self.scopes.set_block(target, format!("**{name}"), block);
            return Ok(());
        };
        let is_lazy = wanted.is_none()
            && !element
                .attribute("lazy_eval")
                .is_some_and(|lazy| ["false", "False", "0"].contains(&lazy.value.as_str()));
        let slot = match is_lazy && value.value.contains('$') {
            true => Slot::Unevaluated(value.value.as_str().into(), value.place.clone()),
            false => Slot::Value(self.value(value, scope)?.literal()),
        };
        self.scopes.set(target, name, slot);
        Ok(())
    }

    pub(crate) fn arg_element(&mut self, element: &Element, scope: usize) -> Result<(), Error> {
        let [name] = self.required(element, ["name"])?;
        let name = self.value(&name, scope)?.printed();
        if self.arguments.contains_key(&name) {
            return Ok(());
        }
        let value = match (self.given.get(&name), element.attribute("default")) {
            (Some(given), _) => Some(given.clone()),
            (None, Some(default)) => Some(self.value(default, scope)?.printed()),
            (None, None) => None,
        };
        self.arguments.extend(value.map(|value| (name, value)));
        Ok(())
    }
}

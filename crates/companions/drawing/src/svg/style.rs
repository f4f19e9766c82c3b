//! The relevant parts of an element's style: whether it is visible, and whether it is filled.

use crate::FillRule;
use roxmltree::Node;
use simplecss::{AttributeOperator, DeclarationTokenizer, Element, PseudoClass, StyleSheet};

/// An element's style, including inherited properties.
#[derive(Debug, Clone, Copy)]
pub(super) struct Style {
    pub is_displayed: bool,
    pub is_visible: bool,
    pub is_filled: bool,
    pub rule: FillRule,
}

impl Default for Style {
    fn default() -> Self {
        Self { is_displayed: true, is_visible: true, is_filled: true, rule: FillRule::NonZero }
    }
}

impl Style {
    /// Returns the style of an element whose parent has this style. The element's own declarations take precedence over
    /// style sheets, and these over its attributes.
    pub fn of(mut self, node: Node, sheet: &StyleSheet) -> Self {
        for attribute in node.attributes().filter(|attribute| attribute.namespace().is_none()) {
            self.set(attribute.name(), attribute.value());
        }
        for rule in sheet.rules.iter().filter(|rule| rule.selector.matches(&SelectorElement(node))) {
            rule.declarations.iter().for_each(|declared| self.set(declared.name, declared.value));
        }
        for declared in DeclarationTokenizer::from(node.attribute("style").unwrap_or_default()) {
            self.set(declared.name, declared.value);
        }
        self
    }

    fn set(&mut self, name: &str, value: &str) {
        let value = value.trim();
        match (name, value) {
            (_, "inherit") => {}
            ("display", _) => self.is_displayed = value != "none",
            ("visibility", _) => self.is_visible = value == "visible",
            ("fill", _) => self.is_filled = !["none", "transparent"].contains(&value),
            ("fill-rule", "evenodd") => self.rule = FillRule::EvenOdd,
            ("fill-rule", "nonzero") => self.rule = FillRule::NonZero,
            _ => {}
        }
    }
}

/// An element in the form that selectors need.
struct SelectorElement<'a, 'i>(Node<'a, 'i>);

impl Element for SelectorElement<'_, '_> {
    fn parent_element(&self) -> Option<Self> {
        self.0.parent_element().map(Self)
    }

    fn prev_sibling_element(&self) -> Option<Self> {
        self.0.prev_sibling_element().map(Self)
    }

    fn has_local_name(&self, name: &str) -> bool {
        self.0.tag_name().name() == name
    }

    fn attribute_matches(&self, name: &str, operator: AttributeOperator<'_>) -> bool {
        self.0.attribute(name).is_some_and(|value| operator.matches(value))
    }

    fn pseudo_class_matches(&self, class: PseudoClass<'_>) -> bool {
        class == PseudoClass::FirstChild && self.0.prev_sibling_element().is_none()
    }
}

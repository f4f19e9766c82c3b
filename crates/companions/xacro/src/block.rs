//! The directive `xacro:insert_block`.

use crate::document::{Element, Node};
use crate::error::{Error, Fault};
use crate::expander::Expander;

impl Expander<'_> {
    pub(crate) fn insert_block(&mut self, element: &Element, scope: usize, out: &mut Vec<Node>) -> Result<(), Error> {
        let [name] = self.required(element, ["name"])?;
        let place = name.place.clone();
        let name = self.value(&name, scope)?.printed();
        let content = self.scopes.block(scope, &format!("**{name}"));
        let block = content.or_else(|| self.scopes.block(scope, &format!("*{name}"))).ok_or_else(|| {
            let message = format!("there is no block \"{name}\"");
            self.error(
                &place,
                Fault::with_hint(message, "a macro names its blocks in params, with a star: params=\"*origin\""),
            )
        })?;
        match block.is_source {
            true => self.nodes(&block.nodes, scope, out),
            false => {
                for node in &block.nodes {
                    let spent = self.budget.spend(size(node));
                    spent.map_err(|fault| self.error(&place, fault))?;
                    out.push(node.clone());
                }
                Ok(())
            }
        }
    }
}

/// Estimates the size of a node in the output, in bytes.
fn size(node: &Node) -> usize {
    match node {
        Node::Text(text, _) => text.len(),
        Node::Element(element) => {
            let attributes = element.attributes.iter().map(|a| a.name.len() + a.value.len() + 4);
            element.name.len() + attributes.sum::<usize>() + element.children.iter().map(size).sum::<usize>()
        }
    }
}

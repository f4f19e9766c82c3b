//! Scopes of names.

use crate::document::{Node, Place};
use crate::macros::Macro;
use crate::value::Value;
use std::collections::BTreeMap;
use std::rc::Rc;

/// The value of a name, possibly not yet evaluated.
#[derive(Debug, Clone)]
pub(crate) enum Slot {
    /// A text that is evaluated when the name is used, with its place.
    Unevaluated(Rc<str>, Place),
    /// A text that is being evaluated. Using the name now is an error.
    Evaluating,
    Value(Value),
}

/// Named nodes that `xacro:insert_block` inserts.
#[derive(Debug, Clone)]
pub(crate) struct Block {
    pub nodes: Vec<Node>,
    /// True if the nodes must be expanded where they are inserted, as those of properties. Nodes of a macro's parameter
    /// are already expanded.
    pub is_source: bool,
}

/// The names of a file, of a call of a macro, or of a namespace.
#[derive(Debug, Default)]
pub(crate) struct Scope {
    parent: Option<usize>,
    slots: BTreeMap<String, Slot>,
    /// Blocks by name, with stars: `*a` is an element, and `**a` its content.
    blocks: BTreeMap<String, Rc<Block>>,
    macros: BTreeMap<String, Rc<Macro>>,
    namespaces: BTreeMap<String, usize>,
}

/// All scopes. The first one belongs to the robot's own file. Each other one has the index of its parent.
#[derive(Debug)]
pub(crate) struct Scopes(Vec<Scope>);

/// Index of the robot's own scope.
pub(crate) const GLOBAL_SCOPE: usize = 0;

impl Scopes {
    pub fn new() -> Self {
        Self(vec![Scope::default()])
    }

    /// Opens a scope within another one.
    pub fn open(&mut self, parent: usize) -> usize {
        self.0.push(Scope { parent: Some(parent), ..Scope::default() });
        self.0.len() - 1
    }

    /// Opens a scope with a name.
    pub fn open_namespace(&mut self, parent: usize, name: &str) -> usize {
        let scope = self.open(parent);
        self.0[parent].namespaces.insert(name.to_owned(), scope);
        scope
    }

    /// Returns the parent scope. `None` for the robot's own scope.
    pub fn parent(&self, scope: usize) -> Option<usize> {
        self.0[scope].parent
    }

    /// Returns the scopes to search for a name, and the name without its namespaces.
    fn candidates<'n>(&self, scope: usize, name: &'n str) -> (Vec<usize>, &'n str) {
        let mut about: Vec<usize> = std::iter::successors(Some(scope), |scope| self.0[*scope].parent).collect();
        let mut rest = name;
        while let Some((namespace, inside)) = rest.split_once('.') {
            let Some(found) = about.iter().find_map(|scope| self.0[*scope].namespaces.get(namespace)) else {
                return (Vec::new(), rest);
            };
            (about, rest) = (vec![*found], inside);
        }
        (about, rest)
    }

    /// Returns the scope that has a property, and the property's name there.
    pub fn find<'n>(&self, scope: usize, name: &'n str) -> Option<(usize, &'n str)> {
        let (about, name) = self.candidates(scope, name);
        about.into_iter().find(|scope| self.0[*scope].slots.contains_key(name)).map(|scope| (scope, name))
    }

    /// Returns the value of a name in exactly this scope, ignoring its parents.
    pub fn slot(&self, scope: usize, name: &str) -> Option<&Slot> {
        self.0[scope].slots.get(name)
    }

    pub fn set(&mut self, scope: usize, name: &str, slot: Slot) {
        self.0[scope].slots.insert(name.to_owned(), slot);
    }

    /// Removes the property and the block with this name.
    pub fn remove(&mut self, scope: usize, name: &str) {
        self.0[scope].slots.remove(name);
        self.0[scope].blocks.remove(&format!("**{name}"));
    }

    pub fn block(&self, scope: usize, name: &str) -> Option<Rc<Block>> {
        let (about, name) = self.candidates(scope, name);
        about.into_iter().find_map(|scope| self.0[scope].blocks.get(name).cloned())
    }

    pub fn set_block(&mut self, scope: usize, name: String, block: Block) {
        self.0[scope].blocks.insert(name, Rc::new(block));
    }

    pub fn find_macro(&self, scope: usize, name: &str) -> Option<Rc<Macro>> {
        let (about, name) = self.candidates(scope, name);
        about.into_iter().find_map(|scope| self.0[scope].macros.get(name).cloned())
    }

    pub fn set_macro(&mut self, scope: usize, name: &str, defined: Macro) {
        self.0[scope].macros.insert(name.to_owned(), Rc::new(defined));
    }

    /// Returns the names of all macros that can be called.
    pub fn macro_names(&self, scope: usize) -> Vec<String> {
        let about = std::iter::successors(Some(scope), |scope| self.0[*scope].parent);
        let mut names: Vec<String> = about.flat_map(|scope| self.0[scope].macros.keys().cloned()).collect();
        names.sort();
        names.dedup();
        names
    }
}

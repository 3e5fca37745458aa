//! Filling lists, sets and dictionaries.

use super::PickleError;
use super::machine::Machine;
use super::node::{Id, Node};

impl Machine {
    pub(super) fn append(&mut self, items: &[Id]) -> Result<(), PickleError> {
        let target = self.stack.top(self.byte)?;
        self.charge_items(items.len())?;
        match &mut self.nodes[target as usize] {
            Node::List(list) => list.extend_from_slice(items),
            other => {
                let found = other.kind().into();
                return Err(self.malformed("a list to append to", found));
            }
        }
        Ok(())
    }

    pub(super) fn add_items(&mut self, items: &[Id]) -> Result<(), PickleError> {
        let target = self.stack.top(self.byte)?;
        self.charge_items(items.len())?;
        match &mut self.nodes[target as usize] {
            Node::Set(set) => set.extend_from_slice(items),
            other => {
                let found = other.kind().into();
                return Err(self.malformed("a set to add to", found));
            }
        }
        Ok(())
    }

    pub(super) fn set_items(&mut self, items: &[Id]) -> Result<(), PickleError> {
        let target = self.stack.top(self.byte)?;
        let pairs = self.pairs(items)?;
        match &mut self.nodes[target as usize] {
            Node::Dict(dict) => dict.extend(pairs),
            other => {
                let found = other.kind().into();
                return Err(self.malformed("a dictionary to fill", found));
            }
        }
        Ok(())
    }

    pub(super) fn pairs(&mut self, items: &[Id]) -> Result<Vec<(Id, Id)>, PickleError> {
        self.charge_items(items.len())?;
        let (pairs, rest) = items.as_chunks::<2>();
        if !rest.is_empty() {
            return Err(self.malformed("a value for each key", "a key alone".into()));
        }
        Ok(pairs.iter().map(|&[key, value]| (key, value)).collect())
    }
}

//! The stack of a pickle machine, with marks that nothing reaches through.

use super::PickleError;
use super::node::Id;

#[derive(Debug, Default)]
pub(super) struct Stack {
    values: Vec<Id>,
    /// Height of the stack at each open mark.
    marks: Vec<usize>,
}

impl Stack {
    /// Puts a value on top.
    pub(super) fn push(&mut self, id: Id) {
        self.values.push(id);
    }

    /// Opens a mark.
    pub(super) fn mark(&mut self, byte: usize, limit: usize) -> Result<(), PickleError> {
        if self.marks.len() >= limit {
            return Err(PickleError::Limit {
                byte,
                what: "the number of open containers",
                found: self.marks.len() as u64 + 1,
                limit: limit as u64,
            });
        }
        self.marks.push(self.values.len());
        Ok(())
    }

    /// Takes the top value; never one below the last mark.
    pub(super) fn pop(&mut self, byte: usize) -> Result<Id, PickleError> {
        self.top(byte)?;
        self.values.pop().ok_or_else(|| underflow(byte))
    }

    /// The top value, above the last mark.
    pub(super) fn top(&self, byte: usize) -> Result<Id, PickleError> {
        let floor = self.marks.last().copied().unwrap_or(0);
        let above = self.values.get(floor..).unwrap_or_default();
        above.last().copied().ok_or_else(|| underflow(byte))
    }

    /// Takes `count` values, lowest first.
    pub(super) fn take(&mut self, byte: usize, count: usize) -> Result<Vec<Id>, PickleError> {
        let floor = self.marks.last().copied().unwrap_or(0);
        if self.values.len() - floor < count {
            return Err(underflow(byte));
        }
        Ok(self.values.split_off(self.values.len() - count))
    }

    /// Number of values above the last mark.
    pub(super) fn above_mark(&self, byte: usize) -> Result<usize, PickleError> {
        let floor = self.marks.last().ok_or_else(|| no_mark(byte))?;
        Ok(self.values.len() - floor)
    }

    /// Closes the last mark and takes what lay above it.
    pub(super) fn take_mark(&mut self, byte: usize) -> Result<Vec<Id>, PickleError> {
        let floor = self.marks.pop().ok_or_else(|| no_mark(byte))?;
        Ok(self.values.split_off(floor))
    }

    /// `POP` on a mark closes it.
    pub(super) fn pop_value_or_mark(&mut self, byte: usize) -> Result<(), PickleError> {
        if self.marks.last() == Some(&self.values.len()) {
            self.marks.pop();
            return Ok(());
        }
        self.pop(byte).map(drop)
    }
}

fn underflow(byte: usize) -> PickleError {
    PickleError::Malformed {
        byte,
        expected: "a value on the stack",
        found: "none above the last mark".into(),
    }
}

fn no_mark(byte: usize) -> PickleError {
    PickleError::Malformed {
        byte,
        expected: "an open mark",
        found: "none".into(),
    }
}

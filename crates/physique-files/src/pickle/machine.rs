//! The machine: one loop over instructions, with values of its own instead of Python's.

use std::collections::HashMap;

use super::blob::{Blob, Bytes};
use super::cursor::Cursor;
use super::global::Global;
use super::instruction::Instruction;
use super::limits::Budget;
use super::node::{Id, Node};
use super::stack::Stack;
use super::{PickleError, PickleLimits};

/// What a finished machine hands over.
#[derive(Debug)]
pub(super) struct Finished {
    pub(super) bytes: Bytes,
    pub(super) nodes: Vec<Node>,
    pub(super) root: Id,
    /// Where the bytes after the pickle start.
    pub(super) end: usize,
}

#[derive(Debug)]
pub(super) struct Machine {
    pub(super) bytes: Bytes,
    pub(super) nodes: Vec<Node>,
    pub(super) limits: PickleLimits,
    pub(super) budget: Budget,
    /// Start of the instruction at work.
    pub(super) byte: usize,
    /// Buffers that lie outside the pickle (protocol 5) and have not been asked for yet.
    pub(super) buffers: std::vec::IntoIter<Blob>,
    pub(super) stack: Stack,
    pub(super) memo: HashMap<u32, Id>,
}

impl Machine {
    pub(super) fn new(bytes: Bytes, buffers: Vec<Blob>, limits: PickleLimits) -> Self {
        Self {
            bytes,
            nodes: Vec::new(),
            limits,
            budget: Budget::new(limits.bytes),
            byte: 0,
            buffers: buffers.into_iter(),
            stack: Stack::default(),
            memo: HashMap::new(),
        }
    }

    /// Runs from `start` to the instruction `STOP`.
    pub(super) fn run(mut self, start: usize, end: usize) -> Result<Finished, PickleError> {
        let mut position = start;
        loop {
            self.byte = position;
            let file = self.bytes.file();
            let mut cursor = Cursor::new(&file[..end.min(file.len())], position);
            let instruction = Instruction::read(&mut cursor)?;
            position = cursor.position();
            if instruction == Instruction::Stop {
                let root = self.stack.pop(self.byte)?;
                return Ok(Finished {
                    bytes: self.bytes,
                    nodes: self.nodes,
                    root,
                    end: position,
                });
            }
            self.step(instruction)?;
            if instruction == Instruction::Build {
                position = self.bytes_behind_joblib_array(position, end)?;
            }
        }
    }

    /// Adds a value to the table and to the stack.
    pub(super) fn push(&mut self, node: Node) -> Result<(), PickleError> {
        let id = self.add(node)?;
        self.stack.push(id);
        Ok(())
    }

    /// Adds a value to the table.
    pub(super) fn add(&mut self, node: Node) -> Result<Id, PickleError> {
        let limit = self.limits.values.min(u32::MAX as usize);
        if self.nodes.len() >= limit {
            return Err(PickleError::Limit {
                byte: self.byte,
                what: "the number of values",
                found: self.nodes.len() as u64 + 1,
                limit: limit as u64,
            });
        }
        // Twice, because a growing table holds up to twice what it needs.
        self.budget.charge(self.byte, 2 * size_of::<Node>())?;
        let id = self.nodes.len() as Id;
        self.nodes.push(node);
        Ok(id)
    }

    /// The value on top of the stack.
    pub(super) fn top(&self) -> Result<Id, PickleError> {
        self.stack.top(self.byte)
    }

    /// The value of a number; all numbers come from [`Machine::add`].
    pub(super) fn node(&self, id: Id) -> &Node {
        &self.nodes[id as usize]
    }

    pub(super) fn kind(&self, id: Id) -> &'static str {
        self.node(id).kind()
    }

    pub(super) fn tuple(&self, id: Id) -> Result<&[Id], PickleError> {
        match self.node(id) {
            Node::Tuple(items) => Ok(items),
            other => Err(self.malformed("a tuple", other.kind().into())),
        }
    }

    /// Keeps decoded bytes beside the file.
    pub(super) fn keep(&mut self, decoded: &[u8]) -> Result<Blob, PickleError> {
        self.budget
            .charge(self.byte, decoded.len().saturating_mul(2))?;
        Ok(self.bytes.keep(decoded))
    }

    pub(super) fn charge_items(&mut self, count: usize) -> Result<(), PickleError> {
        let bytes = count.saturating_mul(2 * size_of::<Id>());
        self.budget.charge(self.byte, bytes)
    }

    pub(super) fn malformed(&self, expected: &'static str, found: String) -> PickleError {
        PickleError::Malformed {
            byte: self.byte,
            expected,
            found,
        }
    }

    pub(super) fn take_mark(&mut self) -> Result<Vec<Id>, PickleError> {
        let count = self.stack.above_mark(self.byte)?;
        self.charge_items(count)?;
        self.stack.take_mark(self.byte)
    }

    pub(super) fn find(&self, module: Blob, name: Blob) -> Result<Global, PickleError> {
        let (module, name) = (self.bytes.get(module), self.bytes.get(name));
        Global::find(module, name).ok_or_else(|| {
            let shown = |text: &[u8]| {
                let start = String::from_utf8_lossy(&text[..text.len().min(120)]);
                start.escape_debug().to_string()
            };
            PickleError::Refused {
                byte: self.byte,
                module: shown(module),
                name: shown(name),
            }
        })
    }

    pub(super) fn global(&self, id: Id) -> Result<Global, PickleError> {
        match self.node(id) {
            Node::Global(global) => Ok(*global),
            other => Err(self.malformed("a function or class", other.kind().into())),
        }
    }

    pub(super) fn construct_from(&mut self, class: Id, arguments: Id) -> Result<(), PickleError> {
        let class = self.global(class)?;
        let arguments = self.tuple(arguments)?.to_vec();
        let id = self.construct(class, &arguments)?;
        self.stack.push(id);
        Ok(())
    }

    pub(super) fn put(&mut self, number: u32) -> Result<(), PickleError> {
        let top = self.stack.top(self.byte)?;
        if self.memo.len() >= self.limits.memo && !self.memo.contains_key(&number) {
            return Err(PickleError::Limit {
                byte: self.byte,
                what: "the memo",
                found: self.memo.len() as u64 + 1,
                limit: self.limits.memo as u64,
            });
        }
        // An entry, its control byte, and room to grow.
        self.budget.charge(self.byte, 24)?;
        self.memo.insert(number, top);
        Ok(())
    }
}

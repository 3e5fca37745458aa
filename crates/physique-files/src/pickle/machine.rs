//! The machine: one loop over instructions, with values of its own instead of Python's.

use std::collections::HashMap;

use super::blob::{Blob, Bytes};
use super::cursor::Cursor;
use super::escapes::{raw_unicode_escape, unquote};
use super::global::Global;
use super::instruction::{Instruction, shown};
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
    buffers: std::vec::IntoIter<Blob>,
    stack: Stack,
    memo: HashMap<u32, Id>,
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

    fn step(&mut self, instruction: Instruction) -> Result<(), PickleError> {
        let byte = self.byte;
        match instruction {
            Instruction::None => self.push(Node::None),
            Instruction::Bool(value) => self.push(Node::Bool(value)),
            Instruction::Integer(value) => self.push(Node::Integer(value)),
            Instruction::Float(value) => self.push(Node::Float(value)),
            Instruction::Bytes(blob) => self.push(Node::Bytes(blob)),
            Instruction::Text(blob) => {
                if str::from_utf8(self.bytes.get(blob)).is_err() {
                    return Err(self.malformed("text in UTF-8", shown(self.bytes.get(blob))));
                }
                self.push(Node::Text(blob))
            }
            Instruction::QuotedBytes(blob) => {
                let decoded = unquote(self.bytes.get(blob));
                let decoded = decoded
                    .ok_or_else(|| self.malformed("quoted bytes", shown(self.bytes.get(blob))))?;
                let blob = self.keep(&decoded)?;
                self.push(Node::Bytes(blob))
            }
            Instruction::EscapedText(blob) => {
                let decoded = raw_unicode_escape(self.bytes.get(blob));
                let decoded = decoded
                    .ok_or_else(|| self.malformed("escaped text", shown(self.bytes.get(blob))))?;
                let blob = self.keep(decoded.as_bytes())?;
                self.push(Node::Text(blob))
            }
            Instruction::EmptyList => self.push(Node::List(Vec::new())),
            Instruction::EmptyTuple => self.push(Node::Tuple(Vec::new())),
            Instruction::EmptyDict => self.push(Node::Dict(Vec::new())),
            Instruction::EmptySet => self.push(Node::Set(Vec::new())),
            Instruction::Mark => self.stack.mark(byte, self.limits.depth),
            Instruction::Pop => self.stack.pop_value_or_mark(byte),
            Instruction::PopMark => self.stack.take_mark(byte).map(drop),
            Instruction::Duplicate => {
                let top = self.stack.top(byte)?;
                self.stack.push(top);
                Ok(())
            }
            Instruction::Tuple(count) => {
                let items = self.stack.take(byte, count)?;
                self.charge_items(items.len())?;
                self.push(Node::Tuple(items))
            }
            Instruction::TupleFromMark => {
                let items = self.take_mark()?;
                self.push(Node::Tuple(items))
            }
            Instruction::ListFromMark => {
                let items = self.take_mark()?;
                self.push(Node::List(items))
            }
            Instruction::DictFromMark => {
                let items = self.take_mark()?;
                let pairs = self.pairs(&items)?;
                self.push(Node::Dict(pairs))
            }
            Instruction::FrozenSetFromMark => {
                let items = self.take_mark()?;
                self.push(Node::Set(items))
            }
            Instruction::Append => {
                let item = self.stack.take(byte, 1)?;
                self.append(&item)
            }
            Instruction::Appends => {
                let items = self.take_mark()?;
                self.append(&items)
            }
            Instruction::SetItem => {
                let items = self.stack.take(byte, 2)?;
                self.set_items(&items)
            }
            Instruction::SetItems => {
                let items = self.take_mark()?;
                self.set_items(&items)
            }
            Instruction::AddItems => {
                let items = self.take_mark()?;
                self.add_items(&items)
            }
            Instruction::Get(number) => {
                let id = self.memo.get(&number).copied();
                let id = id.ok_or_else(|| {
                    self.malformed("a number of the memo", format!("{number}, never stored"))
                })?;
                self.stack.push(id);
                Ok(())
            }
            Instruction::Put(number) => self.put(number),
            Instruction::Memoize => {
                // The memo is bounded far below 2^32.
                self.put(self.memo.len() as u32)
            }
            Instruction::Global { module, name } => {
                let global = self.find(module, name)?;
                self.push(Node::Global(global))
            }
            Instruction::StackGlobal => {
                let (name, module) = (self.stack.pop(byte)?, self.stack.pop(byte)?);
                let (Node::Text(module), Node::Text(name)) = (self.node(module), self.node(name))
                else {
                    let found = format!("{}, {}", self.kind(module), self.kind(name));
                    return Err(self.malformed("a module and a name, both text", found));
                };
                let global = self.find(*module, *name)?;
                self.push(Node::Global(global))
            }
            Instruction::Instance { module, name } => {
                let class = self.find(module, name)?;
                let arguments = self.take_mark()?;
                let id = self.construct(class, &arguments)?;
                self.stack.push(id);
                Ok(())
            }
            Instruction::ObjectFromMark => {
                let items = self.take_mark()?;
                let Some((&class, arguments)) = items.split_first() else {
                    return Err(self.malformed("a class above the mark", "nothing".into()));
                };
                let class = self.global(class)?;
                let id = self.construct(class, arguments)?;
                self.stack.push(id);
                Ok(())
            }
            Instruction::NewObject => {
                let (arguments, class) = (self.stack.pop(byte)?, self.stack.pop(byte)?);
                self.construct_from(class, arguments)
            }
            Instruction::NewObjectWithKeywords => {
                let keywords = self.stack.pop(byte)?;
                let (arguments, class) = (self.stack.pop(byte)?, self.stack.pop(byte)?);
                match self.node(keywords) {
                    Node::Dict(pairs) if pairs.is_empty() => self.construct_from(class, arguments),
                    _ => Err(self.malformed("no keywords", self.kind(keywords).into())),
                }
            }
            Instruction::Reduce => {
                let (arguments, callable) = (self.stack.pop(byte)?, self.stack.pop(byte)?);
                let callable = self.global(callable)?;
                let arguments = self.tuple(arguments)?.to_vec();
                let id = self.call(callable, &arguments)?;
                self.stack.push(id);
                Ok(())
            }
            Instruction::Build => {
                let state = self.stack.pop(byte)?;
                let target = self.stack.top(byte)?;
                self.build(target, state)
            }
            Instruction::PersistentText(blob) => {
                let found = shown(self.bytes.get(blob));
                Err(self.malformed("no reference to things outside the pickle", found))
            }
            Instruction::Persistent => {
                let reference = self.stack.pop(byte)?;
                let storage = self.storage(reference)?;
                self.push(Node::Storage(Box::new(storage)))
            }
            Instruction::Buffer => match self.buffers.next() {
                Some(blob) => self.push(Node::Bytes(blob)),
                None => Err(self.malformed(
                    "no buffer outside the pickle, or one handed to the reader",
                    "one more than was handed over".into(),
                )),
            },
            Instruction::ReadOnlyBuffer => self.stack.top(byte).map(drop),
            Instruction::Nothing | Instruction::Stop => Ok(()),
            Instruction::Extension(number) => Err(PickleError::Refused {
                byte,
                module: "copyreg".into(),
                name: format!("extension {number}"),
            }),
        }
    }

    /// Adds a value to the table and to the stack.
    fn push(&mut self, node: Node) -> Result<(), PickleError> {
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

    fn take_mark(&mut self) -> Result<Vec<Id>, PickleError> {
        let count = self.stack.above_mark(self.byte)?;
        self.charge_items(count)?;
        self.stack.take_mark(self.byte)
    }

    fn find(&self, module: Blob, name: Blob) -> Result<Global, PickleError> {
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

    fn global(&self, id: Id) -> Result<Global, PickleError> {
        match self.node(id) {
            Node::Global(global) => Ok(*global),
            other => Err(self.malformed("a function or class", other.kind().into())),
        }
    }

    fn construct_from(&mut self, class: Id, arguments: Id) -> Result<(), PickleError> {
        let class = self.global(class)?;
        let arguments = self.tuple(arguments)?.to_vec();
        let id = self.construct(class, &arguments)?;
        self.stack.push(id);
        Ok(())
    }

    fn put(&mut self, number: u32) -> Result<(), PickleError> {
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

    fn append(&mut self, items: &[Id]) -> Result<(), PickleError> {
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

    fn add_items(&mut self, items: &[Id]) -> Result<(), PickleError> {
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

    fn set_items(&mut self, items: &[Id]) -> Result<(), PickleError> {
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

    fn pairs(&mut self, items: &[Id]) -> Result<Vec<(Id, Id)>, PickleError> {
        self.charge_items(items.len())?;
        let (pairs, rest) = items.as_chunks::<2>();
        if !rest.is_empty() {
            return Err(self.malformed("a value for each key", "a key alone".into()));
        }
        Ok(pairs.iter().map(|&[key, value]| (key, value)).collect())
    }
}

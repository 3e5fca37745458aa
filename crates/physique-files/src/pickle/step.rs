//! What each instruction does to the stack and the table.

use super::PickleError;
use super::escapes::{raw_unicode_escape, unquote};
use super::instruction::{Instruction, shown};
use super::machine::Machine;
use super::node::Node;

impl Machine {
    pub(super) fn step(&mut self, instruction: Instruction) -> Result<(), PickleError> {
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
}

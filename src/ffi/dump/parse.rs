//! Reads the text of a dump. The text is not trusted: any mistake in it becomes an error that names the line.

use super::image::UNREAD;
use super::FIRST_LINE;
use crate::ffi::member::{Kind, Place, Struct};
use crate::ffi::members::structure;

/// The target of a pointer in a file.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Target {
    Null,
    /// A struct or an array that the file does not contain.
    Unread,
    /// The item of this index, which counts from 0.
    Item(usize),
}

/// The value of a member.
#[derive(Clone, Copy, Debug)]
pub(super) enum Value {
    Int32(i32),
    Int64(i64),
    Double(f64),
    Pointer(Target),
    /// Whether the calling program had set the member: a callback, or a pointer that only this program can interpret.
    OfTheHost(bool),
}

/// A struct or an array that has a number in a file.
#[derive(Debug)]
pub(super) enum Item {
    /// A struct, or an array of structs of which the file has the first one.
    Struct {
        kind: &'static Struct,
        /// The bytes to allocate.
        room: usize,
        members: Vec<(Place, Value)>,
    },
    /// `count` values of `size` bytes each. They begin at byte `first_byte` of the data.
    Array { size: usize, count: usize, first_byte: usize },
    /// An array of so many bytes that the call writes and does not read.
    Output { bytes: usize },
}

/// What the text of a dump says.
#[derive(Debug, Default)]
pub(super) struct Parsed {
    pub library: String,
    pub call: String,
    pub status: i32,
    pub message: String,
    pub arguments: Vec<(String, Target)>,
    pub integers: Vec<(String, i64)>,
    pub items: Vec<Item>,
    /// The bytes that the arrays so far take in the data.
    data: usize,
}

/// Reads the text of a dump. Returns its contents, and the bytes after the text, which are the data of the arrays.
pub(super) fn parse(bytes: &[u8]) -> Result<(Parsed, &[u8]), String> {
    let (mut parsed, mut rest, mut number) = (Parsed::default(), bytes, 0);
    loop {
        number += 1;
        let end = rest.iter().position(|byte| *byte == b'\n').ok_or("the text has no end: it is no dump")?;
        let line = std::str::from_utf8(&rest[..end]).map_err(|_| format!("line {number} is no text"))?;
        rest = &rest[end + 1..];
        if number == 1 {
            if line != FIRST_LINE {
                return Err(format!("it does not begin with \"{FIRST_LINE}\""));
            }
            continue;
        }
        let refuse = |why: String| format!("line {number}: {why}");
        let (word, said) = line.split_once(' ').ok_or_else(|| refuse("a word alone".into()))?;
        if word == "data" {
            let declared = said.parse().map_err(|_| refuse("no number of bytes".into()))?;
            if parsed.data != declared || rest.len() != declared {
                let (arrays, found) = (parsed.data, rest.len());
                return Err(format!("the arrays take {arrays} bytes, the text says {declared}, and there are {found}"));
            }
            return Ok((parsed, rest));
        }
        parsed.read_line(word, said).map_err(refuse)?;
    }
}

/// Word `number` of a line (counted from 0, without the first word), converted to `T`.
fn word<T: std::str::FromStr>(said: &str, number: usize) -> Result<T, String> {
    let word = said.split(' ').nth(number).ok_or("a word is missing")?;
    word.parse().map_err(|_| format!("what is \"{word}\"?"))
}

/// Word `number` of a line, as the target of a pointer.
fn target(said: &str, number: usize) -> Result<Target, String> {
    match word::<String>(said, number)?.as_str() {
        "NULL" => Ok(Target::Null),
        UNREAD => Ok(Target::Unread),
        _ => match word::<usize>(said, number)? {
            0 => Err("items are counted from 1".into()),
            item => Ok(Target::Item(item - 1)),
        },
    }
}

impl Parsed {
    /// Reads a line: its first word, and the rest.
    fn read_line(&mut self, first: &str, said: &str) -> Result<(), String> {
        match first {
            "library" => self.library = said.into(),
            "call" => self.call = said.into(),
            "status" => self.status = word(said, 0)?,
            "message" => self.message = unescaped(said),
            "argument" => self.arguments.push((word(said, 0)?, target(said, 1)?)),
            "integer" => self.integers.push((word(said, 0)?, word(said, 1)?)),
            "struct" | "array" | "output" => {
                let item = self.item(first, said)?;
                // Items are numbered from 1 in the order of their lines, so that no number is missing or used twice.
                if word::<usize>(said, 0)? != self.items.len() + 1 {
                    return Err(format!("it must be number {}", self.items.len() + 1));
                }
                self.items.push(item);
            }
            _ => return self.member(first, said),
        }
        Ok(())
    }

    /// Reads the line of a struct, an array or an output.
    fn item(&mut self, first: &str, said: &str) -> Result<Item, String> {
        let name: String = word(said, 1)?;
        match first {
            "struct" => {
                let kind = structure(&name).ok_or_else(|| format!("this library knows no struct {name}"))?;
                Ok(Item::Struct { kind, room: word(said, 2)?, members: Vec::new() })
            }
            "output" => Ok(Item::Output { bytes: word(said, 1)? }),
            _ => {
                let size: usize = match name.as_str() {
                    "double" => 8,
                    "int32" => 4,
                    _ => return Err(format!("what is an array of {name}?")),
                };
                let (count, first_byte) = (word(said, 2)?, self.data);
                let bytes = size.checked_mul(count).and_then(|bytes| bytes.checked_next_multiple_of(8));
                self.data = bytes.and_then(|bytes| first_byte.checked_add(bytes)).ok_or("an array without end")?;
                Ok(Item::Array { size, count, first_byte })
            }
        }
    }

    /// Reads the line of a member of the last struct.
    fn member(&mut self, first: &str, said: &str) -> Result<(), String> {
        let name: String = word(said, 0)?;
        let Some(Item::Struct { kind, members, .. }) = self.items.last_mut() else {
            return Err(format!("what is \"{first}\"?"));
        };
        let known = kind.places().find(|place| place.name == name);
        let place = known.ok_or_else(|| format!("this library knows no member {name} of {}", kind.name))?;
        let value = match (first, place.kind) {
            ("int32", Kind::Int32) => Value::Int32(word(said, 1)?),
            ("int64", Kind::Int64) => Value::Int64(word(said, 1)?),
            ("double", Kind::Double) => {
                let bits: String = word(said, 1)?;
                let bits = u64::from_str_radix(&bits, 16).map_err(|_| "no bits of a double")?;
                Value::Double(f64::from_bits(bits))
            }
            ("host", Kind::OfTheHost) => Value::OfTheHost(word::<String>(said, 1)? == "given"),
            ("pointer", Kind::Array | Kind::Structs(_)) => Value::Pointer(target(said, 1)?),
            (first, kind) => return Err(format!("{name} is no {first} but {kind:?}")),
        };
        members.push((place, value));
        Ok(())
    }
}

/// The message from its line in the file: the line has `\n` (two characters) for the end of a line, and `\\` for a backslash.
fn unescaped(said: &str) -> String {
    let (mut text, mut characters) = (String::new(), said.chars());
    while let Some(character) = characters.next() {
        match character {
            '\\' => text.push(if characters.next() == Some('n') { '\n' } else { '\\' }),
            _ => text.push(character),
        }
    }
    text
}

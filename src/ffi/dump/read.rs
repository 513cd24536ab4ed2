//! A dump that was read: structs and arrays in memory again, which point to each other as they did.

use std::ops::Range;

use super::parse::{parse, Item, Parsed, Target, Value};
use crate::ffi::fields::contact_normal_fields;
use crate::ffi::member::Kind;
use crate::ffi::options::contact_normal_options;
use crate::ffi::scene::contact_normal_scene;
use crate::ffi::structs::{Versioned, LARGEST};

/// Bytes that the calls of a file may write at most.
const MOST_BYTES: usize = 1 << 32;

/// The arguments of a call and its end: the file of `options->dump`.
///
/// A file is not trusted. The memory of the call has the lengths of the file, and the call is refused before it reads or writes beyond it.
pub struct Dump {
    parsed: Parsed,
    /// The memory of each item, in words: every value is aligned. Calls write into it, so it is used by the pointers below.
    memory: Vec<Vec<u64>>,
    starts: Vec<*mut u64>,
}

impl Dump {
    /// Reads the bytes of a file. An error tells why this version cannot read them.
    pub fn read(bytes: &[u8]) -> Result<Dump, String> {
        let (parsed, data) = parse(bytes)?;
        let sizes: Vec<usize> = parsed.items.iter().map(room).collect();
        let total = sizes.iter().try_fold(0usize, |total, size| total.checked_add(*size));
        let data_room = data.len().saturating_add(MOST_BYTES);
        if total.is_none_or(|total| total > data_room) {
            return Err(format!("it asks for more than {MOST_BYTES} bytes of results"));
        }
        // Zeros come from the system, which gives pages only when they are used.
        let mut memory: Vec<Vec<u64>> = sizes.iter().map(|size| vec![0; size.div_ceil(8)]).collect();
        for (item, to) in parsed.items.iter().zip(&mut memory) {
            if let Item::Array { size, count, at } = item {
                copy(&data[*at..][..size * count], *size, to);
            }
        }
        let starts = memory.iter_mut().map(|words| words.as_mut_ptr()).collect();
        let dump = Dump { parsed, memory, starts };
        dump.write_structs()?;
        Ok(dump)
    }

    /// The function that was called.
    pub fn call(&self) -> &str {
        &self.parsed.call
    }

    /// The version of the library that wrote it.
    pub fn library(&self) -> &str {
        &self.parsed.library
    }

    /// The status that the call ended with.
    pub fn status(&self) -> i32 {
        self.parsed.status
    }

    /// Its message.
    pub fn message(&self) -> &str {
        &self.parsed.message
    }

    /// The scene of the call; its pointers are valid as long as the dump.
    pub fn scene(&self) -> Option<&contact_normal_scene> {
        self.structure("scene")
    }

    /// The options of the call, likewise. Callbacks and their data, which belonged to the host, are NULL.
    pub fn options(&self) -> Option<&contact_normal_options> {
        self.structure("options")
    }

    /// The struct of the arrays of the call, likewise.
    pub fn fields(&self) -> Option<&contact_normal_fields> {
        self.structure("fields")
    }

    /// The `count` values that a member of a struct points to. None if the file holds fewer.
    #[allow(clippy::not_unsafe_ptr_arg_deref)] // nothing but the memory of the file is read
    pub fn doubles_at(&self, at: *const f64, count: usize) -> Option<Vec<f64>> {
        // SAFETY: the memory holds `count` values.
        self.holds(at, count).then(|| unsafe { std::slice::from_raw_parts(at, count) }.to_vec())
    }

    /// The `count` integers that a member of a struct points to. None if the file holds fewer.
    #[allow(clippy::not_unsafe_ptr_arg_deref)] // nothing but the memory of the file is read
    pub fn integers_at(&self, at: *const i32, count: usize) -> Option<Vec<i32>> {
        // SAFETY: the memory holds `count` values.
        self.holds(at, count).then(|| unsafe { std::slice::from_raw_parts(at, count) }.to_vec())
    }

    fn holds<T>(&self, at: *const T, count: usize) -> bool {
        let (at, bytes) = (at as usize, count.checked_mul(size_of::<T>()));
        let end = bytes.and_then(|bytes| at.checked_add(bytes));
        let is_aligned = at % align_of::<T>() == 0;
        at != 0 && is_aligned && end.is_some_and(|end| self.ranges().iter().any(|r| r.start <= at && end <= r.end))
    }

    /// The struct that an argument points to.
    fn structure<T: Versioned>(&self, name: &str) -> Option<&T> {
        // SAFETY: NULL or the memory of a struct of this kind, which lives as long as the dump, and any bytes of which are valid.
        unsafe { self.pointer::<T>(name).ok()?.as_ref() }
    }

    /// A pointer to the struct of an argument.
    pub(super) fn pointer<T: Versioned>(&self, name: &str) -> Result<*mut T, String> {
        match self.target(name) {
            Target::Null => Ok(std::ptr::null_mut()),
            Target::Item(item) if is_struct(&self.parsed.items, item, T::NAME) => Ok(self.start(item) as *mut T),
            Target::Item(_) => Err(format!("{name} is no {}", T::NAME)),
            Target::Unread => Err(format!("{name} could not be read when it was written, and is not in the file")),
        }
    }

    /// A pointer to the array of an argument.
    pub(super) fn array<T>(&self, name: &str) -> Result<*mut T, String> {
        match self.target(name) {
            Target::Null => Ok(std::ptr::null_mut()),
            Target::Item(item) if !matches!(self.parsed.items.get(item), None | Some(Item::Struct { .. })) => {
                Ok(self.start(item) as *mut T)
            }
            Target::Item(_) => Err(format!("{name} is no array")),
            Target::Unread => Err(format!("{name} could not be read when it was written, and is not in the file")),
        }
    }

    /// The integer argument of this name.
    pub(super) fn integer(&self, name: &str) -> Result<i32, String> {
        let found = self.parsed.integers.iter().find(|(known, _)| known == name);
        let value = found.ok_or_else(|| format!("{name} is not in the file"))?.1;
        i32::try_from(value).map_err(|_| format!("{name} is {value}"))
    }

    /// The values of an array of doubles that is an argument, or of a handle ("handle.pressure"); none if there is none of this name.
    pub fn doubles(&self, name: &str) -> Option<Vec<f64>> {
        let Target::Item(item) = self.target(name) else { return None };
        let Some(Item::Array { size: 8, count, .. }) = self.parsed.items.get(item) else { return None };
        // SAFETY: the memory holds `count` values.
        Some(unsafe { std::slice::from_raw_parts(self.starts[item].cast::<f64>(), *count) }.to_vec())
    }

    fn target(&self, name: &str) -> Target {
        let found = self.parsed.arguments.iter().find(|(known, _)| known == name);
        found.map_or(Target::Null, |(_, target)| *target)
    }

    /// Members that point to memory that is not in the file.
    pub fn missing(&self) -> Vec<String> {
        let structs = self.parsed.items.iter().filter_map(|item| match item {
            Item::Struct { kind, members, .. } => Some((kind, members)),
            _ => None,
        });
        let missing = structs.flat_map(|(kind, members)| {
            let unread = members.iter().filter(|(_, value)| matches!(value, Value::Pointer(Target::Unread)));
            unread.map(move |(place, _)| format!("{}->{}", &kind.name["contact_normal_".len()..], place.name))
        });
        missing.collect()
    }

    /// Members that the host had set, and which are NULL here.
    pub fn of_the_host(&self) -> Vec<&str> {
        let members = self.parsed.items.iter().flat_map(|item| match item {
            Item::Struct { members, .. } => &members[..],
            _ => &[],
        });
        members.filter(|(_, value)| matches!(value, Value::OfTheHost(true))).map(|(place, _)| &*place.name).collect()
    }

    /// The memory that calls may use.
    pub(super) fn ranges(&self) -> Vec<Range<usize>> {
        let sizes = self.memory.iter().map(Vec::len);
        self.starts.iter().zip(sizes).map(|(start, words)| *start as usize..*start as usize + words * 8).collect()
    }

    fn start(&self, item: usize) -> usize {
        self.starts[item] as usize
    }

    fn write_structs(&self) -> Result<(), String> {
        for index in 0..self.memory.len() {
            let Item::Struct { members, .. } = &self.parsed.items[index] else { continue };
            for (place, value) in members {
                let bits = match *value {
                    Value::Int32(value) => u64::from(value as u32),
                    Value::Int64(value) => value as u64,
                    Value::Double(value) => value.to_bits(),
                    Value::OfTheHost(_) => 0,
                    Value::Pointer(Target::Item(item)) => self.place(place.kind, item)? as u64,
                    Value::Pointer(_) => 0,
                };
                // SAFETY (both): a struct of ours has room for any size, and its members are aligned.
                unsafe {
                    let to = self.starts[index].cast::<u8>().add(place.at);
                    match place.kind.bytes() {
                        4 => to.cast::<u32>().write(bits as u32),
                        _ => to.cast::<u64>().write(bits),
                    }
                }
            }
        }
        Ok(())
    }

    /// The address of an item to which a member of this kind may point.
    fn place(&self, kind: Kind, item: usize) -> Result<usize, String> {
        let fits = match (kind, self.parsed.items.get(item)) {
            (Kind::Structs(name), Some(Item::Struct { .. })) => is_struct(&self.parsed.items, item, name),
            (Kind::Array, Some(Item::Array { .. } | Item::Output { .. })) => true,
            _ => false,
        };
        fits.then(|| self.start(item)).ok_or_else(|| format!("item {} is not what points to it", item + 1))
    }
}

fn is_struct(items: &[Item], item: usize, name: &str) -> bool {
    matches!(items.get(item), Some(Item::Struct { kind, .. }) if kind.name == name)
}

/// Bytes of memory for an item. A struct has room for the largest size that a struct may declare.
fn room(item: &Item) -> usize {
    match item {
        Item::Struct { room, .. } => LARGEST.max(*room),
        Item::Array { size, count, .. } => size * count,
        Item::Output { bytes } => *bytes,
    }
}

/// Little-endian values of `size` bytes, as those of the machine.
fn copy(from: &[u8], size: usize, to: &mut [u64]) {
    for (word, bytes) in to.iter_mut().zip(from.chunks(8)) {
        let mut eight = [0; 8];
        eight[..bytes.len()].copy_from_slice(bytes);
        if cfg!(target_endian = "big") {
            eight.chunks_exact_mut(size).for_each(<[u8]>::reverse);
        }
        *word = u64::from_ne_bytes(eight);
    }
}

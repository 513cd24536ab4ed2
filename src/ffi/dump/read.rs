//! A dump that was read: the structs and arrays of the call are in memory again, and point to each other as before.

use std::ops::Range;

use super::parse::{parse, Item, Parsed, Target, Value};
use crate::ffi::fields::contact_normal_fields;
use crate::ffi::member::Kind;
use crate::ffi::options::contact_normal_options;
use crate::ffi::scene::contact_normal_scene;
use crate::ffi::structs::{Versioned, LARGEST};

/// The largest memory in bytes that a file may ask for besides its own data: the results of the call.
const MOST_BYTES: usize = 1 << 32;

/// The file of `options->dump`: the arguments of a call, its status and its message.
///
/// A file is not trusted. The structs and arrays have the lengths that the file says, and a call is refused before it reads or writes beyond them.
pub struct Dump {
    parsed: Parsed,
    /// The memory of each item, in words of 8 bytes, so that every value is aligned. Because calls write into this memory, it is used through
    /// `starts` only.
    memory: Vec<Vec<u64>>,
    /// The address of the memory of each item.
    starts: Vec<*mut u64>,
}

impl Dump {
    /// Reads the bytes of a file. The error says why this version cannot read them.
    pub fn read(bytes: &[u8]) -> Result<Dump, String> {
        let (parsed, data) = parse(bytes)?;
        let sizes: Vec<usize> = parsed.items.iter().map(room).collect();
        let total = sizes.iter().try_fold(0usize, |total, size| total.checked_add(*size));
        let data_room = data.len().saturating_add(MOST_BYTES);
        if total.is_none_or(|total| total > data_room) {
            return Err(format!("it asks for more than {MOST_BYTES} bytes of results"));
        }
        // The system provides pages of zeros only when they are used, so outputs cost memory only where the call writes.
        let mut memory: Vec<Vec<u64>> = sizes.iter().map(|size| vec![0; size.div_ceil(8)]).collect();
        for (item, to) in parsed.items.iter().zip(&mut memory) {
            if let Item::Array { size, count, first_byte } = item {
                copy(&data[*first_byte..][..size * count], *size, to);
            }
        }
        let starts = memory.iter_mut().map(|words| words.as_mut_ptr()).collect();
        let dump = Dump { parsed, memory, starts };
        dump.write_structs()?;
        Ok(dump)
    }

    /// The name of the function that was called.
    pub fn call(&self) -> &str {
        &self.parsed.call
    }

    /// The version of the library that wrote the file.
    pub fn library(&self) -> &str {
        &self.parsed.library
    }

    /// The status with which the call ended.
    pub fn status(&self) -> i32 {
        self.parsed.status
    }

    /// The message with which the call ended.
    pub fn message(&self) -> &str {
        &self.parsed.message
    }

    /// The scene of the call. The pointers in it are valid as long as the dump exists.
    pub fn scene(&self) -> Option<&contact_normal_scene> {
        self.structure("scene")
    }

    /// The options of the call, with pointers as in [`Dump::scene`]. Callbacks and their data, which belonged to the calling program, are NULL.
    pub fn options(&self) -> Option<&contact_normal_options> {
        self.structure("options")
    }

    /// The `fields` of the call, with pointers as in [`Dump::scene`].
    pub fn fields(&self) -> Option<&contact_normal_fields> {
        self.structure("fields")
    }

    /// A copy of the `count` values to which a member of a struct points. None if the file has fewer.
    #[allow(clippy::not_unsafe_ptr_arg_deref)] // nothing but the memory of the file is read
    pub fn doubles_at(&self, at: *const f64, count: usize) -> Option<Vec<f64>> {
        // SAFETY: the memory holds `count` values.
        self.holds(at, count).then(|| unsafe { std::slice::from_raw_parts(at, count) }.to_vec())
    }

    /// A copy of the `count` integers to which a member of a struct points. None if the file has fewer.
    #[allow(clippy::not_unsafe_ptr_arg_deref)] // nothing but the memory of the file is read
    pub fn integers_at(&self, at: *const i32, count: usize) -> Option<Vec<i32>> {
        // SAFETY: the memory holds `count` values.
        self.holds(at, count).then(|| unsafe { std::slice::from_raw_parts(at, count) }.to_vec())
    }

    /// Whether `count` aligned values from this address on are in the memory of one item.
    fn holds<T>(&self, at: *const T, count: usize) -> bool {
        let (at, bytes) = (at as usize, count.checked_mul(size_of::<T>()));
        let end = bytes.and_then(|bytes| at.checked_add(bytes));
        let is_aligned = at % align_of::<T>() == 0;
        at != 0 && is_aligned && end.is_some_and(|end| self.ranges().iter().any(|r| r.start <= at && end <= r.end))
    }

    /// The struct to which an argument points. None: the argument is NULL, not in the file, or of another kind.
    fn structure<T: Versioned>(&self, name: &str) -> Option<&T> {
        // SAFETY: NULL or the memory of a struct of this kind, which lives as long as the dump, and any bytes of which are valid.
        unsafe { self.pointer::<T>(name).ok()?.as_ref() }
    }

    /// The pointer that an argument is, to a struct or to the first one of an array of structs.
    pub(super) fn pointer<T: Versioned>(&self, name: &str) -> Result<*mut T, String> {
        match self.target(name) {
            Target::Null => Ok(std::ptr::null_mut()),
            Target::Item(item) if is_struct(&self.parsed.items, item, T::NAME) => Ok(self.start(item) as *mut T),
            Target::Item(_) => Err(format!("{name} is no {}", T::NAME)),
            Target::Unread => Err(format!("{name} could not be read when it was written, and is not in the file")),
        }
    }

    /// The pointer that an argument is, to an array of numbers.
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

    /// A copy of an array of doubles: an argument of the call, or an array of the handle ("handle.pressure"). None: there is no such array.
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

    /// The names of members that pointed to a struct or array that is not in the file.
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

    /// The names of members that the calling program had set to callbacks or to data of its own. They are NULL here.
    pub fn of_the_host(&self) -> Vec<&str> {
        let members = self.parsed.items.iter().flat_map(|item| match item {
            Item::Struct { members, .. } => &members[..],
            _ => &[],
        });
        members.filter(|(_, value)| matches!(value, Value::OfTheHost(true))).map(|(place, _)| &*place.name).collect()
    }

    /// The ranges of addresses that calls may read and write.
    pub(super) fn ranges(&self) -> Vec<Range<usize>> {
        let sizes = self.memory.iter().map(Vec::len);
        self.starts.iter().zip(sizes).map(|(start, words)| *start as usize..*start as usize + words * 8).collect()
    }

    fn start(&self, item: usize) -> usize {
        self.starts[item] as usize
    }

    /// Writes the members of all structs into memory.
    fn write_structs(&self) -> Result<(), String> {
        for index in 0..self.memory.len() {
            let Item::Struct { members, .. } = &self.parsed.items[index] else { continue };
            for (place, value) in members {
                let bits = match *value {
                    Value::Int32(value) => u64::from(value as u32),
                    Value::Int64(value) => value as u64,
                    Value::Double(value) => value.to_bits(),
                    Value::OfTheHost(_) => 0,
                    Value::Pointer(Target::Item(item)) => self.address(place.kind, item)? as u64,
                    Value::Pointer(_) => 0,
                };
                // SAFETY (both): the memory of a struct has room for any size, and its members are aligned.
                unsafe {
                    let to = self.starts[index].cast::<u8>().add(place.offset);
                    match place.kind.bytes() {
                        4 => to.cast::<u32>().write(bits as u32),
                        _ => to.cast::<u64>().write(bits),
                    }
                }
            }
        }
        Ok(())
    }

    /// The address of an item. Refuses an item to which a member of this kind cannot point.
    fn address(&self, kind: Kind, item: usize) -> Result<usize, String> {
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

/// The bytes of memory for an item. A struct gets room for the largest size that a struct may declare.
fn room(item: &Item) -> usize {
    match item {
        Item::Struct { room, .. } => LARGEST.max(*room),
        Item::Array { size, count, .. } => size * count,
        Item::Output { bytes } => *bytes,
    }
}

/// Copies little-endian values of `size` bytes to memory, in the byte order of this machine.
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

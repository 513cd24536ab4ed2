//! The arguments of a call, as text and bytes.

use std::fmt::Write;

use super::argument::Argument;
use crate::ffi::arguments::{Element, Region, Regions};
use crate::ffi::member::{Kind, Place};
use crate::ffi::members::structure;
use crate::ffi::structs::LARGEST;

/// The text for a pointer whose target is not in the file.
pub(super) const UNREAD: &str = "unread";

/// The text that lists structs and arrays, and the bytes of the arrays, in order.
#[derive(Default)]
pub(super) struct Image {
    pub text: String,
    pub data: Vec<u8>,
    /// The structs and arrays that have a number: address and kind of each.
    items: Vec<(usize, Option<&'static str>)>,
    /// The number of items that are written.
    written: usize,
    /// Whether there was no memory for a copy.
    pub lacks_memory: bool,
}

impl Image {
    /// The image of the arguments of a call. They point to the caller's memory.
    pub unsafe fn of(arguments: &[(&'static str, Argument)], regions: &Regions) -> Image {
        let mut image = Image::default();
        // SAFETY: by the caller.
        unsafe { image.add(arguments, regions) };
        image
    }

    /// Adds arguments and all that they point to.
    pub unsafe fn add(&mut self, arguments: &[(&str, Argument)], regions: &Regions) {
        for (name, argument) in arguments {
            let value = match *argument {
                Argument::Integer(value) => {
                    self.line(&format!("integer {name} {value}"));
                    continue;
                }
                // SAFETY: by the caller.
                Argument::Struct(kind, at) => unsafe { self.struct_at(at, kind) },
                Argument::Array(at) => self.array_at(at, regions),
            };
            self.line(&format!("argument {name} {value}"));
        }
        while self.written < self.items.len() {
            let (at, kind) = self.items[self.written];
            self.written += 1;
            let number = self.written;
            match kind {
                // SAFETY: by the caller; `struct_at` has checked it.
                Some(kind) => unsafe { self.write_struct(number, at, kind, regions) },
                // SAFETY: by the caller: the call reads or writes what its regions say.
                None => unsafe { self.write_array(number, at, regions) },
            }
        }
    }

    /// Adds an array of the library's own.
    pub fn add_doubles(&mut self, name: &str, values: &[f64]) {
        let number = self.own_item(name);
        self.line(&format!("array {number} double {}", values.len()));
        self.add_bytes(values.len() * 8, values.iter().flat_map(|value| value.to_le_bytes()));
    }

    /// Adds an array of integers of the library's own.
    pub fn add_integers(&mut self, name: &str, values: &mut dyn ExactSizeIterator<Item = i32>) {
        let number = self.own_item(name);
        self.line(&format!("array {number} int32 {}", values.len()));
        self.add_bytes(values.len() * 4, values.flat_map(i32::to_le_bytes));
    }

    fn own_item(&mut self, name: &str) -> usize {
        self.items.push((0, None));
        self.written = self.items.len();
        let number = self.items.len();
        self.line(&format!("argument {name} {number}"));
        number
    }

    fn line(&mut self, line: &str) {
        self.text.push_str(line);
        self.text.push('\n');
    }

    /// Each array begins at a multiple of 8 bytes.
    fn add_bytes(&mut self, count: usize, bytes: impl Iterator<Item = u8>) {
        if self.data.try_reserve(count + 7).is_err() {
            self.lacks_memory = true;
            return;
        }
        self.data.extend(bytes);
        self.data.resize(self.data.len().next_multiple_of(8), 0);
    }

    fn number(&mut self, at: usize, kind: Option<&'static str>) -> String {
        let known = self.items.iter().position(|item| *item == (at, kind));
        let number = known.unwrap_or_else(|| {
            self.items.push((at, kind));
            self.items.len() - 1
        });
        (number + 1).to_string()
    }

    /// The number of a struct; "NULL", or "unread" where it does not begin with a size.
    unsafe fn struct_at(&mut self, at: usize, kind: &'static str) -> String {
        if at == 0 {
            return "NULL".into();
        }
        // SAFETY: not NULL: the caller's struct begins with its size, by the conventions of the ABI.
        let declared = unsafe { (at as *const i64).read_unaligned() };
        if (8..=LARGEST as i64).contains(&declared) {
            return self.number(at, Some(kind));
        }
        UNREAD.into()
    }

    /// The number of an array; "unread" if the call has not registered its length.
    fn array_at(&mut self, at: usize, regions: &Regions) -> String {
        match (at, regions.at(at)) {
            (0, _) => "NULL".into(),
            (_, Some(_)) => self.number(at, None),
            (_, None) => UNREAD.into(),
        }
    }

    unsafe fn write_struct(&mut self, number: usize, at: usize, kind: &'static str, regions: &Regions) {
        let Some(known) = structure(kind) else { return };
        // SAFETY: by the caller: the size, and as many bytes as it says.
        let declared = unsafe { (at as *const i64).read_unaligned() } as usize;
        // The call writes all structs of an array, not only the first.
        let room = regions.at(at).map_or(0, Region::bytes).max(declared);
        self.line(&format!("struct {number} {kind} {room}"));
        for place in known.places().filter(|place| place.end() <= declared) {
            // SAFETY: within the caller's struct.
            unsafe { self.write_value(at, &place, regions) };
        }
    }

    unsafe fn write_value(&mut self, at: usize, place: &Place, regions: &Regions) {
        let (from, name) = ((at + place.at) as *const u8, &place.name);
        // SAFETY (all): within the caller's struct, any bytes of which are a value.
        unsafe {
            let pointer = || from.cast::<usize>().read_unaligned();
            let line = match place.kind {
                Kind::Int32 => format!("int32 {name} {}", from.cast::<i32>().read_unaligned()),
                Kind::Int64 => format!("int64 {name} {}", from.cast::<i64>().read_unaligned()),
                Kind::Double => {
                    let value = from.cast::<f64>().read_unaligned();
                    format!("double {name} {:016x} {value:?}", value.to_bits())
                }
                Kind::OfTheHost => format!("host {name} {}", if pointer() == 0 { "NULL" } else { "given" }),
                Kind::Array => format!("pointer {name} {}", self.array_at(pointer(), regions)),
                Kind::Structs(kind) => format!("pointer {name} {}", self.struct_at(pointer(), kind)),
            };
            self.line(&line);
        }
    }

    unsafe fn write_array(&mut self, number: usize, at: usize, regions: &Regions) {
        let Some(region) = regions.at(at) else { return };
        let bytes = region.bytes();
        if !region.is_read {
            let _ = writeln!(self.text, "output {number} {bytes} {}", region.name);
            return;
        }
        let (kind, size) = match region.element {
            Element::Double => ("double", 8),
            Element::Int32 => ("int32", 4),
        };
        let _ = writeln!(self.text, "array {number} {kind} {} {}", bytes / size, region.name);
        // SAFETY: the caller's array, which the call reads.
        let values = unsafe { std::slice::from_raw_parts(at as *const u8, bytes) };
        match size {
            _ if cfg!(target_endian = "little") => self.add_bytes(bytes, values.iter().copied()),
            _ => self.add_bytes(bytes, values.chunks_exact(size).flat_map(|value| value.iter().rev().copied())),
        }
    }
}

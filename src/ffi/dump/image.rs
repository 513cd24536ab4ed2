//! The arguments of a call as text and bytes. docs/dump.md describes the format.

use super::argument::Argument;
use crate::ffi::arguments::{Element, Region, Regions};
use crate::ffi::member::{Kind, Place};
use crate::ffi::members::structure;
use crate::ffi::structs::LARGEST;

/// The text for a pointer whose target is not in the file.
pub(super) const UNREAD: &str = "unread";

/// A struct or an array that has a number in the text.
#[derive(Clone, Copy, PartialEq)]
struct Item {
    /// The address in memory; 0 for an array that the library adds, which is written at once.
    address: usize,
    /// The name of the type of a struct. None: an array.
    struct_name: Option<&'static str>,
}

/// The contents of a dump.
#[derive(Default)]
pub(super) struct Image {
    /// Text with one line for each argument, struct, member and array.
    pub text: String,
    /// The bytes of all arrays, in the order in which the text lists the arrays.
    pub data: Vec<u8>,
    /// The structs and arrays. Item i has the number i + 1 in the text.
    items: Vec<Item>,
    /// The items before this index are in `text`. The others wait in a queue.
    written: usize,
    /// Whether a copy failed for lack of memory.
    pub lacks_memory: bool,
}

impl Image {
    /// The image of the arguments of a call, which point to the caller's memory.
    pub unsafe fn of(arguments: &[(&'static str, Argument)], regions: &Regions) -> Image {
        let mut image = Image::default();
        // SAFETY: by the caller.
        unsafe { image.add(arguments, regions) };
        image
    }

    /// Adds arguments, and the structs and arrays to which they point, directly or by members of structs.
    pub unsafe fn add(&mut self, arguments: &[(&str, Argument)], regions: &Regions) {
        for (name, argument) in arguments {
            let value = match *argument {
                Argument::Integer(value) => {
                    self.line(&format!("integer {name} {value}"));
                    continue;
                }
                // SAFETY: by the caller.
                Argument::Struct(struct_name, address) => unsafe { self.reference_to_struct(address, struct_name) },
                Argument::Array(address) => self.reference_to_array(address, regions),
            };
            self.line(&format!("argument {name} {value}"));
        }
        while self.written < self.items.len() {
            let Item { address, struct_name } = self.items[self.written];
            self.written += 1;
            let number = self.written;
            match struct_name {
                // SAFETY: by the caller; `reference_to_struct` has checked the size.
                Some(struct_name) => unsafe { self.write_struct(number, address, struct_name, regions) },
                // SAFETY: by the caller: the call reads or writes what its regions say.
                None => unsafe { self.write_array(number, address, regions) },
            }
        }
    }

    /// Adds an array of doubles that the library owns, as the argument `name`.
    pub fn add_doubles(&mut self, name: &str, values: &[f64]) {
        let number = self.add_array(name);
        self.line(&format!("array {number} double {}", values.len()));
        self.add_bytes(values.len() * 8, values.iter().flat_map(|value| value.to_le_bytes()));
    }

    /// Adds an array of integers that the library owns, as the argument `name`.
    pub fn add_integers(&mut self, name: &str, values: &mut dyn ExactSizeIterator<Item = i32>) {
        let number = self.add_array(name);
        self.line(&format!("array {number} int32 {}", values.len()));
        self.add_bytes(values.len() * 4, values.flat_map(i32::to_le_bytes));
    }

    /// Adds the argument `name`, an array that the library owns, and returns the number of the array. The queue is empty here, because
    /// [`add`](Self::add) ends only after it has written all items.
    fn add_array(&mut self, name: &str) -> usize {
        self.items.push(Item { address: 0, struct_name: None });
        self.written = self.items.len();
        let number = self.items.len();
        self.line(&format!("argument {name} {number}"));
        number
    }

    fn line(&mut self, line: &str) {
        self.text.push_str(line);
        self.text.push('\n');
    }

    /// Appends the bytes of an array, and zeros up to a multiple of 8 bytes.
    fn add_bytes(&mut self, count: usize, bytes: impl Iterator<Item = u8>) {
        if self.data.try_reserve(count + 7).is_err() {
            self.lacks_memory = true;
            return;
        }
        self.data.extend(bytes);
        self.data.resize(self.data.len().next_multiple_of(8), 0);
    }

    /// The number of an item. A new item joins the queue.
    fn number_of(&mut self, item: Item) -> String {
        let known = self.items.iter().position(|known| *known == item);
        let index = known.unwrap_or_else(|| {
            self.items.push(item);
            self.items.len() - 1
        });
        (index + 1).to_string()
    }

    /// The text for a pointer to a struct: the number of the struct, "NULL", or "unread" if the first member is not a plausible size.
    unsafe fn reference_to_struct(&mut self, address: usize, struct_name: &'static str) -> String {
        if address == 0 {
            return "NULL".into();
        }
        // SAFETY: not NULL: the caller's struct begins with its size, by the conventions of the ABI.
        let declared = unsafe { (address as *const i64).read_unaligned() };
        if (8..=LARGEST as i64).contains(&declared) {
            return self.number_of(Item { address, struct_name: Some(struct_name) });
        }
        UNREAD.into()
    }

    /// The text for a pointer to an array: the number of the array, "NULL", or "unread" if the call has not registered the length.
    fn reference_to_array(&mut self, address: usize, regions: &Regions) -> String {
        match (address, regions.beginning_at(address)) {
            (0, _) => "NULL".into(),
            (_, Some(_)) => self.number_of(Item { address, struct_name: None }),
            (_, None) => UNREAD.into(),
        }
    }

    unsafe fn write_struct(&mut self, number: usize, address: usize, struct_name: &'static str, regions: &Regions) {
        // Structs of calls that write no dump are not in the list.
        let Some(known) = structure(struct_name) else { return };
        // SAFETY: by the caller: the size, and as many bytes as it says.
        let declared = unsafe { (address as *const i64).read_unaligned() } as usize;
        // The bytes that a replay has to allocate. A pointer to an array of structs needs room for all of them, because the call writes all. The text
        // has the members of the first one only.
        let room = regions.beginning_at(address).map_or(0, Region::bytes).max(declared);
        self.line(&format!("struct {number} {struct_name} {room}"));
        for place in known.places().filter(|place| place.end() <= declared) {
            // SAFETY: within the caller's struct.
            unsafe { self.write_value(address, &place, regions) };
        }
    }

    /// Writes the line of one member of the struct at `address`.
    unsafe fn write_value(&mut self, address: usize, place: &Place, regions: &Regions) {
        let (from, name) = ((address + place.offset) as *const u8, &place.name);
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
                Kind::Array => format!("pointer {name} {}", self.reference_to_array(pointer(), regions)),
                Kind::Structs(struct_name) => {
                    format!("pointer {name} {}", self.reference_to_struct(pointer(), struct_name))
                }
            };
            self.line(&line);
        }
    }

    unsafe fn write_array(&mut self, number: usize, address: usize, regions: &Regions) {
        let Some(region) = regions.beginning_at(address) else { return };
        let bytes = region.bytes();
        if !region.is_read {
            self.line(&format!("output {number} {bytes} {}", region.name));
            return;
        }
        let (element, size) = match region.element {
            Element::Double => ("double", 8),
            Element::Int32 => ("int32", 4),
        };
        self.line(&format!("array {number} {element} {} {}", bytes / size, region.name));
        // SAFETY: the caller's array, which the call reads.
        let values = unsafe { std::slice::from_raw_parts(address as *const u8, bytes) };
        match size {
            _ if cfg!(target_endian = "little") => self.add_bytes(bytes, values.iter().copied()),
            _ => self.add_bytes(bytes, values.chunks_exact(size).flat_map(|value| value.iter().rev().copied())),
        }
    }
}

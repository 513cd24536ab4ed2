//! The caller's arguments: checks of numbers and arrays, and the list of the memory that a call reads or writes.

use std::cell::RefCell;
use std::ops::Range;

use super::status::Refusal;
use super::structs::{size_of_callers, Rows, Versioned};
use crate::grid::Grid;
use crate::memory::reserve;

/// A positive count from a C integer.
pub(super) fn count(name: &str, value: i32) -> Result<usize, Refusal> {
    match usize::try_from(value) {
        Ok(value) if value > 0 => Ok(value),
        _ => Err(Refusal::invalid(format!("{name} is {value}; it must be positive"))),
    }
}

/// A count from a C integer that may be 0.
pub(super) fn not_negative(name: &str, value: i32) -> Result<usize, Refusal> {
    usize::try_from(value).map_err(|_| Refusal::invalid(format!("{name} is {value}; it must not be negative")))
}

/// Refuses another value than 0 for a member that is reserved for later versions.
pub(super) fn reserved(name: &str, value: i32) -> Result<(), Refusal> {
    match value {
        0 => Ok(()),
        _ => Err(Refusal::invalid(format!("{name} is {value}; it must be 0"))),
    }
}

/// A switch from a C integer that must be 0 or 1.
pub(super) fn switch(name: &str, value: i32) -> Result<bool, Refusal> {
    match value {
        0 => Ok(false),
        1 => Ok(true),
        _ => unknown(name, value, "0 or 1"),
    }
}

/// Refuses the value of an enumeration, which must be `known`.
pub(super) fn unknown<T>(name: &str, value: i32, known: &str) -> Result<T, Refusal> {
    Err(Refusal::invalid(format!("{name} is {value}; it must be {known}")))
}

/// The caller's array of n values. None: NULL.
pub(super) unsafe fn optional<'a, T>(values: *const T, n: usize) -> Option<&'a [T]> {
    // SAFETY: not null: the caller promises n values, by the conventions of the ABI.
    (!values.is_null()).then(|| unsafe { std::slice::from_raw_parts(values, n) })
}

/// The caller's array of n values. Refuses NULL, and an array that is not aligned.
pub(super) unsafe fn required<'a, T>(name: &str, values: *const T, n: usize) -> Result<&'a [T], Refusal> {
    aligned(name, values, n)?;
    // SAFETY: by the caller.
    unsafe { optional(values, n) }.ok_or_else(|| Refusal::null(name))
}

/// Copies `values` to the caller's array, as part k of equal parts. NULL: not wanted.
pub(super) unsafe fn copy_to<A>(values: &[A], to: *mut f64, k: usize) {
    if !to.is_null() {
        // SAFETY: not null: room for the parts, by the conventions of the ABI, and nothing overlaps (`Regions`).
        unsafe { std::ptr::copy_nonoverlapping(values.as_ptr(), to.cast::<A>().add(k * values.len()), values.len()) };
    }
}

/// The type of the values of an array.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Element {
    Double,
    Int32,
}

/// A Rust type whose values arrays that are read have.
pub(super) trait Plain {
    const ELEMENT: Element;
}

impl Plain for f64 {
    const ELEMENT: Element = Element::Double;
}

impl<const N: usize> Plain for [f64; N] {
    const ELEMENT: Element = Element::Double;
}

impl Plain for i32 {
    const ELEMENT: Element = Element::Int32;
}

/// A struct or an array in the caller's memory.
#[derive(Clone, Copy)]
pub(super) struct Region {
    /// The address.
    start: usize,
    /// The address of the first byte after the region.
    end: usize,
    /// The name of the argument or member that points to the region, for messages.
    pub name: &'static str,
    /// In a batch: the problem to which the region belongs, counted from 0.
    problem: Option<usize>,
    /// Whether the call writes the region.
    is_output: bool,
    /// Whether the call reads the array. False for structs, and for outputs that are only written.
    pub is_read: bool,
    /// The type of the values, if the call reads the array.
    pub element: Element,
}

impl Region {
    pub fn bytes(&self) -> usize {
        self.end - self.start
    }
}

thread_local! {
    /// The addresses that calls on this thread may read and write. None: all.
    static ALLOWED: RefCell<Option<Vec<Range<usize>>>> = const { RefCell::new(None) };
}

/// Calls `call`. Meanwhile calls of the library on this thread are refused if they would read or write beyond these ranges of addresses. This is for
/// calls of a dump, whose file is not trusted.
pub(super) fn within<R>(ranges: Vec<Range<usize>>, call: impl FnOnce() -> R) -> R {
    let outer = ALLOWED.replace(Some(ranges));
    let result = call();
    ALLOWED.set(outer);
    result
}

/// The list of all memory that one call reads and writes. An output may not overlap with any other region.
#[derive(Default)]
pub(super) struct Regions {
    list: Vec<Region>,
    /// In a batch: the problem to which the next regions belong.
    problem: Option<usize>,
}

impl Regions {
    /// Removes all regions. The list keeps its memory.
    pub fn clear(&mut self) {
        self.list.clear();
        self.problem = None;
    }

    /// The regions added from now on belong to this problem of a batch.
    pub fn enter_problem(&mut self, problem: usize) {
        self.problem = Some(problem);
    }

    /// Removes the regions of the problem that was entered last. This problem is refused, so that its memory is neither read nor written.
    pub fn leave_out_problem(&mut self) {
        while self.list.last().is_some_and(|region| region.problem.is_some() && region.problem == self.problem) {
            self.list.pop();
        }
    }

    /// Adds an array of `count` values that the call only reads. NULL adds nothing.
    pub fn input<T: Plain>(&mut self, name: &'static str, start: *const T, count: usize) -> Result<(), Refusal> {
        aligned(name, start, count)?;
        self.add(name, start as usize, count.saturating_mul(size_of::<T>()), false)?;
        self.read_too(start);
        Ok(())
    }

    /// Marks the output that begins at `start` as one that the call also reads.
    pub fn read_too<T: Plain>(&mut self, start: *const T) {
        for region in self.list.iter_mut().filter(|region| region.start == start as usize) {
            (region.is_read, region.element) = (true, T::ELEMENT);
        }
    }

    /// The longest of the regions that begin at this address.
    pub fn beginning_at(&self, start: usize) -> Option<&Region> {
        self.list.iter().filter(|region| region.start == start).max_by_key(|region| region.end)
    }

    /// Adds a struct at `address` that the call reads; `read` is the copy of it.
    pub fn input_struct<T: Versioned>(&mut self, address: *const T, read: &T) -> Result<(), Refusal> {
        self.add(T::short_name(), address as usize, size_of_callers(read), false)
    }

    /// Adds a struct at `address` that the call reads and writes; `read` is the copy of it.
    pub fn output_struct<T: Versioned>(&mut self, address: *const T, read: &T) -> Result<(), Refusal> {
        self.add(T::short_name(), address as usize, size_of_callers(read), true)
    }

    /// Adds an array of `count` values that the call writes. NULL adds nothing.
    pub fn output<T>(&mut self, name: &'static str, start: *const T, count: usize) -> Result<(), Refusal> {
        aligned(name, start, count)?;
        self.add(name, start as usize, count.saturating_mul(size_of::<T>()), true)
    }

    /// Adds an array of `count` structs that the call writes.
    pub fn output_rows<T: Versioned>(
        &mut self,
        name: &'static str,
        start: *const T,
        rows: &Rows<T>,
        count: usize,
    ) -> Result<(), Refusal> {
        self.add(name, start as usize, rows.bytes(count), true)
    }

    fn add(&mut self, name: &'static str, start: usize, bytes: usize, is_output: bool) -> Result<(), Refusal> {
        if start == 0 || bytes == 0 {
            return Ok(());
        }
        if self.list.len() == self.list.capacity() {
            // All regions of one problem fit at once: 11 outputs, 15 structs and 18 arrays that are read.
            let room = (2 * self.list.len()).max(44);
            reserve(&mut self.list, room, "the addresses of the arrays")?;
        }
        let (end, problem) = (start.saturating_add(bytes), self.problem);
        let (is_read, element) = (false, Element::Double);
        self.list.push(Region { start, end, name, problem, is_output, is_read, element });
        Ok(())
    }

    /// Refuses regions beyond the addresses that calls on this thread may use.
    fn check_ranges(&self) -> Result<(), Refusal> {
        let checked = ALLOWED.try_with(|ranges| {
            let ranges = ranges.borrow();
            let Some(ranges) = &*ranges else { return Ok(()) };
            let is_inside =
                |region: &Region| ranges.iter().any(|range| range.start <= region.start && region.end <= range.end);
            match self.list.iter().find(|region| !is_inside(region)) {
                Some(region) => {
                    let (name, bytes) = (region.name, region.bytes());
                    Err(Refusal::invalid(format!("{name} takes {bytes} bytes; there are less in the file")))
                }
                None => Ok(()),
            }
        });
        // A thread that ends has lost its thread-local memory. It makes no calls of a dump.
        checked.unwrap_or(Ok(()))
    }

    /// Refuses outputs that overlap with an output or an input.
    pub fn check(&mut self) -> Result<(), Refusal> {
        self.check_ranges()?;
        self.list.sort_unstable_by_key(|region| (region.start, region.end));
        // Of the regions so far, in the order of their addresses: the input and the output that end last.
        let (mut input, mut output): (Option<&Region>, Option<&Region>) = (None, None);
        for region in &self.list {
            let before = if region.is_output { [output, input] } else { [output, None] };
            if let Some(other) = before.into_iter().flatten().find(|other| other.end > region.start) {
                return Err(overlap(other, region));
            }
            let last = if region.is_output { &mut output } else { &mut input };
            if last.is_none_or(|last| last.end < region.end) {
                *last = Some(region);
            }
        }
        Ok(())
    }
}

/// Refuses an array whose address is not aligned for its values, as it may be in packed structs or in records of a file in memory.
pub(super) fn aligned<T>(name: &str, start: *const T, count: usize) -> Result<(), Refusal> {
    if count == 0 || start.is_aligned() {
        return Ok(());
    }
    let rule = format!("it must begin at a multiple of {} bytes", align_of::<T>());
    Err(Refusal::invalid(format!("{name} begins at {:#x}; {rule}", start as usize)))
}

fn overlap(one: &Region, other: &Region) -> Refusal {
    let said = |region: &Region| match region.problem {
        Some(problem) => format!("{} of problem {problem}", region.name),
        None => region.name.to_string(),
    };
    Refusal::invalid(format!("{} and {} overlap; each output needs memory of its own", said(one), said(other)))
}

/// The struct of an effect.
pub(super) trait GivenEffect: Versioned {
    /// Adds the arrays of the effect that the call reads. By default there are none.
    fn add_to(&self, _regions: &mut Regions, _grid: &Grid) -> Result<(), Refusal> {
        Ok(())
    }
}

/// Adds the struct of an effect, if there is one, and its arrays. `read` is the copy of the struct at `address`.
pub(super) fn add<T: GivenEffect>(
    regions: &mut Regions,
    grid: &Grid,
    address: *const T,
    read: &Option<T>,
) -> Result<(), Refusal> {
    let Some(effect) = read else { return Ok(()) };
    regions.input_struct(address, effect)?;
    effect.add_to(regions, grid)
}

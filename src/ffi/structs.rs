//! Structs of the ABI, which grow from version to version. Each begins with its size in the caller's header, which its `_init` sets. The library
//! accepts shorter structs of an older header, from 0.2 on. It accepts longer structs of a newer header if the members that it does not know are 0.

use std::mem::size_of;

use super::marks;
use super::status::Refusal;

/// A struct of the ABI.
///
/// # Safety
/// `repr(C)`, begins with `struct_size: i64`, and every bit pattern is valid: integers, floats, raw pointers and
/// optional function pointers only.
pub unsafe trait Versioned: Copy {
    /// The name of the struct in C.
    const NAME: &'static str;
    /// The size of the struct in the first version that had it. This number never changes again.
    const FIRST_SIZE: usize;
    /// The values that the `_init` of the struct writes. Members beyond the first size are 0, so a newer program that does not set them asks nothing
    /// of an older library.
    fn defaults() -> Self;

    /// The name of the struct in messages.
    fn short_name() -> &'static str {
        &Self::NAME["contact_normal_".len()..]
    }
}

/// Makes a struct [`Versioned`]. The struct must begin with `struct_size`, and otherwise have integers, floats, raw pointers and optional function
/// pointers only. The arguments are the name of the struct, that of its `_init` for Rust, its size in the first version that had it, and the
/// defaults that are not 0 or NULL.
macro_rules! versioned {
    ($name:ident, $init:ident, $first_size:literal $(, $member:ident: $value:expr)* $(,)?) => {
        // SAFETY: the struct keeps the rules above.
        unsafe impl $crate::ffi::structs::Versioned for $name {
            const NAME: &'static str = stringify!($name);
            const FIRST_SIZE: usize = $first_size;
            fn defaults() -> Self {
                // SAFETY: any bytes are valid.
                let mut defaults: Self = unsafe { std::mem::zeroed() };
                defaults.struct_size = size_of::<Self>() as i64;
                $(defaults.$member = $value;)*
                defaults
            }
        }

        impl Default for $name {
            fn default() -> Self {
                $crate::ffi::structs::Versioned::defaults()
            }
        }

        #[doc = concat!("Fills a `", stringify!($name), "` with the defaults: the function of this name in the header, for Rust.")]
        pub unsafe extern "C" fn $init(to: *mut $name) {
            // SAFETY: NULL or a whole struct, by the conventions of the ABI.
            unsafe { $crate::ffi::structs::init(to, size_of::<$name>() as i64) }
        }
    };
}
pub(super) use versioned;

/// The largest size of a struct, in bytes, in this and all later versions. Calls refuse longer structs, and `_init` writes no more than this.
pub(super) const LARGEST: usize = 4096;

/// The size that the caller declares of a struct. Refuses sizes that no version has, marks of the Fortran module, and members that are set but
/// unknown to this library.
pub(super) unsafe fn declared_size<T: Versioned>(from: *const T, name: &str) -> Result<usize, Refusal> {
    if from.is_null() {
        return Err(Refusal::null(name));
    }
    // SAFETY: not null, and the caller's struct begins with its size, by the conventions of the ABI.
    let declared = unsafe { from.cast::<i64>().read_unaligned() };
    let refuse = |rule: &str| {
        Err(Refusal::struct_size(format!("{name}->struct_size is {declared}; {rule}: call {}_init", T::NAME)))
    };
    if let Some(fault) = marks::read(declared) {
        return Err(Refusal::invalid(fault));
    }
    let Ok(size) = usize::try_from(declared) else { return refuse("it must be positive") };
    if size < T::FIRST_SIZE {
        return refuse(&format!("it must be at least {}", T::FIRST_SIZE));
    }
    if size > LARGEST {
        return refuse(&format!("no version has more than {LARGEST} bytes"));
    }
    for i in size_of::<T>()..size {
        // SAFETY: the caller declares `size` bytes.
        if unsafe { from.cast::<u8>().add(i).read() } != 0 {
            let (byte, version) = (i / 8 * 8, env!("CARGO_PKG_VERSION"));
            return Err(Refusal::struct_size(format!(
                "{name} sets the member at byte {byte}, which version {version} of the library does not know: use a newer one \
                 (struct_size is {declared}; or was {}_init not called?)",
                T::NAME
            )));
        }
    }
    Ok(size)
}

/// Reads a struct. Members that an older header does not have get their defaults.
pub unsafe fn read<T: Versioned>(from: *const T, name: &str) -> Result<T, Refusal> {
    // SAFETY: the caller's pointer is NULL or points to a struct that declares its size.
    let size = unsafe { declared_size(from, name)? }.min(size_of::<T>());
    let mut value = T::defaults();
    // SAFETY: both sides have `size` bytes, and any bytes are a valid T (Versioned).
    unsafe { std::ptr::copy_nonoverlapping(from.cast::<u8>(), (&raw mut value).cast::<u8>(), size) };
    Ok(value)
}

/// As [`read`], with None for NULL.
pub unsafe fn read_optional<T: Versioned>(from: *const T, name: &str) -> Result<Option<T>, Refusal> {
    // SAFETY: by the caller.
    (!from.is_null()).then(|| unsafe { read(from, name) }).transpose()
}

/// The size that the caller declared of a struct, from the copy that [`read`] made.
pub fn size_of_callers<T: Versioned>(value: &T) -> usize {
    // SAFETY: a Versioned begins with its size, which `read` copied.
    let declared = unsafe { (value as *const T).cast::<i64>().read() };
    usize::try_from(declared).unwrap_or(0)
}

/// Writes the members that the caller's header has. `struct_size` keeps its value.
pub unsafe fn write<T: Versioned>(to: *mut T, value: &T) -> Result<(), Refusal> {
    // SAFETY: as in `read`.
    let size = unsafe { declared_size(to.cast_const(), T::NAME)? }.min(size_of::<T>());
    let skip = size_of::<i64>();
    // SAFETY: both sides have `size` bytes.
    unsafe {
        std::ptr::copy_nonoverlapping(
            (value as *const T).cast::<u8>().add(skip),
            to.cast::<u8>().add(skip),
            size - skip,
        );
    }
    Ok(())
}

/// An array of structs in the caller's memory, possibly of an older or newer version. Each struct takes the bytes that the first one declares.
pub struct Rows<T> {
    first: *mut T,
    stride: usize,
}

impl<T: Versioned> Rows<T> {
    /// The array that begins at `first`, which must be a struct that declares its size. NULL is refused.
    pub unsafe fn of(first: *mut T, name: &str) -> Result<Rows<T>, Refusal> {
        // SAFETY: by the caller.
        Ok(Rows { first, stride: unsafe { declared_size(first.cast_const(), name)? } })
    }

    /// The bytes that `count` rows take.
    pub fn bytes(&self, count: usize) -> usize {
        self.stride.saturating_mul(count)
    }

    /// The address of row `i`. Refuses a row whose declared size differs from that of the first row.
    pub unsafe fn at(&self, i: usize, name: &str) -> Result<*mut T, Refusal> {
        // SAFETY: the caller's array has more than `i` rows.
        let row = unsafe { self.first.byte_add(i * self.stride) };
        // SAFETY: as above; each row begins with its size.
        let declared = unsafe { row.cast::<i64>().read_unaligned() };
        if declared != self.stride as i64 {
            let rule = format!("it must be {}, as that of the first of the array: call {}_init", self.stride, T::NAME);
            return Err(Refusal::struct_size(format!("{name}->struct_size is {declared}; {rule}")));
        }
        Ok(row)
    }

    /// Writes row `i`, and 0 into members that are unknown here. The row needs no `_init` before.
    pub unsafe fn write(&self, i: usize, value: &T) {
        let (stride, known) = (self.stride, self.stride.min(size_of::<T>()));
        // SAFETY (all): the caller's array has more than `i` rows of `stride` bytes, and a Versioned is bytes.
        unsafe {
            let to = self.first.cast::<u8>().add(i * stride);
            to.write_bytes(0, stride);
            to.copy_from_nonoverlapping((&raw const *value).cast::<u8>(), known);
            to.cast::<i64>().write_unaligned(stride as i64);
        }
    }
}

/// Writes the defaults into a struct that has `size` bytes in the caller's header, and 0 into members that are unknown here. It writes no more than
/// `size` bytes. NULL is ignored.
pub unsafe fn init<T: Versioned>(to: *mut T, size: i64) {
    // Every struct has an `_init`, so this checks every struct: a struct may grow, but never get smaller than in its first version.
    const { assert!(size_of::<T>() >= T::FIRST_SIZE && T::FIRST_SIZE % 8 == 0 && size_of::<T>() <= LARGEST) };
    let defaults = T::defaults();
    // SAFETY: a Versioned is bytes; NULL or `size` bytes, by the caller.
    unsafe {
        let bytes = std::slice::from_raw_parts((&raw const defaults).cast::<u8>(), size_of::<T>());
        init_bytes(to.cast(), bytes, size);
    }
}

/// Writes a struct of an unknown kind: its size, then 0.
pub unsafe fn init_unknown(to: *mut u8, size: i64) {
    // SAFETY: by the caller.
    unsafe { init_bytes(to, &[], size) }
}

/// Writes `size` bytes: the declared size, the `defaults` after it, then 0.
unsafe fn init_bytes(to: *mut u8, defaults: &[u8], size: i64) {
    const OF_SIZE: usize = size_of::<i64>();
    // Of a larger struct than LARGEST only the first bytes are written. The calls that read such a struct refuse it.
    let room = usize::try_from(size).unwrap_or(0).min(LARGEST);
    if to.is_null() || room < OF_SIZE {
        return;
    }
    let known = defaults.len().min(room);
    // SAFETY: the caller's struct has `room` bytes or more.
    unsafe {
        to.write_bytes(0, room);
        to.copy_from_nonoverlapping(defaults.as_ptr(), known);
        to.cast::<i64>().write_unaligned(size);
    }
}

#[cfg(test)]
#[path = "../../tests/unit/structs.rs"]
mod tests;

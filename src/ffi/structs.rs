//! Structs that grow: each begins with its size, set by its `_init`. Shorter ones (of an older header, from 0.1 on) and longer
//! ones (of a newer header, if what we do not know is zero) are accepted.

use std::mem::size_of;

use super::status::Refusal;

/// A struct of the ABI.
///
/// # Safety
/// `repr(C)`, begins with `struct_size: i64`, and every bit pattern is valid: integers, floats, raw pointers and
/// optional function pointers only.
pub unsafe trait Versioned: Copy {
    /// Its name in C.
    const NAME: &'static str;
    /// Its size in the first version that had it: never changes again.
    const FIRST_SIZE: usize;
    /// What its `_init` writes.
    fn defaults() -> Self;

    /// What it is called in messages.
    fn short_name() -> &'static str {
        &Self::NAME["contact_normal_".len()..]
    }
}

/// Makes a struct [`Versioned`] that is what that asks for: `struct_size` first, integers, floats, raw pointers and optional function
/// pointers only. Gives its size in the first version that had it, and the defaults that are not 0 or NULL.
macro_rules! versioned {
    ($name:ident, $first_size:literal $(, $member:ident: $value:expr)* $(,)?) => {
        // SAFETY: by the struct, see above.
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
    };
}
pub(super) use versioned;

/// No struct of ours will ever be larger: a bound for what is read of longer ones.
const LARGEST: usize = 4096;

/// The declared size of a struct, after a check.
pub(super) unsafe fn declared_size<T: Versioned>(from: *const T, name: &str) -> Result<usize, Refusal> {
    if from.is_null() {
        return Err(Refusal::null(name));
    }
    // SAFETY: not null, and the caller's struct begins with its size, by the conventions of the ABI.
    let declared = unsafe { from.cast::<i64>().read_unaligned() };
    let refuse = |rule: &str| {
        Err(Refusal::struct_size(format!("{name}->struct_size is {declared}; {rule}: call {}_init", T::NAME)))
    };
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
            return refuse("it sets members that this version of the library does not know");
        }
    }
    Ok(size)
}

/// Reads a struct; members that an older header does not have get their defaults.
pub unsafe fn read<T: Versioned>(from: *const T, name: &str) -> Result<T, Refusal> {
    // SAFETY: the caller's pointer is NULL or points to a struct that declares its size.
    let size = unsafe { declared_size(from, name)? }.min(size_of::<T>());
    let mut value = T::defaults();
    // SAFETY: both sides have `size` bytes, and any bytes are a valid T (Versioned).
    unsafe { std::ptr::copy_nonoverlapping(from.cast::<u8>(), (&raw mut value).cast::<u8>(), size) };
    Ok(value)
}

/// The same where NULL means none.
pub unsafe fn read_optional<T: Versioned>(from: *const T, name: &str) -> Result<Option<T>, Refusal> {
    // SAFETY: by the caller.
    (!from.is_null()).then(|| unsafe { read(from, name) }).transpose()
}

/// The size that the caller declares of a struct that was read.
pub fn size_of_callers<T: Versioned>(value: &T) -> usize {
    // SAFETY: a Versioned begins with its size, which `read` copied.
    let declared = unsafe { (value as *const T).cast::<i64>().read() };
    usize::try_from(declared).unwrap_or(0)
}

/// Writes the members that the caller's header has; `struct_size` stays.
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

/// Writes the defaults: the body of every `_init`. NULL is ignored.
pub unsafe fn init<T: Versioned>(to: *mut T) {
    // Every struct has an `_init`, so every struct is checked here: it may grow, never shrink below its first size.
    const { assert!(size_of::<T>() >= T::FIRST_SIZE && T::FIRST_SIZE % 8 == 0 && size_of::<T>() <= LARGEST) };
    if !to.is_null() {
        // SAFETY: not null, and `_init` is documented to fill a whole struct of this version.
        unsafe { to.write_unaligned(T::defaults()) };
    }
}

//! The floating-point environment of the host, the calling program. Fortran programs may flush denormals to zero, or trap exceptions. The library
//! computes in the default environment and then restores that of the host. Callbacks run in the host's environment; changes that a callback makes to
//! this environment remain.

use std::cell::Cell;

thread_local! {
    /// The host's environment. None: this thread is not in a call of the library.
    static HOST: Cell<Option<Register>> = const { Cell::new(None) };
}

/// While this value lives, its thread has the default environment. The drop restores the host's environment.
pub struct DefaultEnvironment {
    /// The host's environment of the outer call, if this call is made in a callback.
    outer: Option<Register>,
}

#[cfg(target_arch = "x86_64")]
type Register = u32;
#[cfg(target_arch = "aarch64")]
type Register = u64;
/// On other architectures the library does not change the environment.
#[cfg(not(any(target_arch = "x86_64", target_arch = "aarch64")))]
type Register = ();

/// The default of the register MXCSR: all exceptions masked, round to nearest, denormals kept.
#[cfg(target_arch = "x86_64")]
const DEFAULT: Register = 0x1f80;
/// The default of the register FPCR: no traps, round to nearest, denormals kept.
#[cfg(target_arch = "aarch64")]
const DEFAULT: Register = 0;
#[cfg(not(any(target_arch = "x86_64", target_arch = "aarch64")))]
const DEFAULT: Register = ();

#[cfg(target_arch = "x86_64")]
fn read() -> Register {
    let mut value: Register = 0;
    // SAFETY: stmxcsr writes the 4 bytes of MXCSR to `value`; SSE is part of x86_64.
    unsafe { std::arch::asm!("stmxcsr [{}]", in(reg) &mut value, options(nostack, preserves_flags)) };
    value
}

#[cfg(target_arch = "x86_64")]
fn write(value: Register) {
    // SAFETY: the value is the default, or one that stmxcsr has read. The compiler assumes the default environment, and Rust code of the library runs
    // only in that.
    unsafe { std::arch::asm!("ldmxcsr [{}]", in(reg) &value, options(nostack, preserves_flags, readonly)) };
}

#[cfg(target_arch = "aarch64")]
fn read() -> Register {
    let value: Register;
    // SAFETY: reads the floating-point control register.
    unsafe { std::arch::asm!("mrs {}, fpcr", out(reg) value, options(nomem, nostack, preserves_flags)) };
    value
}

#[cfg(target_arch = "aarch64")]
fn write(value: Register) {
    // SAFETY: the value is the default, or one that was read from the register.
    unsafe { std::arch::asm!("msr fpcr, {}", in(reg) value, options(nomem, nostack, preserves_flags)) };
}

#[cfg(not(any(target_arch = "x86_64", target_arch = "aarch64")))]
fn read() -> Register {}

#[cfg(not(any(target_arch = "x86_64", target_arch = "aarch64")))]
fn write(_: Register) {}

impl DefaultEnvironment {
    /// Stores the host's environment and switches to the default one.
    pub fn enter() -> DefaultEnvironment {
        let outer = HOST.replace(Some(read()));
        write(DEFAULT);
        DefaultEnvironment { outer }
    }
}

impl Drop for DefaultEnvironment {
    fn drop(&mut self) {
        if let Some(host) = HOST.replace(self.outer) {
            write(host);
        }
    }
}

/// Calls a function of the host in the host's environment, then switches back to the default one. Outside a call of the library the environment is
/// not changed.
#[inline(never)]
pub fn in_host_environment<R>(call: impl FnOnce() -> R) -> R {
    let Some(host) = HOST.get() else { return call() };
    write(host);
    let result = call();
    HOST.set(Some(read()));
    write(DEFAULT);
    result
}

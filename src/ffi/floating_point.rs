//! The floating-point environment of the host. Fortran hosts flush denormals to zero, or trap. The library computes in the default environment and
//! restores the host's. Callbacks run in the host's environment, and changes that they make to it remain.

use std::cell::Cell;

thread_local! {
    /// The host's environment, while a call of ours runs on this thread.
    static HOST: Cell<Option<Register>> = const { Cell::new(None) };
}

/// Restores the host's environment when dropped.
pub struct DefaultEnvironment {
    /// The host's environment of the outer call, if this call is made in a callback.
    outer: Option<Register>,
}

#[cfg(target_arch = "x86_64")]
type Register = u32;
#[cfg(target_arch = "aarch64")]
type Register = u64;
/// Unknown architectures keep the environment they have.
#[cfg(not(any(target_arch = "x86_64", target_arch = "aarch64")))]
type Register = ();

/// MXCSR: all exceptions masked, round to nearest, denormals kept.
#[cfg(target_arch = "x86_64")]
const DEFAULT: Register = 0x1f80;
/// FPCR: no traps, round to nearest, denormals kept.
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
    // SAFETY: only values read by stmxcsr or the architecture's default are loaded. The compiler assumes the default
    // environment, which is what the library runs in between the two writes.
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
    // SAFETY: only values read from the register, or its default.
    unsafe { std::arch::asm!("msr fpcr, {}", in(reg) value, options(nomem, nostack, preserves_flags)) };
}

#[cfg(not(any(target_arch = "x86_64", target_arch = "aarch64")))]
fn read() -> Register {}

#[cfg(not(any(target_arch = "x86_64", target_arch = "aarch64")))]
fn write(_: Register) {}

impl DefaultEnvironment {
    /// Switches to the default environment.
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

/// Calls a function of the host's in the host's environment, then goes on in the default one.
#[inline(never)]
pub fn in_host_environment<R>(call: impl FnOnce() -> R) -> R {
    let Some(host) = HOST.get() else { return call() };
    write(host);
    let result = call();
    HOST.set(Some(read()));
    write(DEFAULT);
    result
}

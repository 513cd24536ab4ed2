//! Makes the call of a dump again and prints whether the status is the same: `contact-normal-replay FILE`. See docs/dump.md.

use std::ffi::CStr;
use std::process::ExitCode;

use contact_normal::ffi::dump::{Dump, Replayed};
use contact_normal::ffi::{contact_normal_last_error, contact_normal_report, contact_normal_status_text};

/// The exit status if the call is not made: no file is named, the file is not a dump, or the dump does not contain the whole call.
const NOT_MADE: u8 = 2;

fn main() -> ExitCode {
    let arguments: Vec<_> = std::env::args_os().skip(1).collect();
    let [path] = &arguments[..] else {
        eprintln!("usage: contact-normal-replay FILE");
        return ExitCode::from(NOT_MADE);
    };
    let read = std::fs::read(path).map_err(|why| why.to_string()).and_then(|bytes| Dump::read(&bytes));
    match read.and_then(replay) {
        Ok(true) => ExitCode::SUCCESS,
        Ok(false) => ExitCode::FAILURE,
        Err(why) => {
            eprintln!("{}: {why}", path.to_string_lossy());
            ExitCode::from(NOT_MADE)
        }
    }
}

/// Makes the call again and prints the result. Returns whether the status is that of the file.
fn replay(dump: Dump) -> Result<bool, String> {
    let (status, message) = (dump.status(), dump.message().to_owned());
    println!("{} of version {}: {}", dump.call(), dump.library(), told(status, &message));
    let missing = dump.missing();
    if !missing.is_empty() {
        println!("not in the file, NULL here: {}", missing.join(", "));
    }
    let of_the_host = dump.of_the_host();
    if !of_the_host.is_empty() {
        println!("of the host, NULL here: {}", of_the_host.join(", "));
    }
    let Replayed { status: now, report } = dump.replay()?;
    println!("again: {}", told(now, &last_error()));
    if let Some(report) = report.filter(|_| now >= 0) {
        print_report(&report);
    }
    println!("{}", if now == status { "reproduced" } else { "not reproduced" });
    Ok(now == status)
}

fn print_report(report: &contact_normal_report) {
    let (normal, tangential, statistics) = (&report.normal, &report.tangential, &report.statistics);
    println!("force {:e}, approach {:e}, residual {:e}", normal.force, normal.approach, normal.residual);
    println!("{} elements in contact, {} cycles", normal.contact_count, statistics.cycles);
    println!(
        "tangential force {:e} {:e}, residual {:e}",
        tangential.force[0], tangential.force[1], tangential.residual
    );
}

/// A status with its text and the message of the call.
fn told(status: i32, message: &str) -> String {
    // SAFETY: never NULL, static storage.
    let text = unsafe { CStr::from_ptr(contact_normal_status_text(status)) }.to_string_lossy();
    let more = if message.is_empty() { String::new() } else { format!(": {message}") };
    format!("status {status} ({text}){more}")
}

fn last_error() -> String {
    // SAFETY: never NULL, valid until the next call on this thread.
    unsafe { CStr::from_ptr(contact_normal_last_error()) }.to_string_lossy().into_owned()
}

//! Writes the file of a dump.

use std::fs::{remove_file, rename, File};
use std::io::Write;
use std::path::{Path, PathBuf};
use std::sync::atomic::{AtomicU64, Ordering};

use super::image::Image;

/// The number of dumps of this process so far.
static COUNT: AtomicU64 = AtomicU64::new(0);
/// The largest number of names that are tried for an unfinished file.
const MOST_ATTEMPTS: usize = 100;

/// Writes a file under a temporary name, then renames it, so that no reader finds an unfinished file. Returns the path, or the reason of a failure.
pub(super) fn write(path: &[u8], head: &str, image: &Image) -> Result<String, String> {
    let number = COUNT.fetch_add(1, Ordering::Relaxed) + 1;
    let path = expanded(path, number);
    if image.lacks_memory {
        return Err("no memory for a copy of what the call was given".into());
    }
    let path = place(path)?;
    let failed = |why| format!("{} cannot be written: {why}", path.display());
    let (part, file) = new_part(&path, number).map_err(failed)?;
    let written = write_to(file, head, image).and_then(|()| rename(&part, &path));
    written.map(|()| path.display().to_string()).map_err(|why| {
        // If the unfinished file cannot be removed either, the first reason is the one to report.
        let _ = remove_file(&part);
        failed(why)
    })
}

/// Makes a new file in the folder of `path` for the unfinished dump `number`. Returns the path of the file, and the file. It tries another name if a
/// file of that name exists: a process of another machine or container may have the same process number.
fn new_part(path: &Path, number: u64) -> std::io::Result<(PathBuf, File)> {
    let mut made = Err(std::io::ErrorKind::AlreadyExists.into());
    for attempt in 0..MOST_ATTEMPTS {
        let part = path.with_file_name(format!("contact_normal.{}.{number}.{attempt}.part", std::process::id()));
        made = File::create_new(&part).map(|file| (part, file));
        if !matches!(&made, Err(why) if why.kind() == std::io::ErrorKind::AlreadyExists) {
            break;
        }
    }
    made
}

/// The path to write: the target if `path` is a link, otherwise `path`. Refuses a path that exists and is no file: a device or a pipe would be
/// replaced.
fn place(path: PathBuf) -> Result<PathBuf, String> {
    if path.file_name().is_none() {
        return Err(format!("{} names no file", path.display()));
    }
    let is_link = std::fs::symlink_metadata(&path).is_ok_and(|found| found.is_symlink());
    let place = match is_link {
        true => target(&path).map_err(|why| format!("{} cannot be written: {why}", path.display()))?,
        false => path,
    };
    match std::fs::metadata(&place) {
        Ok(found) if !found.is_file() => Err(format!("{} is no file", place.display())),
        _ => Ok(place),
    }
}

/// The target of a link. Its file need not exist yet.
fn target(link: &Path) -> std::io::Result<PathBuf> {
    link.canonicalize().or_else(|why| match why.kind() {
        std::io::ErrorKind::NotFound => {
            std::fs::read_link(link).map(|to| link.parent().map_or(to.clone(), |folder| folder.join(&to)))
        }
        _ => Err(why),
    })
}

fn write_to(mut file: File, head: &str, image: &Image) -> std::io::Result<()> {
    file.write_all(head.as_bytes())?;
    file.write_all(image.text.as_bytes())?;
    file.write_all(format!("data {}\n", image.data.len()).as_bytes())?;
    file.write_all(&image.data)?;
    file.sync_all()
}

/// Replaces %p in the path by the number of the process, %n by the `number` of the dump, and %% by %.
fn expanded(path: &[u8], number: u64) -> PathBuf {
    let (mut bytes, mut rest) = (Vec::new(), path);
    while let Some((&first, after)) = rest.split_first() {
        let value = match after.first() {
            Some(b'p') => std::process::id().to_string(),
            Some(b'n') => number.to_string(),
            Some(b'%') => "%".into(),
            _ => String::new(),
        };
        if first == b'%' && !value.is_empty() {
            bytes.extend(value.as_bytes());
            rest = &after[1..];
        } else {
            bytes.push(first);
            rest = after;
        }
    }
    path_of(bytes)
}

#[cfg(unix)]
fn path_of(bytes: Vec<u8>) -> PathBuf {
    <std::ffi::OsString as std::os::unix::ffi::OsStringExt>::from_vec(bytes).into()
}

#[cfg(not(unix))]
fn path_of(bytes: Vec<u8>) -> PathBuf {
    String::from_utf8_lossy(&bytes).into_owned().into()
}

//! Structs of the C ABI in other versions: older programs with this library, and programs of newer headers.
#![allow(dead_code)] // some functions of the macro are not used

use super::*;

/// A struct in its first version. `contact_normal_later` is the same struct in a later version.
#[repr(C)]
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct contact_normal_first {
    pub struct_size: i64,
    pub tolerance: f64,
}

#[repr(C)]
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct contact_normal_later {
    pub struct_size: i64,
    pub tolerance: f64,
    pub limit: f64,
    pub count: i64,
}

versioned! { contact_normal_first, first_init, 16, tolerance: 1e-6 }
versioned! { contact_normal_later, later_init, 16, tolerance: 1e-6 }

/// Memory of the caller, with the bytes that it had before.
#[repr(C, align(8))]
struct Room([u8; 64]);

fn room() -> Room {
    Room([0xAB; 64])
}

impl Room {
    fn at<T>(&mut self) -> *mut T {
        (&raw mut self.0).cast()
    }
}

#[test]
fn an_older_program_on_a_newer_library() {
    let mut caller = room();
    // SAFETY (all): the caller's struct has 16 bytes and declares so.
    unsafe {
        init(caller.at::<contact_normal_later>(), 16);
        assert_eq!(caller.0[16..], [0xAB; 48], "nothing is written beyond the caller's struct");
        assert_eq!(
            caller.at::<contact_normal_first>().read(),
            contact_normal_first { struct_size: 16, tolerance: 1e-6 }
        );
        let read = read(caller.at::<contact_normal_later>(), "options").expect("an older struct");
        assert_eq!(read, contact_normal_later { struct_size: 16, tolerance: 1e-6, limit: 0.0, count: 0 });
        let found = contact_normal_later { struct_size: 32, tolerance: 0.5, limit: 1.0, count: 2 };
        write(caller.at::<contact_normal_later>(), &found).expect("an older struct");
        assert_eq!(caller.0[16..], [0xAB; 48], "nothing is written beyond the caller's struct");
        assert_eq!(
            caller.at::<contact_normal_first>().read(),
            contact_normal_first { struct_size: 16, tolerance: 0.5 }
        );
    }
}

#[test]
fn a_newer_program_on_an_older_library() {
    let mut caller = room();
    // SAFETY (all): the caller's struct has 32 bytes and declares so.
    unsafe {
        init(caller.at::<contact_normal_first>(), 32);
        assert_eq!(caller.0[32..], [0xAB; 32]);
        let newer = caller.at::<contact_normal_later>();
        assert_eq!(newer.read(), contact_normal_later { struct_size: 32, tolerance: 1e-6, limit: 0.0, count: 0 });
        let read_by_older = read(caller.at::<contact_normal_first>(), "options").expect("nothing new is set");
        assert_eq!(read_by_older.tolerance, 1e-6);
        (*newer).count = 1;
        let refused = read(caller.at::<contact_normal_first>(), "options").expect_err("a new member is set");
        assert!(refused.message.contains("options sets the member at byte 24"), "{}", refused.message);
    }
}

#[test]
fn a_struct_that_an_older_library_does_not_know_is_zero() {
    let mut caller = room();
    // SAFETY: it has 24 bytes.
    unsafe { init_unknown(caller.at(), 24) };
    assert_eq!(caller.0[..8], 24i64.to_ne_bytes());
    assert_eq!(caller.0[8..24], [0; 16]);
    assert_eq!(caller.0[24..], [0xAB; 40]);
}

#[test]
fn rows_are_as_far_apart_as_the_first_says() {
    let value = contact_normal_later { struct_size: 32, tolerance: 0.5, limit: 1.0, count: 2 };
    // Rows of 16 bytes, as of an older header, and rows of 24 bytes, as of a newer one.
    for size in [16usize, 24] {
        let mut caller = room();
        // SAFETY (all): room for two rows of that size.
        unsafe {
            let first = caller.at::<contact_normal_first>();
            init(first, size as i64);
            let older = Rows::of(first, "rows").expect("a size");
            older.write(1, &contact_normal_first { struct_size: 16, tolerance: 0.5 });
            assert_eq!(older.bytes(2), 2 * size);
            assert_eq!(first.byte_add(size).read(), contact_normal_first { struct_size: size as i64, tolerance: 0.5 });
            let newer = Rows::of(caller.at::<contact_normal_later>(), "rows").expect("a size");
            newer.write(0, &value);
            assert_eq!(first.read(), contact_normal_first { struct_size: size as i64, tolerance: 0.5 });
        }
        assert_eq!(caller.0[2 * size..], room().0[2 * size..], "{size}");
    }
}

#[test]
fn sizes_that_are_none_write_nothing() {
    for size in [i64::MIN, -1, 0, 7] {
        let mut caller = room();
        // SAFETY (both): nothing is written.
        unsafe {
            init(caller.at::<contact_normal_later>(), size);
            init(std::ptr::null_mut::<contact_normal_later>(), 32);
        }
        assert_eq!(caller.0, [0xAB; 64], "{size}");
    }
}

//! `contact_normal_frictional_wear`: overlaps, structs, and outputs, which a refused call does not write.

use std::ptr::{null, null_mut};

use crate::call::{initialised, last_error};
use contact_normal::ffi::*;

const N: usize = 6;

/// A call on 3 x 2 elements, with all results.
struct Call {
    wear: contact_normal_wear,
    worn: contact_normal_worn,
    fields: [Vec<f64>; 6],
    work: Vec<f64>,
    depth: Vec<f64>,
    passage: Vec<f64>,
}

impl Call {
    fn new() -> Box<Call> {
        let mut wear: contact_normal_wear = initialised(contact_normal_wear_init);
        (wear.mx, wear.my, wear.dx, wear.dy, wear.rolling_distance) = (3, 2, 0.5, 0.4, 0.5);
        let fields = [1.0, 2.0, -0.1, -0.2, 3.0, 1e-3].map(|value| vec![value; N]);
        let worn = initialised(contact_normal_worn_init);
        let mut call =
            Box::new(Call { wear, worn, fields, work: vec![7.0; N], depth: vec![7.0; N], passage: vec![7.0; 2] });
        let at = |k: usize| call.fields[k].as_ptr();
        (call.wear.traction, call.wear.slip) = ([at(0), at(1)], [at(2), at(3)]);
        (call.wear.pressure, call.wear.coefficients) = (at(4), at(5));
        call
    }
}

#[test]
fn results_that_overlap_with_anything_are_refused() {
    type Outputs = (*mut f64, *mut f64, *mut f64, *mut contact_normal_worn);
    type Spoil = fn(&mut Call, &mut Outputs);
    let cases: [(Spoil, &str); 8] = [
        (|call, to| to.0 = call.fields[0].as_mut_ptr(), "wear->traction[0]"),
        (|call, to| to.1 = call.fields[3].as_mut_ptr(), "wear->slip[1]"),
        (|call, to| to.2 = call.fields[4].as_mut_ptr(), "wear->pressure"),
        (|call, to| to.1 = call.work.as_mut_ptr(), "work"),
        (|call, to| to.0 = (&mut call.wear as *mut contact_normal_wear).cast(), "wear"),
        (|call, to| to.2 = (&mut call.worn as *mut contact_normal_worn).cast(), "worn"),
        (|call, to| to.3 = call.fields[1].as_mut_ptr().cast(), "wear->traction[1]"),
        (|call, to| to.3 = call.depth.as_mut_ptr().cast(), "depth"),
    ];
    for (spoil, name) in cases {
        let mut call = Call::new();
        let mut to: Outputs =
            (call.work.as_mut_ptr(), call.depth.as_mut_ptr(), call.passage.as_mut_ptr(), &mut call.worn);
        spoil(&mut call, &mut to);
        if !std::ptr::eq(to.3, &call.worn) {
            // The memory is first filled with a valid struct.
            unsafe { to.3.write(call.worn) };
        }
        let before = (call.fields.clone(), call.work.clone(), call.depth.clone(), call.passage.clone(), call.worn.work);
        // SAFETY: structs and arrays of this test.
        let status = unsafe { contact_normal_frictional_wear(&call.wear, to.0, to.1, to.2, to.3) };
        let message = last_error();
        assert_eq!(status, CONTACT_NORMAL_INVALID_ARGUMENT, "{name}: {message}");
        assert!(message.contains("overlap") && message.contains(name), "{name}: {message}");
        let bits = |fields: &[Vec<f64>]| fields.iter().flatten().map(|value| value.to_bits()).collect::<Vec<u64>>();
        assert_eq!(bits(&before.0), bits(&call.fields), "{name}");
        assert_eq!(bits(&[before.1, before.2, before.3]), bits(&[call.work, call.depth, call.passage]), "{name}");
        assert_eq!(before.4, call.worn.work);
    }
    let mut call = Call::new();
    // SAFETY: structs and arrays of this test.
    unsafe {
        let (work, passage) = (call.work.as_mut_ptr(), call.passage.as_mut_ptr());
        assert_eq!(
            contact_normal_frictional_wear(&call.wear, work, null_mut(), passage, &mut call.worn),
            CONTACT_NORMAL_OK
        );
        assert!((call.work[0] - 0.5).abs() <= 1e-15 && (call.worn.work - 0.6).abs() <= 1e-15);
        assert!(call.depth[0] == 7.0 && (call.passage[1] - 3.0 * 3e-3 * 0.05f64.sqrt()).abs() <= 1e-17);
        call.wear.rolling_distance = 1e-320;
        let status = contact_normal_frictional_wear(&call.wear, work, null_mut(), passage, null_mut());
        assert_eq!(status, CONTACT_NORMAL_NOT_FINITE, "{}", last_error());
        assert!(last_error().contains("the depth of a passage is inf"), "{}", last_error());
        assert_eq!(
            contact_normal_frictional_wear(null(), work, null_mut(), null_mut(), null_mut()),
            CONTACT_NORMAL_NULL_POINTER
        );
    }
}

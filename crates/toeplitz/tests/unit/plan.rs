//! Plans are shared, and the least recently used ones are removed. The tests share one list of plans. So each test uses a separate type, and the
//! tests run one after the other.

use std::sync::{Mutex, MutexGuard, PoisonError};

use super::*;

/// Waits until no other test uses the list of plans.
fn alone() -> MutexGuard<'static, ()> {
    static ONE: Mutex<()> = Mutex::new(());
    ONE.lock().unwrap_or_else(PoisonError::into_inner)
}

/// A plan of this number of bytes.
struct Own<const KIND: usize>(usize);

impl<const KIND: usize> Plan for Own<KIND> {
    fn bytes(&self) -> usize {
        self.0
    }
}

#[test]
fn a_plan_serves_again_on_any_thread() {
    let _alone = alone();
    let first = shared(7, || Ok(Own::<0>(1))).unwrap();
    let again =
        std::thread::spawn(|| shared(7, || -> Result<Own<0>> { panic!("it is known") }).unwrap()).join().unwrap();
    assert!(Arc::ptr_eq(&first, &again));
    let other = shared(8, || Ok(Own::<0>(1))).unwrap();
    assert!(!Arc::ptr_eq(&first, &other));
}

#[test]
fn plans_beyond_the_bound_are_forgotten() {
    let _alone = alone();
    let most = MOST_KEPT;
    let made = |length: usize| shared(length, || Ok(Own::<1>(most / 4))).unwrap();
    let kept = made(0);
    for length in 1..20 {
        made(length);
        assert!(Arc::ptr_eq(&kept, &made(0)), "what is used stays");
        assert!(super::kept() <= most);
    }
    // A plan that is larger than the limit is not kept, but its caller gets it.
    assert_eq!(shared(99, || Ok(Own::<1>(most + 1))).unwrap().0, most + 1);
    assert!(find::<Own<1>>(99).is_none());
}

#[test]
fn a_plan_that_cannot_be_made_is_not_known() {
    let _alone = alone();
    let refuse = || Err(par::OutOfMemory("no memory".into()));
    assert!(shared::<Own<2>>(3, refuse).is_err());
    assert_eq!(shared(3, || Ok(Own::<2>(5))).unwrap().0, 5);
}

use super::*;

/// The sums of the library for a change from p = 0 and u = 0 to the given p and u.
fn change(p: &[f64], u: &[f64]) -> [f64; 6] {
    let (zeros, mut d, mut w, mut sums) = (vec![0.0; p.len()], vec![0f32; p.len()], vec![0f32; p.len()], Sums::new());
    let (d, w, sums_of_row) = (&mut d[..], &mut w[..], &mut sums);
    pulp::Arch::new().dispatch(Change { p: (p, &zeros, 1.0), u: (u, &zeros, 1.0), d, w, sums: sums_of_row });
    sums.values()
}

#[test]
fn a_change_is_measured_where_pressures_change() {
    let (p, u) = ([2.0, 0.0, -1.0, 3.0, 0.0, 1.0], [5.0, 4.0, 3.0, 2.0, 1.0, 6.0]);
    // The last sum is that of w^2 over the elements with a change d, and no others.
    assert_eq!(change(&p, &u), [5.0, 7.0, 7.0, 19.0, 15.0, 25.0 + 9.0 + 4.0 + 36.0]);
}

#[test]
fn what_single_precision_cannot_hold_is_no_change() {
    for at in 0..6 {
        let mut u = [1.0; 6];
        u[at] = 1e300;
        let [.., energy, _, _] = change(&[2.0, 0.0, 1.0, 3.0, 0.0, 1.0], &u);
        assert!(!energy.is_finite(), "element {at}: {energy}");
    }
}

//! Jacobi with relaxation: all elements at once, `p_I += omega r_I / A_II`.

/// One sweep over the elements in contact.
pub fn sweep(diagonal: f64, p: &mut [f64], residual: &[f64], contact: &[bool], relaxation: f64) {
    for ((p, r), _) in p.iter_mut().zip(residual).zip(contact).filter(|(_, &inside)| inside) {
        *p += relaxation * r / diagonal;
    }
}

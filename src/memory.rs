//! Memory by the size of the grid: asked for, so that a lack of it is a status and not the end of the process.

use crate::error::{Error, Result};

/// n zeros. `what` they are says the message.
pub(crate) fn zeros<A: Clone + Default>(n: usize, what: &str) -> Result<Vec<A>> {
    let mut v = Vec::new();
    reserve(&mut v, n, what)?;
    v.resize(n, A::default());
    Ok(v)
}

/// Room for n values: what is put there later allocates nothing.
pub(crate) fn reserve<A>(v: &mut Vec<A>, n: usize, what: &str) -> Result<()> {
    v.try_reserve_exact(n.saturating_sub(v.len()))
        .map_err(|_| Error::OutOfMemory(format!("no memory for {n} values of {what}")))
}

/// Values that are computed.
pub(crate) fn collected<A>(values: impl ExactSizeIterator<Item = A>, what: &str) -> Result<Vec<A>> {
    let mut collected = Vec::new();
    reserve(&mut collected, values.len(), what)?;
    collected.extend(values);
    Ok(collected)
}

//! Sets other influence coefficients on a handle. The handle must use them from then on, or refuse them and stay as it was.

use contact_normal::ffi::*;

use crate::call::{self, Handle};
use crate::case::Case;
use crate::effects::{self, Definiteness, UserCoefficients};
use crate::half_space::compliance;
use crate::random::Random;
use crate::rules::check;
use crate::verdict::Verdict;

/// Checks that a handle that was set up without a table refuses one.
fn without_table(case: &Case, table: &UserCoefficients) -> Verdict {
    let Ok(mut handle) = Handle::new(case) else { return Verdict::default() };
    let status = handle.set_influence(table);
    if status == CONTACT_NORMAL_INVALID_ARGUMENT {
        return check(case, &handle.solve(case, false));
    }
    Verdict::failed("a handle without a table takes none", format!("status {status}"))
}

/// Changes the coefficients of a handle from solve to solve, and checks each result. Scenes with a period, row tables or a coating are skipped.
pub fn run(case: &Case, random: &mut Random) -> Verdict {
    let effects = &case.effects;
    if effects.period.is_some() || effects.row_tables.is_some() || effects.coating.is_some() {
        return Verdict::default();
    }
    let mut case = case.clone();
    (case.how.given, case.how.fixed, case.how.cancel_at) = (None, None, None);
    let c = compliance(case.shear_modulus, case.poisson_ratio);
    if case.effects.influence.is_none() {
        let table = effects::table(random, &case.grid, c, Definiteness::PositiveDefinite);
        if random.chance(0.1) {
            return without_table(&case, &table);
        }
        case.effects.influence = Some(table);
    }
    let Ok(mut handle) = Handle::new(&case) else { return Verdict::default() };
    let mut verdict = Verdict::default();
    for _ in 0..random.integer(1, 3) {
        let definiteness = if random.chance(0.3) { Definiteness::Unsymmetric } else { Definiteness::PositiveDefinite };
        let mut table = effects::table(random, &case.grid, c, definiteness);
        let spoiled = random.chance(0.3);
        if spoiled {
            // The coefficient of an element on itself is always read. Those beyond the grid are not.
            let self_influence = table.cy * 2 * table.cx + table.cx;
            table.values[self_influence] = f64::NAN;
        }
        let status = handle.set_influence(&table);
        if (status >= 0) == spoiled {
            let details = format!("status {status}, spoiled {spoiled}");
            verdict.fail("coefficients are set, or refused where they are none", details);
        }
        if !spoiled {
            let effects = &mut case.effects;
            (effects.influence, effects.definiteness) = (Some(table), definiteness);
        }
        // The handle has the table, so later scenes may leave it out.
        let mut asked = case.clone();
        if random.chance(0.5) {
            asked.effects.influence = None;
        }
        let outputs = handle.solve(&asked, false);
        verdict.add(check(&case, &outputs).within(&format!("{}: after set_influence: ", case.describe())));
        let fresh = call::solve(&case);
        if outputs.status != fresh.status || outputs.bits() != fresh.bits() {
            let details = format!("status {} and {}", outputs.status, fresh.status);
            verdict.fail("coefficients that were set give the bits of a fresh call", details);
        }
    }
    verdict
}

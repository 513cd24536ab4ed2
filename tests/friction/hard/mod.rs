//! The hard cases of friction and the results that the library promises for them. docs/reliability_friction.md lists the same cases.

pub mod cases;
pub mod certificate;

#[cfg(test)]
mod tests {
    use super::cases::{all, MOTIONS};
    use super::certificate::{judge, Verdict};

    #[test]
    fn every_hard_case_is_solved_or_refused_for_its_reason() {
        let (mut solved, mut refused) = (0, 0);
        for (family, cases) in all() {
            for case in cases {
                for (name, motion) in MOTIONS {
                    match judge(&case, motion) {
                        Verdict::Solved { .. } => solved += 1,
                        Verdict::Refused(_) => refused += 1,
                        other => panic!("{family}, {}, {name}: {other:?}", case.name),
                    }
                }
            }
        }
        assert!(solved >= 80 && refused >= 30, "{solved} {refused}");
    }
}

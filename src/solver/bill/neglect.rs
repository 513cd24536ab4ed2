//! Leaves out effects that the bill shows to be negligible.

use super::asked::BillOptions;
use super::omission::Omission;
use super::small_grids::{self, SmallGrids};
use super::verdict::{BillRow, Verdict};
use crate::error::Result;
use crate::scene::Scene;
use crate::solver::quantities::Quantity;
use crate::solver::{InitialGuess, Options, Outcome, ProgressCallback};

/// The effects that a solve leaves out as negligible.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Neglected {
    /// The omissions.
    pub omissions: Vec<Omission>,
    /// The largest relative change of a quantity by all omissions together, its error included. 0 without omissions.
    pub error: f64,
}

/// The quantities of the normal problem that must not change by more than the target: force or approach, largest pressure, contact area.
const KEPT: [Quantity; 3] = [Quantity::Force, Quantity::MaxPressure, Quantity::ContactArea];

impl Neglected {
    /// Finds the omissions from `scene` that together change no quantity by more than the target. Candidates are the omissions that are negligible
    /// alone. The scene is solved on small grids without all of them. If this changes a quantity too much, the candidate with the largest change is
    /// withdrawn, and so on.
    ///
    /// Some omissions are never candidates. Friction, adhesion, a step in time, and a layer in place of a coating decide which results there are.
    /// Small grids do not resolve the peaks that reach a pressure limit, and a limit that no element reaches changes nothing.
    ///
    /// `progress` is called after the cycles on small grids. If it cancels during the solves without single omissions, nothing is left out. If it
    /// cancels later, the omissions that are being solved for together count as not negligible.
    pub fn of(
        scene: &Scene<'_>,
        options: &Options,
        target: f64,
        mut progress: Option<ProgressCallback<'_>>,
    ) -> Result<Neglected> {
        let asked = BillOptions { pairs: false, ..BillOptions::new(target) };
        let wanted = guarded(scene);
        let options = &Options { initial_guess: InitialGuess::None, ..*options };
        let is_never_left_out = |one: &Omission| match one {
            Omission::Friction
            | Omission::CoatingAsLayer
            | Omission::Adhesion
            | Omission::PressureLimit
            | Omission::Visco => true,
            // Elements without a patch have no surface, with the patches and without them. Then the patches cannot simply be left out.
            Omission::Patches => scene.patches.is_some_and(|patches| patches.patch.iter().any(|patch| *patch < 0)),
            _ => false,
        };
        let singles: Vec<Omission> = Omission::of(scene).into_iter().filter(|one| !is_never_left_out(one)).collect();
        small_grids::check(scene, options, &asked)?;
        let each = singles.iter().map(|one| vec![*one]).collect();
        let Some(rows) = bill((scene, options), &asked, &wanted, each, &mut progress)? else {
            return Ok(Neglected::default());
        };
        let mut candidates: Vec<(Omission, f64)> = singles
            .into_iter()
            .filter_map(|one| {
                let of_this: Vec<&BillRow> = rows.iter().filter(|row| row.omission == one).collect();
                let holds = of_this.iter().all(|row| row.verdict == Verdict::Negligible);
                holds.then(|| (one, largest_change(&of_this)))
            })
            .collect();
        candidates.sort_by(|(_, one), (_, other)| one.total_cmp(other));
        while let Some((_, alone)) = candidates.last().copied() {
            let omissions: Vec<Omission> = candidates.iter().map(|(one, _)| *one).collect();
            let error = match omissions.len() {
                1 => Some(alone),
                _ => together((scene, options), &asked, &wanted, &omissions, &mut progress)?,
            };
            if let Some(error) = error {
                return Ok(Neglected { omissions, error });
            }
            candidates.pop();
        }
        Ok(Neglected::default())
    }

    /// One bit for each omission: `1 << (number - 1)`.
    pub fn bits(&self) -> i64 {
        self.omissions.iter().map(|one| 1 << (one.number() - 1)).sum()
    }

    /// The scene without the omitted effects.
    pub fn leave_out<'a>(&self, scene: &Scene<'a>) -> Scene<'a> {
        self.omissions.iter().fold(scene.clone(), |scene, omission| omission.leave_out(&scene))
    }
}

/// The quantities that must not change by more than the target: [`KEPT`], and the tangential force and the creepage if the scene has them.
fn guarded(scene: &Scene<'_>) -> Vec<Quantity> {
    let tangential = [Quantity::TangentialForce, Quantity::Creepage];
    KEPT.into_iter().chain(tangential.into_iter().filter(|quantity| quantity.check(scene).is_ok())).collect()
}

/// The largest relative change of these rows, errors included. Infinite if one is unknown.
fn largest_change(rows: &[&BillRow]) -> f64 {
    let change = |row: &&BillRow| match (row.value, row.change, row.error) {
        (Some(value), Some(change), Some(error)) if value != 0.0 => (change.abs() + error) / value.abs(),
        (_, Some(0.0), Some(0.0)) => 0.0,
        _ => f64::INFINITY,
    };
    rows.iter().map(change).fold(0.0, f64::max)
}

/// Makes the rows of a bill for the omissions `left_out`. None: `progress` cancelled.
fn bill(
    (scene, options): (&Scene<'_>, &Options),
    asked: &BillOptions,
    wanted: &[Quantity],
    left_out: Vec<Vec<Omission>>,
    progress: &mut Option<ProgressCallback<'_>>,
) -> Result<Option<Vec<BillRow>>> {
    let mut grids = SmallGrids::new(scene, options, asked, wanted, left_out);
    let outcome = grids.solve(progress.as_mut().map(|progress| &mut **progress as ProgressCallback<'_>))?;
    Ok((outcome != Outcome::Cancelled).then(|| grids.rows()))
}

/// The largest relative change with all omissions together. None if it is not negligible, or if `progress` cancelled.
fn together(
    scene: (&Scene<'_>, &Options),
    asked: &BillOptions,
    wanted: &[Quantity],
    omissions: &[Omission],
    progress: &mut Option<ProgressCallback<'_>>,
) -> Result<Option<f64>> {
    let Some(rows) = bill(scene, asked, wanted, vec![omissions.to_vec()], progress)? else { return Ok(None) };
    let holds = rows.iter().all(|row| row.verdict == Verdict::Negligible);
    Ok(holds.then(|| largest_change(&rows.iter().collect::<Vec<_>>())))
}

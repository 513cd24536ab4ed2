//! Omits effects that the bill shows to be negligible.

use super::asked::BillOptions;
use super::omission::Omission;
use super::small_grids::{self, SmallGrids};
use super::verdict::{BillRow, Verdict};
use crate::error::Result;
use crate::scene::Scene;
use crate::solver::quantities::Quantity;
use crate::solver::{InitialGuess, Options, Outcome, ProgressCallback};

/// The omissions of a solve.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Neglected {
    /// The omissions.
    pub omissions: Vec<Omission>,
    /// The relative error by the omissions; 0 without any.
    pub error: f64,
}

/// The normal quantities that must not change: force or approach, largest pressure, area.
const KEPT: [Quantity; 3] = [Quantity::Force, Quantity::MaxPressure, Quantity::ContactArea];

impl Neglected {
    /// The omissions from `scene` that a target allows together: each is negligible, and the rest of the scene is solved again on small grids. If
    /// this changes too much, the omission with the largest change is withdrawn. Effects that determine the kind of the result are never left out:
    /// friction, adhesion, a step in time, and a layer in place of a coating. Nor is a pressure limit: small grids do not resolve the peaks that
    /// reach it, and a limit that no element reaches changes nothing.
    ///
    /// `progress` is called after the cycles on small grids. If it cancels the bill of the single omissions, nothing is left out. If it cancels a
    /// later one, the omissions solved together count as not negligible.
    pub fn of(
        scene: &Scene<'_>,
        options: &Options,
        target: f64,
        mut progress: Option<ProgressCallback<'_>>,
    ) -> Result<Neglected> {
        let asked = BillOptions { pairs: false, ..BillOptions::new(target) };
        let wanted = kept(scene);
        let options = &Options { initial_guess: InitialGuess::None, ..*options };
        let stays = |one: &Omission| match one {
            Omission::Friction
            | Omission::CoatingAsLayer
            | Omission::Adhesion
            | Omission::PressureLimit
            | Omission::Visco => true,
            // Elements without a patch have no surface. This stays when the patches are omitted.
            Omission::Patches => scene.patches.is_some_and(|patches| patches.patch.iter().any(|patch| *patch < 0)),
            _ => false,
        };
        let singles: Vec<Omission> = Omission::of(scene).into_iter().filter(|one| !stays(one)).collect();
        small_grids::check(scene, options, &asked)?;
        let each = singles.iter().map(|one| vec![*one]).collect();
        let Some(rows) = bill((scene, options), &asked, &wanted, each, &mut progress)? else {
            return Ok(Neglected::default());
        };
        let mut left: Vec<(Omission, f64)> = singles
            .into_iter()
            .filter_map(|one| {
                let of_this: Vec<&BillRow> = rows.iter().filter(|row| row.omission == one).collect();
                let holds = of_this.iter().all(|row| row.verdict == Verdict::Negligible);
                holds.then(|| (one, largest(&of_this)))
            })
            .collect();
        left.sort_by(|a, b| a.1.total_cmp(&b.1));
        while let Some((_, alone)) = left.last().copied() {
            let omissions: Vec<Omission> = left.iter().map(|(one, _)| *one).collect();
            let error = match omissions.len() {
                1 => Some(alone),
                _ => together((scene, options), &asked, &wanted, &omissions, &mut progress)?,
            };
            if let Some(error) = error {
                return Ok(Neglected { omissions, error });
            }
            left.pop();
        }
        Ok(Neglected::default())
    }

    /// One bit for each omission: `1 << (number - 1)`.
    pub fn bits(&self) -> i64 {
        self.omissions.iter().map(|one| 1 << (one.number() - 1)).sum()
    }

    /// The scene with the omissions.
    pub fn leave_out<'a>(&self, scene: &Scene<'a>) -> Scene<'a> {
        self.omissions.iter().fold(scene.clone(), |scene, omission| omission.leave_out(&scene))
    }
}

/// The quantities that must not change: [`KEPT`], and the tangential force and the creepage if the scene has them.
fn kept(scene: &Scene<'_>) -> Vec<Quantity> {
    let tangential = [Quantity::TangentialForce, Quantity::Creepage];
    KEPT.into_iter().chain(tangential.into_iter().filter(|quantity| quantity.check(scene).is_ok())).collect()
}

/// The largest relative change of these rows, errors included.
fn largest(rows: &[&BillRow]) -> f64 {
    let of = |row: &&BillRow| match (row.value, row.change, row.error) {
        (Some(value), Some(change), Some(error)) if value != 0.0 => (change.abs() + error) / value.abs(),
        (_, Some(0.0), Some(0.0)) => 0.0,
        _ => f64::INFINITY,
    };
    rows.iter().map(of).fold(0.0, f64::max)
}

/// The rows of a bill; none: cancelled.
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

/// The largest relative change with all omissions together; none if it is not negligible.
fn together(
    scene: (&Scene<'_>, &Options),
    asked: &BillOptions,
    wanted: &[Quantity],
    omissions: &[Omission],
    progress: &mut Option<ProgressCallback<'_>>,
) -> Result<Option<f64>> {
    let Some(rows) = bill(scene, asked, wanted, vec![omissions.to_vec()], progress)? else { return Ok(None) };
    let holds = rows.iter().all(|row| row.verdict == Verdict::Negligible);
    Ok(holds.then(|| largest(&rows.iter().collect::<Vec<_>>())))
}

//! The caller's tables of tangential influence coefficients in `contact_normal_friction`.

use super::arguments::{required, Regions};
use super::friction::contact_normal_friction;
use super::influence::{contact_normal_influence, contact_normal_row_tables};
use super::status::{Refusal, CONTACT_NORMAL_UNSUPPORTED};
use super::structs::{self, Versioned};
use crate::scene::{Friction, TangentialInfluence};

/// The names of the tables xx, yy, xy and, for unlike bodies, xz, yz.
const TABLES: [&str; 5] = [
    "friction->influence[0]",
    "friction->influence[1]",
    "friction->influence[2]",
    "friction->influence_cross[0]",
    "friction->influence_cross[1]",
];

/// The names of the tables xx, yy, xy per loaded row.
const ROW_TABLES: [&str; 3] = ["friction->row_tables[0]", "friction->row_tables[1]", "friction->row_tables[2]"];

/// Reads the structs of N tables. None: all pointers are NULL.
fn read<T: Versioned, const N: usize>(
    addresses: [*const T; N],
    names: [&str; N],
) -> Result<Option<[Option<T>; N]>, Refusal> {
    let mut tables = [None; N];
    for (k, table) in tables.iter_mut().enumerate() {
        // SAFETY: NULL or a struct that declares its size, by the conventions of the ABI.
        *table = unsafe { structs::read_optional(addresses[k], names[k])? };
    }
    Ok(tables.iter().any(Option::is_some).then_some(tables))
}

/// The members of a table, each with its name, and the address of its coefficients.
type Given = ([(&'static str, f64); 3], *const f64);

/// The `size` coefficients of table k. Refuses a table whose members differ from those of the first table.
fn values<'a, T>(
    (tables, names): (&[Option<T>], &[&str]),
    (k, size): (usize, usize),
    given: impl Fn(&T) -> Given,
) -> Result<&'a [f64], Refusal> {
    let table = |k: usize| tables[k].as_ref().map(&given).ok_or_else(|| Refusal::null(names[k]));
    let ((members, coefficients), (members_of_first, _)) = (table(k)?, table(0)?);
    let differs = |((_, value), (_, first)): &(&(_, f64), (_, f64))| value != first;
    if let Some(((member, value), (_, first))) = members.iter().zip(members_of_first).find(differs) {
        let (name, first_name) = (names[k], names[0]);
        return Err(Refusal::invalid(format!(
            "{name}->{member} is {value}; it must be {first}, as that of {first_name}"
        )));
    }
    // SAFETY: NULL or as many values as the members say, by the conventions of the ABI.
    unsafe { required(&format!("{}->coefficients", names[k]), coefficients, size) }
}

impl contact_normal_friction {
    /// A [`Friction`] that has nothing but the tables.
    pub(super) fn tables_alone<'a>(&self) -> Result<Friction<'a>, Refusal> {
        Ok(Friction { influence: self.own_influence()?, ..Friction::new(0.0) })
    }

    fn tables(&self) -> Result<Option<[Option<contact_normal_influence>; 5]>, Refusal> {
        let [xx, yy, xy] = self.influence;
        let [xz, yz] = self.influence_cross;
        read([xx, yy, xy, xz, yz], TABLES)
    }

    /// The caller's tangential influence coefficients. None: the friction has no tables.
    pub(super) fn own_influence<'a>(&self) -> Result<Option<TangentialInfluence<'a>>, Refusal> {
        let (tables, rows) = (self.tables()?, read(self.row_tables, ROW_TABLES)?);
        match (tables, rows) {
            (None, None) => Ok(None),
            (Some(tables), None) => by_offset(tables).map(Some),
            (None, Some(tables)) => by_row(tables).map(Some),
            (Some([None, None, None, ..]), Some(_)) => Err(Refusal::new(
                CONTACT_NORMAL_UNSUPPORTED,
                "friction->row_tables and friction->influence_cross are both given; unlike bodies are not solved with tables per row"
                    .into(),
            )),
            (Some(_), Some(_)) => Err(Refusal::new(
                CONTACT_NORMAL_UNSUPPORTED,
                "friction->influence and friction->row_tables are both given; only one of them can be".into(),
            )),
        }
    }

    /// Adds the tables that a call reads.
    pub(super) fn add_tables_to(&self, regions: &mut Regions) -> Result<(), Refusal> {
        let (addresses, tables) = (self.influence.into_iter().chain(self.influence_cross), self.tables()?);
        let first = tables.and_then(|tables| tables[0]);
        for ((address, table), name) in addresses.zip(tables.iter().flatten()).zip(TABLES) {
            let Some(table) = table else { continue };
            regions.input_struct(address, table)?;
            // A table whose size differs from that of the first one is refused later, so its coefficients are not read.
            if first.is_some_and(|first| (first.cx, first.cy) == (table.cx, table.cy)) {
                regions.input(name, table.coefficients, table.size(name)?.2)?;
            }
        }
        let rows = read(self.row_tables, ROW_TABLES)?;
        let first = rows.and_then(|tables| tables[0]);
        for ((address, table), name) in self.row_tables.into_iter().zip(rows.iter().flatten()).zip(ROW_TABLES) {
            let Some(table) = table else { continue };
            regions.input_struct(address, table)?;
            if first.is_some_and(|first| (first.cx, first.rows) == (table.cx, table.rows)) {
                regions.input(name, table.coefficients, table.size_on(None, name)?.2)?;
            }
        }
        Ok(())
    }
}

/// Translates tables for all elements, over the offsets in x and in y.
fn by_offset<'a>(tables: [Option<contact_normal_influence>; 5]) -> Result<TangentialInfluence<'a>, Refusal> {
    let first = tables[0].ok_or_else(|| Refusal::null(TABLES[0]))?;
    let (cx, cy, size) = first.size(TABLES[0])?;
    let given = |table: &contact_normal_influence| -> Given {
        ([("cx", table.cx.into()), ("cy", table.cy.into()), ("scale", table.scale)], table.coefficients)
    };
    let table = |k: usize| values((&tables, &TABLES), (k, size), given);
    let coefficients = [table(0)?, table(1)?, table(2)?];
    let has_cross = tables[3].is_some() || tables[4].is_some();
    let cross = if has_cross { Some([table(3)?, table(4)?]) } else { None };
    Ok(TangentialInfluence { cx, cy, by_row: false, coefficients, cross, scale: first.scale })
}

/// Translates tables per loaded row.
fn by_row<'a>(tables: [Option<contact_normal_row_tables>; 3]) -> Result<TangentialInfluence<'a>, Refusal> {
    let first = tables[0].ok_or_else(|| Refusal::null(ROW_TABLES[0]))?;
    let (cx, cy, size) = first.size_on(None, ROW_TABLES[0])?;
    let given = |table: &contact_normal_row_tables| -> Given {
        ([("cx", table.cx.into()), ("rows", table.rows.into()), ("scale", table.scale)], table.coefficients)
    };
    let table = |k: usize| values((&tables, &ROW_TABLES), (k, size), given);
    let coefficients = [table(0)?, table(1)?, table(2)?];
    Ok(TangentialInfluence { cx, cy, by_row: true, coefficients, cross: None, scale: first.scale })
}

//! Multipoint constraints G u = 0, eliminated after everything else that says how rows of the model follow dofs.
//!
//! ```text
//! u = T₁ x           rows of the model from dofs, with held dofs and patches
//! G T₁ x = 0         the constraints on these; interface dofs among them stay
//! x = C q,  T = T₁C  dependent dofs follow the others: the pencil TᵀKT, TᵀMT has no constraint left
//! ```
//! Coefficients are made comparable first, by powers of two: a rotation by the extent of the nodes that it takes part with, or by the lever
//! of its constraints, a constraint by its largest term. What a patch makes of a constraint is relative to the terms that it sums, so that
//! constraints that the patch satisfies anyway are rounding and follow from it.

use std::collections::BTreeMap;

use super::constraint_digits::SetRight;
use super::elimination::{Elimination, LEAST_PIVOT, Obstacle, Terms, eliminated, summed};
use super::transformation::{DofOrigin, ReducedDof, Transformation};
use super::{constraint_digits, constraint_ground};
use crate::error::{Error, Result};
use crate::input::{Constraint, ConstraintRows};
use crate::model::{Finding, Frame, Model};

/// Largest entry of C, with rotations in the scale of displacements: stiffness grows by its square, of which half the digits are left
/// to the dofs that follow nothing.
const LARGEST: f64 = 1e4;
/// Exponents of coefficients: products of two with coordinates are numbers.
const EXPONENTS: std::ops::RangeInclusive<i32> = -400..=400;
/// Share of the size of the model below which nodes are at one place.
const ONE_PLACE: f64 = 1e-12;
/// Share of its largest terms that may be left of a constraint: pivots of 10⁻⁵ leave 10⁵ roundings of terms up to [`LARGEST`].
const BROKEN: f64 = 1e-6;
/// What it takes to let a dof of a patch follow others: more than any row of a matrix, so that dofs of nodes are taken first.
const OF_PATCH: u32 = u32::MAX;

/// T with the constraints of a model eliminated, how many dofs follow others, and what is to be said of them.
///
/// # Errors
/// [`Error::ConstraintGround`] where constraints let no rigid-body motion pass; [`Error::ConstraintInterface`],
/// [`Error::ConstraintRank`], [`Error::ConstraintSpread`] and [`Error::ConstraintBlock`] where they cannot be eliminated;
/// [`Error::ConstraintAll`] where they leave nothing that moves; [`Error::UnitRange`].
pub(super) fn applied(model: &Model, transformation: Transformation) -> Result<(Transformation, usize, Vec<Finding>)> {
    let Some(given) = &model.constraints else { return Ok((transformation, 0, Vec::new())) };
    refuse_out_of_range(given)?;
    let motions = constraint_ground::Motions::of(model);
    let SetRight { rows: given, open, finding: mended } = constraint_digits::set_right(&motions, given)?;
    let given = &given;
    let ground = constraint_ground::held_motion(&motions, given)?;
    let whole = size(model);
    let scales = scales(given, &transformation, whole);
    let rows: Vec<Terms> = given.list.iter().map(|row| carried(row, &transformation, &scales)).collect();
    let uncertain: Vec<f64> = given
        .list
        .iter()
        .zip(&open)
        .map(|(row, open)| share_open((row, open.as_ref()), &transformation, &scales))
        .collect();
    let costs: Vec<Option<u32>> = transformation.dofs.iter().map(|dof| cost(model, dof)).collect();
    let Elimination { dependent, redundant } =
        eliminated(&rows, &uncertain, &costs).map_err(|obstacle| refused(model, given, obstacle))?;
    let largest = refuse_spread(model, &transformation, &dependent)?;
    let in_units = |(dof, terms): (u32, Terms)| {
        let own = scales[dof as usize];
        let terms = terms.into_iter().map(|(other, value)| (other, value * own / scales[other as usize]));
        (dof, terms.collect())
    };
    let dependent: BTreeMap<u32, Terms> = dependent.into_iter().map(in_units).collect();
    refuse_broken(
        model,
        (given, &rows),
        &Solved { dofs: &transformation.dofs, scales: &scales, dependent: &dependent },
        whole,
    )?;
    let n_dependent = dependent.len();
    let transformation = transformation.constrained(&dependent);
    if transformation.dofs.is_empty() {
        return Err(Error::ConstraintAll { left: format!("hold all {} dofs at rest", model.n_dofs()) });
    }
    let empty = given.n_rows - given.list.len() as u64;
    let redundant = redundant.iter().map(|number| given.list[*number].row + 1).collect();
    let found = Finding::Constrained { n_rows: given.list.len(), n_dependent, largest, redundant, empty };
    Ok((transformation, n_dependent, std::iter::once(found).chain(mended).chain(ground).collect()))
}

/// Refuses coefficients whose products with coordinates may be no numbers.
fn refuse_out_of_range(given: &ConstraintRows) -> Result<()> {
    let values = given.list.iter().flat_map(|row| row.terms.iter().map(|(_, value)| value.abs()));
    let exponents = values.map(|value| value.log2().floor() as i32);
    let mut outside = exponents.filter(|exponent| !EXPONENTS.contains(exponent));
    outside.next().map_or(Ok(()), |exponent| Err(Error::UnitRange { what: "a constraint", exponent }))
}

/// What a displacement of each dof is measured in: one, and for a rotation the reciprocal of a length at which it is felt. That is the
/// extent of the nodes that constraints tie it to, or the lever of a constraint: how much larger its coefficients of rotations are than those
/// of displacements. Nodes at one place have no extent but the rounding of their coordinates, and a lever longer than the model is none.
fn scales(given: &ConstraintRows, transformation: &Transformation, whole: f64) -> Vec<f64> {
    let dofs = &transformation.dofs;
    let mut lengths = vec![0.0f64; dofs.len()];
    for row in &given.list {
        let length = extent(row, transformation).max(lever(row, transformation).min(whole));
        on_dofs(row, transformation).for_each(|(dof, _)| lengths[dof as usize] = lengths[dof as usize].max(length));
    }
    let scale = |(dof, length): (&ReducedDof, f64)| {
        let length = if length > ONE_PLACE * whole { length } else { whole };
        if is_rotation(dof) { (-length.log2().floor()).exp2() } else { 1.0 }
    };
    dofs.iter().zip(lengths).map(scale).collect()
}

/// The terms of a constraint on the dofs; a dof may have several.
fn on_dofs<'a>(row: &'a Constraint, transformation: &'a Transformation) -> impl Iterator<Item = (u32, f64)> + 'a {
    let of_row = |(row, value): &'a (u32, f64)| {
        transformation.rows[*row as usize].entries().map(move |(dof, factor)| (dof, value * factor))
    };
    row.terms.iter().flat_map(of_row)
}

/// The extent of the model; one where it has no coordinates.
fn size(model: &Model) -> f64 {
    model.sites().map_or(1.0, |sites| Frame::of(&sites, &(0..sites.len()).collect::<Vec<_>>()).size)
}

fn is_rotation(dof: &ReducedDof) -> bool {
    dof.site.is_some_and(|site| site.direction.is_rotation())
}

/// The extent of the nodes of a constraint.
fn extent(row: &Constraint, transformation: &Transformation) -> f64 {
    let (mut low, mut high) = ([f64::INFINITY; 3], [f64::NEG_INFINITY; 3]);
    for site in on_dofs(row, transformation).filter_map(|(dof, _)| transformation.dofs[dof as usize].site) {
        for axis in 0..3 {
            low[axis] = low[axis].min(site.position[axis]);
            high[axis] = high[axis].max(site.position[axis]);
        }
    }
    (0..3).map(|axis| (high[axis] - low[axis]).max(0.0).powi(2)).sum::<f64>().sqrt()
}

/// The largest coefficient of a rotation over that of a displacement; nothing where it has none of either.
fn lever(row: &Constraint, transformation: &Transformation) -> f64 {
    let [mut turning, mut moving] = [0.0f64; 2];
    for (dof, value) in on_dofs(row, transformation) {
        let largest = if is_rotation(&transformation.dofs[dof as usize]) { &mut turning } else { &mut moving };
        *largest = largest.max(value.abs());
    }
    if moving > 0.0 { turning / moving } else { 0.0 }
}

/// Makes sure that every constraint holds, those that were left out among them: what is left of its terms for each dof is rounding of these.
/// The size of the model is what turns rotations into displacements here, which is not the measure that the constraints were solved by.
fn refuse_broken(
    model: &Model,
    (given, carried): (&ConstraintRows, &[Terms]),
    found: &Solved<'_>,
    whole: f64,
) -> Result<()> {
    for (row, terms) in given.list.iter().zip(carried) {
        let in_displacements =
            |dof: u32, size: f64| if is_rotation(&found.dofs[dof as usize]) { size / whole } else { size };
        let mut of_dofs: BTreeMap<u32, (f64, f64)> = BTreeMap::new();
        // Of a row whose dofs are at rest nothing is left but rounding of its own terms.
        let mut largest = 0.0f64;
        for (dof, value) in terms {
            let value = value / found.scales[*dof as usize];
            largest = largest.max(in_displacements(*dof, value.abs()));
            let own = [(*dof, 1.0)];
            for (other, factor) in found.dependent.get(dof).map_or(&own[..], Vec::as_slice) {
                let (sum, size) = of_dofs.entry(*other).or_default();
                (*sum, *size) = (*sum + value * factor, *size + (value * factor).abs());
            }
        }
        let largest = of_dofs.iter().fold(largest, |most, (dof, (_, size))| most.max(in_displacements(*dof, *size)));
        let left = of_dofs.iter().map(|(dof, (sum, _))| in_displacements(*dof, sum.abs())).fold(0.0, f64::max);
        if left > BROKEN * largest {
            return Err(Error::ConstraintRank {
                row: row.row + 1,
                dofs: row.dofs(model.names()),
                left: left / largest,
                most: LEAST_PIVOT,
            });
        }
    }
    Ok(())
}

/// How dofs follow others.
struct Solved<'a> {
    dofs: &'a [ReducedDof],
    scales: &'a [f64],
    /// Each dependent dof with its terms.
    dependent: &'a BTreeMap<u32, Terms>,
}

/// What the digits of a constraint leave open, relative to its largest term on the dofs.
fn share_open(
    (constraint, open): (&Constraint, Option<&Constraint>),
    transformation: &Transformation,
    scales: &[f64],
) -> f64 {
    let largest = |constraint: &Constraint| {
        let scaled = on_dofs(constraint, transformation).map(|(dof, value)| (value * scales[dof as usize]).abs());
        scaled.fold(0.0f64, f64::max)
    };
    let whole = largest(constraint);
    open.filter(|_| whole > 0.0).map_or(0.0, |open| largest(open) / whole)
}

/// A constraint on the dofs, its largest term in [1, 2).
fn carried(constraint: &Constraint, transformation: &Transformation, scales: &[f64]) -> Terms {
    let scaled = on_dofs(constraint, transformation).map(|(dof, value)| (dof, value * scales[dof as usize]));
    let mut terms: Terms = scaled.collect();
    let largest = terms.iter().fold(0.0f64, |max, (_, value)| max.max(value.abs()));
    if largest == 0.0 {
        return Terms::new();
    }
    let unit = largest.log2().floor().exp2();
    terms.iter_mut().for_each(|(_, value)| *value /= unit);
    summed(terms)
}

/// What it takes to let a dof follow others: the entries that K and M have in its row. Interface dofs stay.
fn cost(model: &Model, dof: &ReducedDof) -> Option<u32> {
    let of_row = |row: usize| {
        let entries = [&model.stiffness, &model.mass].map(|matrix| matrix.outer_view(row).map_or(0, |row| row.nnz()));
        u32::try_from(entries[0] + entries[1]).unwrap_or(OF_PATCH)
    };
    let cost = match dof.origin {
        DofOrigin::Row(row) => of_row(row),
        DofOrigin::PatchNode(..) | DofOrigin::Distortion(..) => OF_PATCH,
    };
    (!dof.is_interface).then_some(cost)
}

/// The largest entry of C.
fn refuse_spread(model: &Model, transformation: &Transformation, dependent: &BTreeMap<u32, Terms>) -> Result<f64> {
    let entries = dependent.iter().flat_map(|(dof, terms)| terms.iter().map(move |(_, value)| (*dof, value.abs())));
    let Some((dof, largest)) = entries.max_by(|a, b| a.1.total_cmp(&b.1)) else { return Ok(0.0) };
    if largest <= LARGEST {
        return Ok(largest);
    }
    let dof = match transformation.dofs[dof as usize].origin {
        DofOrigin::Row(row) => model.names().short(row),
        DofOrigin::PatchNode(..) | DofOrigin::Distortion(..) => "a dof of a patch".to_owned(),
    };
    Err(Error::ConstraintSpread { dof, factor: largest, limit: LARGEST })
}

/// The error of constraints that cannot be eliminated.
fn refused(model: &Model, given: &ConstraintRows, obstacle: Obstacle) -> Error {
    let name = |number: usize| (given.list[number].row + 1, given.list[number].dofs(model.names()));
    match obstacle {
        Obstacle::Kept(number) => {
            let (row, dofs) = name(number);
            Error::ConstraintInterface { row, dofs }
        }
        Obstacle::NearlyFollows(number, [left, most]) => {
            let (row, dofs) = name(number);
            Error::ConstraintRank { row, dofs, left, most }
        }
        Obstacle::Block(number, [n_rows, n_dofs]) => {
            let (row, dofs) = name(number);
            let found = format!("one of {n_rows} between {n_dofs} dofs that hang together");
            Error::ConstraintBlock { row, dofs, found }
        }
        Obstacle::Entries(number) => {
            let (row, dofs) = name(number);
            Error::ConstraintBlock { row, dofs, found: "one of a chain whose dofs follow too many others".to_owned() }
        }
    }
}

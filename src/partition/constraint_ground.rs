//! Constraints that hold the component to the ground.
//!
//! ```text
//! U    n × 6    the six unit motions of all rows about their middle
//! G U = 0       constraints between nodes let every rigid-body motion of the model pass
//! ```
//! Where one does not, dofs are held by it – or a lever has the wrong sign, a coupling of equal dofs lies between nodes that are apart,
//! coordinates are those of another state. None of this shows in K: the component would only be stiffer than it is.

use supel_runtime::MOTIONS;

use crate::dofs::RowNames;
use crate::error::{Error, Result};
use crate::input::{Constraint, ConstraintRows};
use crate::model::{Finding, Frame, Model, Site};

/// Share of the displacements that a constraint compares, up to which it is rounding: coefficients and coordinates of five digits
/// leave less.
const ROUNDED: f64 = 1e-4;
/// Share up to which nobody rounded: products and sums of doubles leave less.
pub(super) const EXACT: f64 = 1e-9;
/// Share of the largest term of a constraint below which another is what rounding left of none.
const NOTHING: f64 = 16.0 * f64::EPSILON;

/// A constraint and the motion that it resists.
pub(super) struct Resisting<'a> {
    pub(super) constraint: &'a Constraint,
    motion: usize,
    pub(super) share: f64,
}

impl Resisting<'_> {
    /// What the motion is called.
    pub(super) fn name(&self) -> &'static str {
        MOTIONS[self.motion]
    }
}

/// The motion that constraints resist most; none where they let all pass, and where nothing tells the directions of rows. One that they
/// resist by as much as few digits leave is told: the component is held all the same.
///
/// # Errors
/// [`Error::ConstraintGround`] where the job does not accept it.
pub(super) fn held_motion(motions: &Motions<'_>, given: &ConstraintRows) -> Result<Option<Finding>> {
    let resisting: Vec<Resisting<'_>> = given.list.iter().filter_map(|row| motions.resisted(row, EXACT)).collect();
    let Some(worst) = resisting.iter().reduce(|worst, next| if next.share > worst.share { next } else { worst }) else {
        return Ok(None);
    };
    let (row, motion, n_rows) = (worst.constraint.row + 1, worst.name(), resisting.len());
    let dofs = worst.constraint.dofs(motions.names());
    if worst.share <= ROUNDED {
        let (dofs, share) = (dofs.join(", "), worst.share);
        return Ok(Some(Finding::ConstraintRounded { row, dofs, motion, n_rows, share }));
    }
    let n_rows = resisting.iter().filter(|resisting| resisting.share > ROUNDED).count();
    match given.may_ground {
        true => Ok(Some(Finding::ConstraintGround { row, dofs: dofs.join(", "), motion, n_rows })),
        false => Err(Error::ConstraintGround { row, dofs, motion, share: worst.share, n_rows }),
    }
}

/// The unit motions of the rows of a model, as far as dof map and coordinates tell.
pub(super) struct Motions<'a> {
    model: &'a Model,
    sites: Option<Vec<Option<Site>>>,
    centre: [f64; 3],
    size: f64,
}

impl<'a> Motions<'a> {
    pub(super) fn of(model: &'a Model) -> Self {
        let sites = model.sites();
        let every: Vec<usize> = (0..model.n_dofs()).collect();
        let (centre, size) = match &sites {
            Some(sites) => {
                let frame = Frame::of(sites, &every);
                (frame.centre, frame.size)
            }
            None => ([0.0; 3], 1.0),
        };
        Self { model, sites, centre, size }
    }

    /// What rows are called.
    pub(super) fn names(&self) -> RowNames<'_> {
        self.model.names()
    }

    /// Whether rows have places.
    pub(super) fn are_placed(&self) -> bool {
        self.sites.is_some()
    }

    /// The middle of the rows of a constraint.
    pub(super) fn middle(&self, constraint: &Constraint) -> [f64; 3] {
        let rows = || constraint.terms.iter().map(|(row, _)| *row as usize);
        let sites = self.sites.as_deref().unwrap_or_default();
        let places: Vec<[f64; 3]> = rows().filter_map(|row| sites.get(row)?.map(|site| site.position)).collect();
        let mean = |axis: usize| places.iter().map(|place| place[axis]).sum::<f64>() / places.len().max(1) as f64;
        [0, 1, 2].map(mean)
    }

    /// The six motions of a row about a point; without coordinates the translations, without a dof map nothing.
    pub(super) fn at(&self, row: usize, centre: [f64; 3]) -> [f64; 6] {
        if let Some(rounded) = self.model.fit.rounded() {
            return rounded.motion(row, centre);
        }
        let direction = || self.model.dofs.as_ref()?[row].map(|dof| dof.direction);
        match (&self.sites, direction()) {
            (Some(sites), _) => sites[row].map_or([0.0; 6], |site| site.rigid_motion_about(centre)),
            (None, Some(direction)) if !direction.is_rotation() => {
                std::array::from_fn(|motion| f64::from(u8::from(motion == direction.axis())))
            }
            (None, _) => [0.0; 6],
        }
    }

    /// The motion that a constraint resists most, relative to displacements of all of its dofs of the size that the motion has anywhere; none
    /// where that is no more than `least`.
    pub(super) fn resisted<'b>(&self, constraint: &'b Constraint, least: f64) -> Option<Resisting<'b>> {
        let shares = self.shares(constraint, self.centre);
        let motion = (1..6).fold(0, |most, j| if shares[j] > shares[most] { j } else { most });
        (shares[motion] > least).then(|| Resisting { constraint, motion, share: shares[motion] })
    }

    /// By how much a constraint resists each motion about a point, relative as in [`Motions::resisted`].
    pub(super) fn shares(&self, constraint: &Constraint, centre: [f64; 3]) -> [f64; 6] {
        let (mut sums, mut sizes) = ([0.0f64; 6], [0.0f64; 6]);
        let turns = |row: u32| {
            let dof = self.model.dofs.as_ref().and_then(|dofs| dofs[row as usize]);
            dof.is_some_and(|dof| dof.direction.is_rotation())
        };
        let size_of = |(row, value): &(u32, f64)| value.abs() / if turns(*row) { self.size } else { 1.0 };
        let largest = constraint.terms.iter().map(size_of).fold(0.0, f64::max);
        for (row, value) in constraint.terms.iter().filter(|term| size_of(term) > NOTHING * largest) {
            let motion = self.at(*row as usize, centre);
            let turns = turns(*row);
            for j in 0..6 {
                sums[j] += value * motion[j];
                // A translation leaves rotations at rest; a rotation by one makes displacements of the size of the model.
                let size = match (j < 3, turns) {
                    (true, true) => 0.0,
                    (false, false) => self.size,
                    _ => 1.0,
                };
                sizes[j] += value.abs() * size;
            }
        }
        std::array::from_fn(|j| if sizes[j] > 0.0 { sums[j].abs() / sizes[j] } else { 0.0 })
    }
}

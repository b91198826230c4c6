//! What a doubt comes to: supports, rounded coordinates, or coordinates that belong to another model.

use super::doubt::{Doubt, Place};
use super::free::Free;
use super::mended::mended;
use super::motions::Motions;
use super::zeros::{Zeros, counted, n_loose_rows, whole};
use crate::error::{Error, Result};
use crate::input::Direction;
use crate::model::{CoordinateFit, Misfit};
use crate::sparse::product;

/// Share of the Rayleigh quotient of the first elastic mode that rounded coordinates may cost. Five digits of a plate of
/// thickness 1:1000 cost 3·10⁻³, one node of a block moved by a hundredth costs 2.5·10⁻² (catalogue I-18, I-19).
const ROUNDED: f64 = 1e-2;
/// How far the worst node may stand out from the median one. Rounding is of one size everywhere: the largest of a million
/// normal numbers is 7 times the median one, and digits may be lost unevenly by some 10. A node out of place by a hundredth
/// stands out by 10³ to 10⁴.
const EVEN: f64 = 100.0;
/// Names of the six motions.
const MOTIONS: [&str; 6] = [
    "translation along x",
    "translation along y",
    "translation along z",
    "rotation about x",
    "rotation about y",
    "rotation about z",
];

/// What is known of all bodies once there is a doubt.
struct Case<'a> {
    motions: &'a Motions<'a>,
    doubts: &'a [Doubt],
    free: Vec<Free>,
    /// M C, n × 6.
    momenta: faer::Mat<f64>,
    /// Motions without energy that the coordinates explain, and rows that move by themselves.
    n_explained: usize,
}

/// Settles the doubts about coordinates, by the motions without energy that K has.
pub(super) fn settled(motions: &Motions<'_>, doubts: &[Doubt], held: &[Direction]) -> Result<CoordinateFit> {
    let momenta = product(&motions.model.mass, motions.centred.as_ref());
    let free: Vec<Free> = motions.bodies.iter().map(|body| Free::of(motions, body, &momenta)).collect::<Result<_>>()?;
    let n_explained = free.iter().map(|free| free.n_free).sum::<usize>() + n_loose_rows(motions);
    let case = Case { motions, doubts, free, momenta, n_explained };
    let whole = whole(motions)?;
    match doubts.iter().all(|doubt| doubt.costly.is_empty()) {
        true => {
            let noise = case.free.iter().fold(0.0, |max: f64, free| max.max(free.noise));
            match counted(&whole, noise)? {
                Some(n_zero) if n_zero <= n_explained => Ok(CoordinateFit::Exact),
                _ => case.supports(&Zeros::of(&whole)?),
            }
        }
        false => case.rotations(&Zeros::of(&whole)?, held),
    }
}

impl Case<'_> {
    /// Supports touch some rows, and the coordinates are right on all others: more motions without energy than they explain
    /// are mechanisms, unless they are rigid-body motions as far as the other rows tell.
    fn supports(&self, zeros: &Zeros) -> Result<CoordinateFit> {
        let Self { motions, doubts, .. } = self;
        let cost = |doubt: &&Doubt| self.free[doubt.body].largest_quotient;
        let Some(worst) = doubts.iter().max_by(|a, b| cost(a).total_cmp(&cost(b))) else {
            return Ok(CoordinateFit::Exact);
        };
        let energy = zeros.first_elastic.map_or(f64::INFINITY, |lambda| cost(&worst) / lambda);
        let n_rows: usize = doubts.iter().map(|doubt| motions.bodies[doubt.body].rows.len()).sum();
        let n_touched: usize = doubts.iter().map(|doubt| doubt.n_touched(motions)).sum();
        // Where supports touch most rows, the others are no witness.
        let is_unexplained = zeros.count() > self.n_explained
            && energy > ROUNDED
            && (2 * n_touched > n_rows || zeros.n_rigid(motions, doubts)? > self.n_explained);
        if !is_unexplained {
            return Ok(CoordinateFit::Exact);
        }
        let costly: Vec<usize> = (0..6).filter(|motion| self.costs_energy(worst, *motion)).collect();
        let place = Place::of(motions, &motions.bodies[worst.body].rows, &costly);
        Err(self.misfit(zeros, &costly, (energy, ROUNDED), place.at))
    }

    /// Rotations make forces where no support is.
    fn rotations(&self, zeros: &Zeros, held: &[Direction]) -> Result<CoordinateFit> {
        let motions = self.motions;
        let of_doubt = |doubt| (self.cost_of_rotations(doubt), doubt);
        let costly = self.doubts.iter().filter(|doubt| !doubt.costly.is_empty()).map(of_doubt);
        let Some((quotient, worst)) = costly.max_by(|a, b| a.0.total_cmp(&b.0)) else {
            return Ok(CoordinateFit::Exact);
        };
        let energy = zeros.first_elastic.map_or(f64::INFINITY, |lambda| quotient / lambda);
        let Place { at, concentration } = Place::of(motions, &worst.untouched, &worst.costly);
        // Of a node out of place all but what the median node shows is too much.
        let expected = if concentration <= EVEN { ROUNDED } else { ROUNDED.min(energy / concentration.powi(2)) };
        let is_rounded = !energy.is_nan() && energy <= expected;
        if is_rounded && zeros.count() >= self.n_of_right_coordinates(held) {
            let rotation = axis(worst.costly[0]);
            let misfit = Misfit { rotation, energy, at };
            let mended = mended(motions, &self.free, zeros, misfit)?;
            return Ok(CoordinateFit::Rounded(mended));
        }
        let translates_freely = worst.n_touched(motions) == 0;
        if translates_freely && zeros.count() <= self.n_explained {
            let (rotations, n_zero) = (named(&worst.costly), zeros.count());
            return Err(Error::RotationsHeld { rotations, n_zero, energy, dof: at });
        }
        Err(self.misfit(zeros, &worst.costly, (energy, expected), at))
    }

    /// Motions without energy there would be if the coordinates were right but for rounding: every motion of a body that no
    /// support touches and that the job does not say to be held, and what is free of the others.
    fn n_of_right_coordinates(&self, held: &[Direction]) -> usize {
        let of_body = |(number, free): (usize, &Free)| match self.doubts.iter().find(|doubt| doubt.body == number) {
            Some(doubt) if doubt.n_touched(self.motions) == 0 && held.is_empty() => free.n_moving,
            _ => free.n_free,
        };
        self.free.iter().enumerate().map(of_body).sum()
    }

    /// The largest Rayleigh quotient of a rotation of a body, without the share of supports.
    ///
    /// Of a body that supports touch the energy is estimated: forces f that displacements out of place make are those of their
    /// own rows, of stiffness K_ii, and cost Σ f_i² / K_ii.
    fn cost_of_rotations(&self, doubt: &Doubt) -> f64 {
        let Self { motions, momenta, .. } = self;
        let body = &motions.bodies[doubt.body];
        if doubt.n_touched(motions) == 0 {
            return self.free[doubt.body].largest_quotient;
        }
        let stiffness = crate::model::diagonal(&motions.model.stiffness);
        let quotient = |motion: &usize| {
            let of_row = |row: &usize| motions.forces[(*row, *motion)].powi(2) / stiffness[*row];
            let energy: f64 = doubt.untouched.iter().filter(|row| stiffness[**row] > 0.0).map(of_row).sum();
            let mass: f64 =
                body.rows.iter().map(|row| motions.centred[(*row, *motion)] * momenta[(*row, *motion)]).sum();
            energy / mass
        };
        doubt.costly.iter().map(quotient).fold(0.0, f64::max)
    }

    /// Whether a motion of a body by the coordinates costs more than rounding.
    fn costs_energy(&self, doubt: &Doubt, motion: usize) -> bool {
        let (energy, terms) = self.motions.energy(&self.motions.bodies[doubt.body], motion);
        energy > crate::rigid::FREE_BELOW_NOISE * self.motions.rounding() * terms
    }

    fn misfit(&self, zeros: &Zeros, costly: &[usize], (energy, expected): (f64, f64), dof: String) -> Error {
        Error::CoordinatesDoNotFit {
            n_zero: zeros.count(),
            n_explained: self.n_explained,
            motions: named(costly),
            energy,
            expected,
            dof,
        }
    }
}

/// The axis of a rotation among the six motions.
fn axis(rotation: usize) -> &'static str {
    ["x", "y", "z"][rotation % 3]
}

/// Some of the six motions by name, in their order.
fn named(motions: &[usize]) -> String {
    let names: Vec<&str> = (0..6).filter(|motion| motions.contains(motion)).map(|motion| MOTIONS[motion]).collect();
    names.join(", ")
}

//! The decision about a doubt: supports, rounded coordinates, or coordinates that belong to another model.

use std::ops::Range;

use super::below_zero;
use super::doubt::{Costly, Doubt, Place};
use super::free::Free;
use super::mended::{Mended, apart, first_rounded, mended};
use super::motions::{AXES, FIVE_DIGITS, Motions, SIX_DIGITS};
use super::nodes::{FIRST_ROTATION, TOUCHED};
use super::zeros::{Whole, Zeros, n_loose_rows};
use crate::dofs::Direction;
use crate::error::{Error, ErrorClass, Result};
use crate::job::Mechanisms;
use crate::model::{CoordinateFit, Misfit, RoundedCoordinates};
use crate::number::quantity;
use crate::partition::TiedNodes;
use supel_runtime::MOTIONS;

/// Share of the Rayleigh quotient of the first elastic mode that rounded coordinates may cost. Five digits of a plate of
/// thickness 1:1000 cost 3·10⁻³, one node of a block moved by a hundredth costs 2.5·10⁻² (catalogue I-18, I-19).
const ROUNDED: f64 = 1e-2;
/// Share of the energy of the first elastic mode up to which springs that hold rotations are soft: those of a thousandth of its
/// frequency. The component is nearly free, and W-GROUNDED says how nearly.
const SOFTLY_HELD: f64 = 1e-6;
/// How far the worst node may stand out from the median one. Rounding is of one size everywhere: the largest of a million
/// normal numbers is 7 times the median one, and digits may be lost unevenly by some 10. A node out of place by a hundredth
/// stands out by 10³ to 10⁴.
const EVEN: f64 = 100.0;
/// Displacement out of place that coordinates of three digits leave, which is as much as belongs to any model of the same nodes: a map of
/// other nodes or axes moves them by a hundredth or more.
const THREE_DIGITS: f64 = 2e-3;

/// Motions of a body.
const ALL_MOTIONS: usize = 6;
/// Motions of a body in a plane.
const IN_A_PLANE: usize = 3;

/// What is known of all bodies once there is a doubt.
struct Case<'a> {
    motions: &'a Motions<'a>,
    doubts: &'a [Doubt],
    free: Vec<Free>,
    /// Motions without energy that the coordinates explain, and rows that move by themselves.
    n_explained: usize,
    /// What the job says of mechanisms.
    mechanisms: Mechanisms,
    /// Labels of the nodes that patches tie by their coordinates.
    tied: &'a TiedNodes,
}

/// Settles the doubts about coordinates, by the motions without energy that K has.
pub(super) fn settled(
    motions: &Motions<'_>,
    doubts: &[Doubt],
    (mechanisms, tied): (Mechanisms, &TiedNodes),
) -> Result<CoordinateFit> {
    let free = Free::of_all(motions)?;
    let n_explained = free.iter().map(|free| free.n_free).sum::<usize>() + n_loose_rows(motions);
    let case = Case { motions, doubts, free, n_explained, mechanisms, tied };
    let whole = Whole::of(motions);
    match doubts.iter().all(|doubt| doubt.costly.is_empty()) {
        true => {
            let noise = case.free.iter().fold(0.0, |max: f64, free| max.max(free.noise));
            match whole.counted(noise)? {
                Some(n_zero) if n_zero <= n_explained && !case.may_be_turned(n_zero) => Ok(CoordinateFit::Exact),
                _ => match whole.zeros() {
                    Ok(zeros) => case.supports(&zeros),
                    Err(error) if is_of_the_arithmetic(&error) => Ok(CoordinateFit::Unknown),
                    Err(error) => Err(error),
                },
            }
        }
        false => case.rotations(&below_zero::zeros_unless_negative(motions, (doubts, &case.free), &whole)?),
    }
}

/// The fit of coordinates that nothing is said against: where roundings of axes are felt in a body that nothing holds, and explain what it
/// feels, its motions are those that K lets pass.
pub(super) fn with_axes_as_known(motions: &Motions<'_>, doubts: &[Doubt]) -> Result<CoordinateFit> {
    let is_held = |number: usize| doubts.iter().any(|doubt| doubt.body == number && doubt.n_touched > 0);
    let bodies = motions.bodies.iter().enumerate();
    if !bodies.filter(|(number, _)| !is_held(*number)).any(|(_, body)| motions.feels_axes(body)) {
        return Ok(CoordinateFit::Exact);
    }
    let free = Free::of_all(motions)?;
    match Whole::of(motions).zeros() {
        Ok(zeros) => Ok(CoordinateFit::Rounded(mended(motions, &free, &zeros, (None, &|_| false, 0))?.coordinates)),
        Err(error) if is_of_the_arithmetic(&error) => Ok(CoordinateFit::Exact),
        Err(error) => Err(error),
    }
}

/// Whether an error says that motions without energy cannot be told from others: the stages that need them say why.
fn is_of_the_arithmetic(error: &Error) -> bool {
    matches!(error, Error::NotDefinite { .. } | Error::IndefiniteStiffness { .. } | Error::DigitsTooFew { .. })
        || error.class() == ErrorClass::NumericalLimit
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
        let cost = of_first_elastic(cost(&worst), zeros.first_elastic(0));
        let n_touched: usize = doubts.iter().map(|doubt| doubt.n_touched).sum();
        // As many as all bodies have motions: soft supports leave them some at most, rows along axes that are off all.
        let are_all = zeros.count() >= self.n_moving();
        // Where supports touch few rows, parts that move against each other on all others are a held chain of links, which nothing but the job
        // tells from axes that are off beyond these rows. Rows along a line have no axes to be off.
        let have_axes = doubts.iter().all(|doubt| self.free[doubt.body].n_moving >= IN_A_PLANE);
        let may_be_askew = have_axes && self.mechanisms == Mechanisms::Warn;
        let is_unmeant_chain = || Ok::<_, Error>(may_be_askew && zeros.n_rigid(motions, doubts)? < zeros.count());
        let is_askew = are_all && (self.are_mostly_touched() || is_unmeant_chain()?);
        // Where supports touch most rows, the others prove too little; where they touch none, there are no supports.
        let is_unexplained = zeros.count() > self.n_explained
            && (cost.energy > ROUNDED || is_askew)
            && (is_askew
                || self.are_mostly_touched()
                || n_touched == 0
                || zeros.n_rigid(motions, doubts)? > self.n_explained);
        if !is_unexplained {
            let apart = if have_axes { self.refuse_apart(zeros, &(0..ALL_MOTIONS))? } else { 0.0 };
            // What is off by no more than the decimals of the axes is mended as they are, and so is what six digits of axes leave. Springs to
            // the ground leave rows along their axes.
            let is_rounded = apart > TOUCHED && zeros.turn <= SIX_DIGITS;
            let is_off = zeros.count() == self.n_moving() && (zeros.count() > self.n_explained || is_rounded);
            let misfit = match motions.has_rounded_axes() {
                true => None,
                false => Some(self.misfit_of_axes(worst, cost)),
            };
            return match is_off && (is_rounded || misfit.is_none()) {
                true => {
                    Ok(CoordinateFit::Rounded(mended(motions, &self.free, zeros, (misfit, &|_| false, 0))?.coordinates))
                }
                false => Ok(CoordinateFit::Exact),
            };
        }
        zeros.refuse_uncounted(motions)?;
        let costly: Vec<usize> = (0..6).filter(|motion| self.costs_energy(worst, *motion)).collect();
        let place = Place::of(motions, &motions.bodies[worst.body].rows, &costly);
        let mut error = self.misfit(zeros, &costly, cost, place.at);
        if let Error::CoordinatesDoNotFit { found, .. } = &mut error
            && !self.are_mostly_touched()
            && n_touched > 0
        {
            *found +=
                ", unless it is held there and hinges let the rest move, which `model.mechanisms = \"accept\"` says";
        }
        Err(error)
    }

    /// Whether rows that translations make forces at may lie along axes of their own: nothing holds the bodies as far as energies tell, and
    /// forces tell twice as many digits, where K has them all.
    fn may_be_turned(&self, n_zero: usize) -> bool {
        let is_touched = self.doubts.iter().any(|doubt| doubt.n_touched > 0);
        is_touched && n_zero == self.n_moving() && !self.motions.model.precision.stiffness.is_coarse()
    }

    /// The rotation that costs most by rows along other axes than the map says.
    fn misfit_of_axes(&self, worst: &Doubt, Cost { energy, of, .. }: Cost) -> Misfit {
        let (motions, body) = (self.motions, &self.motions.bodies[worst.body]);
        let share = |rotation: &usize| {
            let (energy, terms) = motions.energy(body, *rotation);
            if terms > 0.0 { energy / terms } else { 0.0 }
        };
        let costliest = (FIRST_ROTATION..ALL_MOTIONS).max_by(|a, b| share(a).total_cmp(&share(b)));
        let rotation = costliest.unwrap_or(FIRST_ROTATION);
        Misfit { rotation: AXES[rotation % 3], energy, of, at: Place::of(motions, &body.rows, &[rotation]).at }
    }

    /// Motions of all bodies that move a dof.
    fn n_moving(&self) -> usize {
        self.free.iter().map(|free| free.n_moving).sum()
    }

    /// Where nothing holds the bodies, as many motions cost nothing as they have and no other, and rows that feel translations are along other
    /// axes than the map says, unless the job says that mechanisms are meant. Springs to the ground that are nothing next to the stiffness
    /// leave the motions as they are. How far the worst row moves otherwise, by no more than digits explain; zero where nothing is compared.
    fn refuse_apart(&self, zeros: &Zeros, looked_at: &Range<usize>) -> Result<f64> {
        let n_moving = self.n_moving();
        let is_told = n_moving > self.n_explained || self.may_be_turned(zeros.count());
        if zeros.count() != n_moving || !is_told || self.mechanisms == Mechanisms::Accept {
            return Ok(0.0);
        }
        zeros.refuse_uncounted(self.motions)?;
        let (energy, worst) = apart(self.motions, (&self.free, zeros), looked_at)?;
        let expected = SIX_DIGITS.max(zeros.turn);
        if energy <= expected {
            return Ok(energy);
        }
        let dof = self.motions.name_of(worst);
        let found = format!(
            "nothing holds the body, and in motions that cost nothing rows move otherwise than their coordinates and axes say by up to {} of its \
             size, the worst at {dof}",
            quantity(energy, 2)
        );
        Err(Error::CoordinatesDoNotFit { found, energy, expected, dof })
    }

    /// Whether supports touch most rows of the nodes of the bodies in doubt.
    fn are_mostly_touched(&self) -> bool {
        let n_rows: usize = self.doubts.iter().map(|doubt| doubt.n_rows).sum();
        let n_touched: usize = self.doubts.iter().map(|doubt| doubt.n_touched).sum();
        2 * n_touched > n_rows
    }

    /// Rotations make forces where no support is.
    fn rotations(&self, zeros: &Zeros) -> Result<CoordinateFit> {
        let motions = self.motions;
        let of_doubt = |doubt| (self.cost_of_rotations(doubt, zeros), doubt);
        let costly = self.doubts.iter().filter(|doubt| !doubt.costly.is_empty()).map(of_doubt);
        let Some((cost, worst)) = costly.max_by(|a, b| a.0.energy.total_cmp(&b.0.energy)) else {
            return Ok(CoordinateFit::Exact);
        };
        let rotations: Vec<usize> = worst.costly.iter().map(|costly| costly.rotation).collect();
        let Place { at, concentration, .. } = Place::of(motions, &worst.costly[0].witnesses, &rotations);
        // Of a node out of place all but what the median node shows is too much.
        let expected = if concentration <= EVEN { ROUNDED } else { ROUNDED.min(cost.energy / concentration.powi(2)) };
        let is_rounded = !cost.energy.is_nan() && cost.energy <= expected;
        let is_held = worst.costly.iter().all(|costly| !costly.is_free);
        if is_rounded && is_held {
            self.refuse_out_of_place(worst, &rotations)?;
        }
        if is_rounded && zeros.count() >= self.n_of_right_coordinates() {
            // Of a body whose rows are nearly all touched the others say little, and the number of motions all.
            if self.are_mostly_touched() {
                self.supports(zeros)?;
            }
            // No rounding of coordinates is felt by translations.
            if worst.n_touched > 0 {
                self.refuse_apart(zeros, &(0..FIRST_ROTATION))?;
            }
            let misfit = Misfit { rotation: AXES[rotations[0] % 3], energy: cost.energy, of: cost.of, at };
            let is_tied = |row: usize| self.is_tied(row);
            let mended = mended(motions, &self.free, zeros, (Some(misfit), &is_tied, first_rounded(motions)))?;
            return self.in_place(mended).map(CoordinateFit::Rounded);
        }
        let is_free = worst.costly.iter().any(|costly| costly.is_free);
        let is_held_in_rotation = is_free && zeros.count() < self.n_of_right_coordinates();
        if is_free && zeros.count() <= self.n_explained && cost.energy <= SOFTLY_HELD {
            return Ok(CoordinateFit::Exact);
        }
        if is_held_in_rotation && zeros.count() <= self.n_explained && !self.are_more_than_held(worst, zeros) {
            let directions = rotations.iter().map(|motion| Direction::ALL[*motion]).collect();
            let (rotations, n_zero) = (named(&rotations), zeros.count());
            return Err(Error::RotationsHeld { rotations, directions, n_zero, energy: cost.energy, dof: at });
        }
        let mut error = self.misfit(zeros, &rotations, Cost { expected, ..cost }, at);
        if let Error::CoordinatesDoNotFit { found, .. } = &mut error
            && zeros.count() <= self.n_explained
            && (is_held_in_rotation || !is_free)
        {
            let directions: Vec<String> =
                rotations.iter().map(|motion| format!("\"{}\"", Direction::ALL[*motion])).collect();
            *found += &format!(
                ", unless supports hold nodes there in rotation, which `model.held_rotations = [{}]` says",
                directions.join(", ")
            );
        }
        Err(error)
    }

    /// Whether a row is of a node that a patch ties.
    fn is_tied(&self, row: usize) -> bool {
        let dof = self.motions.model.dofs.as_ref().and_then(|dofs| dofs[row]);
        dof.is_some_and(|dof| self.tied.contains(dof.node))
    }

    /// What is mended of free bodies, where no node was farther out of place than coordinates of three digits leave it.
    fn in_place(&self, Mended { coordinates, out_of_place, worst }: Mended) -> Result<RoundedCoordinates> {
        if out_of_place <= THREE_DIGITS {
            return Ok(coordinates);
        }
        let dof = self.motions.name_of(worst);
        let found = format!(
            "nodes are out of place by up to {} of the size of the body, the worst at {dof}",
            quantity(out_of_place, 2)
        );
        Err(Error::CoordinatesDoNotFit { found, energy: out_of_place, expected: THREE_DIGITS, dof })
    }

    /// Of a held body nothing mends the coordinates that tie nodes to a patch, and of other nodes no rounding moves so many so far.
    fn refuse_out_of_place(&self, doubt: &Doubt, rotations: &[usize]) -> Result<()> {
        let motions = self.motions;
        let is_tied = |row: &usize| self.is_tied(*row);
        let witnesses = &doubt.costly[0].witnesses;
        let tied: Vec<usize> = witnesses.iter().copied().filter(is_tied).collect();
        let n_tied = motions.bodies[doubt.body].rows.iter().filter(|row| is_tied(row)).count();
        // Rounding is of one size everywhere: of a patch next to supports the other witnesses tell.
        let of_patches = if tied.len() < n_tied { witnesses } else { &tied };
        let of_patches = Some((of_patches, FIVE_DIGITS)).filter(|_| n_tied > 0);
        for (rows, expected) in of_patches.into_iter().chain([(witnesses, THREE_DIGITS)]) {
            let Place { at: dof, largest: energy, .. } = Place::of(motions, rows, rotations);
            if energy > expected {
                let found = format!(
                    "nodes of the held component are out of place by up to {} of its size, the worst at {dof}",
                    quantity(energy, 2)
                );
                return Err(Error::CoordinatesDoNotFit { found, energy, expected, dof });
            }
        }
        Ok(())
    }

    /// Whether few digits of K let more motions pass than springs against the costly rotations of a body would: they hide what the rotations of
    /// wrong coordinates cost, in a thin part the more of it, and one more may be held by them alone.
    fn are_more_than_held(&self, doubt: &Doubt, zeros: &Zeros) -> bool {
        let n_turning = doubt.costly.iter().filter(|costly| costly.is_free).count();
        let is_coarse = self.motions.model.precision.stiffness.is_coarse();
        is_coarse && zeros.count() + n_turning > self.n_of_right_coordinates()
    }

    /// Motions without energy there would be if the coordinates were right but for rounding: what is free by them, and the
    /// rotations that nothing holds.
    fn n_of_right_coordinates(&self) -> usize {
        let of_body = |(number, free): (usize, &Free)| {
            let doubt = self.doubts.iter().find(|doubt| doubt.body == number);
            let n_turning = doubt.map_or(0, |doubt| doubt.costly.iter().filter(|costly| costly.is_free).count());
            free.n_moving.min(free.n_free + n_turning)
        };
        self.free.iter().enumerate().map(of_body).sum()
    }

    /// What the rotations of a body cost: relative to the first elastic mode, or where supports hold the body to what turning
    /// it costs in all.
    ///
    /// The share of a held body is an estimate: forces f that displacements out of place make are those of their own rows, of
    /// stiffness K_ii, and cost Σ f_i² / K_ii.
    fn cost_of_rotations(&self, doubt: &Doubt, zeros: &Zeros) -> Cost {
        let Self { motions, .. } = self;
        let body = &motions.bodies[doubt.body];
        if doubt.costly.iter().any(|costly| costly.is_free) {
            // Rotations that springs hold have eigenvalues of their own below those of the elastic modes.
            let n_held = self.n_of_right_coordinates().saturating_sub(zeros.count());
            return of_first_elastic(self.free[doubt.body].largest_quotient, zeros.first_elastic(n_held));
        }
        let stiffness = crate::sparse::diagonal(&motions.model.stiffness);
        let share = |costly: &Costly| {
            let of_row = |row: &usize| motions.forces[(*row, costly.rotation)].powi(2) / stiffness[*row];
            let energy: f64 = costly.witnesses.iter().filter(|row| stiffness[**row] > 0.0).map(of_row).sum();
            energy / motions.energy(body, costly.rotation).0
        };
        let energy = doubt.costly.iter().map(share).fold(0.0, f64::max);
        Cost { energy, of: "what turning the held component costs", expected: ROUNDED }
    }

    /// Whether a motion of a body by the coordinates costs more than rounding.
    fn costs_energy(&self, doubt: &Doubt, motion: usize) -> bool {
        let (energy, terms) = self.motions.energy(&self.motions.bodies[doubt.body], motion);
        energy > super::free::FREE_BELOW_NOISE * self.motions.rounding() * terms
    }

    fn misfit(&self, zeros: &Zeros, costly: &[usize], cost: Cost, dof: String) -> Error {
        let Cost { energy, of, expected } = cost;
        let (n_zero, n_explained) = (zeros.count(), self.n_explained);
        let mut found = match n_zero > n_explained {
            true => format!("it has {n_zero} motions without energy, of which the coordinates explain {n_explained}"),
            // Those that cost nothing as they are need no explanation.
            false => format!("it has {n_zero} motions without energy, no more than the coordinates explain"),
        };
        if n_zero > n_explained && (costly.is_empty() || energy <= expected) {
            // Nothing is wrong with what they cost: there are too many.
            return Error::CoordinatesDoNotFit {
                found,
                energy: n_zero as f64,
                expected: (n_explained + 1) as f64,
                dof,
            };
        }
        let cost = quantity(energy, 2);
        found += &format!("; by them {} cost up to {cost} of {of}, most of it at {dof}", named(costly));
        Error::CoordinatesDoNotFit { found, energy, expected, dof }
    }
}

/// What motions by the coordinates cost.
struct Cost {
    /// Their energy relative to another.
    energy: f64,
    /// What it is relative to.
    of: &'static str,
    /// What rounding of coordinates may cost.
    expected: f64,
}

fn of_first_elastic(quotient: f64, first: Option<f64>) -> Cost {
    let energy = first.map_or(f64::INFINITY, |lambda| quotient / lambda);
    Cost { energy, of: "the energy of the first elastic mode", expected: ROUNDED }
}

/// Some of the six motions by name, in their order.
fn named(motions: &[usize]) -> String {
    let names: Vec<&str> = (0..6).filter(|motion| motions.contains(motion)).map(|motion| MOTIONS[motion]).collect();
    names.join(", ")
}

//! How many of its six motions a body makes without energy, by the coordinates.

use faer::Mat;

use super::motions::{Body, Motions};
use super::nodes::FIRST_ROTATION;
use crate::dense;
use crate::eigen::{NO_MASS, zero};
use crate::error::Result;
use crate::rigid::moving_directions;

/// A motion by the coordinates is free when its energy stays below this many times the noise of the data. The noise bound adds all
/// roundings with one sign; measured energies of exact rigid motions stay below it, so ten is generous.
pub(super) const FREE_BELOW_NOISE: f64 = 10.0;

/// The motions of a body in numbers of order six.
pub(super) struct Free {
    /// Independent motions that move a dof.
    pub(super) n_moving: usize,
    /// Independent motions that cost no energy.
    pub(super) n_free: usize,
    /// The largest Rayleigh quotient of a motion with mass.
    pub(super) largest_quotient: f64,
    /// The largest Rayleigh quotient that rounding of the data can make.
    pub(super) noise: f64,
    /// The Rayleigh quotient of a motion that is farther below zero than roundings of K explain, and what these can make of it.
    pub(super) below_zero: Option<[f64; 2]>,
    /// The combinations of the six columns of C that are M-orthonormal, 6 × (≤ 6).
    pub(super) orthonormal: Mat<f64>,
}

impl Free {
    /// Of all bodies, in their order.
    pub(super) fn of_all(motions: &Motions<'_>) -> Result<Vec<Self>> {
        let momenta = motions.momenta();
        motions.bodies.iter().map(|body| Self::of(motions, body, &momenta)).collect()
    }

    /// Of a body; `momenta` are those of [`Motions::momenta`].
    fn of(motions: &Motions<'_>, body: &Body, momenta: &Mat<f64>) -> Result<Self> {
        let rows = |a: &Mat<f64>| Mat::from_fn(body.rows.len(), 6, |i, j| a[(body.rows[i], j)]);
        let c = rows(&motions.centred);
        let magnitudes = dense::absolute(c.as_ref());
        let moving = moving_directions(c.as_ref())?;
        let mut energy = dense::gram(c.as_ref(), rows(&motions.forces).as_ref());
        let mut mass = dense::gram(c.as_ref(), rows(momenta).as_ref());
        dense::symmetrise(&mut energy);
        dense::symmetrise(&mut mass);
        let terms = dense::gram(magnitudes.as_ref(), rows(&motions.terms).as_ref());
        let (massive, massless) = by_mass(&mass, &moving)?;
        let look = |directions: &Mat<f64>| energies(motions, directions, &energy, &terms);
        let (of_massive, of_massless) = (look(&massive)?, look(&massless)?);
        // Translations depend on no coordinate: what is below zero of them is what the program that wrote K left.
        let shown = (0..FIRST_ROTATION).map(|j| -energy[(j, j)] / terms[(j, j)].max(f64::MIN_POSITIVE));
        let shown = shown.fold(motions.rounding(), f64::max);
        let lowest = of_massive.iter().min_by(|a, b| a.energy.total_cmp(&b.energy));
        let lowest = lowest.map(|of| [of.energy, FREE_BELOW_NOISE * of.noise.max(shown * of.terms)]);
        Ok(Self {
            n_moving: moving.ncols(),
            n_free: n_free(&of_massive) + n_free(&of_massless),
            largest_quotient: of_massive.iter().fold(0.0, |max, of| max.max(of.energy.abs())),
            noise: of_massive.iter().fold(0.0, |max, of| max.max(of.noise)),
            below_zero: lowest.filter(|[energy, level]| *energy < -level),
            orthonormal: massive,
        })
    }
}

/// Directions of unit modal mass, and those without mass.
fn by_mass(mass: &Mat<f64>, moving: &Mat<f64>) -> Result<(Mat<f64>, Mat<f64>)> {
    let within = dense::gram(moving.as_ref(), dense::product(mass.as_ref(), moving.as_ref()).as_ref());
    let (masses, vectors) = dense::symmetric_eigen(within.as_ref())?;
    let directions = dense::product(moving.as_ref(), vectors.as_ref());
    let largest = masses.last().copied().unwrap_or(0.0);
    let (massive, massless): (Vec<usize>, Vec<usize>) = (0..masses.len()).partition(|j| masses[*j] > NO_MASS * largest);
    let unit = |j: usize| 1.0 / masses[j].sqrt();
    let of = |chosen: &[usize], factor: &dyn Fn(usize) -> f64| {
        Mat::from_fn(6, chosen.len(), |i, j| directions[(i, chosen[j])] * factor(chosen[j]))
    };
    Ok((of(&massive, &unit), of(&massless, &|_| 1.0)))
}

/// How many cost no energy, each by its own rounding as in [`crate::rigid`].
fn n_free(energies: &[Energy]) -> usize {
    let of = |which: fn(&Energy) -> f64| energies.iter().map(which).collect::<Vec<f64>>();
    let [lambda, noise, terms] = [of(|of| of.energy), of(|of| of.noise), of(|of| of.terms)];
    let levels: Vec<f64> = zero::of_alike(&lambda, &noise).into_iter().map(|noise| FREE_BELOW_NOISE * noise).collect();
    let levels = zero::raised(&lambda, &levels, &terms);
    lambda.iter().zip(levels).filter(|(energy, level)| **energy <= *level).count()
}

/// What a motion costs.
struct Energy {
    energy: f64,
    /// What rounding of the data can make of it.
    noise: f64,
    /// |c|ᵀ|K||c|.
    terms: f64,
}

/// What some directions cost, combined so that none shares energy with another.
fn energies(motions: &Motions<'_>, directions: &Mat<f64>, energy: &Mat<f64>, terms: &Mat<f64>) -> Result<Vec<Energy>> {
    let within = dense::gram(directions.as_ref(), dense::product(energy.as_ref(), directions.as_ref()).as_ref());
    let (energies, own) = dense::symmetric_eigen(within.as_ref())?;
    let directions = dense::product(directions.as_ref(), own.as_ref());
    let terms_of = |k: usize| -> f64 {
        let weight = |i: usize| directions[(i, k)].abs();
        (0..6).flat_map(|i| (0..6).map(move |j| (i, j))).map(|(i, j)| weight(i) * terms[(i, j)] * weight(j)).sum()
    };
    // A combination of six carries the rounding of the largest energy: a motion along guides has no terms of its own.
    let of_combining = f64::EPSILON * energies.iter().fold(0.0, |max: f64, energy| max.max(energy.abs()));
    let of = |(k, energy)| {
        let terms = terms_of(k);
        Energy { energy, noise: motions.rounding() * terms + of_combining, terms }
    };
    Ok(energies.into_iter().enumerate().map(of).collect())
}

//! The modes of an assembly, each between two bounds.
//!
//! A frequency is an upper bound for the full assembly's of the same number; what the components leave out gives the lower one, see
//! [`super::omitted`].

use faer::Mat;
use serde::Serialize;

use super::assembly::{Assembled, Assembly};
use super::omitted::{Omitted, SprungMass};
use super::spectrum::{Pencil, Spectrum, emptiest};
use crate::dense;
use crate::error::{Error, Result};

/// How far beyond the end of the band the last mode that was kept may come out: by its error bar, which is taken off the band.
const SAME_FREQUENCY: f64 = 1e-6;

/// Which modes are wanted, rigid-body modes included.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Wanted {
    /// The lowest ones, as many.
    Count(usize),
    /// All up to a frequency in Hz.
    UpTo(f64),
}

/// The modes of an assembly.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct AssemblyModes {
    /// Coordinates that are free to move, joined ones counted once.
    pub n_free: usize,
    /// Rigid-body modes.
    pub n_rigid: usize,
    /// Coordinates without mass of their own: as many eigenvalues are infinite, and left out.
    pub n_massless: usize,
    /// Modes there are, of which some may not have been wanted.
    pub n_modes: usize,
    /// The frequency in Hz above which a component leaves modes out, the lowest of all; none where none leaves any out or one does not say.
    pub band_hz: Option<f64>,
    /// The modes that were wanted, ascending.
    pub modes: Vec<AssemblyMode>,
}

/// A mode of an assembly.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct AssemblyMode {
    /// Its number, from one.
    pub number: usize,
    /// What it is.
    pub kind: Kind,
    /// Natural frequency of the assembled superelements: no lower than that of the full assembly, but for rounding, where no component is in
    /// doubt.
    pub frequency_hz: f64,
    /// How far rounding of the reduced matrices may have moved it.
    pub rounding_hz: f64,
    /// No frequency of this number of the full assembly is lower; none where a component does not say what it leaves out.
    pub at_least_hz: Option<f64>,
    /// Whether it lies above the band in which no component leaves out a mode of its own.
    pub is_beyond_band: bool,
    /// Share of the strain energy in each component; none for a motion without energy.
    pub energy_shares: Option<Vec<f64>>,
    /// Number of the component whose omitted modes widen the bounds most.
    pub limited_by: Option<usize>,
}

/// What a mode is.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum Kind {
    /// A motion of the whole in which no component is strained.
    RigidBody,
    /// A motion whose energy is rounding, although a component is strained.
    WithoutEnergy,
    /// A vibration.
    Elastic,
}

impl Assembly {
    /// The modes of the assembly.
    ///
    /// Cost: some decompositions of dense matrices of the order of the free coordinates and the interface coordinates together.
    ///
    /// # Errors
    /// [`Error::AssemblyHeld`] where nothing moves, [`Error::AssemblySingular`] where a motion has neither stiffness nor mass,
    /// [`Error::AssemblyIndefinite`] where one has negative energy, [`Error::DenseEigen`].
    pub fn modes(&self, wanted: Wanted) -> Result<AssemblyModes> {
        let assembled = self.assembled()?;
        let pencil = &assembled.pencil;
        let Some(spectrum) = pencil.spectrum(None)? else {
            let at = emptiest(pencil.stiffness.as_ref(), pencil.mass.as_ref())?;
            return Err(Error::AssemblySingular { at: self.name_of(at) });
        };
        self.refuse_negative(&spectrum)?;
        let omitted = self.omitted();
        let lower = match &omitted {
            Some(omitted) => Some(lower_bounds(&assembled, omitted, &spectrum)?),
            None => None,
        };
        let (n_free, n_rigid) = (pencil.stiffness.nrows(), pencil.rigid.ncols());
        let n_modes = n_rigid + spectrum.lambda.len();
        let n_wanted = match wanted {
            Wanted::Count(count) => count.min(n_modes),
            Wanted::UpTo(hz) => n_rigid + spectrum.lambda.partition_point(|lambda| hertz(*lambda) <= hz),
        };
        let band_hz = omitted.iter().flatten().map(|omitted| omitted.hz).reduce(f64::min);
        let rigid = (1..=n_rigid).map(|number| AssemblyMode::rigid(number, lower.as_ref().map(|_| 0.0)));
        let elastic = (0..spectrum.lambda.len()).map(|j| {
            let omitted = omitted.as_deref().unwrap_or_default();
            let found = Found { assembled: &assembled, spectrum: &spectrum, omitted, j };
            self.mode(&found, lower.as_deref(), band_hz, n_rigid)
        });
        let modes = rigid.chain(elastic).take(n_wanted).collect();
        Ok(AssemblyModes { n_free, n_rigid, n_massless: n_free - n_modes.min(n_free), n_modes, band_hz, modes })
    }

    fn refuse_negative(&self, spectrum: &Spectrum) -> Result<()> {
        match spectrum.lambda.first().zip(spectrum.rounding.first()) {
            Some((lambda, rounding)) if *lambda < -rounding || !lambda.is_finite() => {
                let highest = spectrum.lambda.last().copied().unwrap_or(1.0);
                let what = "the assembly".to_owned();
                Err(Error::AssemblyIndefinite { what, matrix: "stiffness", value: lambda / highest })
            }
            _ => Ok(()),
        }
    }

    /// What the components leave out; none where one does not say.
    fn omitted(&self) -> Option<Vec<OmittedOf<'_>>> {
        let mut all = Vec::new();
        for (component, of) in self.components.iter().enumerate() {
            match &of.omitted {
                Omitted::Nothing => {}
                Omitted::Above { hz, mass } => all.push(OmittedOf { component, hz: *hz, mass }),
                Omitted::Unknown { .. } | Omitted::InDoubt { .. } => return None,
            }
        }
        Some(all)
    }

    fn mode(&self, found: &Found<'_>, lower: Option<&[f64]>, band_hz: Option<f64>, n_rigid: usize) -> AssemblyMode {
        let Found { assembled, spectrum, omitted, j } = found;
        let (lambda, rounding) = (spectrum.lambda[*j], spectrum.rounding[*j]);
        let has_energy = lambda > rounding;
        let frequency_hz = if has_energy { hertz(lambda) } else { 0.0 };
        let shape = dense::column(spectrum.shapes.as_ref(), *j);
        let own = |block: &Vec<Option<usize>>| -> Vec<f64> {
            block.iter().map(|to| to.map_or(0.0, |to| shape[to])).collect()
        };
        let shapes: Vec<Vec<f64>> = assembled.blocks.iter().map(own).collect();
        let energies = self.components.iter().zip(&shapes).map(|(component, x)| quadratic(&component.stiffness, x));
        let energies: Vec<f64> = energies.collect();
        let whole: f64 = energies.iter().sum();
        let width = |omitted: &OmittedOf<'_>| {
            let SprungMass { factor, springs } = omitted.mass;
            let parts = springs.iter().enumerate().map(|(column, kappa)| {
                let part = dense::dot(dense::column(factor.as_ref(), column), &shapes[omitted.component]).powi(2);
                if lambda < *kappa { lambda / (kappa - lambda) * part } else { f64::INFINITY }
            });
            (omitted.component, parts.sum::<f64>())
        };
        let widest = omitted.iter().map(width).filter(|(_, width)| *width > 0.0);
        let at_least_hz = lower.map(|lower| lower[*j].min(frequency_hz));
        AssemblyMode {
            number: n_rigid + j + 1,
            kind: if has_energy { Kind::Elastic } else { Kind::WithoutEnergy },
            frequency_hz,
            rounding_hz: hertz(lambda.max(0.0) + rounding) - hertz(lambda),
            at_least_hz,
            is_beyond_band: band_hz.is_some_and(|band| frequency_hz > (1.0 + SAME_FREQUENCY) * band),
            energy_shares: has_energy.then(|| energies.iter().map(|energy| energy / whole).collect()),
            limited_by: widest.reduce(|a, b| if b.1 > a.1 { b } else { a }).map(|(component, _)| component),
        }
    }
}

impl AssemblyMode {
    fn rigid(number: usize, at_least_hz: Option<f64>) -> Self {
        Self {
            number,
            kind: Kind::RigidBody,
            frequency_hz: 0.0,
            rounding_hz: 0.0,
            at_least_hz,
            is_beyond_band: false,
            energy_shares: None,
            limited_by: None,
        }
    }
}

/// What one component leaves out.
struct OmittedOf<'a> {
    component: usize,
    hz: f64,
    mass: &'a SprungMass,
}

/// Lower bounds in Hz of the elastic frequencies of a spectrum: those of the assembly with the omitted mass on springs, and no more than the
/// end of the lowest band.
fn lower_bounds(assembled: &Assembled, omitted: &[OmittedOf<'_>], upper: &Spectrum) -> Result<Vec<f64>> {
    let pencil = &assembled.pencil;
    let n_springs: usize = omitted.iter().map(|omitted| omitted.mass.springs.len()).sum();
    // G in the coordinates of the assembly, and κ′ of each of its columns.
    let (mut g, mut kappa) = (Mat::<f64>::zeros(pencil.stiffness.nrows(), n_springs), Vec::new());
    for OmittedOf { component, mass: SprungMass { factor, springs }, .. } in omitted {
        let places = assembled.blocks[*component].iter().enumerate();
        for (i, to) in places.filter_map(|(i, to)| Some((i, (*to)?))) {
            (0..springs.len()).for_each(|column| g[(to, kappa.len() + column)] += factor[(i, column)]);
        }
        kappa.extend(springs);
    }
    let end = omitted.iter().map(|omitted| omitted.hz).fold(f64::INFINITY, f64::min);
    // What is taken off the mass may leave coordinates nothing but rounding, which tells no first eigenvalue.
    let sprung = sprung(pencil, &g, &kappa).spectrum(upper.first_elastic())?;
    let lower = |j: usize| match &sprung {
        Some(found) => found.lambda.get(j).map_or(end, |lambda| hertz(lambda - found.rounding[j]).min(end)),
        // Rounding decides; zero is a bound in any case.
        None => 0.0,
    };
    // What no frequency is below, no higher one is.
    let highest = |so_far: &mut f64, bound: f64| {
        *so_far = so_far.max(bound);
        Some(*so_far)
    };
    Ok((0..upper.lambda.len()).map(lower).scan(0.0, highest).collect())
}

/// An eigenpair of the assembly.
struct Found<'a> {
    assembled: &'a Assembled,
    spectrum: &'a Spectrum,
    /// What each component leaves out; empty also where one does not say.
    omitted: &'a [OmittedOf<'a>],
    j: usize,
}

/// The pencil with the mass GGᵀ taken off it and hung on springs, see [`super::omitted`].
fn sprung(pencil: &Pencil, g: &Mat<f64>, kappa: &[f64]) -> Pencil {
    let (n, n_springs) = (g.nrows(), g.ncols());
    let stiff = Mat::from_fn(n, n_springs, |i, c| kappa[c] * g[(i, c)]);
    let mut held = dense::product(stiff.as_ref(), g.transpose());
    dense::symmetrise(&mut held);
    let mut taken = dense::product(g.as_ref(), g.transpose());
    dense::symmetrise(&mut taken);
    let extended =
        |own: &dyn Fn(usize, usize) -> f64, across: &dyn Fn(usize, usize) -> f64, springs: &dyn Fn(usize) -> f64| {
            Mat::from_fn(n + n_springs, n + n_springs, |i, j| match (i < n, j < n) {
                (true, true) => own(i, j),
                (true, false) => across(i, j - n),
                (false, true) => across(j, i - n),
                (false, false) => {
                    if i == j {
                        springs(i - n)
                    } else {
                        0.0
                    }
                }
            })
        };
    let noise = dense::NOISE_FACTOR * f64::EPSILON;
    let carried = dense::product(g.transpose(), pencil.rigid.as_ref());
    Pencil {
        stiffness: extended(&|i, j| pencil.stiffness[(i, j)] + held[(i, j)], &|i, c| -stiff[(i, c)], &|c| kappa[c]),
        mass: extended(&|i, j| pencil.mass[(i, j)] - taken[(i, j)], &|_, _| 0.0, &|_| 1.0),
        rounding: extended(
            &|i, j| pencil.rounding[(i, j)] + noise * held[(i, j)].abs(),
            &|i, c| noise * stiff[(i, c)].abs(),
            &|c| noise * kappa[c],
        ),
        doubt: extended(&|i, j| pencil.doubt[(i, j)], &|_, _| 0.0, &|_| 0.0),
        rigid: Mat::from_fn(n + n_springs, pencil.rigid.ncols(), |i, j| {
            if i < n { pencil.rigid[(i, j)] } else { carried[(i - n, j)] }
        }),
    }
}

fn quadratic(a: &Mat<f64>, x: &[f64]) -> f64 {
    (0..a.ncols()).map(|j| x[j] * dense::dot(dense::column(a.as_ref(), j), x)).sum()
}

/// √λ/2π, zero below zero.
fn hertz(lambda: f64) -> f64 {
    lambda.max(0.0).sqrt() / std::f64::consts::TAU
}

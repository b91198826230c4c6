//! The checks of a foreign superelement that need no interface.

use faer::Mat;

use super::compared::Compared;
use super::dependence;
use super::foreign::{Difference, Foreign, Pair};
use crate::audit::{condition_of, negative_mass};
use crate::certification::strayed;
use crate::dense;
use crate::error::Result;
use crate::number::{counted, quantity};
use crate::verification::check::{Check, Limits};
use crate::verification::limits::{self, Judged, Known};

/// Share of a motion or of its mass that practice does not miss.
const CARRIED: f64 = 1e-6;
/// Share that fails.
const NOT_CARRIED: f64 = 1e-3;
/// Relative difference of a frequency that practice accepts.
pub(super) const FREQUENCY: f64 = 1e-2;
/// Share of a mode beside the basis that practice accepts, and from which on the basis has another one: of its mass, a hundredth and a
/// half.
const BESIDE: [f64; 2] = [0.1, 0.707];

/// Every check that needs no interface.
///
/// # Errors
/// A dense eigenproblem that does not converge.
pub(super) fn checks(compared: &Compared<'_>, band_hz: [f64; 2]) -> Result<Vec<Check>> {
    let Compared { foreign, .. } = compared;
    let mut checks = vec![compared.projection("stiffness", &foreign.stiffness.worst(foreign.rounding))];
    checks.push(compared.projection("mass", &foreign.mass.worst(foreign.rounding)));
    checks.extend(compared.missing());
    checks.extend(compared.rigid_motion());
    checks.push(compared.zero_modes());
    checks.extend(compared.rigid_energy());
    checks.extend(compared.rigid_mass());
    checks.extend(compared.frequencies_in_band(band_hz));
    checks.extend(compared.modes_in_basis(band_hz));
    checks.extend(strayed::check(compared.component.partition, &foreign.strayed, |at| foreign.name(at)));
    checks.extend(compared.monotonicity());
    checks.push(condition(foreign));
    checks.push(symmetry(foreign));
    checks.push(compared.definiteness());
    checks.push(dependence::check(compared.component.partition, foreign)?);
    Ok(checks)
}

impl Compared<'_> {
    fn name(&self, at: usize) -> String {
        self.foreign.name(at)
    }

    /// C-07.
    fn projection(&self, which: &'static str, difference: &Difference) -> Check {
        let Difference { value, limits, at } = *difference;
        let (name, equation) = match which {
            "stiffness" => ("reduced stiffness is that of the basis", "max |K̂ − ΨᵀKΨ|_ij / √((ΨᵀKΨ)_ii (ΨᵀKΨ)_jj)"),
            _ => ("reduced mass is that of the basis", "max |M̂ − ΨᵀMΨ|_ij / √((ΨᵀMΨ)_ii (ΨᵀMΨ)_jj)"),
        };
        let worst = at.map(|(i, j)| {
            let pair = if which == "stiffness" { &self.foreign.stiffness } else { &self.foreign.mass };
            let factor = quantity(pair.given[(i, j)] / pair.projected[(i, j)], 4);
            match i == j {
                true => format!("{}, {factor} times as large", self.name(i)),
                false => format!("{} and {}, {factor} times as large", self.name(i), self.name(j)),
            }
        });
        Check { id: "C-07", name, equation, value, limits, fail_above: projection_fails(&limits), worst }
    }

    /// M-06: of the component's own modes that are compared with.
    fn missing(&self) -> Option<Check> {
        let certificate = self.certificate?;
        Some(Check {
            id: "M-06",
            name: "no mode of the component is missing",
            equation: "eigenvalues counted by the inertia of K − σM less those found",
            value: certificate.n_counted.abs_diff(certificate.n_found) as f64,
            limits: Limits::default(),
            fail_above: 0.0,
            worst: Some(format!("counted {}, found {}", certificate.n_counted, certificate.n_found)),
        })
    }

    /// What the digits of the basis leave of a motion.
    fn of_digits(&self) -> f64 {
        self.foreign.of_digits()
    }

    /// M-11.
    fn rigid_motion(&self) -> Option<Check> {
        let left = &self.rigid.left;
        let value = dense::worst(left.iter().copied());
        let worst = left.iter().position(|left| *left == value);
        let limits = Limits { engineering: CARRIED, arithmetic: 0.0, data: self.of_digits() };
        let limits = limits.capped(0.0, NOT_CARRIED);
        (!left.is_empty()).then(|| Check {
            id: "M-11",
            name: "the basis carries rigid-body motion",
            equation: "max min_q ‖U − Ψq‖ / ‖U‖ in M",
            value,
            limits,
            fail_above: NOT_CARRIED,
            worst: worst.map(|motion| format!("rigid-body mode {} of {}", motion + 1, left.len())),
        })
    }

    /// M-12: as many motions without stiffness as the component has.
    fn zero_modes(&self) -> Check {
        let n_given = self.n_without_stiffness;
        let n_asked = self.rigid.left.len();
        Check {
            id: "M-12",
            name: "as many motions without stiffness as K",
            equation: "eigenvalues of K̂, ΨᵀMΨ below half of the first elastic one of K, M, less rigid-body modes",
            value: n_given.abs_diff(n_asked) as f64,
            limits: Limits::default(),
            fail_above: 0.0,
            worst: Some(format!("{}, the component {n_asked}", counted(n_given, "motion", "motions"))),
        }
    }

    /// M-12: their energy, by the forces of what the superelement takes for rigid-body motion.
    fn rigid_energy(&self) -> Option<Check> {
        let first = self.first;
        let (k, q) = (&self.foreign.stiffness, &self.rigid.coordinates);
        let energies = dense::dots(q.as_ref(), dense::product(k.given.as_ref(), q.as_ref()).as_ref());
        let value = dense::worst(energies.iter().map(|energy| energy.abs() / first));
        let partition = self.component.partition;
        let known = self.full.iter().zip(self.errors);
        let known = known.map(|(lambda, error)| Known { lambda: *lambda, relative_bar: error.data_bar });
        let noise = limits::energy_noise((partition, self.component.rigid), known, first);
        let of_digits = self.energy_of_digits(q) / first;
        let precision = partition.precision.stiffness.share + if of_digits > noise { 1.0 } else { 0.0 };
        let Judged { limits, fail_above } =
            limits::of_energy(noise.max(of_digits), precision / (f64::EPSILON + precision));
        (q.ncols() > 0).then_some(Check {
            id: "M-12",
            name: "rigid-body motion costs no energy",
            equation: "max qᵀK̂q / λ of the first elastic mode, Ψq nearest to rigid-body motion",
            value,
            limits,
            fail_above,
            worst: None,
        })
    }

    /// What the digits of K̂ may make of the energy of motions.
    fn energy_of_digits(&self, motions: &Mat<f64>) -> f64 {
        let of_motion = |at: usize| self.foreign.stiffness.changed_by_digits(dense::column(motions.as_ref(), at));
        (0..motions.ncols()).map(of_motion).fold(0.0, f64::max)
    }

    /// M-16.
    fn rigid_mass(&self) -> Option<Check> {
        let q = &self.rigid.coordinates;
        let masses = dense::gram(q.as_ref(), dense::product(self.foreign.mass.given.as_ref(), q.as_ref()).as_ref());
        let identity = |i: usize, j: usize| f64::from(u8::from(i == j));
        let mut worst = (0.0, (0, 0));
        for j in 0..masses.ncols() {
            for i in 0..=j {
                let error = (masses[(i, j)] - identity(i, j)).abs();
                if dense::worse(error, worst.0) {
                    worst = (error, (i, j));
                }
            }
        }
        let [relative, absolute] = self.foreign.mass.rounding;
        let of_mass = if relative.max(absolute) > f64::EPSILON { relative.max(absolute) } else { 0.0 };
        let data = self.of_digits() + dense::NOISE_FACTOR * of_mass;
        let limits = Limits { engineering: CARRIED, arithmetic: 0.0, data }.capped(0.0, NOT_CARRIED);
        let (i, j) = worst.1;
        (q.ncols() > 0).then(|| Check {
            id: "M-16",
            name: "mass and inertia are those of the component",
            equation: "max |qᵀM̂q − UᵀMU|, U of unit mass",
            value: worst.0,
            limits,
            fail_above: NOT_CARRIED,
            worst: Some(match i == j {
                true => format!("rigid-body mode {}: {} of its mass", i + 1, quantity(masses[(i, i)], 4)),
                false => format!("rigid-body modes {} and {}", i + 1, j + 1),
            }),
        })
    }

    /// C-08.
    fn frequencies_in_band(&self, band_hz: [f64; 2]) -> Option<Check> {
        let compared = self.frequencies(band_hz)?;
        let inside = compared.frequencies.iter().enumerate().filter(|(_, pair)| pair.in_band);
        let mut worst = (0.0, None);
        for (at, pair) in inside {
            let value = pair.relative_difference.abs();
            if worst.1.is_none() || dense::worse(value, worst.0) {
                worst = (value, Some((at, pair)));
            }
        }
        let (value, at) = worst;
        let (at, pair) = at?;
        Some(Check {
            id: "C-08",
            name: "frequencies of the free component are preserved",
            equation: "max |f_reduced / f − 1| in the band, of modes that are the same by their shapes",
            value,
            limits: Limits { engineering: FREQUENCY, ..Limits::default() },
            fail_above: self.frequency_fails,
            worst: Some(match pair.reduced_hz.is_finite() {
                true => format!(
                    "elastic mode {} at {} Hz, {} Hz in the superelement{}",
                    at + 1,
                    quantity(pair.full_hz, 7),
                    quantity(pair.reduced_hz, 7),
                    if value > FREQUENCY { self.culprit() } else { "" }
                ),
                false => format!("elastic mode {} at {} Hz, which it has not", at + 1, quantity(pair.full_hz, 7)),
            }),
        })
    }

    /// Which matrix frequencies are wrong by, where one of them alone is not that of the basis.
    fn culprit(&self) -> &'static str {
        let is_wrong = |pair: &Pair| {
            let Difference { value, limits, .. } = pair.worst(self.foreign.rounding);
            value > projection_fails(&limits)
        };
        match (is_wrong(&self.foreign.stiffness), is_wrong(&self.foreign.mass)) {
            (false, true) => ", by its mass, which is not that of the basis",
            (true, false) => ", by its stiffness, which is not that of the basis",
            _ => "",
        }
    }

    /// C-09.
    fn modes_in_basis(&self, [from, to]: [f64; 2]) -> Option<Check> {
        let hertz = |lambda: f64| self.component.partition.scaling.hertz(lambda);
        let modes = self.full.iter().map(|lambda| hertz(*lambda)).zip(&self.left_of_modes);
        let mut worst: (f64, Option<f64>) = (0.0, None);
        for (frequency, left) in modes.filter(|(frequency, _)| (from..=to).contains(frequency)) {
            if worst.1.is_none() || dense::worse(*left, worst.0) {
                worst = (*left, Some(frequency));
            }
        }
        let (value, at) = worst;
        let [engineering, fail_above] = BESIDE;
        at.map(|frequency| Check {
            id: "C-09",
            name: "modes of the free component are in the basis",
            equation: "max min_q ‖x − Ψq‖ / ‖x‖ in M, over the modes x of the band",
            value,
            limits: Limits { engineering, ..Limits::default() },
            fail_above,
            worst: Some(format!(
                "the mode at {} Hz, of whose mass the basis has {:.1} %",
                quantity(frequency, 7),
                100.0 * (1.0 - value * value).max(0.0)
            )),
        })
    }

    /// M-24: the k-th of all eigenvalues of the one against the k-th of all of the other.
    fn monotonicity(&self) -> Option<Check> {
        /// What rounding may excuse at most.
        const MOST: f64 = 1e-2;
        let mut worst: (f64, Limits, Option<usize>) = (0.0, Limits { engineering: CARRIED, ..Limits::default() }, None);
        let compared = self.full.iter().zip(self.errors).enumerate().filter(|(_, (full, _))| **full <= self.top);
        for (at, (full, error)) in compared {
            let Some((reduced, of_digits)) = self.above(at) else { break };
            let below = (1.0 - reduced / full).max(0.0);
            let of_reduced = dense::NOISE_FACTOR * of_digits;
            let data = error.data_bar + self.of_digits() * error.cancellation + of_reduced;
            let limits = Limits { engineering: CARRIED, arithmetic: error.residual_bar, data }.capped(MOST, MOST);
            if worst.2.is_none() || dense::worse(below / limits.value(), worst.0 / worst.1.value()) {
                worst = (below, limits, Some(at));
            }
        }
        let (value, limits, at) = worst;
        at.map(|at| Check {
            id: "M-24",
            name: "no frequency lies below that of the component",
            equation: "max (λ_full − λ_reduced) / λ_full (Rayleigh), the interface free",
            value,
            limits,
            fail_above: limits.value().max(1e-3),
            worst: Some(format!("elastic mode {}", at + 1)),
        })
    }

    /// M-25.
    fn definiteness(&self) -> Check {
        let mass = negative_mass(self.foreign.mass.given.as_ref());
        let first = self.first;
        let (value, worst) = match (mass, &self.reduced) {
            (Ok(Some(_)) | Err(_), _) => (f64::INFINITY, Some("the mass has a negative eigenvalue".to_owned())),
            (Ok(None), None) => {
                (f64::INFINITY, Some("a motion has neither stiffness nor mass, or negative ones".to_owned()))
            }
            (Ok(None), Some(reduced)) => ((-reduced.first().copied().unwrap_or(0.0) / first).max(0.0), None),
        };
        let of_digits = self.energy_of_digits(&self.rigid.coordinates) / first;
        let Judged { limits, fail_above } = limits::of_energy(of_digits, 1.0);
        Check {
            id: "M-25",
            name: "reduced mass and stiffness are not negative",
            equation: "λ_min(M̂) ≥ 0; max(0, −λ_min(K̂, M̂)) / λ of the first elastic mode",
            value,
            limits,
            fail_above,
            worst,
        }
    }
}

/// Difference from what the basis makes of a matrix that fails.
fn projection_fails(limits: &Limits) -> f64 {
    limits.value().max(1e-3)
}

/// M-23.
fn condition(foreign: &Foreign) -> Check {
    Check {
        id: "M-23",
        name: "condition of the reduced mass",
        equation: "λ_max / λ_min of D M̂ D with unit diagonal",
        value: condition_of(foreign.mass.given.as_ref()).unwrap_or(f64::INFINITY),
        limits: Limits::NONE,
        fail_above: f64::INFINITY,
        worst: None,
    }
}

/// M-25.
fn symmetry(foreign: &Foreign) -> Check {
    let rounding = [&foreign.stiffness, &foreign.mass].map(|pair| pair.rounding[0].max(pair.rounding[1]));
    let data = rounding.into_iter().filter(|rounding| *rounding > f64::EPSILON).fold(0.0, f64::max);
    let limits = Limits { engineering: 1e-12, arithmetic: 0.0, data: 2.0 * data }.capped(0.0, 1e-4);
    Check {
        id: "M-25",
        name: "reduced matrices are symmetric",
        equation: "max |K̂ − K̂ᵀ|/|K̂|, |M̂ − M̂ᵀ|/|M̂|",
        value: foreign.stiffness.asymmetry.max(foreign.mass.asymmetry),
        limits,
        fail_above: limits.value().max(1e-6),
        worst: None,
    }
}

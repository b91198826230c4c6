//! The checks of a result.
//!
//! Their limits are those of practice: another program may stop its iteration earlier than this one does, and write fewer digits.

use super::band::Completed;
use super::claims::Claims;
use super::judgement::{Judged, NOT_RIGID};
use super::measured::Measured;
use super::pair::PairKind;
use crate::dense::{self, NOISE_FACTOR};
use crate::eigen::{NOTICED_BAR, mass_orthogonality};
use crate::modes::Component;
use crate::number::{counted, quantity};
use crate::sparse::product;
use crate::verification::check::{Check, Limits};
use crate::verification::limits::{self, Known, UNKNOWN};

/// Frequencies or numbers that a line lists at most.
const LISTED: usize = 6;

pub(super) fn checks(
    component: Component<'_>,
    (claims, measured): (&Claims, &Measured),
    (judged, completed): (&Judged, &Completed),
) -> Vec<Check> {
    let looked_at = Subject { component, claims, measured, judged, completed };
    let mut checks = vec![looked_at.backward_error()];
    checks.extend(looked_at.mass_orthogonality());
    checks.extend(looked_at.stiffness_orthogonality());
    checks.extend(looked_at.rigid_energy());
    checks.extend(looked_at.missing());
    checks.extend(looked_at.angles());
    checks.extend(looked_at.data_precision());
    checks.extend(looked_at.frequencies());
    checks.push(looked_at.invented());
    checks.push(looked_at.repeated());
    checks.extend(looked_at.rigid_modes());
    checks.extend(looked_at.rigid_frequencies());
    checks.push(looked_at.modal_masses());
    checks
}

/// What is said besides the checks.
pub(super) fn notes(component: Component<'_>, claims: &Claims, judged: &Judged) -> Vec<String> {
    /// Displacement of dofs at rest that is no rounding of a text.
    const MOVES: f64 = 1e-5;
    let mut notes = Vec::new();
    if claims.not_followed > MOVES {
        notes.push(format!(
            "dofs that are held, or that follow others, move in the shapes by up to {} of the largest displacement: the result may be that \
             of other supports",
            quantity(claims.not_followed, 2)
        ));
    }
    if judged.n_cut > 0 {
        notes.push(format!(
            "the result ends inside a group of modes of one frequency: {} of it more in the model; ask for {} more",
            counted(judged.n_cut, "mode is", "modes are"),
            counted(judged.n_cut, "mode", "modes"),
        ));
    }
    if component.rigid.n_massless > 0 {
        notes.push(format!(
            "{} of the model without mass: no program can find them",
            counted(component.rigid.n_massless, "rigid-body motion is", "rigid-body motions are")
        ));
    }
    if claims.lambda.is_none() {
        notes.push("the result has no frequencies: those that belong to its shapes are shown".to_owned());
    }
    let order = judged.order();
    notes.extend(order);
    notes
}

impl Judged {
    /// Frequencies that are all there and belong to other shapes.
    fn order(&self) -> Option<String> {
        let elastic: Vec<_> = self.pairs.iter().filter(|pair| pair.kind == PairKind::Inexact).collect();
        let (Some(mut stated), mut of_shapes) = (
            elastic.iter().map(|pair| pair.stated_hz).collect::<Option<Vec<f64>>>(),
            elastic.iter().map(|pair| pair.shape_hz).collect::<Vec<f64>>(),
        ) else {
            return None;
        };
        stated.sort_by(f64::total_cmp);
        of_shapes.sort_by(f64::total_cmp);
        let is_same = |(a, b): (&f64, &f64)| (a / b - 1.0).abs() <= NOTICED_BAR;
        (elastic.len() > 1 && stated.iter().zip(&of_shapes).all(is_same)).then(|| {
            format!(
                "the frequencies of {} are those of other shapes among them: shapes and frequencies are in different orders",
                counted(elastic.len(), "pair", "pairs")
            )
        })
    }
}

/// The largest of some values, with the pair it belongs to.
fn worst(values: impl IntoIterator<Item = (usize, f64)>) -> (f64, Option<usize>) {
    let mut worst = (0.0, None);
    for (pair, value) in values {
        if dense::worse(value, worst.0) {
            worst = (value, Some(pair));
        }
    }
    worst
}

struct Subject<'a> {
    component: Component<'a>,
    claims: &'a Claims,
    measured: &'a Measured,
    judged: &'a Judged,
    completed: &'a Completed,
}

impl Subject<'_> {
    /// The numbers of pairs of some kinds, from zero.
    fn of_kinds(&self, kinds: &[PairKind]) -> Vec<usize> {
        (0..self.claims.count()).filter(|claim| kinds.contains(&self.judged.pairs[*claim].kind)).collect()
    }

    /// Pairs that are modes, or should be.
    fn elastic(&self) -> Vec<usize> {
        let is_rigid = |claim: &usize| self.judged.pairs[*claim].mode_hz == Some(0.0);
        let of_kinds = self.of_kinds(&[PairKind::Mode, PairKind::Inexact]);
        of_kinds.into_iter().filter(|claim| !is_rigid(claim)).collect()
    }

    /// λ of the first elastic mode, where the band has it.
    fn first_elastic(&self) -> Option<f64> {
        self.completed.modes.lambda.first().copied().filter(|_| self.completed.ends[0] <= 0.0)
    }

    /// What the digits of the shapes leave of a measure that is relative to its terms.
    fn of_digits(&self) -> f64 {
        let rounding = self.claims.shape_rounding;
        if rounding > f64::EPSILON { NOISE_FACTOR * rounding } else { 0.0 }
    }

    fn name(&self, claim: usize) -> String {
        let pair = &self.judged.pairs[claim];
        let hertz = pair.stated_hz.unwrap_or(pair.shape_hz);
        format!("mode {} at {} Hz", pair.number, quantity(hertz, 6))
    }

    /// M-01.
    fn backward_error(&self) -> Check {
        let inside = self.of_kinds(&[PairKind::Mode, PairKind::Inexact, PairKind::RigidBody, PairKind::Invented]);
        let (value, at) = worst(inside.into_iter().map(|claim| (claim, self.measured.backward[claim])));
        let data = self.of_digits() + self.component.partition.precision.share();
        let limits = Limits { engineering: 1e-9, arithmetic: 0.0, data }.capped(0.0, 1e-5);
        Check {
            id: "M-01",
            name: "modes satisfy the full model",
            equation: "max ‖Kx − λMx‖ / ((‖K‖ + λ‖M‖) ‖x‖), equilibrated",
            value,
            limits,
            fail_above: limits.value().max(1e-6),
            worst: at.map(|claim| format!("{}, {}", self.name(claim), self.judged.pairs[claim].worst_at)),
        }
    }

    /// M-03, of shapes of unit modal mass that are modes.
    fn mass_orthogonality(&self) -> Option<Check> {
        let kinds = [PairKind::RigidBody, PairKind::Mode, PairKind::Inexact];
        let modes = self.of_kinds(&kinds);
        let shapes = dense::columns(self.claims.shapes.as_ref(), &modes);
        let found = mass_orthogonality(&self.component.partition.mass, shapes.as_ref());
        let (a, b) = found.pair;
        let limits = Limits {
            engineering: 1e-6,
            arithmetic: NOISE_FACTOR * f64::EPSILON * found.largest_terms,
            data: self.of_digits() * found.largest_terms,
        };
        let limits = limits.capped(1e-6, 1e-3);
        (modes.len() > 1).then(|| Check {
            id: "M-03",
            name: "modes are orthogonal in the mass",
            equation: "max |XᵀMX − I|, each shape at unit modal mass",
            value: found.error,
            limits,
            fail_above: limits.value().max(1e-2),
            worst: Some(format!("{} and {}", self.name(modes[a]), self.name(modes[b]))),
        })
    }

    /// M-04.
    fn stiffness_orthogonality(&self) -> Option<Check> {
        let modes = self.elastic();
        let shapes = dense::columns(self.claims.shapes.as_ref(), &modes);
        let forces = product(&self.component.partition.stiffness, shapes.as_ref());
        let energies = dense::gram(shapes.as_ref(), forces.as_ref());
        let coupling = |i: usize, j: usize| {
            energies[(i, j)].abs() / (self.measured.lambda[modes[i]] * self.measured.lambda[modes[j]]).abs().sqrt()
        };
        let mut found = (0.0, (0, 0));
        for j in 0..modes.len() {
            for i in 0..j {
                if dense::worse(coupling(i, j), found.0) {
                    found = (coupling(i, j), (i, j));
                }
            }
        }
        let cancellation = modes.iter().map(|claim| self.measured.errors[*claim].cancellation).fold(0.0, f64::max);
        let limits = Limits {
            engineering: 1e-4,
            arithmetic: NOISE_FACTOR * f64::EPSILON * cancellation,
            data: self.of_digits() * cancellation,
        };
        let limits = limits.capped(1e-3, 1e-2);
        let (value, (a, b)) = found;
        (modes.len() > 1).then(|| Check {
            id: "M-04",
            name: "modes are orthogonal in the stiffness",
            equation: "max |x_iᵀKx_j| / √(λ_i λ_j), i ≠ j",
            value,
            limits,
            fail_above: limits.value().max(3e-2),
            worst: Some(format!("{} and {}", self.name(modes[a]), self.name(modes[b]))),
        })
    }

    /// M-05: the rigid-body modes of the model, not those of the result.
    fn rigid_energy(&self) -> Option<Check> {
        let Component { partition, rigid, .. } = self.component;
        let first = self.first_elastic()?;
        let errors = self.completed.modes.errors.iter();
        let known = self.completed.modes.lambda.iter().zip(errors);
        let known = known.map(|(lambda, error)| Known { lambda: *lambda, relative_bar: error.data_bar });
        let precision = partition.precision.stiffness.share;
        let judged = limits::of_energy(
            limits::energy_noise((partition, rigid), known, first),
            precision / (f64::EPSILON + precision),
        );
        (rigid.count() > 0).then(|| Check {
            id: "M-05",
            name: "rigid-body motion costs no energy",
            equation: "max qᵀKq / λ of the first elastic mode",
            value: rigid.energy.largest_quotient / first,
            limits: judged.limits,
            fail_above: judged.fail_above,
            worst: None,
        })
    }

    /// M-06.
    fn missing(&self) -> Option<Check> {
        let certificate = self.completed.certificate.as_ref();
        let missing = &self.judged.missing;
        let n_missing = missing.len() + self.completed.n_not_sought;
        let listed: Vec<String> =
            missing.iter().take(LISTED).map(|mode| format!("{} Hz", quantity(mode.frequency_hz, 6))).collect();
        let mut said = match (listed.len(), certificate) {
            (0, Some(certificate)) => format!("counted {}, all there", certificate.n_counted - self.judged.n_above),
            (0, None) => String::new(),
            (n, _) if n < missing.len() => format!("{} and {} more", listed.join(", "), missing.len() - n),
            _ => listed.join(", "),
        };
        if self.completed.n_not_sought > 0 {
            said += &format!("; {} more by the count alone", self.completed.n_not_sought);
        }
        if let Some(doubt) = certificate.map(|certificate| certificate.doubt()).filter(|doubt| *doubt > 1.0) {
            said += &format!("; the count is likely, not certain: doubt {} (limit 1)", quantity(doubt, 2));
        }
        (certificate.is_some() || n_missing > 0).then_some(Check {
            id: "M-06",
            name: "no mode is missing",
            equation: "eigenvalues counted in the band, by the inertia of K − σM at its ends, that no pair is",
            value: n_missing as f64,
            limits: Limits::default(),
            fail_above: 0.0,
            worst: Some(said),
        })
    }

    /// M-08.
    fn angles(&self) -> Option<Check> {
        let modes = self.elastic();
        let known: Vec<(usize, f64)> =
            modes.into_iter().filter_map(|claim| Some((claim, self.judged.angles[claim]?))).collect();
        let is_empty = known.is_empty();
        let (value, at) = worst(known);
        let data = self.component.partition.precision.share();
        let limits = Limits { engineering: 1e-3, arithmetic: 0.0, data }.capped(0.0, 1e-2);
        (!is_empty).then(|| Check {
            id: "M-08",
            name: "shapes lie close to eigenvectors",
            equation: "max sin ∠(x, eigenvectors of its cluster) ≤ δ/γ, in the norm of K − σM",
            value,
            limits,
            fail_above: 1e-1,
            worst: at.map(|claim| self.name(claim)),
        })
    }

    /// M-09.
    fn data_precision(&self) -> Option<Check> {
        let modes = self.elastic();
        let is_empty = modes.is_empty();
        let bars = modes.into_iter().map(|claim| (claim, 0.5 * self.measured.errors[claim].data_bar));
        let (value, at) = worst(bars);
        (!is_empty).then(|| Check {
            id: "M-09",
            name: "digits of the data suffice",
            equation: "max ½ (|xᵀEx| + ε_M λ|x|ᵀ|M||x|) / λ, E roundings of K: relative error bar of a frequency",
            value,
            limits: Limits { engineering: NOTICED_BAR, ..Limits::default() },
            fail_above: UNKNOWN,
            worst: at.map(|claim| self.name(claim)),
        })
    }

    /// C-01.
    fn frequencies(&self) -> Option<Check> {
        let modes = self.elastic();
        let is_empty = modes.is_empty();
        let off = |claim: usize| {
            let pair = &self.judged.pairs[claim];
            let mode = pair.mode_hz.unwrap_or(pair.shape_hz);
            let difference = pair.stated_hz.map_or(0.0, |stated| (stated / mode - 1.0).abs());
            // The frequency of a pair that is another mode than its quotient says is known without its own bar.
            let bar = if mode == pair.shape_hz { 0.5 * self.judged.bars[claim] } else { 0.0 };
            let own = (pair.shape_hz / mode - 1.0).abs();
            (claim, difference.max(own) + bar)
        };
        let (value, at) = worst(modes.into_iter().map(off));
        // Rounding of λ is twice that of its root; of a frequency it is what it is.
        let data = self.claims.value_rounding + 0.5 * self.component.partition.precision.share();
        let limits = Limits { engineering: NOTICED_BAR, arithmetic: 0.0, data }.capped(0.0, 1e-3);
        (!is_empty).then(|| Check {
            id: "C-01",
            name: "frequencies are those of the full model",
            equation: "max |f − f_model| / f_model, with the error bar that the residual leaves",
            value,
            limits,
            fail_above: limits.value().max(1e-3),
            worst: at.map(|claim| self.told_frequency(claim)),
        })
    }

    fn told_frequency(&self, claim: usize) -> String {
        let pair = &self.judged.pairs[claim];
        let mode = pair.mode_hz.unwrap_or(pair.shape_hz);
        format!("{}, whose shape has {} Hz", self.name(claim), quantity(mode, 6))
    }

    /// C-02.
    fn invented(&self) -> Check {
        let invented = self.of_kinds(&[PairKind::Invented]);
        self.none_of(invented, "C-02", "no mode is invented", "pairs that are no mode of K and M, nor nearly one")
    }

    /// C-03.
    fn repeated(&self) -> Check {
        let repeated = self.of_kinds(&[PairKind::Repeated]);
        self.none_of(repeated, "C-03", "no mode is given twice", "shapes that are combinations of others")
    }

    fn none_of(&self, claims: Vec<usize>, id: &'static str, name: &'static str, equation: &'static str) -> Check {
        let mut listed: Vec<String> = claims.iter().take(LISTED).map(|claim| self.name(*claim)).collect();
        if claims.len() > LISTED {
            listed.push(format!("{} more", claims.len() - LISTED));
        }
        Check {
            id,
            name,
            equation,
            value: claims.len() as f64,
            limits: Limits::default(),
            fail_above: 0.0,
            worst: (!claims.is_empty()).then(|| listed.join(", ")),
        }
    }

    /// C-04, where the band begins at zero and the model is free. A result without any leaves them out on purpose.
    fn rigid_modes(&self) -> Option<Check> {
        let n_missing = self.judged.n_rigid_missing;
        let n_rigid = self.component.rigid.count() - self.component.rigid.n_massless;
        let has_none = n_missing == n_rigid;
        (n_rigid > 0 && self.completed.ends[0] <= 0.0).then(|| Check {
            id: "C-04",
            name: "rigid-body modes are there",
            equation: "rigid-body modes of the model that the result has not",
            value: n_missing as f64,
            limits: Limits::default(),
            fail_above: if has_none { Check::NEVER } else { 0.0 },
            worst: Some(match (n_missing, has_none) {
                (0, _) => format!("all {n_rigid}"),
                (_, true) => format!("{n_rigid} motions in which the model is free: the result has none of them"),
                (n, false) => format!("{n} of {n_rigid} motions in which the model is free"),
            }),
        })
    }

    /// C-05.
    fn rigid_frequencies(&self) -> Option<Check> {
        let first = self.first_elastic()?;
        let is_rigid = |claim: &usize| self.judged.pairs[*claim].mode_hz == Some(0.0);
        let rigid: Vec<usize> = (0..self.claims.count()).filter(is_rigid).collect();
        let is_empty = rigid.is_empty();
        let stated = |claim: usize| self.claims.lambda.as_ref().map_or(self.measured.lambda[claim], |all| all[claim]);
        let (value, at) = worst(rigid.into_iter().map(|claim| (claim, stated(claim).abs() / first)));
        (!is_empty).then(|| Check {
            id: "C-05",
            name: "rigid-body modes have no frequency",
            equation: "max |λ| / λ of the first elastic mode",
            value,
            limits: Limits { engineering: 1e-6, ..Limits::default() },
            fail_above: NOT_RIGID,
            worst: at.map(|claim| self.name(claim)),
        })
    }

    /// C-06.
    fn modal_masses(&self) -> Check {
        let masses = &self.claims.modal_masses;
        let (low, high) = masses.iter().fold((f64::INFINITY, 0.0f64), |(low, high), m| (low.min(*m), high.max(*m)));
        let (value, _) = worst(masses.iter().map(|mass| (mass - 1.0).abs()).enumerate());
        let said = if value <= 1e-6 {
            "mass-normalised".to_owned()
        } else {
            format!("from {} to {}: not mass-normalised", quantity(low, 4), quantity(high, 4))
        };
        Check {
            id: "C-06",
            name: "modal masses are one",
            equation: "max |xᵀMx − 1|, shapes as they are in the file",
            value,
            limits: Limits::NONE,
            fail_above: f64::INFINITY,
            worst: Some(said),
        }
    }
}

//! The retained modes as eigenpairs of the full model: M-01, M-02, M-03, M-04, M-09.
//!
//! ```text
//! r = K x − λ M x    residual of a pair, measured here from the shapes, not taken from the eigensolver
//! D                  powers of two near 1/√K_ii, so that units of length and angle do not matter
//! ```

use std::borrow::Cow;

use faer::{Mat, MatRef};

use super::check::{Check, Limits, MAX_EXCUSE};
use super::evidence::Evidence;
use super::limits::UNKNOWN;
use super::repeated;
use super::residual::{AT_REST, Residuals, Rows, Worst};
use crate::dense::{self, NOISE_FACTOR};
use crate::eigen::{MassOrthogonality, ModeError, NOTICED_BAR, RESIDUAL_FLOOR, mass_orthogonality};
use crate::job::Boundary;
use crate::modes::Retained;
use crate::rigid::RigidEnergy;
use crate::sparse::Pencil;
use crate::sparse::panels;

/// Residual of a solve beyond which the free modes are computed by another factor ([`crate::modes`] says why).
const MAX_SOLVE_RESIDUAL: f64 = 1e-8;

/// The largest relative gap that rounding is taken to mix modes over: a bar that M-09 lets pass. Bars are measured on the shapes, which may
/// not excuse themselves.
const MOST_MIXED: f64 = NOTICED_BAR;

/// The residual that the eigensolver takes a pair at, a share of the largest θ.
const TAKEN_AT: f64 = RESIDUAL_FLOOR * f64::EPSILON;
/// Terms of a unit modal mass that nearly cancel: those of meshes are of the size of ten.
const CANCELS: f64 = 1e3;
/// What rounding of products with M explains of the residual of one row, at most: half of it is what it may be of a frequency.
const MOST_OF_PRODUCTS: f64 = 1e-6;

/// What was measured of all pairs.
pub(super) struct Pairs {
    /// M-01.
    backward: Worst,
    /// M-02.
    componentwise: Worst,
    /// max ‖D⁻¹x‖₂ / ‖D⁻¹x‖_∞: how far the norm of a mode exceeds its largest component.
    concentration: f64,
    /// max |x|ᵀ|M||x|: how large the terms are that a modal mass of one is summed from.
    inertia_terms: f64,
    /// M-04: the largest coupling and its pair.
    coupling: (f64, (usize, usize)),
}

/// K and M of the boundary the modes were computed under.
pub(super) fn pencil<'a>(evidence: &Evidence<'a>) -> Pencil<'a> {
    evidence.partition.pencil_under(evidence.retained.boundary)
}

/// The shapes of the retained modes at the dofs of that pencil.
fn shapes<'a>(evidence: &Evidence<'a>) -> Cow<'a, Mat<f64>> {
    let Retained { modes, boundary, .. } = evidence.retained;
    let rows = evidence.partition.rows_under(*boundary, modes.shapes.as_ref());
    rows.map_or(Cow::Borrowed(&modes.shapes), Cow::Owned)
}

impl Pairs {
    pub(super) fn of(evidence: &Evidence<'_>) -> Self {
        let rows = Rows::of(pencil(evidence));
        let modes = &evidence.retained.modes;
        let all = shapes(evidence);
        let mut found = Self {
            backward: Worst::none(),
            componentwise: Worst::none(),
            concentration: 1.0,
            inertia_terms: 1.0,
            coupling: (0.0, (0, 0)),
        };
        let runs = repeated::runs(&modes.lambda);
        // The memory needed in addition to the shapes is five such panels, or seven times the longest run.
        for panel in panels(modes.count()) {
            let (start, end) = (panel.start, panel.end);
            let shapes = all.as_ref().as_ref().get(.., panel.clone());
            let of_panel = rows.residuals(shapes, &modes.lambda[panel]);
            found.inertia_terms = found.inertia_terms.max(dense::worst(of_panel.inertia_terms.iter().copied()));
            let alone = (start..end).filter(|mode| !runs.iter().any(|run| run.contains(mode)));
            alone.for_each(|mode| found.take(&rows, (mode, modes.lambda[mode]), (shapes, mode - start), &of_panel));
            let energies = dense::gram(all.as_ref().as_ref().subcols(0, end), of_panel.forces.as_ref());
            found.couple(&energies, start, &modes.lambda);
        }
        for run in runs {
            let shapes = all.as_ref().as_ref().get(.., run.clone());
            let of_space = repeated::residuals(&rows, modes, run.clone(), shapes);
            run.enumerate().for_each(|(j, mode)| found.take(&rows, (mode, modes.lambda[mode]), (shapes, j), &of_space));
        }
        found
    }

    /// Takes in a mode with its λ, in a column of some shapes and of what they leave.
    fn take(
        &mut self,
        rows: &Rows<'_>,
        (mode, lambda): (usize, f64),
        (shapes, j): (MatRef<'_, f64>, usize),
        Residuals { residual, terms, .. }: &Residuals,
    ) {
        let (x, r) = (dense::column(shapes, j), dense::column(residual.as_ref(), j));
        self.backward.take(rows.norms.backward_error(lambda, x, r), mode, rows.norms.largest(r));
        let (error, at) = rows.componentwise(lambda, x, r, dense::column(terms.as_ref(), j));
        self.componentwise.take(error, mode, at);
        let largest = x.iter().zip(&rows.norms.scale).fold(0.0f64, |max, (x, d)| max.max((x / d).abs()));
        self.concentration = self.concentration.max(rows.norms.scaled_norm(x) / largest);
    }

    /// Takes in the columns of XᵀKX from `start` on.
    fn couple(&mut self, energies: &Mat<f64>, start: usize, lambda: &[f64]) {
        for j in 0..energies.ncols() {
            for i in 0..start + j {
                let coupling = energies[(i, j)].abs() / (lambda[i] * lambda[start + j]).abs().sqrt();
                if dense::worse(coupling, self.coupling.0) {
                    self.coupling = (coupling, (i, start + j));
                }
            }
        }
    }
}

/// The largest relative gap within a run of modes whose error bars meet: rounding mixes their shapes, and a mixture of two eigenvectors
/// leaves a residual of that share of λ. Modes of one λ are judged as their space ([`repeated`]). Digits that the data lack mix nothing, for
/// the eigensolver has the matrices as they are.
fn mixed_by_rounding(evidence: &Evidence<'_>) -> f64 {
    if evidence.partition.has_few_digits() {
        return 0.0;
    }
    let modes = &evidence.retained.modes;
    let reach = |j: usize| modes.errors[j].data_bar * modes.lambda[j];
    let (mut first, mut largest) = (0, 0.0f64);
    for j in 1..modes.count() {
        if modes.lambda[j] - modes.lambda[j - 1] > (reach(j) + reach(j - 1)).min(MOST_MIXED * modes.lambda[j]) {
            first = j;
        }
        largest = largest.max(1.0 - modes.lambda[first] / modes.lambda[j]);
    }
    largest.min(MOST_MIXED)
}

/// The force of rigid-body motion relative to its terms, as far as M-05 takes it for rounding of coordinates and entries.
fn force_of_rounding(evidence: &Evidence<'_>) -> f64 {
    let RigidEnergy { largest_residual, residual_rounding, .. } = evidence.rigid.energy;
    largest_residual.min(residual_rounding)
}

/// Limits of a residual, relative to the terms it is summed from: what the eigensolver and the data leave of it.
fn residual_limits(evidence: &Evidence<'_>) -> Limits {
    let digits = evidence.partition.precision.share();
    // The eigensolver takes a pair at a residual of 16 ε of the largest θ = 1/λ, which is this share of its own.
    let solver = (TAKEN_AT * evidence.retained.modes.spread()).max(mixed_by_rounding(evidence));
    // On a free component a load is balanced by the interface first and the rigid-body motion taken out afterwards.
    // That motion is up to 1/ratio times the elastic one, and K lets it pass only to the precision of its data and to that of its coordinates;
    // ten stands for the sum over the rigid-body modes. An interface that holds too badly is not used for this.
    let of_motion =
        |share: f64| (10.0 * share / evidence.rank.singular_ratio).min(MAX_SOLVE_RESIDUAL.max(10.0 * share));
    let is_free = match evidence.retained.boundary {
        Boundary::FreeInterface => true,
        Boundary::MixedInterface => evidence.n_zero() > 0,
        Boundary::FixedInterface => false,
    };
    let [of_digits, of_rounding] =
        if is_free { [digits, force_of_rounding(evidence)].map(of_motion) } else { [0.0; 2] };
    let solver = solver.max(of_rounding);
    if digits > f64::EPSILON {
        Limits { engineering: 0.0, arithmetic: solver, data: of_digits }
    } else {
        Limits { engineering: 0.0, arithmetic: solver.max(of_digits), data: 0.0 }
    }
}

/// What products with M leave of a residual, relative to the terms it is summed from. They are rounded to ε of terms that nearly cancel
/// where a large mass is far from the node that its motion is described at, and the eigensolver then takes a pair at that.
fn left_by_products(evidence: &Evidence<'_>, pairs: &Pairs) -> f64 {
    if pairs.inertia_terms < CANCELS { 0.0 } else { TAKEN_AT * pairs.inertia_terms * evidence.retained.modes.spread() }
}

/// M-01.
pub(super) fn backward_error(evidence: &Evidence<'_>, pairs: &Pairs) -> Check {
    const FAIL: f64 = 1e-10;
    let limits = Limits { engineering: 1e-13, ..residual_limits(evidence) };
    let limits = limits.capped(FAIL.max(mixed_by_rounding(evidence)), MAX_EXCUSE);
    Check {
        id: "M-01",
        name: "modes satisfy the full model",
        equation: "max ‖Kx − λMx‖ / ((‖K‖ + λ‖M‖) ‖x‖), equilibrated",
        value: pairs.backward.value,
        limits,
        fail_above: limits.value().max(FAIL),
        worst: pairs.backward.name_under(evidence, "mode"),
    }
}

/// M-02.
pub(super) fn componentwise_error(evidence: &Evidence<'_>, pairs: &Pairs) -> Check {
    const FAIL: f64 = 1e-8;
    // What may be left is a share of the norm of the whole mode, and all of it may be in one row, which is measured by the
    // largest component. It weighs more still against the smallest terms that a row is judged by.
    let (of_norm, in_one_row) = (residual_limits(evidence), pairs.concentration / AT_REST);
    let limits =
        Limits { engineering: 1e-11, arithmetic: of_norm.arithmetic * in_one_row, data: of_norm.data * in_one_row };
    let limits = limits.capped(FAIL.max(mixed_by_rounding(evidence) * in_one_row).min(MOST_MIXED), MAX_EXCUSE);
    // What products with M explain is a warning, as it is of M-03.
    let explained = (left_by_products(evidence, pairs) * in_one_row).min(MOST_OF_PRODUCTS);
    Check {
        id: "M-02",
        name: "modes satisfy every row of the full model",
        equation: "max |Kx − λMx|_i / ((|K| + λ|M|)|x|)_i; rows at rest against their own norm",
        value: pairs.componentwise.value,
        limits,
        fail_above: limits.value().max(FAIL).max(explained),
        worst: pairs.componentwise.name_under(evidence, "mode"),
    }
}

/// M-03.
pub(super) fn orthogonality(evidence: &Evidence<'_>) -> Check {
    const FAIL: f64 = 1e-9;
    let shapes = shapes(evidence);
    let shapes = shapes.as_ref().as_ref();
    let (joined, n_r) = match evidence.rigid.under(evidence.retained.boundary) {
        None => (None, 0),
        Some(rigid) => {
            // Motions without mass have no length in it.
            let rigid = rigid.massive();
            (Some(dense::side_by_side(rigid, shapes)), rigid.ncols())
        }
    };
    let all = joined.as_ref().map_or(shapes, Mat::as_ref);
    // These rigid-body modes are orthonormal combinations, not unit motions.
    let rigid_name = |i: usize| format!("orthonormal rigid-body mode {}", i + 1);
    let MassOrthogonality { error: value, pair: (a, b), largest_terms } =
        mass_orthogonality(pencil(evidence).mass, all);
    let name = |i: usize| if i < n_r { rigid_name(i) } else { format!("mode {}", i - n_r + 1) };
    // x_iᵀMx_j of n terms is rounded by ε times their sizes, at most √(m_i m_j) with m = |x|ᵀ|M||x|, and so it is by rounding of
    // the modes themselves. A mode that M nearly lets pass has m ≫ 1, as one has that moves a mass of 10⁷ times the component only in
    // coordinates. What that explains is a warning up to a millionth of a modal mass, half of which is what it is of a frequency.
    let limits = Limits { engineering: 1e-12, arithmetic: NOISE_FACTOR * f64::EPSILON * largest_terms, data: 0.0 };
    let explained = limits.capped(1e-6, 0.0).value();
    Check {
        id: "M-03",
        name: "modes are orthonormal in the mass",
        equation: "max |XᵀMX − I|, rigid-body modes included",
        value,
        limits: limits.capped(FAIL, 0.0),
        fail_above: explained.max(FAIL),
        worst: (value > 0.0).then(|| if a == b { name(a) } else { format!("{} and {}", name(a), name(b)) }),
    }
}

/// M-04.
pub(super) fn stiffness_orthogonality(evidence: &Evidence<'_>, pairs: &Pairs) -> Check {
    const FAIL: f64 = 1e-7;
    let (value, (a, b)) = pairs.coupling;
    let cancellation = evidence.retained.modes.largest_cancellation();
    // Rounding of x_iᵀKx_j is that of its terms, √(c_i c_j) times the energies; added to it is the rest of
    // x_iᵀMx_j, a few ε, times √(λ_j / λ_i).
    let arithmetic = NOISE_FACTOR * f64::EPSILON * cancellation.max(evidence.retained.modes.spread().sqrt());
    // Rigid-body motion that K does not quite let pass is strain energy of the modes, and relative to it that much larger.
    let data = residual_limits(evidence).data * cancellation;
    let limits = Limits { engineering: 1e-10, arithmetic, data };
    // A thousandth is what measured modes are accepted with. What the digits explain beyond it is a warning in addition to M-09,
    // up to a hundredth.
    let explained = limits.capped(1e-3, MAX_EXCUSE).value();
    let limits = limits.capped(1e-3, 1e-3);
    Check {
        id: "M-04",
        name: "modes are orthogonal in the stiffness",
        equation: "max |x_iᵀKx_j| / √(λ_i λ_j), i ≠ j",
        value,
        limits,
        fail_above: explained.max(FAIL),
        worst: (value > 0.0).then(|| format!("modes {} and {}", a + 1, b + 1)),
    }
}

/// What few digits of K leave of the backward error of a mode in the reduced model: what they leave of it in the full one, and what M-04
/// has measured that they leave of x_iᵀKx_j, which the row of one mode in the residual of another is. Up to √k modes add to it.
pub(super) fn left_by_digits(evidence: &Evidence<'_>, coupling: &Check) -> f64 {
    if evidence.partition.precision.share() <= f64::EPSILON {
        return 0.0;
    }
    let n_modes = evidence.retained.modes.count() as f64;
    let of_pairs = n_modes.sqrt() * coupling.value.min(coupling.fail_above);
    residual_limits(evidence).data.max(NOISE_FACTOR * of_pairs)
}

/// M-09.
pub(super) fn data_precision(evidence: &Evidence<'_>) -> Check {
    // The bar of a frequency is half that of its square.
    let (value, worst) = largest(evidence, |error| 0.5 * error.data_bar);
    Check {
        id: "M-09",
        name: "digits of the data suffice",
        equation: "max ½ (|xᵀEx| + ε_M λ|x|ᵀ|M||x|) / λ, E roundings of K: relative error bar of a frequency",
        value,
        limits: Limits { engineering: NOTICED_BAR, ..Limits::default() },
        fail_above: UNKNOWN,
        worst,
    }
}

fn largest(evidence: &Evidence<'_>, measure: impl Fn(&ModeError) -> f64) -> (f64, Option<String>) {
    let errors = evidence.retained.modes.errors.iter().map(measure).enumerate();
    let worst = errors.fold(None, |worst: Option<(usize, f64)>, (mode, value)| match worst {
        Some((_, largest)) if !crate::dense::worse(value, largest) => worst,
        _ => Some((mode, value)),
    });
    worst.map_or((0.0, None), |(mode, value)| (value, Some(format!("mode {}", mode + 1))))
}

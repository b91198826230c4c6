//! Rigid-body motion of the full model against Û and M_F: M-05, M-16.

use faer::linalg::solvers::SolveLstsq;
use faer::{Mat, MatRef};

use super::full::Full;
use super::scaled::Scaled;
use crate::audit::mass::is_of_a_body;
use crate::dense::{self, NOISE_FACTOR};
use crate::eigen::NO_MASS;
use crate::rigid::{RigidBodyModes, RigidSource};
use crate::sparse::energies_of_terms;
use crate::sparse::product_and_terms;
use crate::sparse::{absolute_energy, diagonal};
use crate::verification::check::{Check, Limits};
use crate::verification::force;
use crate::verification::limits::LARGEST_EXCUSE;
use crate::verification::mass_difference;

/// The most that roundings of K excuse of its zero modes: one that may be any other motion is compared with nothing, and the file's are
/// held to the coordinates instead.
const LARGEST_TURN: f64 = 1.0;
/// Relative difference of numbers that both are made of the same coordinates by a few multiplications.
const SAME_COORDINATES: f64 = 1e-14;

/// What the full model says of its rigid-body motion.
pub(super) struct KnownMotions {
    /// Zero modes of K, by inverse iteration, and those that have no mass either.
    pub(super) n_zero: usize,
    /// How many of them, the last, have no mass.
    n_massless: usize,
    /// The first elastic eigenvalue.
    first: f64,
    /// Q_B of the zero modes, n_B × n_r.
    zero: Mat<f64>,
    /// X_B of the first elastic modes of unit modal mass, n_B × k.
    elastic: Mat<f64>,
    /// The unit motions, where the file's are those.
    unit: Option<UnitMotions>,
    meaning: Meaning,
    /// The motions that inertia relief answers.
    relieved: Relieved,
    /// Whether they move one mass with one centre.
    is_of_a_body: bool,
    /// Whether the interface tells them apart.
    pub(super) sight: Sight,
    /// Rounding of K relative to the first elastic eigenvalue: what a displacement may be off by.
    rounding: f64,
    /// What rounding of products with M turns a zero mode towards an elastic one by: ε |q|ᵀ|M||q|, as far as (K − σM)⁻¹ lets it pass.
    of_products: f64,
    /// Limits of what zero modes of K differ by from the motions of the coordinates: roundings turn them towards elastic ones.
    of_zero_modes: Limits,
}

/// Whether an interface tells rigid-body motions apart.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Sight {
    /// At rest it leaves none of them free.
    Whole,
    /// At rest it leaves some of them free.
    Part,
}

/// The motions that inertia relief answers.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Relieved {
    /// Those that the reduction starts from.
    Given,
    /// Zero modes, of which those of the file are combinations.
    Zero,
}

/// What the rigid-body modes of a file are known by.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Meaning {
    /// They are the unit motions of its nodes, and it has to say so.
    Unit,
    /// Nearly: mass and the directions of gravity are known.
    Classical,
    /// They span the motions without energy.
    Zero,
}

struct UnitMotions {
    /// U_B, n_B × n_r.
    interface: Mat<f64>,
    /// UᵀMU.
    mass: Mat<f64>,
    /// |U|ᵀ|M||U|, of which the mass is rounded by ε.
    terms: Vec<f64>,
}

impl KnownMotions {
    /// `given` are the motions that the reduction starts from.
    pub(super) fn of(full: &Full<'_>, given: &RigidBodyModes) -> Self {
        let partition = full.partition;
        let (n_i, n_b) = (partition.n_internal, partition.n_interface());
        let n_zero = full.zero.count();
        let (k, m) = (diagonal(&partition.stiffness), diagonal(&partition.mass));
        let ratios = k.iter().zip(&m).filter(|(_, m)| **m > 0.0).map(|(k, m)| k / m);
        let condition = ratios.fold(1.0, f64::max) / full.first;
        let rounding = (NOISE_FACTOR * f64::EPSILON * condition).min(LARGEST_EXCUSE);
        let turn = (NOISE_FACTOR * full.noise).min(LARGEST_TURN);
        let are_all = given.count() == n_zero && given.n_mechanisms == 0;
        let is_geometric = are_all && given.source == RigidSource::Geometric;
        let unit = is_geometric.then(|| {
            let modes = given.modes.as_ref();
            let (momenta, terms) = product_and_terms(&partition.mass, modes);
            UnitMotions {
                interface: modes.subrows(n_i, n_b).to_owned(),
                mass: dense::gram(modes, momenta.as_ref()),
                terms: energies_of_terms(modes, terms.as_ref()),
            }
        });
        Self {
            n_zero,
            n_massless: full.zero.n_massless,
            first: full.first,
            zero: full.zero.orthonormal.as_ref().subrows(n_i, n_b).to_owned(),
            elastic: full.elastic.as_ref().subrows(n_i, n_b).to_owned(),
            unit,
            meaning: match (given.count() == n_zero && given.are_unit_motions(partition), given.is_classical) {
                (true, _) => Meaning::Unit,
                (false, true) => Meaning::Classical,
                (false, false) => Meaning::Zero,
            },
            relieved: match is_geometric || are_all && given.is_classical {
                true => Relieved::Given,
                false => Relieved::Zero,
            },
            is_of_a_body: given.is_classical && is_of_a_body(given.rigid_body_mass(&partition.mass).as_ref()),
            sight: Sight::Whole,
            rounding,
            of_products: NOISE_FACTOR * f64::EPSILON * mass_terms(full) * full.sigma.abs() / (full.first - full.sigma),
            of_zero_modes: match partition.has_few_digits() {
                true => Limits { engineering: 1e-9, arithmetic: rounding, data: turn },
                false => Limits { engineering: 1e-9, arithmetic: rounding.max(turn), data: 0.0 },
            },
        }
    }

    /// Of an interface that leaves some of them free. Where coordinates tell fewer of them the reduction takes all from the matrices, which know
    /// neither mass nor directions of gravity.
    pub(super) fn seen_in_part(self, n_of_coordinates: usize) -> Self {
        let seen = Self { sight: Sight::Part, ..self };
        let are_known = n_of_coordinates >= seen.n_zero;
        if are_known { seen } else { Self { meaning: Meaning::Zero, is_of_a_body: false, ..seen } }
    }

    /// Whether the file has to say that its rigid-body modes are the six unit motions.
    pub(super) fn is_geometric(&self) -> bool {
        self.meaning == Meaning::Unit
    }

    /// Whether mass and the directions of gravity are known: one free body with coordinates.
    pub(super) fn is_classical(&self) -> bool {
        self.meaning != Meaning::Zero
    }

    /// Whether the file has mass properties to state.
    pub(super) fn is_of_a_body(&self) -> bool {
        self.is_of_a_body
    }

    /// Whether inertia relief answers the unit motions, whatever they are called.
    pub(super) fn has_unit(&self) -> bool {
        self.unit.is_some()
    }

    /// Whether it answers the motions that the reduction starts from: those of the coordinates, or these as far as zero modes mend them.
    pub(super) fn is_relief_of_given(&self) -> bool {
        self.relieved == Relieved::Given
    }

    /// What rounding of K may move a displacement by, relatively.
    pub(super) fn rounding(&self) -> f64 {
        self.rounding
    }

    /// M-05: how many motions of the full model are free.
    pub(super) fn count(&self, file: &Scaled) -> Check {
        let stored = file.u.ncols();
        Check {
            id: "M-05",
            name: "full model has as many free motions",
            equation: "|zero modes of K − n_r|, by inverse iteration",
            value: stored.abs_diff(self.n_zero) as f64,
            limits: Limits::default(),
            fail_above: 0.0,
            worst: Some(format!("{} in the model, {stored} in the file", self.n_zero)),
        }
    }

    /// Motions of the file from the zero modes, A with Û_B = Q_B A, n_r × n_r; and what is left over.
    pub(super) fn combination(&self, file: &Scaled) -> (Mat<f64>, f64) {
        let [q, u] = [self.zero.as_ref(), file.u.as_ref().subrows(0, file.n_b)].map(|a| self.by_inertia(file, a));
        let combination = q.qr().solve_lstsq(&u);
        let mut left = u.clone();
        dense::add_product(left.as_mut(), -1.0, q.as_ref(), combination.as_ref());
        let ratio = |j: usize| dense::norm(dense::column(left.as_ref(), j)) / dense::norm(dense::column(u.as_ref(), j));
        (combination, dense::worst((0..u.ncols()).map(ratio)))
    }

    /// Rows of the interface weighted by inertia, so that translations and rotations count alike. Where a motion has none the stiffness, over
    /// the first elastic eigenvalue, stands next to it, or what stands for that in forces of such a motion: rows of that motion alone would
    /// count for nothing.
    fn by_inertia(&self, file: &Scaled, a: MatRef<'_, f64>) -> Mat<f64> {
        let parts = (file.k.as_ref(), file.m.as_ref(), file.u.as_ref());
        let squares: Vec<f64> = match self.n_massless {
            0 => dense::diagonal(file.m.as_ref()),
            _ => force::sizes(parts, self.first, &file.directions).iter().map(|size| size / self.first).collect(),
        };
        Mat::from_fn(a.nrows(), a.ncols(), |i, j| squares[i].max(0.0).sqrt() * a[(i, j)])
    }

    /// What a zero mode that is turned by a unit angle towards an elastic one is off by, seen from the interface: max ‖Q_B⁺X_B‖. Next to a
    /// heavy mass a zero mode hardly moves, and an elastic one does.
    fn swing(&self, file: &Scaled) -> f64 {
        let [q, x] = [&self.zero, &self.elastic].map(|a| self.by_inertia(file, a.as_ref()));
        let seen = q.qr().solve_lstsq(&x);
        (0..seen.ncols()).map(|j| dense::norm(dense::column(seen.as_ref(), j))).fold(1.0, f64::max)
    }

    /// By how much more than zero modes elastic ones move the interface, beyond what looks like zero modes there: what M-05 sees of a turn of a
    /// zero mode by a unit angle. Soft rotations of interface nodes of their own are more than motions of the whole.
    fn in_view(&self, file: &Scaled) -> f64 {
        let [q, x] = [&self.zero, &self.elastic].map(|a| self.by_inertia(file, a.as_ref()));
        let mut left = x.clone();
        dense::add_product(left.as_mut(), -1.0, q.as_ref(), q.qr().solve_lstsq(&x).as_ref());
        let length = |a: &Mat<f64>, j: usize| dense::norm(dense::column(a.as_ref(), j));
        let least = (0..q.ncols()).map(|j| length(&q, j)).fold(f64::INFINITY, f64::min);
        (0..left.ncols()).map(|j| length(&left, j) / least).filter(|ratio| ratio.is_finite()).fold(1.0, f64::max)
    }

    /// M-05: Û moves the interface as zero modes of the full model do, and as the coordinates say; M-16: and has their inertia.
    pub(super) fn checks(&self, file: &Scaled) -> Vec<Check> {
        let mut checks: Vec<Check> = self.unit.iter().flat_map(|unit| unit.checks(file)).collect();
        if self.n_zero == 0 || file.n_b == 0 || self.sight == Sight::Part {
            return checks;
        }
        let (combination, left) = self.combination(file);
        let turned = self.of_zero_modes;
        let view = self.in_view(file);
        let limits = Limits { data: turned.data * view, arithmetic: turned.arithmetic * view, ..turned };
        let limits = limits.capped(LARGEST_TURN, LARGEST_TURN);
        checks.push(Check {
            id: "M-05",
            name: "rigid-body modes are free in the full model",
            equation: "max ‖Û_B − Q_B A‖ / ‖Û_B‖, Q by inverse iteration",
            value: left,
            limits,
            fail_above: limits.value().max(1e-6),
            worst: None,
        });
        if !file.has_mass {
            return checks;
        }
        let massive = combination.as_ref().subrows(0, self.n_zero - self.n_massless);
        let inertia = dense::gram(massive, massive);
        let (value, worst) = difference(&file.m_f, &inertia);
        let swing = self.swing(file);
        let arithmetic = turned.arithmetic.max(self.of_products) * swing;
        let limits = Limits { arithmetic, data: turned.data * swing, ..turned };
        let limits = limits.capped(LARGEST_TURN, LARGEST_TURN);
        checks.push(Check {
            id: "M-16",
            name: "rigid-body mass is that of the zero modes",
            equation: "max |M_F − AᵀQᵀMQA|_ij / √(ii jj)",
            value,
            limits,
            fail_above: limits.value().max(1e-6),
            worst,
        });
        checks
    }
}

/// The largest |q|ᵀ|M||q| of the zero modes, which have unit mass.
fn mass_terms(full: &Full<'_>) -> f64 {
    absolute_energy(&full.partition.mass, full.zero.orthonormal.as_ref()).into_iter().fold(1.0, f64::max)
}

impl UnitMotions {
    fn checks(&self, file: &Scaled) -> Vec<Check> {
        let mut worst = (0.0, None);
        for j in 0..self.interface.ncols() {
            let expected = dense::column(self.interface.as_ref(), j);
            let largest = expected.iter().fold(1.0f64, |max, value| max.max(value.abs()));
            for (i, value) in expected.iter().enumerate() {
                let error = (file.u[(i, j)] - value).abs() / largest;
                if dense::worse(error, worst.0) {
                    worst = (error, Some(format!("rigid-body mode {}, interface dof {}", j + 1, i + 1)));
                }
            }
        }
        let of_coordinates = Check {
            id: "M-05",
            name: "rigid-body modes are unit motions of the job's nodes",
            equation: "max |Û_B − U_B|, relative to the largest displacement",
            value: worst.0,
            limits: Limits { engineering: SAME_COORDINATES, ..Limits::default() },
            fail_above: 10.0 * SAME_COORDINATES,
            worst: worst.1,
        };
        if !file.has_mass {
            return vec![of_coordinates];
        }
        let (value, worst) = difference(&file.m_f, &self.mass);
        let least = NO_MASS * (0..self.terms.len()).fold(0.0f64, |max, j| max.max(self.mass[(j, j)]));
        let with_mass = (0..self.terms.len()).filter(|j| self.mass[(*j, *j)] > least);
        let terms = with_mass.map(|j| self.terms[j] / self.mass[(j, j)]).fold(1.0, f64::max);
        let limits = Limits { engineering: 1e-13, arithmetic: NOISE_FACTOR * f64::EPSILON * terms, data: 0.0 };
        let inertia = Check {
            id: "M-16",
            name: "rigid-body mass is that of the full model",
            equation: "max |M_F − UᵀMU|_ij / √(ii jj), U unit motions",
            value,
            limits,
            fail_above: 10.0 * limits.value(),
            worst,
        };
        vec![of_coordinates, inertia]
    }
}

/// max |A − B|_ij / √(B_ii B_jj), and where.
fn difference(found: &Mat<f64>, expected: &Mat<f64>) -> (f64, Option<String>) {
    let (value, (i, j)) = mass_difference(found.as_ref(), expected.as_ref());
    (value, (value > 0.0).then(|| format!("rigid-body modes {} and {}", i + 1, j + 1)))
}

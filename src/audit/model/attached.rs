//! Rubin's static modes of a component whose interface leaves rigid-body motions free, made again: A_I A_B⁻¹ (41), and what they leave of
//! rigid-body modes, elastic modes and answers to loads.
//!
//! ```text
//! A     n' × n_B          answers to unit loads at the interface, by conjugate gradients with the factor of K − σM of all dofs
//! Z     n' × p            [A_I A_B⁻¹ P; P]
//! N     n_I × n_N         V_I − Ψ_R V_B of the rigid-body modes, the elastic modes and the answers to loads
//! g     ± ε (|K||x| + |f|)   signs at random: roundings of an answer x, which make e = K⁺g of it
//! ```

use faer::linalg::solvers::Solve;
use faer::{Mat, MatRef, Side};

use super::asked::AskedModes;
use super::columns::{Columns, Motions, Named};
use super::interior::Solved;
use super::solve_errors::Lengths;
use crate::dense;
use crate::eigen::{Factored, ModalProblem};
use crate::modes::answers;
use crate::partition::Partition;
use crate::random::SplitMix64;
use crate::rigid::{RigidBodyModes, RigidSource};
use crate::sparse::product_and_terms;

/// Seed of the signs.
const SEED: u64 = 0x0a77_ac4e;

/// Answers of the free component to loads, with what they may be off by.
pub(super) struct FreeAnswers {
    /// A, n' × n_B.
    units: Mat<f64>,
    /// Of the loads of the job, n' × n_l.
    of_loads: Mat<f64>,
    /// What the answers to unit loads, and those to the loads of the job, may be off by.
    errors: [Lengths; 2],
    /// What A_B may be off by, entry by entry.
    at_interface: Mat<f64>,
    /// The largest residual of a unit load relative to it.
    pub(super) residual: f64,
}

impl FreeAnswers {
    /// Answers by a factor of K − σM of all dofs; `rigid` are the motions that the reduction deflates.
    pub(super) fn of(partition: &Partition, operator: &Factored<'_>, rigid: &RigidBodyModes) -> Self {
        let (n_i, n_b) = (partition.n_internal, partition.n_interface());
        let problem = partition.free_problem().deflating(rigid.deflated());
        let unit = Mat::from_fn(partition.n_dofs(), n_b, |i, j| f64::from(u8::from(i == n_i + j)));
        let loads = dense::side_by_side(unit.as_ref(), partition.loads.vectors.as_ref());
        let x = answers(problem, operator, loads.as_ref());
        let (roundings, residual) = roundings(problem, &x, loads.as_ref());
        let e = answers(problem, operator, roundings.as_ref());
        let lengths = |e: MatRef<'_, f64>| Lengths::of(partition, e.subrows(0, n_i));
        let (of_units, of_loads) = e.as_ref().split_at_col(n_b);
        let at_interface = dense::absolute(of_units.subrows(n_i, n_b));
        let (units, answered) = x.as_ref().split_at_col(n_b);
        Self {
            units: units.to_owned(),
            of_loads: answered.to_owned(),
            errors: [lengths(of_units), lengths(of_loads)],
            at_interface,
            residual,
        }
    }
}

/// ± ε (|K||x| + |f|) of answers x to loads f, and the largest ‖f − Kx‖ / ‖f‖ of what both have in balance, in the scales of the dofs.
fn roundings(problem: ModalProblem<'_>, x: &Mat<f64>, loads: MatRef<'_, f64>) -> (Mat<f64>, f64) {
    let [q, mass_q] = problem.deflated;
    let mut balanced = loads.to_owned();
    dense::add_product(balanced.as_mut(), -1.0, mass_q, dense::gram(q, loads).as_ref());
    let (forces, mut terms) = product_and_terms(problem.stiffness, x.as_ref());
    let scale: Vec<f64> = problem.stiffness.diagonal().into_iter().map(dense::power_of_two_root).collect();
    let length = |column: &[f64]| dense::norm(&column.iter().zip(&scale).map(|(f, d)| f * d).collect::<Vec<f64>>());
    // What K leaves of motions without energy, by its digits, is no lack of a solve.
    let mut left = &balanced - &forces;
    let along = dense::gram(q, left.as_ref());
    dense::add_product(left.as_mut(), -1.0, mass_q, along.as_ref());
    let ratio = |j: usize| length(dense::column(left.as_ref(), j)) / length(dense::column(balanced.as_ref(), j));
    let residual = dense::worst((0..x.ncols()).map(ratio));
    terms += dense::absolute(balanced.as_ref());
    let mut signs = Mat::zeros(terms.nrows(), terms.ncols());
    SplitMix64::new(SEED).fill(signs.as_mut());
    (Mat::from_fn(terms.nrows(), terms.ncols(), |i, j| signs[(i, j)].signum() * f64::EPSILON * terms[(i, j)]), residual)
}

/// Ψ_R with what it may be off by.
struct StaticModes {
    /// A_I A_B⁻¹, n_I × n_B.
    modes: Mat<f64>,
    errors: Lengths,
}

impl StaticModes {
    /// None where A_B is not definite.
    fn of(partition: &Partition, free: &FreeAnswers) -> Option<Self> {
        let (n_i, n_b) = (partition.n_internal, partition.n_interface());
        let (internal, interface) = free.units.as_ref().split_at_row(n_i);
        let mut of_interface = interface.to_owned();
        dense::symmetrise(&mut of_interface);
        let (scaled, scale) = dense::unit_diagonal(of_interface.as_ref());
        let solved = scaled.llt(Side::Lower).ok()?.solve(&Mat::<f64>::identity(n_b, n_b));
        let inverse = Mat::from_fn(n_b, n_b, |i, j| solved[(i, j)] * scale[i] * scale[j]);
        let modes = dense::product(internal, inverse.as_ref());
        // (A + δA)(A_B + δA_B)⁻¹ = Ψ_R + δA A_B⁻¹ − Ψ_R δA_B A_B⁻¹.
        let mut errors = free.errors[0].summed(inverse.as_ref());
        let sizes = dense::absolute(inverse.as_ref());
        let of_inverse = dense::product(free.at_interface.as_ref(), sizes.as_ref());
        errors.add(&Lengths::of(partition, modes.as_ref()).summed(of_inverse.as_ref()));
        Some(Self { modes, errors })
    }
}

/// Columns and their errors, as they come.
struct Growing {
    shapes: Mat<f64>,
    energy: Vec<f64>,
    inertia: Vec<f64>,
    displacement: Vec<f64>,
    named: Vec<Named>,
}

impl Growing {
    /// Adds V_I − Ψ_R V_B of motions V with errors of their own.
    fn add(
        &mut self,
        statics: &StaticModes,
        motions: MatRef<'_, f64>,
        own: &Lengths,
        named: impl Iterator<Item = Named>,
    ) {
        let n_i = statics.modes.nrows();
        let (internal, interface) = motions.split_at_row(n_i);
        let mut left = Mat::zeros(motions.nrows(), motions.ncols());
        let mut inside = left.as_mut().subrows_mut(0, n_i);
        inside.copy_from(internal);
        dense::add_product(inside, -1.0, statics.modes.as_ref(), interface);
        let mut errors = statics.errors.summed(interface);
        errors.add(own);
        self.shapes = dense::side_by_side(self.shapes.as_ref(), left.as_ref());
        self.energy.extend(errors.energy);
        self.inertia.extend(errors.inertia);
        self.displacement.extend(errors.displacement);
        self.named.extend(named);
    }
}

impl Columns {
    /// W of a component whose interface leaves rigid-body motions free; none where A_B is not definite.
    pub(super) fn attached(
        partition: &Partition,
        free: &FreeAnswers,
        motions: Motions<'_>,
        (asked, probes): (&AskedModes, Mat<f64>),
    ) -> Option<Self> {
        let statics = StaticModes::of(partition, free)?;
        let with_interface = faer::concat![[dense::product(statics.modes.as_ref(), probes.as_ref())], [probes]];
        let of_probes = statics.errors.summed(probes.as_ref());
        let mut growing = Growing {
            shapes: with_interface,
            energy: of_probes.energy,
            inertia: of_probes.inertia,
            displacement: of_probes.displacement,
            named: Vec::new(),
        };
        let shapes = asked.modes.shapes.as_ref();
        let first = asked.lambda().first().copied().unwrap_or(1.0);
        // Zero modes of K are turned towards elastic ones by its rounding; motions by the coordinates are not.
        let turn = if motions.source == RigidSource::Geometric { f64::EPSILON } else { motions.carried.energy.angle };
        let rigid: Vec<[f64; 2]> = vec![[turn, first]; motions.relieved.ncols()];
        let elastic = (0..asked.modes.count()).map(|mode| [asked.angles[mode], asked.lambda()[mode]]);
        let elastic: Vec<[f64; 2]> = elastic.collect();
        let own = of_turns(&statics, motions.relieved, &rigid, |_| 0.0);
        growing.add(&statics, motions.relieved, &own, (0..).map(Named::Rigid).take(rigid.len()));
        let own = of_turns(&statics, shapes, &elastic, |mode| asked.width(mode));
        growing.add(&statics, shapes, &own, (0..).map(Named::Mode).take(elastic.len()));
        let loads = partition.loads.facts.iter().enumerate().filter(|(_, load)| load.has_residual_vector);
        let asked_for: Vec<usize> = loads.map(|(load, _)| load).collect();
        let answers = dense::columns(free.of_loads.as_ref(), &asked_for);
        let pick = |sizes: &Vec<f64>| asked_for.iter().map(|load| sizes[*load]).collect();
        let of_loads = &free.errors[1];
        let own = Lengths {
            energy: pick(&of_loads.energy),
            inertia: pick(&of_loads.inertia),
            displacement: pick(&of_loads.displacement),
        };
        growing.add(&statics, answers.as_ref(), &own, asked_for.iter().copied().map(Named::Residual));
        Some(Self {
            shapes: growing.shapes,
            probes,
            named: growing.named,
            energy_errors: growing.energy,
            inertia_errors: growing.inertia,
            displacement_errors: growing.displacement,
            solved: Solved { residual: free.residual, rounding: 0.0 },
            load_norms: None,
        })
    }
}

/// What a turn of motions by small angles, towards others of their size at the interface, makes of their columns: each has its angle and
/// its λ, and `width` is how far its energy may change besides.
fn of_turns(
    statics: &StaticModes,
    motions: MatRef<'_, f64>,
    turns: &[[f64; 2]],
    width: impl Fn(usize) -> f64,
) -> Lengths {
    let n_i = statics.modes.nrows();
    let interface = motions.subrows(n_i, motions.nrows() - n_i);
    let followed = |j: usize| {
        let column = dense::product(statics.modes.as_ref(), interface.subcols(j, 1));
        dense::norm(dense::column(column.as_ref(), 0)) / dense::norm(dense::column(motions, j)).max(f64::MIN_POSITIVE)
    };
    let (mut energy, mut inertia) = (Vec::new(), Vec::new());
    for (j, [angle, lambda]) in turns.iter().enumerate() {
        let amplified = angle * (1.0 + followed(j));
        energy.push((amplified + width(j)) * lambda.sqrt());
        inertia.push(amplified);
    }
    Lengths { energy, inertia, displacement: vec![0.0; turns.len()] }
}

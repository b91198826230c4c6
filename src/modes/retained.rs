//! The modes a method retains: the one place where the reduction method is told apart.

use faer::Mat;

use super::random::SplitMix64;
use super::{
    Boundary, Equilibrated, Factored, FreeAtZero, ModalProblem, ModeRequest, Modes, SEED, ShiftInvert, Wanted,
    elastic_modes, shifted,
};
use crate::basis::{
    ConstraintModes, DynamicColumns, fixed_interface_columns, modal_columns, mode_acceleration_columns,
};
use crate::dense;
use crate::error::Result;
use crate::factor::{Analysis, Cholesky, Pencil};
use crate::job::{Method, ModeSelection, ReductionJob};
use crate::partition::Partition;
use crate::rigid::RigidBodyModes;
use crate::sparse::SparseMatrix;
use crate::sparse::product;

/// What the modes are computed from.
#[derive(Clone, Copy, Debug)]
pub struct Component<'a> {
    /// The matrices in their order.
    pub partition: &'a Partition,
    /// K_II and M_II.
    pub internal: (&'a SparseMatrix, &'a SparseMatrix),
    /// The factor of K_II.
    pub factor: &'a Cholesky<'a>,
    /// The rigid-body modes.
    pub rigid: &'a RigidBodyModes,
    /// The constraint modes.
    pub constraint: &'a ConstraintModes,
}

/// The modes a method retains, and the columns of Ψ_D that they make.
#[derive(Clone, Debug)]
pub struct Retained {
    /// The elastic modes.
    pub modes: Modes,
    /// The boundary they were computed under.
    pub boundary: Boundary,
    /// The columns of Ψ_D.
    pub columns: DynamicColumns,
    /// Factorisations beside that of K_II.
    pub n_factorisations: usize,
}

/// Relative residual of K x = f up to which the factor of K_II serves the free component. Healthy interfaces give 10⁻¹⁶ to
/// the precision of the data; at this limit half the digits of a mode would be lost.
const HOLDS_UP: f64 = 1e-8;

/// Computes the modes that the job's method retains.
///
/// # Errors
/// The eigensolver does not converge; a mechanism.
pub fn retained(component: Component<'_>, job: &ReductionJob, seed: u64) -> Result<Retained> {
    let Component { partition, internal, factor, rigid, constraint } = component;
    let request = ModeRequest { wanted: wanted(job.modes, partition), eigensolver: job.eigensolver, seed };
    if partition.n_interface() == 0 && rigid.count() > 0 {
        // Nothing holds the component and nothing is to be condensed: its own modes are the model (S-23).
        let (modes, n_factorisations) = by_shift(partition, free_problem(component), request)?;
        let columns = modal_columns(rigid, &modes);
        return Ok(Retained { modes, boundary: Boundary::FreeInterface, columns, n_factorisations });
    }
    match job.method {
        Method::CraigBampton => {
            let problem =
                ModalProblem { stiffness: internal.0, mass: internal.1, rigid: None, precision: partition.precision };
            let modes = elastic_modes(problem, &Factored::new(factor, 0.0), request)?;
            Ok(Retained {
                columns: fixed_interface_columns(&modes),
                modes,
                boundary: Boundary::FixedInterface,
                n_factorisations: 0,
            })
        }
        Method::Herting => {
            let (modes, n_factorisations) = free_modes(component, free_problem(component), request)?;
            let columns = mode_acceleration_columns(partition, factor, constraint, rigid, &modes);
            Ok(Retained { modes, boundary: Boundary::FreeInterface, columns, n_factorisations })
        }
    }
}

/// The component with its interface free, rigid-body modes deflated.
fn free_problem<'a>(component: Component<'a>) -> ModalProblem<'a> {
    let Component { partition, rigid, .. } = component;
    let precision = partition.precision;
    ModalProblem { stiffness: &partition.stiffness, mass: &partition.mass, rigid: Some(rigid), precision }
}

/// Free-free modes by the factor of K_II where that holds up, by a factor of K − σM where it does not.
///
/// Returns the modes and the factorisations made.
fn free_modes(component: Component<'_>, problem: ModalProblem<'_>, request: ModeRequest) -> Result<(Modes, usize)> {
    let Component { partition, factor, rigid, constraint, .. } = component;
    let psi_s = constraint.modes.as_ref();
    let operator = FreeAtZero::new(factor, &partition.stiffness, psi_s, constraint.stiffness.as_ref(), rigid)?;
    if relative_residual(problem, &operator) <= HOLDS_UP {
        return Ok((elastic_modes(problem, &operator, request)?, 0));
    }
    by_shift(partition, problem, request)
}

/// The same modes by a factor of K − σM on all dofs.
fn by_shift(partition: &Partition, problem: ModalProblem<'_>, request: ModeRequest) -> Result<(Modes, usize)> {
    let analysis = Analysis::new(Pencil { stiffness: problem.stiffness, mass: problem.mass })?;
    let shifted = shifted(&analysis, problem, &|dof| partition.name_of(dof))?;
    let modes = elastic_modes(problem, &Factored::new(&shifted.factor, shifted.sigma), request)?;
    Ok((modes, shifted.n_factorisations))
}

/// How well an operator at shift zero solves K x = f for a self-equilibrated load: ‖Kx − f‖ / (‖K‖‖x‖ + ‖f‖), equilibrated.
fn relative_residual(problem: ModalProblem<'_>, operator: &dyn ShiftInvert) -> f64 {
    let nothing = Mat::zeros(operator.n(), 0);
    let (q, mass_q) = problem.rigid.map_or((nothing.as_ref(), nothing.as_ref()), |rigid| {
        (rigid.orthonormal.as_ref(), rigid.mass_orthonormal.as_ref())
    });
    let mut probe = Mat::zeros(operator.n(), 1);
    SplitMix64::new(SEED).fill(probe.as_mut());
    let mut load = product(problem.mass, probe.as_ref());
    let resultant = dense::gram(q, load.as_ref());
    dense::add_product(load.as_mut(), -1.0, mass_q, resultant.as_ref());
    let mut x = load.clone();
    operator.solve_in_place(x.as_mut());
    let motion = dense::gram(mass_q, x.as_ref());
    dense::add_product(x.as_mut(), -1.0, q, motion.as_ref());
    let force = product(problem.stiffness, x.as_ref());
    let norms = Equilibrated::of(problem.stiffness, problem.mass);
    let load = dense::column(load.as_ref(), 0);
    let residual: Vec<f64> = dense::column(force.as_ref(), 0).iter().zip(load).map(|(k, f)| k - f).collect();
    let of = |column: &[f64]| {
        let scaled: Vec<f64> = column.iter().zip(&norms.scale).map(|(a, d)| a * d).collect();
        dense::norm(&scaled)
    };
    of(&residual) / (norms.stiffness_norm * norms.scaled_norm(dense::column(x.as_ref(), 0)) + of(load))
}

fn wanted(selection: ModeSelection, partition: &Partition) -> Wanted {
    match selection {
        // No model has more modes than degrees of freedom.
        ModeSelection::Count { count } => Wanted::Count(count.min(partition.n_dofs())),
        ModeSelection::UpTo { up_to_hz } => {
            let omega = 2.0 * std::f64::consts::PI * up_to_hz;
            Wanted::UpTo(omega * omega / partition.scaling.eigenvalue_unit())
        }
    }
}

#[cfg(test)]
mod tests {
    use faer::MatMut;

    use super::*;
    use crate::input::{Input, MatrixInput};
    use crate::job::{Coupling, Eigensolver, InterfaceJob, NodeSelection, Origin};
    use crate::model::Model;
    use crate::rigid;
    use crate::sparse::{AssemblyNotes, Declared, Triplets};

    /// A free chain of springs with unit masses, held by its first and last row.
    fn chain(n: usize) -> Partition {
        let matrix = |entries: &[(usize, usize, f64)]| {
            let mut triplets = Triplets::default();
            entries.iter().for_each(|(row, col, value)| triplets.push(*row as u32, *col as u32, *value));
            let (matrix, _) = triplets.assemble(n, Declared::General, "chain".as_ref()).expect("sound");
            let (path, digest) = ("chain".into(), String::new());
            MatrixInput { matrix, notes: AssemblyNotes::default(), digits: 17, path, digest }
        };
        let mut k = Vec::new();
        for i in 0..n - 1 {
            k.extend([(i, i, 1.0), (i + 1, i + 1, 1.0), (i, i + 1, -1.0), (i + 1, i, -1.0)]);
        }
        let m: Vec<_> = (0..n).map(|i| (i, i, 1.0)).collect();
        let input = Input { stiffness: matrix(&k), mass: matrix(&m), dofs: None, nodes: None, notes: Vec::new() };
        let ends = InterfaceJob {
            name: "ends".into(),
            nodes: NodeSelection::Rows { rows: vec![0, n - 1] },
            coupling: Coupling::Direct,
            origin: Origin::Centroid,
            dofs: None,
        };
        Partition::new(&Model::new(input).expect("sound"), &[ends]).expect("sound")
    }

    /// An operator whose answers are off by a share.
    struct Off<'a>(&'a dyn ShiftInvert, f64);

    impl ShiftInvert for Off<'_> {
        fn n(&self) -> usize {
            self.0.n()
        }

        fn shift(&self) -> f64 {
            self.0.shift()
        }

        fn solve_in_place(&self, mut block: MatMut<'_, f64>) {
            self.0.solve_in_place(block.as_mut());
            block *= faer::Scale(1.0 + self.1);
        }
    }

    #[test]
    fn operator_that_does_not_hold_up_is_noticed_and_the_shift_gives_the_same_modes() {
        let partition = chain(60);
        let rigid = rigid::rigid_body_modes(&partition).expect("free").0;
        let (k, m) = (partition.internal_stiffness(), partition.internal_mass());
        let pencil = Pencil { stiffness: &k, mass: &m };
        let analysis = Analysis::new(pencil).expect("memory");
        let factor = Cholesky::new(&analysis, pencil, 0.0, &|dof| partition.name_of(dof)).expect("definite");
        let constraint = crate::basis::constraint_modes(&partition, &factor, &rigid);
        let schur = constraint.stiffness.as_ref();
        let operator =
            FreeAtZero::new(&factor, &partition.stiffness, constraint.modes.as_ref(), schur, &rigid).expect("no hinge");
        let problem = ModalProblem {
            stiffness: &partition.stiffness,
            mass: &partition.mass,
            rigid: Some(&rigid),
            precision: partition.precision,
        };
        // κ of the chain is 60² ≈ 4e3; the residual of a backward stable solve does not grow with it.
        assert!(relative_residual(problem, &operator) < 1e-14);
        // The share itself times ‖f‖ / (‖K‖‖x‖), which is above 1/κ.
        assert!(relative_residual(problem, &Off(&operator, 0.01)) > 1e-2 / 4e3);
        assert!(relative_residual(problem, &Off(&operator, 0.01)) > HOLDS_UP);
        let request = ModeRequest { wanted: Wanted::Count(6), eigensolver: Eigensolver::Lanczos, seed: SEED };
        let at_zero = elastic_modes(problem, &operator, request).expect("converges");
        let (by_shift, n_factorisations) = by_shift(&partition, problem, request).expect("converges");
        assert!(n_factorisations >= 1);
        for ((a, b), error) in at_zero.lambda.iter().zip(&by_shift.lambda).zip(&at_zero.errors) {
            // Both are Rayleigh quotients with the same bar of rounding.
            assert!((a / b - 1.0).abs() <= 4.0 * error.relative_bar, "{a} and {b}");
        }
    }
}

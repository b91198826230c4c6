//! The eigenproblem of a component under one boundary condition: its matrices, its operators and its counts.

use faer::{MatMut, MatRef};

use super::Component;
use crate::cache::recalled;
use crate::constraint::{FreeAtZero, FreeStatics, RefinedAtZero};
use crate::eigen::ElasticCount;
use crate::eigen::Interval;
use crate::eigen::relative_residual;
use crate::eigen::{CARRIES_NOTHING, Factored, ShiftInvert};
use crate::eigen::{ModalProblem, Shifted, shifted};
use crate::error::{Error, Result};
use crate::factor::{Analysis, InertiaCount, ShiftedFactor, count_below_freeing};
use crate::job::Boundary;
use crate::partition::Partition;
use crate::rigid::{RigidBodyModes, that_pass};
use crate::sparse::diagonal;

/// A component under one boundary condition.
#[derive(Clone, Copy, Debug)]
pub struct BoundaryProblem<'a> {
    /// What the modes are computed from.
    pub component: Component<'a>,
    /// The boundary condition.
    pub boundary: Boundary,
}

/// Relative residual of K x = f up to which the factor of K_II serves the free component. Healthy interfaces give 10⁻¹⁶ to
/// the precision of the data; at this limit half the digits of a mode would be lost.
pub(super) const MAX_RESIDUAL_OF_CLAMPED_FACTOR: f64 = 1e-8;

impl<'a> BoundaryProblem<'a> {
    /// K, M and the rigid-body modes of the dofs that are free to move.
    pub fn modal(&self) -> ModalProblem<'a> {
        let Component { partition, rigid, .. } = self.component;
        let problem = partition.problem_under(self.boundary);
        rigid.under(self.boundary).map_or(problem, |rigid| problem.deflating(rigid.deflated()))
    }

    /// Rigid-body modes under this boundary.
    pub fn n_rigid(&self) -> usize {
        self.modal().n_deflated()
    }

    /// Hands the operator at or below zero to `solve`: by the factor of K_II where that holds up, by a factor of K − σM where
    /// it does not; and says how many factorisations that took.
    ///
    /// # Errors
    /// A mechanism; a rigid-body motion without mass; those of [`shifted`]; those of `solve`.
    pub(super) fn with_lowest_operator<T>(
        &self,
        solve: impl FnOnce(&dyn ShiftInvert) -> Result<T>,
    ) -> Result<(T, usize)> {
        let Component { partition, factor, rigid, constraint, .. } = self.component;
        if self.boundary == Boundary::FixedInterface {
            return Ok((solve(&Factored::new(factor, 0.0))?, 0));
        }
        let problem = self.modal();
        self.refuse_massless()?;
        let Some(constraint) = constraint.filter(|_| !self.component.is_modal()) else {
            return self.with_operator_below(solve);
        };
        if let (Some(rigid), Some(free)) = (&rigid.passing, partition.free_under(self.boundary)) {
            let statics = FreeStatics::of(factor, problem.stiffness, (free, partition.n_interface()));
            return self.with_operator_at_zero((statics.operator(rigid), rigid), solve);
        }
        self.with_operator_at_zero((FreeAtZero::new(factor, &partition.stiffness, constraint, rigid), rigid), solve)
    }

    /// Hands an operator to `solve` whose matrix is definite: K where the component is held, otherwise K − σM with σ below the spectrum.
    ///
    /// # Errors
    /// The errors of [`shifted`] and those of `solve`.
    pub(crate) fn with_definite_operator<T>(&self, solve: impl FnOnce(&dyn ShiftInvert) -> Result<T>) -> Result<T> {
        match self.boundary {
            Boundary::FixedInterface => solve(&Factored::new(self.component.factor, 0.0)),
            Boundary::FreeInterface | Boundary::MixedInterface => {
                self.with_operator_below(solve).map(|(found, _)| found)
            }
        }
    }

    /// Hands an operator at zero to `solve` where it holds up, and one below zero where it does not.
    fn with_operator_at_zero<T>(
        &self,
        (operator, rigid): (Result<FreeAtZero<'_>>, &RigidBodyModes),
        solve: impl FnOnce(&dyn ShiftInvert) -> Result<T>,
    ) -> Result<(T, usize)> {
        let operator = match operator {
            // Few digits leave S no more definite than a mechanism does.
            Err(Error::Mechanism { .. }) if self.component.partition.has_few_digits() => {
                return self.with_operator_below(solve);
            }
            operator => operator?,
        };
        let residual = relative_residual(self.modal(), &operator);
        if residual <= MAX_RESIDUAL_OF_CLAMPED_FACTOR {
            // K of few digits makes forces of rigid-body motion, and so do roundings of penalties that tie dofs: modes of the operator
            // as it is would be those of another K by as much.
            if residual <= CARRIES_NOTHING {
                return Ok((solve(&operator)?, 0));
            }
            // They may be little next to all forces and not next to those of a motion as soft as a joint.
            if let Some(refined) = RefinedAtZero::new(&operator, rigid, self.modal().mass) {
                return Ok((solve(&refined)?, 0));
            }
        }
        self.with_operator_below(solve)
    }

    /// Hands an operator below zero to `solve`, by a factor of K − σM on the dofs that are free to move.
    ///
    /// # Errors
    /// The errors of [`shifted`] and those of `solve`.
    pub(super) fn with_operator_below<T>(
        &self,
        solve: impl FnOnce(&dyn ShiftInvert) -> Result<T>,
    ) -> Result<(T, usize)> {
        let partition = self.component.partition;
        by_shift((partition, self.boundary), self.modal(), |shifted| {
            solve(&Factored::new(&shifted.factor, shifted.sigma))
        })
    }

    /// Factors K − σM inside the spectrum.
    ///
    /// # Errors
    /// σ lies on an eigenvalue; a rigid-body motion of a free component has no mass; no memory for the factor.
    pub fn factor_at(&self, sigma: f64) -> Result<ShiftedFactor<'a>> {
        let Component { partition, analysis, .. } = self.component;
        self.refuse_massless()?;
        let factor = ShiftedFactor::freeing(analysis, partition.pencil(), sigma, partition.free_under(self.boundary))?;
        if self.is_off(factor.count) { Ok(factor) } else { Err(Error::SturmPivot) }
    }

    /// A motion without stiffness and mass makes K − σM singular at every σ.
    fn refuse_massless(&self) -> Result<()> {
        let Component { partition, rigid, .. } = self.component;
        match self.boundary {
            Boundary::FreeInterface => massive(partition, rigid.massless()),
            Boundary::FixedInterface => Ok(()),
            Boundary::MixedInterface => {
                let held = partition.held_under(self.boundary);
                massive(partition, that_pass(partition, rigid.massless(), &held)?.as_ref())
            }
        }
    }

    /// Whether a shift lies off the eigenvalues as far as the factor tells by itself.
    fn is_off(&self, count: InertiaCount) -> bool {
        match self.boundary {
            Boundary::FixedInterface => count.is_off_clamped(),
            Boundary::FreeInterface | Boundary::MixedInterface => count.is_off_clamped() && count.is_off_free(),
        }
    }

    /// Counts the elastic eigenvalues below a shift above zero.
    ///
    /// # Errors
    /// As [`Self::factor_at`].
    pub fn count_below(&self, sigma: f64) -> Result<ElasticCount> {
        match self.count_at(sigma)? {
            (count, true) => count,
            (_, false) => Err(Error::SturmPivot),
        }
    }

    /// Counts as [`Self::count_below`] does, wherever the shift lies, and says whether it lies off the eigenvalues as far as the
    /// factor tells by itself.
    ///
    /// # Errors
    /// A rigid-body motion of a free component has no mass; no memory for the count; σ hits an eigenvalue exactly.
    pub(super) fn count_at(&self, sigma: f64) -> Result<(Result<ElasticCount>, bool)> {
        self.refuse_massless()?;
        let Component { partition, analysis, .. } = self.component;
        let free = partition.free_under(self.boundary);
        let key = || partition.key_of_matrices("count").numbers(&[sigma]).shown(&free);
        let counted = || count_below_freeing(analysis, partition.pencil(), sigma, free);
        let count = recalled(partition.cache(), key, counted)?;
        Ok((self.elastic(count), self.is_off(count)))
    }

    /// Without the rigid-body modes: they lie below any shift above zero, and a count that says otherwise is wrong.
    fn elastic(&self, inertia: InertiaCount) -> Result<ElasticCount> {
        let (counted, found) = match self.boundary {
            Boundary::FreeInterface | Boundary::MixedInterface => (inertia.free, self.n_rigid()),
            Boundary::FixedInterface => (inertia.clamped, 0),
        };
        match counted.checked_sub(found) {
            Some(n_elastic) => Ok(ElasticCount { inertia, n_elastic }),
            None => {
                let below_hz = self.component.partition.scaling.hertz(inertia.sigma);
                Err(Error::ModesMissing { below_hz, found, counted })
            }
        }
    }

    /// Hands an operator with a shift inside an interval to `solve`, off the eigenvalues known so far and as near the middle
    /// as that allows.
    ///
    /// # Errors
    /// Every shift tried lies on an eigenvalue; those of `solve`.
    pub(super) fn with_operator_inside<T>(
        &self,
        interval: Interval,
        solve: impl FnOnce(&dyn ShiftInvert) -> Result<T>,
    ) -> Result<(T, usize)> {
        const PLACES: [f64; 5] = [0.5, 0.46, 0.54, 0.42, 0.58];
        let mut last = Err(Error::SturmPivot);
        for (attempt, place) in PLACES.into_iter().enumerate() {
            let sigma = interval.from + place * (interval.to - interval.from);
            last = self.factor_at(sigma);
            if let Ok(factor) = &last {
                let operator = AtShift { factor, boundary: self.boundary, n: self.modal().mass.rows() };
                return Ok((solve(&operator)?, attempt + 1));
            }
        }
        Err(last.err().unwrap_or(Error::SturmPivot))
    }
}

/// Refuses free modes where a rigid-body motion moves no mass: K − σM is singular along it at every σ, and any λ is an
/// eigenvalue.
pub(crate) fn massive(partition: &Partition, massless: MatRef<'_, f64>) -> Result<()> {
    if massless.ncols() == 0 {
        return Ok(());
    }
    let stiffness = diagonal(&partition.stiffness);
    let size = |i: &usize| massless[(*i, 0)].abs() * stiffness[*i].max(0.0).sqrt();
    let largest = (0..massless.nrows()).max_by(|a, b| size(a).total_cmp(&size(b))).unwrap_or(0);
    Err(Error::MasslessFreeMotion { dof: partition.name_of(largest) })
}

/// (K − σM)⁻¹ with σ inside the spectrum.
pub struct AtShift<'a> {
    /// The factor.
    pub factor: &'a ShiftedFactor<'a>,
    /// Whether the interface is held.
    pub boundary: Boundary,
    /// Order of the eigenproblem.
    pub n: usize,
}

impl ShiftInvert for AtShift<'_> {
    fn n(&self) -> usize {
        self.n
    }

    fn shift(&self) -> f64 {
        self.factor.count.sigma
    }

    fn solve_in_place(&self, block: MatMut<'_, f64>) {
        match self.boundary {
            Boundary::FixedInterface => self.factor.solve_held(block),
            Boundary::FreeInterface | Boundary::MixedInterface => self.factor.solve_free(block),
        }
    }

    fn bytes(&self) -> u64 {
        self.factor.bytes()
    }
}

/// Hands a factor of K − σM on all dofs to `solve`, with the number of factorisations made.
pub(super) fn by_shift<T>(
    (partition, boundary): (&Partition, Boundary),
    problem: ModalProblem<'_>,
    solve: impl FnOnce(&Shifted<'_>) -> Result<T>,
) -> Result<(T, usize)> {
    let analysis = Analysis::new(problem.pencil())?;
    let shifted = shifted(&analysis, problem, &|row| partition.name_of(partition.dof_under(boundary, row)))?;
    Ok((solve(&shifted)?, shifted.n_factorisations))
}

#[cfg(test)]
mod tests {
    use faer::MatMut;

    use super::*;
    use crate::eigen::{ModeRequest, Wanted, elastic_modes};
    use crate::factor::Cholesky;
    use crate::input::{Digits, Input, MatrixInput};
    use crate::job::{Coupling, Eigensolver, InterfaceJob, NodeSelection};
    use crate::model::Model;
    use crate::random::SEED;
    use crate::rigid;
    use crate::sparse::{AssemblyNotes, Declared, Triplets};

    /// A free chain of springs with unit masses, held by its first and last row.
    fn chain(n: usize) -> Partition {
        let matrix = |entries: &[(usize, usize, f64)]| {
            let mut triplets = Triplets::default();
            entries.iter().for_each(|(row, col, value)| triplets.push(*row as u32, *col as u32, *value));
            let (matrix, _) = triplets.assemble(n, Declared::General, "chain".as_ref()).expect("sound");
            let (path, digest) = ("chain".into(), String::new());
            MatrixInput { matrix, notes: AssemblyNotes::default(), digits: Digits::DOUBLE, path, layout: None, digest }
        };
        let mut k = Vec::new();
        for i in 0..n - 1 {
            k.extend([(i, i, 1.0), (i + 1, i + 1, 1.0), (i, i + 1, -1.0), (i + 1, i, -1.0)]);
        }
        let m: Vec<_> = (0..n).map(|i| (i, i, 1.0)).collect();
        let input = Input {
            stiffness: matrix(&k),
            mass: matrix(&m),
            dofs: None,
            labels: Default::default(),
            cells: Vec::new(),
            nodes: None,
            rows: Default::default(),
            constraints: None,
            internal_forces: None,
            turning: None,
            axes: None,
            digests: Default::default(),
            notes: Vec::new(),
        };
        let ends = InterfaceJob::new("ends", NodeSelection::Rows { rows: vec![0, n - 1] }, Coupling::Direct);
        Partition::new(Model::new(input).expect("sound"), &[ends]).expect("sound")
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
        let analysis = partition.analysis().expect("memory");
        let factor =
            Cholesky::new(&analysis, partition.pencil(), 0.0, &|dof| partition.name_of(dof)).expect("definite");
        let constraint = crate::constraint::constraint_modes(&partition, &factor, &rigid);
        let operator = FreeAtZero::new(&factor, &partition.stiffness, &constraint, &rigid).expect("no hinge");
        let problem = partition.free_problem().deflating(rigid.deflated());
        // κ of the chain is 60² ≈ 4e3; the residual of a backward stable solve does not grow with it.
        assert!(relative_residual(problem, &operator) < 1e-14);
        // The share itself times ‖f‖ / (‖K‖‖x‖), which is above 1/κ.
        assert!(relative_residual(problem, &Off(&operator, 0.01)) > 1e-2 / 4e3);
        assert!(relative_residual(problem, &Off(&operator, 0.01)) > MAX_RESIDUAL_OF_CLAMPED_FACTOR);
        let request = ModeRequest { wanted: Wanted::Count(6), eigensolver: Eigensolver::Lanczos, seed: SEED };
        let at_zero = elastic_modes(problem, &operator, request).expect("converges");
        let found = by_shift((&partition, Boundary::FreeInterface), problem, |shifted| {
            elastic_modes(problem, &Factored::new(&shifted.factor, shifted.sigma), request)
        });
        let (by_shift, n_factorisations) = found.expect("converges");
        assert!(n_factorisations >= 1);
        for ((a, b), error) in at_zero.lambda.iter().zip(&by_shift.lambda).zip(&at_zero.errors) {
            // Both are Rayleigh quotients with the same bar of rounding.
            assert!((a / b - 1.0).abs() <= 4.0 * error.relative_bar, "{a} and {b}");
        }
    }
}

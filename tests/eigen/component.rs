//! A generated model ready for an eigensolver, and the one check every answer has to pass.

use supel::dense;
use supel::eigen::{
    Factored, MassOrthogonality, ModalProblem, ModeRequest, Modes, Wanted, elastic_modes, mass_orthogonality, shifted,
};
use supel::factor::{Analysis, Cholesky};
use supel::job::{Eigensolver, InterfaceJob};
use supel::model::Model;
use supel::partition::Partition;
use supel::random::SEED;
use supel::rigid::{RigidBodyModes, from_coordinates};

use crate::chain;

/// A partition with its rigid-body modes and an answer for every request.
pub(crate) struct Component {
    pub(crate) partition: Partition,
    pub(crate) rigid: RigidBodyModes,
    analysis: Analysis,
}

impl Component {
    /// A model without interface; its rigid-body modes come from its coordinates.
    pub(crate) fn new(model: &supel_models::Model) -> Self {
        Self::of(partition(model, &[]))
    }

    pub(crate) fn of(partition: Partition) -> Self {
        let rigid = from_coordinates(&partition).expect("rigid-body modes").unwrap_or_else(|| none(&partition));
        let analysis = Analysis::new(partition.pencil()).expect("an analysis");
        Self { partition, rigid, analysis }
    }

    /// A factor of (rad/s)² from λ as the tool has it.
    pub(crate) fn unit(&self) -> f64 {
        self.partition.scaling.eigenvalue_unit()
    }

    /// Elastic modes, checked: at shift zero where the component is held, at a negative shift where it is free.
    pub(crate) fn modes(&self, wanted: Wanted, eigensolver: Eigensolver) -> Modes {
        let request = ModeRequest { wanted, eigensolver, seed: SEED };
        let (pencil, precision) = (self.partition.pencil(), self.partition.precision);
        let name = |step| self.partition.name_of(step);
        let modes = if self.rigid.count() == 0 {
            let problem = ModalProblem::of(pencil, precision);
            let factor = Cholesky::new(&self.analysis, pencil, 0.0, &name).expect("a factor");
            elastic_modes(problem, &Factored::new(&factor, 0.0), request)
        } else {
            let problem = ModalProblem::of(pencil, precision).deflating(self.rigid.deflated());
            let found = shifted(&self.analysis, problem, &name).expect("a shift");
            elastic_modes(problem, &Factored::new(&found.factor, found.sigma), request)
        };
        let modes = modes.unwrap_or_else(|error| panic!("{eigensolver:?}: {error}"));
        self.check(&modes);
        modes
    }

    /// The residual check of every eigenproblem: backward errors, orthogonality, order, and the next eigenvalue above.
    pub(crate) fn check(&self, modes: &Modes) {
        let mass = &self.partition.mass;
        // A pair is taken at a residual of 1e-13 θ, or of 16 ε times the largest θ; (K − σM) times it is that share of λ M x
        // and at most the same share of the norms the backward error is relative to. A solve adds a few ε per dof.
        let first = modes.lambda.first().copied().unwrap_or(1.0);
        for (j, (error, lambda)) in modes.errors.iter().zip(&modes.lambda).enumerate() {
            let taken_at = 1e-13 + 16.0 * f64::EPSILON * lambda / first;
            let bar = taken_at + mass.rows() as f64 * f64::EPSILON;
            assert!(error.backward <= bar, "mode {j}: backward error {:e} above {bar:e}", error.backward);
        }
        // Two passes of orthonormalisation leave a few ε for each of the k vectors.
        let MassOrthogonality { error: worst, pair, .. } = mass_orthogonality(mass, modes.shapes.as_ref());
        assert!(worst <= 1e-12, "modes {pair:?} are orthogonal to {worst:e} only");
        let rigid = dense::gram(self.rigid.mass_orthonormal.as_ref(), modes.shapes.as_ref());
        assert!(rigid.norm_max() <= 1e-12, "rigid-body motion in the modes: {:e}", rigid.norm_max());
        assert!(modes.lambda.is_sorted_by(|a, b| *a <= *b * (1.0 + 1e-9)), "{:?}", modes.lambda);
        if let (Some(next), Some(last)) = (modes.next, modes.lambda.last()) {
            assert!(next > *last, "the next eigenvalue {next} above {last}");
        }
    }

    /// Asserts λ against a reference in user units. Rounding of the entries and of the Rayleigh quotient moves λ_j by
    /// c_j times the rounding unit of a sum of a row's terms: up to 81 of them, and n in the quotient, summed in eight
    /// lanes; 32 ε c_j covers both, as their errors add up like the root of their number.
    pub(crate) fn assert_lambda(&self, modes: &Modes, exact: &[f64]) {
        assert_eq!(modes.count(), exact.len(), "number of modes: {:?} for {exact:?}", modes.lambda);
        for (j, (lambda, exact)) in modes.lambda.iter().zip(exact).enumerate() {
            let lambda = lambda * self.unit();
            let error = (lambda - exact).abs() / exact.abs();
            let bar = 32.0 * f64::EPSILON * modes.errors[j].cancellation;
            assert!(error <= bar, "λ_{j} = {lambda}, exact {exact}: error {error:e} above {bar:e}");
        }
    }
}

fn none(partition: &Partition) -> RigidBodyModes {
    RigidBodyModes::none(partition.n_dofs())
}

pub(crate) fn partition(model: &supel_models::Model, interfaces: &[InterfaceJob]) -> Partition {
    let model = Model::new(chain::input(model)).expect("a model");
    Partition::new(model, interfaces).expect("a partition")
}

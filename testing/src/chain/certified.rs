//! The search for modes and its certificate on generated models.

use supel::constraint::constraint_modes;
use supel::eigen::{Modes, mass_orthogonality};
use supel::error::Error;
use supel::factor::Cholesky;
use supel::job::{Certify, Eigensolver, InterfaceJob, InterfacePart, Method, ModeSelection, ReductionJob};
use supel::modes::{Certificate, Component, ModeSource, Search, certified};
use supel::partition::DofOrigin;
use supel::random::SEED;
use supel::rigid;
use supel_models::Model;

/// Modes with the counts that certify them, in user units.
pub struct Certified {
    pub modes: Modes,
    pub certificate: Certificate,
    /// λ in user units.
    pub lambda: Vec<f64>,
    /// Row of the model that each row of the shapes belongs to.
    pub rows: Vec<usize>,
    /// |XᵀMX − I|.
    pub orthogonality: f64,
    /// A factor of (rad/s)² from λ as the tool has it.
    pub unit: f64,
}

/// The solvers this build has.
pub fn eigensolvers() -> &'static [Eigensolver] {
    Eigensolver::BUILT_IN
}

/// Their words in jobs and flags.
pub fn eigensolver_words() -> &'static [&'static str] {
    &["lanczos", "arpack"][..Eigensolver::BUILT_IN.len()]
}

/// Fixed-interface modes, with no interface those of the model as it is.
pub fn held(modes: ModeSelection, eigensolver: Eigensolver) -> ReductionJob {
    ReductionJob { eigensolver, ..ReductionJob::new(Method::CraigBampton, modes) }
}

/// Free-interface modes.
pub fn free(modes: ModeSelection, eigensolver: Eigensolver) -> ReductionJob {
    ReductionJob { eigensolver, ..ReductionJob::new(Method::Herting, modes) }
}

/// So many modes.
pub fn count(count: usize) -> ModeSelection {
    ModeSelection::Count { count }
}

/// All modes up to an eigenvalue.
pub fn up_to(lambda: f64) -> ModeSelection {
    ModeSelection::UpTo { up_to_hz: lambda.sqrt() / std::f64::consts::TAU }
}

/// Modes with these interfaces held, or directions of them, and the others free.
pub fn mixed(held: &[&str], modes: ModeSelection, eigensolver: Eigensolver) -> ReductionJob {
    let held = held.iter().map(|held| InterfacePart((*held).to_owned())).collect();
    ReductionJob { eigensolver, held: Some(held), ..ReductionJob::new(Method::MixedInterface, modes) }
}

/// Runs the stages up to the factor of K_II.
pub fn with_component<T>(
    model: &Model,
    interfaces: &[InterfaceJob],
    look: impl FnOnce(Component<'_>) -> Result<T, Error>,
) -> Result<T, Error> {
    with_component_of(model, interfaces, &held(count(0), Eigensolver::Lanczos), look)
}

/// Runs the stages up to the factor of K_II for a job, which may hold some of its interfaces.
pub fn with_component_of<T>(
    model: &Model,
    interfaces: &[InterfaceJob],
    job: &ReductionJob,
    look: impl FnOnce(Component<'_>) -> Result<T, Error>,
) -> Result<T, Error> {
    let (mut partition, rigid) = super::rigid_of(model, interfaces)?;
    rigid::interface_rank(&partition, &rigid)?;
    job.held.as_ref().map_or(Ok(()), |held| partition.hold_for_modes(held))?;
    let rigid = rigid::with_passing(rigid, &partition)?;
    let analysis = partition.analysis()?;
    let factor = Cholesky::new(&analysis, partition.pencil(), 0.0, &|dof| partition.name_of(dof))?;
    let constraint = constraint_modes(&partition, &factor, &rigid);
    look(Component {
        partition: &partition,
        analysis: &analysis,
        factor: &factor,
        rigid: &rigid,
        constraint: Some(&constraint),
    })
}

/// Searches and certifies.
pub fn certify(model: &Model, interfaces: &[InterfaceJob], job: &ReductionJob) -> Result<Certified, Error> {
    with_component_of(model, interfaces, job, |component| {
        let search = Search::new(component, job)?;
        let found = search.lowest(SEED)?;
        let (modes, certificate) = certified(&search, &search.problem, found, search.edge(), Certify::Count)?;
        Ok(judge(&search, modes, certificate.expect("a count was asked for")))
    })
}

/// What every certified answer has to satisfy whatever it is of.
pub fn judge(search: &Search<'_>, modes: Modes, certificate: Certificate) -> Certified {
    assert!(certificate.holds(), "{certificate:?}");
    assert!(certificate.doubt() <= 1.0, "growth beyond what is certain: {certificate:?}");
    assert_eq!(certificate.n_counted, modes.count() + search.problem.n_rigid());
    let intervals = &certificate.intervals;
    assert!(intervals.windows(2).all(|pair| pair[0].to == pair[1].from), "gaps between intervals: {intervals:?}");
    assert_eq!(intervals.iter().map(|interval| interval.n_found).sum::<usize>(), certificate.n_found);
    let partition = search.problem.component.partition;
    let unit = partition.scaling.eigenvalue_unit();
    let row = |dof: &supel::partition::ReducedDof| match dof.origin {
        DofOrigin::Row(row) => row,
        DofOrigin::PatchNode(..) | DofOrigin::Distortion(..) => usize::MAX,
    };
    let dof_of = |at: usize| &partition.dofs[partition.dof_under(search.problem.boundary, at)];
    let rows = (0..modes.shapes.nrows()).map(|at| row(dof_of(at))).collect();
    let orthogonality = mass_orthogonality(search.problem.modal().mass, modes.shapes.as_ref()).error;
    let lambda = modes.lambda.iter().map(|lambda| lambda * unit).collect();
    Certified { lambda, modes, certificate, orthogonality, rows, unit }
}

impl Certified {
    /// Asserts the lowest eigenvalues against exact ones. Rounding of the entries and of the Rayleigh quotient moves λ_j by
    /// c_j times the rounding of sums of up to 81 terms, whose errors add up like the root of their number: 32 ε c_j.
    #[track_caller]
    pub fn assert_lambda(&self, exact: &[f64]) {
        assert_eq!(self.lambda.len(), exact.len(), "number of modes");
        for (j, (lambda, exact)) in self.lambda.iter().zip(exact).enumerate() {
            let error = (lambda / exact - 1.0).abs();
            let bar = 32.0 * f64::EPSILON * self.modes.errors[j].cancellation;
            assert!(error <= bar, "λ_{j} = {lambda}, exact {exact}: error {error:e} above {bar:e}");
        }
    }

    /// Asserts eigenvalues of a chosen spectrum, whose K is rounded in units of its largest one and has cond(C)² below 100.
    #[track_caller]
    pub fn assert_known(&self, exact: &[f64], largest: f64) {
        assert_eq!(self.lambda.len(), exact.len(), "{:?}", self.lambda);
        for (lambda, exact) in self.lambda.iter().zip(exact) {
            assert!((lambda - exact).abs() <= 100.0 * f64::EPSILON * largest, "{lambda} for {exact}");
        }
    }
}

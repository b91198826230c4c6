//! The evidence of a generated model, as `supel::reduce` gathers it.

use supel::basis::Basis;
use supel::constraint::constraint_modes;
use supel::factor::Cholesky;
use supel::input::Input;
use supel::job::{InterfaceJob, Method, ModeSelection, ReductionJob};
use supel::model::Model;
use supel::modes::{Component, ModeSource, Retained, Search};
use supel::partition::Partition;
use supel::plan::Relief;
use supel::random::SEED;
use supel::reduction::Reduction;
use supel::rigid;
use supel::verification::check::{Check, Verdict};
use supel::verification::{Evidence, verify};

use crate::chain::input;

/// Runs the stages on an input and hands their evidence on.
pub fn with_evidence<T>(
    input: Input,
    interfaces: &[InterfaceJob],
    (method, count): (Method, usize),
    look: impl FnOnce(Evidence<'_>) -> T,
) -> T {
    let model = Model::new(input).expect("a sound model");
    let partition = Partition::new(model, interfaces).expect("interfaces of the model");
    let (rigid, _) = rigid::rigid_body_modes(&partition).expect("rigid-body modes");
    let rank = rigid::interface_rank(&partition, &rigid).expect("an interface that reacts them");
    let analysis = partition.analysis().expect("memory");
    let factor = Cholesky::new(&analysis, partition.pencil(), 0.0, &|dof| partition.name_of(dof)).expect("definite");
    let constraint = constraint_modes(&partition, &factor, &rigid);
    let component = Component::new(&partition, &analysis, &factor, &rigid, Some(&constraint));
    let job = ReductionJob::new(method, ModeSelection::Count { count });
    let search = Search::new(component, &job).expect("a stable component");
    let retained = Retained::of(search.lowest(SEED).expect("modes"), search.problem.boundary);
    let basis = Basis::new(
        &constraint,
        &supel::basis::retained_columns(component, &constraint, Relief::of_reduction(&job), &retained),
        partition.internal().mass,
    );
    let reduction = Reduction::new(&partition, &basis, &rigid);
    look(Evidence {
        partition: &partition,
        factor: &factor,
        rigid: &rigid,
        rank,
        constraint: &constraint,
        retained: &retained,
        basis: &basis,
        reduction: &reduction,
        answers: None,
        rubin: None,
        damping: None,
        unseen: &[],
        certificate: None,
        enclosures: None,
        expect: None,
    })
}

/// The evidence of a generated model with all its digits.
pub fn with_model<T>(
    model: &supel_models::Model,
    interfaces: &[InterfaceJob],
    method: (Method, usize),
    look: impl FnOnce(Evidence<'_>) -> T,
) -> T {
    with_evidence(input(model), interfaces, method, look)
}

/// The checks of some evidence.
pub fn checks(evidence: &Evidence<'_>) -> Vec<Check> {
    verify(evidence).expect("dense decompositions").checks
}

/// Identifiers of the checks that do not pass, each once, with their verdicts.
pub fn complaints(checks: &[Check]) -> Vec<(&'static str, Verdict)> {
    let mut found: Vec<_> = checks
        .iter()
        .filter(|check| check.verdict() > Verdict::Pass)
        .map(|check| (check.id, check.verdict()))
        .collect();
    found.sort_unstable();
    found.dedup_by_key(|(id, _)| *id);
    found
}

/// A check as a line of text.
pub fn line(check: &Check) -> String {
    let (limit, worst) = (check.limits.value(), check.worst.as_deref().unwrap_or("-"));
    format!("{:?} {} {}: {:.1e} of {limit:.1e}, at {worst}", check.verdict(), check.id, check.name, check.value)
}

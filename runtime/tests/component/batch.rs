//! Many components at once.

use std::num::NonZero;

use supel_runtime::component::{
    BatchError, Evaluation, EvaluationError, ModalComponent, Workspace, evaluate_all, exact_tangents_all, tangents_all,
};

use crate::situation::{Situation, components};

/// Components of different sizes, each in a state of its own.
fn mechanism() -> (Vec<ModalComponent>, Vec<Situation>) {
    let components: Vec<_> = components().into_iter().cycle().take(100).collect();
    let situations = components.iter().zip(0..).map(|(component, seed)| Situation::random(component, 0.2, seed));
    let situations = situations.collect();
    (components, situations)
}

fn evaluations<'a>(
    components: &'a [ModalComponent],
    situations: &'a [Situation],
    workspaces: &'a mut [Workspace],
) -> Vec<Evaluation<'a>> {
    let each = components.iter().zip(situations).zip(workspaces);
    each.map(|((component, situation), workspace)| Evaluation { component, state: situation.state(), workspace })
        .collect()
}

#[test]
fn a_batch_has_the_bits_of_single_evaluations_for_any_number_of_threads() {
    let (components, situations) = mechanism();
    for n_threads in [1, 2, 3, 8, 200] {
        let threads = NonZero::new(n_threads).expect("a thread");
        let mut workspaces: Vec<_> = components.iter().map(ModalComponent::workspace).collect();
        evaluate_all(&mut evaluations(&components, &situations, &mut workspaces), threads).expect("moderate states");
        let alone: Vec<_> = components.iter().zip(&situations).map(|(c, situation)| situation.evaluated(c)).collect();
        for (found, expected) in workspaces.iter().zip(&alone) {
            assert_eq!(found.elastic_forces(), expected.elastic_forces());
            assert_eq!(found.inertial_forces(), expected.inertial_forces());
            assert_eq!(found.kinetic_energy(), expected.kinetic_energy());
        }
        let mut workspaces: Vec<_> = components.iter().map(ModalComponent::workspace).collect();
        tangents_all(&mut evaluations(&components, &situations, &mut workspaces), threads).expect("moderate states");
        for ((found, component), situation) in workspaces.iter().zip(&components).zip(&situations) {
            let expected = situation.tangents(component);
            assert_eq!((found.stiffness(), found.gyroscopic()), (expected.stiffness(), expected.gyroscopic()));
        }
        let mut workspaces: Vec<_> = components.iter().map(ModalComponent::workspace).collect();
        let mut all = evaluations(&components, &situations, &mut workspaces);
        exact_tangents_all(&mut all, threads).expect("moderate states");
        for ((found, component), situation) in workspaces.iter().zip(&components).zip(&situations) {
            assert_eq!(found.exact_stiffness(), situation.exact_tangents(component).exact_stiffness());
        }
    }
}

#[test]
fn the_first_failure_is_named_and_all_others_are_evaluated() {
    let (components, mut situations) = mechanism();
    for index in [90, 17, 40] {
        situations[index].accelerations[1] = f64::NAN;
    }
    let mut workspaces: Vec<_> = components.iter().map(ModalComponent::workspace).collect();
    let threads = NonZero::new(4).expect("a thread");
    let outcome = evaluate_all(&mut evaluations(&components, &situations, &mut workspaces), threads);
    let source = EvaluationError::NotFinite { what: "accelerations", index: 1 };
    assert_eq!(outcome, Err(BatchError { index: 17, source }));
    for (index, (found, component)) in workspaces.iter().zip(&components).enumerate() {
        if ![90, 17, 40].contains(&index) {
            assert_eq!(found.inertial_forces(), situations[index].evaluated(component).inertial_forces());
        }
    }
    assert_eq!(evaluate_all(&mut [], threads), Ok(()));
}

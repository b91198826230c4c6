//! Time of two evaluations of a component with two interface nodes, against the number of modal amplitudes; and of one evaluation of
//! many components by one and two threads.

#![allow(missing_docs)]

use supel_models::superelements::beam;

use std::hint::black_box;
use std::num::NonZero;

use criterion::{BenchmarkId, Criterion, criterion_group, criterion_main};
use supel_models::SplitMix64;
use supel_runtime::Superelement;
use supel_runtime::component::{
    BatchError, Evaluation, FloatingFrame, ModalComponent, State, Workspace, evaluate_all, tangents_all,
};
use supel_runtime::motion::Motion;

/// A component, and its states in two time steps of which each is evaluated after the other, as in a simulation.
struct Case {
    component: ModalComponent,
    workspace: Workspace,
    motions: [Vec<Motion>; 2],
    rest: [Vec<f64>; 3],
}

impl Case {
    fn new(n_modal: usize) -> Self {
        let (tensors, metadata) = beam::random_parts(2, n_modal, 1);
        let superelement = Superelement::new(tensors, metadata).expect("the parts fit");
        let component = ModalComponent::new(&superelement, FloatingFrame::MassWeighted).expect("a free body");
        let mut random = SplitMix64::new(2);
        let r = component.n_coordinates();
        let first: Vec<Motion> = (0..2).map(|_| random.motion(0.05)).collect();
        let second = first.iter().map(|motion| motion.compose(&random.motion(0.005))).collect();
        let rest = [random.vector(n_modal, 0.05), random.vector(r, 1.0), random.vector(r, 1.0)];
        Self { workspace: component.workspace(), component, motions: [first, second], rest }
    }

    fn states(&self) -> [State<'_>; 2] {
        let [amplitudes, velocities, accelerations] = &self.rest;
        [0, 1].map(|step| State { motions: &self.motions[step], amplitudes, velocities, accelerations })
    }
}

fn evaluation(criterion: &mut Criterion) {
    let mut group = criterion.benchmark_group("two steps of two nodes");
    for n_modal in [0, 5, 10, 20, 40, 80] {
        let case = Case::new(n_modal);
        let mut workspace = case.workspace.clone();
        group.bench_function(BenchmarkId::new("forces", n_modal), |bencher| {
            bencher.iter(|| {
                for state in &case.states() {
                    case.component.evaluate(black_box(state), &mut workspace).expect("a small deformation");
                }
            });
        });
        group.bench_function(BenchmarkId::new("tangents", n_modal), |bencher| {
            bencher.iter(|| {
                for state in &case.states() {
                    case.component.tangents(black_box(state), &mut workspace).expect("a small deformation");
                }
            });
        });
        group.bench_function(BenchmarkId::new("exact tangents", n_modal), |bencher| {
            bencher.iter(|| {
                for state in &case.states() {
                    case.component.exact_tangents(black_box(state), &mut workspace).expect("a small deformation");
                }
            });
        });
    }
    group.finish();
}

/// One step of a mechanism of components with 20 modes, by one and two threads.
fn batch(criterion: &mut Criterion) {
    let case = Case::new(20);
    let [state, _] = case.states();
    let mut group = criterion.benchmark_group("components at once");
    for n_components in [10, 100, 1000] {
        let mut workspaces = vec![case.workspace.clone(); n_components];
        let component = &case.component;
        let each = workspaces.iter_mut().map(|workspace| Evaluation { component, state, workspace });
        let mut evaluations: Vec<_> = each.collect();
        for n_threads in [1, 2] {
            let threads = NonZero::new(n_threads).expect("a thread");
            for (name, all) in [("forces", evaluate_all as All), ("tangents", tangents_all)] {
                let id = BenchmarkId::new(format!("{name}, threads {n_threads}"), n_components);
                group.bench_function(id, |bencher| {
                    bencher.iter(|| all(black_box(&mut evaluations), threads).expect("a small deformation"));
                });
            }
        }
    }
    group.finish();
}

type All = fn(&mut [Evaluation<'_>], NonZero<usize>) -> Result<(), BatchError>;

criterion_group!(benches, evaluation, batch);
criterion_main!(benches);

//! Evaluations allocate nothing.

#![allow(unsafe_code)]

use supel_models::superelements::beam;

use std::alloc::{GlobalAlloc, Layout, System};
use std::cell::Cell;

use supel_models::SplitMix64;
use supel_runtime::component::{DeadLoad, FloatingFrame, Measures, ModalComponent, RecoveredNode, State};
use supel_runtime::motion::{IDENTITY_3, Motion};
use supel_runtime::{Direction, Matrix, Precision, RecoveredDof, Recovery, Superelement};

/// The system's allocator, counting the calls of each thread.
struct Counting;

thread_local! {
    static CALLS: Cell<usize> = const { Cell::new(0) };
}

fn count() {
    CALLS.set(CALLS.get() + 1);
}

// SAFETY: every call is passed on to the system's allocator as it came; counting touches no memory of the caller, and the
// counter is a constant-initialised thread-local without a destructor, which does not allocate itself.
unsafe impl GlobalAlloc for Counting {
    unsafe fn alloc(&self, layout: Layout) -> *mut u8 {
        count();
        // SAFETY: the caller's promises are those that `System` asks for.
        unsafe { System.alloc(layout) }
    }

    unsafe fn dealloc(&self, pointer: *mut u8, layout: Layout) {
        count();
        // SAFETY: as above.
        unsafe { System.dealloc(pointer, layout) }
    }

    unsafe fn realloc(&self, pointer: *mut u8, layout: Layout, size: usize) -> *mut u8 {
        count();
        // SAFETY: as above.
        unsafe { System.realloc(pointer, layout, size) }
    }
}

#[global_allocator]
static ALLOCATOR: Counting = Counting;

#[test]
fn evaluations_allocate_nothing() {
    let (mut tensors, mut metadata, _) = beam::reduced_parts(&beam::arc_nodes(), &beam::SOFT, &[0, 8], 5);
    // Unsymmetric, which takes the longer way.
    tensors.damping = Some(Matrix::from_fn(17, 17, |i, j| tensors.mass[(i, j)] + if i < j { 0.1 } else { 0.0 }));
    let rows = Matrix::from_fn(3, 17, |i, j| if i == j { 1.0 } else { 0.0 });
    let dofs = Direction::ALL[..3].iter().map(|&direction| RecoveredDof { node: 7, direction }).collect();
    tensors.recovery = Some(Recovery::new(rows, dofs, Precision::Double).expect("three rows, three dofs"));
    tensors.load_vectors = Some(Matrix::from_fn(17, 1, |i, _| i as f64));
    metadata.load_names = vec!["thrust".to_owned()];
    let superelement = Superelement::new(tensors, metadata).expect("the parts fit");
    let mut random = SplitMix64::new(2);
    let (amplitudes, velocities) = (random.vector(5, 0.1), random.vector(17, 1.0));
    let near: Vec<Motion> = (0..2).map(|_| random.motion(0.2)).collect();
    let broken = vec![near[0], near[0].compose(&Motion::exp(&[0.0, 0.0, 0.0, 3.1, 0.0, 0.0]))];
    let load = DeadLoad { node: 1, force: [1.0; 3], moment: [2.0; 3] };
    let (mut forces, mut stiffness) = (vec![0.0; 17], vec![0.0; 17 * 17]);
    let mut node = [RecoveredNode { displacement: [0.0; 3], rotation: IDENTITY_3 }];
    for measures in [Measures::MotionBased, Measures::Classical] {
        let component =
            ModalComponent::with_measures(&superelement, FloatingFrame::MassWeighted, measures).expect("a free body");
        let mut workspace = component.workspace();
        let before = CALLS.get();
        for motions in [&near, &broken, &near] {
            let state = State { motions, amplitudes: &amplitudes, velocities: &velocities, accelerations: &velocities };
            let outcome = component.evaluate(&state, &mut workspace);
            assert_eq!(outcome.is_ok(), component.tangents(&state, &mut workspace).is_ok());
            assert_eq!(outcome.is_ok(), component.exact_tangents(&state, &mut workspace).is_ok());
            let g = [0.0, 0.0, -9.81];
            assert_eq!(outcome.is_ok(), component.gravity_forces(&g, &mut workspace).is_ok());
            assert_eq!(outcome.is_ok(), component.gravity_potential(&g, &workspace).is_ok());
            let added = component.add_gravity_stiffness(&g, &mut workspace, &mut stiffness);
            assert_eq!(outcome.is_ok(), added.is_ok());
            assert_eq!(outcome.is_ok(), component.load_vector_forces(0, 2.0, &mut workspace).is_ok());
            let added = component.add_load_vector_stiffness(0, 2.0, &mut workspace, &mut stiffness);
            assert_eq!(outcome.is_ok(), added.is_ok());
            component.velocities_to_origin(&mut forces).expect("all coordinates");
            component.velocities_to_nodes(&mut forces).expect("all coordinates");
            component.forces_to_nodes(&mut forces).expect("all coordinates");
            component.matrix_to_nodes(&mut stiffness).expect("a matrix");
            component.add_load(&load, motions, &mut forces).expect("a node of the component");
            component.add_load_stiffness(&load, motions, &mut stiffness).expect("a node of the component");
            assert_eq!(outcome.is_ok(), component.recover(&workspace, &[[0.0; 3]], &mut node).is_ok());
            assert_eq!(outcome.is_ok(), component.recover_node(&workspace, 7, &[0.0; 3]).is_ok());
        }
        assert_eq!(CALLS.get(), before);
    }
    let before = CALLS.get();
    drop(std::hint::black_box(vec![0.0; forces.len()]));
    assert_eq!(CALLS.get(), before + 2, "the counter counts");
}

//! Displacements inside the component.

use supel_runtime::component::{EvaluationError, FloatingFrame, ModalComponent, RecoveredNode};
use supel_runtime::motion::{IDENTITY_3, Motion, Vector3};
use supel_runtime::{Direction, Matrix, Precision, RecoveredDof, Recovery, Superelement};

use crate::beam;
use crate::situation::{CHOICES, Situation, assert_close, times};
use supel_models::SplitMix64;

const EMPTY: RecoveredNode = RecoveredNode { displacement: [0.0; 3], rotation: IDENTITY_3 };

/// The arc with rows of the basis for the dofs of node 3 and the translations of node 5, in a mixed order.
fn arc(directions: &[(usize, usize)]) -> (Superelement, Vec<f64>) {
    let (mut tensors, metadata, basis) = beam::reduced_parts(&beam::arc_nodes(), &beam::SOFT, &[0, 8], 4);
    let r = tensors.mass.rows();
    let rows = Matrix::from_fn(directions.len(), r, |i, j| basis[(6 * directions[i].0 + directions[i].1) * r + j]);
    let dof =
        |(node, direction): &(usize, usize)| RecoveredDof { node: *node as i64, direction: Direction::ALL[*direction] };
    let dofs = directions.iter().map(dof).collect();
    tensors.recovery = Some(Recovery::new(rows, dofs, Precision::Double).expect("as many dofs as rows"));
    (Superelement::new(tensors, metadata).expect("the parts fit"), basis)
}

const WHOLE: [(usize, usize); 9] = [(5, 1), (3, 0), (3, 5), (3, 3), (5, 0), (3, 4), (3, 2), (3, 1), (5, 2)];

fn recovered(component: &ModalComponent, situation: &Situation) -> [RecoveredNode; 2] {
    let nodes = beam::arc_nodes();
    let mut found = [EMPTY; 2];
    component.recover(&situation.evaluated(component), &[nodes[5], nodes[3]], &mut found).expect("whole nodes");
    found
}

#[test]
fn recovered_nodes_follow_a_rigid_motion() {
    let nodes = beam::arc_nodes();
    for (frame, measures) in CHOICES {
        let component = ModalComponent::with_measures(&arc(&WHOLE).0, frame, measures).expect("a free body");
        assert_eq!(component.recovered_labels(), [5, 3]);
        let motion = SplitMix64::new(1).motion(2.5);
        let mut situation = Situation::random(&component, 0.0, 2);
        situation.motions.fill(motion);
        situation.amplitudes.fill(0.0);
        for (found, x) in recovered(&component, &situation).iter().zip([nodes[5], nodes[3]]) {
            let moved = motion.apply(&x);
            let expected: Vector3 = std::array::from_fn(|i| moved[i] - x[i]);
            assert_close(&found.displacement, &expected, 1e-13);
            assert_close(found.rotation.as_flattened(), motion.rotation.as_flattened(), 1e-13);
        }
    }
}

/// Against the linear recovery Ψ q of displacements q of the nodes; the difference is of second order.
#[test]
fn small_motion_is_recovered_as_in_the_linear_model() {
    for (frame, measures) in CHOICES {
        let (superelement, basis) = arc(&WHOLE);
        let component = ModalComponent::with_measures(&superelement, frame, measures).expect("a free body");
        let errors = [1e-3, 5e-4].map(|size| {
            let mut random = SplitMix64::new(3);
            let increments = random.vector(12, size);
            let mut situation = Situation::random(&component, 0.0, 4);
            situation.amplitudes = random.vector(4, size);
            let mut q = Vec::new();
            for (j, x) in component.positions().iter().enumerate() {
                let motion = Motion::exp(&std::array::from_fn(|i| increments[6 * j + i]));
                let moved = motion.apply(x);
                q.extend((0..3).map(|i| moved[i] - x[i]));
                q.extend(&increments[6 * j + 3..6 * j + 6]);
                situation.motions[j] = motion;
            }
            q.extend(&situation.amplitudes);
            let linear = times(&basis, &q);
            let [five, three] = recovered(&component, &situation);
            let turn = three.rotation;
            let found = [
                five.displacement,
                three.displacement,
                [turn[2][1] - turn[1][2], turn[0][2] - turn[2][0], turn[1][0] - turn[0][1]].map(|x| 0.5 * x),
            ];
            let expected = [&linear[30..33], &linear[18..21], &linear[21..24]].concat();
            found.as_flattened().iter().zip(&expected).fold(0.0_f64, |worst, (x, y)| worst.max((x - y).abs()))
        });
        assert!(errors[0] < 1e-5, "{errors:?}");
        let ratio = errors[0] / errors[1];
        assert!((3.9..4.1).contains(&ratio), "second order: {ratio}");
    }
}

#[test]
fn what_cannot_be_recovered_is_refused() {
    let component = |directions: &[(usize, usize)]| {
        ModalComponent::new(&arc(directions).0, FloatingFrame::MassWeighted).expect("a free body")
    };
    let refusal = |component: &ModalComponent, positions: usize, nodes: usize| {
        let workspace = component.workspace();
        component.recover(&workspace, &vec![[0.0; 3]; positions], &mut vec![EMPTY; nodes]).expect_err("impossible")
    };
    let wrong = |what, found| EvaluationError::WrongLength { what, found, expected: 2 };
    let whole = component(&WHOLE);
    let at = |positions: [Vector3; 2]| whole.recover(&whole.workspace(), &positions, &mut [EMPTY; 2]);
    let not_finite = EvaluationError::NotFinite { what: "positions of recovered nodes", index: 4 };
    assert_eq!(at([[0.0; 3], [0.0, f64::NAN, 0.0]]), Err(not_finite));
    let mut far = whole.workspace();
    let mut situation = Situation::random(&whole, 0.0, 1);
    situation.motions.iter_mut().for_each(|motion| motion.translation = [0.0, 1e308, 0.0]);
    whole.evaluate(&situation.state(), &mut far).expect("a rigid motion");
    let overflow = Err(EvaluationError::Overflow { what: "displacements of recovered nodes" });
    assert_eq!(whole.recover(&far, &[[1.7e308; 3]; 2], &mut [EMPTY; 2]), overflow);
    assert_eq!(refusal(&component(&WHOLE), 1, 2), wrong("positions of recovered nodes", 1));
    assert_eq!(refusal(&component(&WHOLE), 2, 3), wrong("recovered nodes", 3));
    let at = |label: i64, position: Vector3| whole.recover_node(&whole.workspace(), label, &position);
    assert_eq!(at(4, [0.0; 3]), Err(EvaluationError::NotRecovered { label: 4 }));
    let not_finite = EvaluationError::NotFinite { what: "positions of recovered nodes", index: 2 };
    assert_eq!(at(3, [0.0, 0.0, f64::INFINITY]), Err(not_finite));
    let none = ModalComponent::new(&beam::arc(0).superelement, FloatingFrame::Rigid).expect("a free body");
    assert!(none.recovered_labels().is_empty());
    assert_eq!(none.recover(&none.workspace(), &[], &mut []), Ok(()));
    let missing = none.recover_node(&none.workspace(), 3, &[0.0; 3]);
    assert_eq!(missing, Err(EvaluationError::NotRecovered { label: 3 }));
}

/// A node of which the file has some directions is refused by its name, and costs no other node.
#[test]
fn nodes_with_some_directions_cost_no_others() {
    let nodes = beam::arc_nodes();
    let partial = [(4, 0), (4, 1), (7, 0), (7, 1), (7, 2), (7, 5)];
    let with_partial = |first: usize| [&partial[..first], &WHOLE[..], &partial[first..]].concat();
    let whole = ModalComponent::new(&arc(&WHOLE).0, FloatingFrame::MassWeighted).expect("a free body");
    let situation = Situation::random(&whole, 0.01, 5);
    let expected = recovered(&whole, &situation);
    for first in [0, 2, 6] {
        let component = ModalComponent::new(&arc(&with_partial(first)).0, FloatingFrame::MassWeighted);
        let component = component.expect("a free body");
        assert_eq!((component.recovered_labels(), component.incomplete_labels()), (&[5, 3][..], &[4, 7][..]));
        assert_eq!(recovered(&component, &situation), expected, "the same bits");
        let workspace = situation.evaluated(&component);
        assert_eq!(component.recover_node(&workspace, 3, &nodes[3]), Ok(expected[1]));
        for label in [4, 7] {
            let error = component.recover_node(&workspace, label, &nodes[0]).expect_err("some directions");
            assert_eq!(error, EvaluationError::IncompleteRecovery { label });
            assert!(error.to_string().contains(&format!("node {label};")), "{error}");
        }
    }
}

/// Positions of the file come in the order of the labels, those of other nodes left out.
#[test]
fn positions_come_with_the_file() {
    let at = |label: i64| [label as f64, 0.5, -1.0];
    let directions = [&[(4, 0), (4, 1)][..], &WHOLE].concat();
    let placed = |superelement: Superelement, labels: &[i64]| {
        let mut tensors = superelement.tensors().clone();
        let recovery = tensors.recovery.take().expect("rows");
        tensors.recovery = recovery.with_positions(labels.iter().map(|label| at(*label)).collect()).ok();
        Superelement::new(tensors, superelement.metadata().clone()).expect("the parts fit")
    };
    let file = placed(arc(&directions).0, &[4, 5, 3]);
    assert_eq!(Superelement::from_bytes(&file.to_bytes().expect("bytes").bytes).expect("a file"), file);
    let component = ModalComponent::new(&file, FloatingFrame::Rigid).expect("a free body");
    assert_eq!(component.recovered_positions(), Some(&[at(5), at(3)][..]));
    let without = ModalComponent::new(&arc(&WHOLE).0, FloatingFrame::Rigid).expect("a free body");
    assert_eq!(without.recovered_positions(), None);
    let few = arc(&WHOLE).0.tensors().recovery.clone().expect("rows").with_positions(vec![at(5)]);
    assert!(matches!(few, Err(supel_runtime::FileError::WrongShape { tensor: "recovery_positions", .. })), "{few:?}");
}

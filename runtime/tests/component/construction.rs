//! What a component is made of, and what cannot become one.

use supel_runtime::component::{ComponentError, FloatingFrame, Measures, ModalComponent};
use supel_runtime::motion::Motion;
use supel_runtime::{Coordinate, Direction, Matrix, Metadata, Superelement, Tensors};

use crate::beam;
use crate::situation::{CHOICES, assert_close, largest};

/// A matrix or its rows and columns left out.
fn without(a: &Matrix, rows: &[usize], cols: &[usize]) -> Matrix {
    let kept = |n: usize, out: &[usize]| (0..n).filter(|i| !out.contains(i)).collect::<Vec<_>>();
    let (rows, cols) = (kept(a.rows(), rows), kept(a.cols(), cols));
    Matrix::from_fn(rows.len(), cols.len(), |i, j| a[(rows[i], cols[j])])
}

/// The arc without some of its first coordinates.
fn arc_without(out: &[usize]) -> (Tensors, Metadata) {
    let (mut tensors, mut metadata, _) = beam::reduced_parts(&beam::arc_nodes(), &beam::SOFT, &[0, 8], 2);
    tensors.stiffness = without(&tensors.stiffness, out, out);
    tensors.mass = without(&tensors.mass, out, out);
    tensors.rigid_body_modes = without(&tensors.rigid_body_modes, out, &[]);
    let mut index = 0;
    metadata.coordinates.retain(|_| {
        index += 1;
        !out.contains(&(index - 1))
    });
    (tensors, metadata)
}

fn refusal(parts: (Tensors, Metadata), frame: FloatingFrame) -> ComponentError {
    let superelement = Superelement::new(parts.0, parts.1).expect("the parts fit");
    ModalComponent::new(&superelement, frame).expect_err("no component")
}

#[test]
fn nodes_that_only_translate_are_refused_with_the_remedy() {
    let (tensors, mut metadata) = arc_without(&[9, 10, 11]);
    metadata.interface_nodes[1].dofs.truncate(3);
    let error = refusal((tensors, metadata), FloatingFrame::MassWeighted);
    let missing = vec![Direction::Rx, Direction::Ry, Direction::Rz];
    assert_eq!(error, ComponentError::MissingDofs { node: 1, name: "node 1".into(), missing });
    let text = error.to_string();
    assert!(text.contains("no rx, ry, rz") && text.contains("`rigid`") && text.contains("`average`"), "{text}");
}

#[test]
fn a_node_without_one_rotation_is_refused() {
    let (tensors, mut metadata) = arc_without(&[4]);
    metadata.interface_nodes[0].dofs.remove(4);
    let error = refusal((tensors, metadata), FloatingFrame::Rigid);
    assert_eq!(error, ComponentError::MissingDofs { node: 0, name: "node 0".into(), missing: vec![Direction::Ry] });
}

#[test]
fn interface_rows_are_refused() {
    let (mut tensors, mut metadata) = arc_without(&[]);
    metadata.interface_nodes.pop();
    tensors.interface_positions.pop();
    tensors.interface_frames.pop();
    (6..12).for_each(|i| metadata.coordinates[i] = Coordinate::InterfaceRow { row: i as u64 });
    assert_eq!(refusal((tensors, metadata), FloatingFrame::Rigid), ComponentError::InterfaceRows { count: 6 });
}

#[test]
fn a_modal_model_without_interface_is_refused() {
    let (mut tensors, mut metadata) = arc_without(&(0..12).collect::<Vec<_>>());
    metadata.interface_nodes.clear();
    tensors.interface_positions.clear();
    tensors.interface_frames.clear();
    assert_eq!(refusal((tensors, metadata), FloatingFrame::Rigid), ComponentError::NoInterfaceNodes);
}

#[test]
fn several_bodies_in_one_are_refused() {
    let (mut tensors, metadata) = arc_without(&[]);
    let modes = tensors.rigid_body_modes;
    tensors.rigid_body_modes = Matrix::from_fn(modes.rows(), 7, |i, j| modes[(i, j % 6)]);
    tensors.rigid_body_mass = Matrix::from_fn(7, 7, |_, _| 1.0);
    assert_eq!(refusal((tensors, metadata), FloatingFrame::Rigid), ComponentError::Mechanism { found: 7 });
}

#[test]
fn a_component_that_is_held_is_refused() {
    let (mut tensors, metadata) = arc_without(&[]);
    let k = tensors.stiffness.clone();
    tensors.stiffness =
        Matrix::from_fn(k.rows(), k.cols(), |i, j| k[(i, j)] + if i == 1 && j == 1 { k[(1, 1)] } else { 0.0 });
    let error = refusal((tensors, metadata), FloatingFrame::Rigid);
    assert!(matches!(error, ComponentError::NotFree { residual, .. } if residual > 0.1), "{error}");
}

/// One node just holds a component: what is left of its stiffness is rounding, and a spring is visible against the first mode.
#[test]
fn a_component_of_one_node_is_free_unless_a_spring_holds_it() {
    let (tensors, metadata, _) = beam::reduced_parts(&beam::arc_nodes(), &beam::SOFT, &[8], 5);
    let spring = tensors.mass[(1, 1)] * tensors.stiffness[(6, 6)] / tensors.mass[(6, 6)];
    let component = |share: f64| {
        let k = |i: usize, j: usize| tensors.stiffness[(i, j)] + if (i, j) == (1, 1) { share * spring } else { 0.0 };
        let stiffness = Matrix::from_fn(tensors.stiffness.rows(), tensors.stiffness.cols(), k);
        let superelement = Superelement::new(Tensors { stiffness, ..tensors.clone() }, metadata.clone());
        ModalComponent::new(&superelement.expect("the parts fit"), FloatingFrame::MassWeighted)
    };
    // The solution with the internal stiffness, of condition 1e4, leaves stiffnesses of 1e-12 of the elements'; these are some
    // thousand times the first mode's.
    let residual = component(0.0).expect("a free body").rigid_motion_residual();
    assert!(residual > 0.0 && residual < 1e-8, "{residual:e}");
    for share in [1.0, 1e-3] {
        let error = component(share).expect_err("it is held");
        assert!(matches!(error, ComponentError::NotFree { residual, .. } if residual > 0.1 * share), "{error}");
    }
}

/// Two nodes tell a spring by the stiffness between them, however heavy the node that it holds.
#[test]
fn a_heavy_node_hides_no_spring() {
    let (mut tensors, metadata) = arc_without(&[]);
    let (k, m) = (tensors.stiffness.clone(), tensors.mass.clone());
    let at = |i: usize, j: usize| (i, j) == (1, 1);
    tensors.mass = Matrix::from_fn(m.rows(), m.cols(), |i, j| m[(i, j)] * if at(i, j) { 1e8 } else { 1.0 });
    tensors.stiffness = Matrix::from_fn(k.rows(), k.cols(), |i, j| k[(i, j)] * if at(i, j) { 2.0 } else { 1.0 });
    let error = refusal((tensors, metadata), FloatingFrame::Rigid);
    assert!(matches!(error, ComponentError::NotFree { residual, .. } if residual > 0.1), "{error}");
}

/// Damping in proportion to a stiffness that is rounding where one node just holds the component.
#[test]
fn damping_in_proportion_to_the_stiffness_does_not_brake_a_component_of_one_node() {
    let (tensors, metadata, _) = beam::reduced_parts(&beam::arc_nodes(), &beam::SOFT, &[8], 5);
    for (share, brakes) in [(0.0, false), (1e-2, true)] {
        let (k, m) = (&tensors.stiffness, &tensors.mass);
        let damping = Matrix::from_fn(k.rows(), k.cols(), |i, j| 1e-3 * k[(i, j)] + share * m[(i, j)]);
        let tensors = Tensors { damping: Some(damping), ..tensors.clone() };
        let superelement = Superelement::new(tensors, metadata.clone()).expect("the parts fit");
        let component = ModalComponent::new(&superelement, FloatingFrame::Rigid).expect("a free body");
        let mut situation = crate::situation::Situation::random(&component, 0.0, 1);
        situation.motions.fill(Motion::IDENTITY);
        situation.velocities.fill(0.0);
        situation.amplitudes.fill(0.0);
        situation.velocities[5] = 1.0;
        let brake = largest(situation.evaluated(&component).damping_forces());
        assert_eq!(brake > 0.0, brakes, "{share}: {brake:e}");
    }
}

#[test]
fn a_component_without_inertia_about_an_axis_needs_the_rigid_floating_frame() {
    let (mut tensors, metadata) = arc_without(&[]);
    let m = tensors.mass;
    // Point masses on the line between the nodes: no inertia about it.
    tensors.mass = Matrix::from_fn(m.rows(), m.cols(), |i, j| if i == j && i % 6 < 3 && i < 12 { 1.0 } else { 0.0 });
    let superelement = Superelement::new(tensors, metadata).expect("the parts fit");
    let error = ModalComponent::new(&superelement, FloatingFrame::MassWeighted).expect_err("no frame");
    assert_eq!(error, ComponentError::MasslessMotion);
    assert!(ModalComponent::new(&superelement, FloatingFrame::Rigid).is_ok());
}

/// The frame of a body 1e5 away is lost in rounding: 1e-16 of the inertia 1e10 about the origin, which the search amplifies.
#[test]
fn distance_from_the_origin_is_not_taken_for_a_lack_of_mass() {
    let at = |distance: f64, frame: FloatingFrame| {
        let nodes: Vec<[f64; 3]> = (0..=8).map(|i| [0.25 * f64::from(i) - 1.0, distance, 0.0]).collect();
        let superelement = beam::reduced(&nodes, &beam::SOFT, &[0, 8], 2).superelement;
        ModalComponent::new(&superelement, frame)
    };
    assert!(at(1e3, FloatingFrame::MassWeighted).is_ok() && at(1e5, FloatingFrame::Rigid).is_ok());
    let error = at(1e5, FloatingFrame::MassWeighted).expect_err("too far");
    let ComponentError::FarFromOrigin { distance, radius, limit } = error else { panic!("{error}") };
    assert_close(&[distance], &[1e5], 1e-9);
    // About the axis of the beam: polar inertia 0.05 of a mass of 2 for each length; 1e-16 of 1e10 is 1e-4 of 0.025.
    assert_close(&[radius], &[0.025_f64.sqrt()], 1e-3);
    assert!(distance / radius > limit && error_text(&at(1e5, FloatingFrame::MassWeighted)).contains("near the origin"));
}

fn error_text(outcome: &Result<ModalComponent, ComponentError>) -> String {
    outcome.as_ref().map_or_else(ToString::to_string, |_| String::new())
}

/// Matrices printed with six digits make a component, and their stiffness-proportional damping no brake.
#[test]
fn rounded_damping_in_proportion_to_the_stiffness_does_not_brake() {
    let (mut tensors, metadata) = arc_without(&[]);
    let six = |x: f64| format!("{x:.5e}").parse::<f64>().expect("a number");
    let k = tensors.stiffness;
    tensors.stiffness = Matrix::from_fn(k.rows(), k.cols(), |i, j| six(k[(i, j)]));
    for (share, brakes) in [(0.0, false), (1e-2, true)] {
        let (k, m) = (&tensors.stiffness, &tensors.mass);
        let damping = Matrix::from_fn(k.rows(), k.cols(), |i, j| six(1e-3 * k[(i, j)] + share * m[(i, j)]));
        let tensors = Tensors { damping: Some(damping), ..tensors.clone() };
        let superelement = Superelement::new(tensors, metadata.clone()).expect("the parts fit");
        let component = ModalComponent::new(&superelement, FloatingFrame::Rigid).expect("a free body");
        assert!(component.rigid_motion_residual() > 1e-9, "{:e}", component.rigid_motion_residual());
        let mut situation = crate::situation::Situation::random(&component, 0.0, 1);
        situation.motions.fill(Motion::IDENTITY);
        situation.velocities.fill(0.0);
        situation.amplitudes.fill(0.0);
        (situation.velocities[5], situation.velocities[11]) = (1.0, 1.0);
        let brake = largest(situation.evaluated(&component).damping_forces());
        // Without one only rounding of the deformation rate is left, 1e-16 of a velocity of order one times the damping.
        let rounding = 1e-14 * largest(component.reference_damping().expect("a damping"));
        assert_eq!(brake > rounding, brakes, "{share}: {brake:e}");
    }
}

#[test]
fn rigid_motion_makes_no_force() {
    // Without internal nodes the matrices are those of the elements; the solution with the internal stiffness, whose
    // condition number is 1e4, costs a reduced one a few digits.
    let all: Vec<usize> = (0..9).collect();
    for (interface, n_modes, tolerance) in [(all.as_slice(), 0, 1e-14), (&[0, 8], 0, 1e-13), (&[0, 8], 5, 1e-13)] {
        let superelement = beam::reduced(&beam::arc_nodes(), &beam::SOFT, interface, n_modes).superelement;
        let component = ModalComponent::new(&superelement, FloatingFrame::Rigid).expect("a free body");
        let (nodes, r) = (interface.len(), 6 * interface.len() + n_modes);
        assert_eq!((component.n_nodes(), component.n_modal(), component.n_coordinates()), (nodes, n_modes, r));
        assert!(component.rigid_motion_residual() <= tolerance, "{:.1e}", component.rigid_motion_residual());
        for (i, row) in component.reference_stiffness().chunks_exact(r).enumerate() {
            for a in 0..6 {
                let force: f64 = (0..nodes).map(|j| row[6 * j + a]).sum();
                assert!(force.abs() <= tolerance * largest(row), "row {i}, motion {a}: {force:e}");
            }
        }
    }
}

#[test]
fn the_rigid_mass_is_that_of_the_file() {
    for (frame, measures) in CHOICES {
        let superelement = beam::arc(3).superelement;
        let component = ModalComponent::with_measures(&superelement, frame, measures).expect("a free body");
        let expected = superelement.tensors().rigid_body_mass.as_slice();
        assert_close(component.rigid_mass().as_flattened(), expected, 1e-13);
    }
}

#[test]
fn turned_axes_of_the_interface_nodes_change_nothing() {
    let (mut tensors, metadata) = arc_without(&[]);
    let make = |tensors: &Tensors| {
        let superelement = Superelement::new(tensors.clone(), metadata.clone()).expect("the parts fit");
        ModalComponent::new(&superelement, FloatingFrame::MassWeighted).expect("a free body")
    };
    let straight = make(&tensors);
    tensors.interface_frames[0] = [[0.0, -1.0, 0.0], [1.0, 0.0, 0.0], [0.0, 0.0, 1.0]];
    assert_eq!(make(&tensors).reference_stiffness(), straight.reference_stiffness());
    assert_eq!(make(&tensors).reference_mass(), straight.reference_mass());
}

/// Rubin's basis where the internal stiffness is singular: rigid-body motion has amplitudes N.
#[test]
fn rigid_body_amplitudes_are_taken_out_of_the_motion() {
    let (tensors, metadata) = arc_without(&[]);
    let (n_b, r) = (12, tensors.stiffness.rows());
    let amplitude = |mode: usize, motion: usize| 0.3 + mode as f64 - 0.1 * motion as f64;
    // η = η_file − N P u_B with P the mean of D⁻¹u over the two nodes.
    let positions = tensors.interface_positions.clone();
    let entry = |i: usize, j: usize| {
        if i == j {
            return 1.0;
        }
        if i < n_b || j >= n_b {
            return 0.0;
        }
        // D⁻¹ is the rigid motion of the opposite position.
        let back = [positions[j / 6].map(|x| -x)];
        -(0..6).map(|a| 0.5 * amplitude(i - n_b, a) * beam::rigid_motion(&back, a, j % 6)).sum::<f64>()
    };
    let change = Matrix::from_fn(r, r, entry);
    let congruent = |a: &Matrix| {
        let product = |i: usize, j: usize| -> f64 {
            (0..r * r).map(|c| change[(c / r, i)] * a[(c / r, c % r)] * change[(c % r, j)]).sum()
        };
        Matrix::from_fn(r, r, |i, j| 0.5 * (product(i, j) + product(j, i)))
    };
    let mut turned = tensors.clone();
    (turned.stiffness, turned.mass) = (congruent(&tensors.stiffness), congruent(&tensors.mass));
    let modes = &tensors.rigid_body_modes;
    turned.rigid_body_modes = Matrix::from_fn(r, 6, |i, a| if i < n_b { modes[(i, a)] } else { amplitude(i - n_b, a) });
    for (frame, measures) in CHOICES {
        let make = |tensors: &Tensors| {
            let superelement = Superelement::new(tensors.clone(), metadata.clone()).expect("the parts fit");
            ModalComponent::with_measures(&superelement, frame, measures).expect("a free body")
        };
        let (plain, mixed) = (make(&tensors), make(&turned));
        assert_close(mixed.reference_stiffness(), plain.reference_stiffness(), 1e-12);
        assert_close(mixed.reference_mass(), plain.reference_mass(), 1e-12);
        let situation = crate::situation::Situation::random(&plain, 0.3, 1);
        let (found, expected) = (situation.evaluated(&mixed), situation.evaluated(&plain));
        assert_close(found.elastic_forces(), expected.elastic_forces(), 1e-11);
        assert_close(found.inertial_forces(), expected.inertial_forces(), 1e-11);
    }
}

#[test]
fn measures_are_motion_based_unless_asked_for() {
    let component = ModalComponent::new(&beam::arc(0).superelement, FloatingFrame::Rigid).expect("a free body");
    assert_eq!(component.measures(), Measures::MotionBased);
}

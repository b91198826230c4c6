//! One test for each way in which numbers and metadata can fail to be one superelement. Each changes one thing in a
//! good one.

use supel_models::superelements::particle as sample;

use supel_runtime::{
    Coordinate, Direction, FileError, InterfaceDof, Matrix, MatrixKind, Metadata, NamedMatrix, Precision, Recovery,
    Superelement, Tensors, Verdict,
};

fn refusal(change: impl FnOnce(&mut Tensors, &mut Metadata)) -> FileError {
    let (mut tensors, mut metadata) = sample::complete_parts();
    change(&mut tensors, &mut metadata);
    Superelement::new(tensors, metadata).unwrap_err()
}

macro_rules! assert_refused {
    ($error:expr, $pattern:pat $(if $guard:expr)?) => {
        match $error {
            $pattern $(if $guard)? => {}
            other => panic!("{other:?}"),
        }
    };
}

/// A copy of a matrix with one other entry.
fn with(matrix: &Matrix, place: (usize, usize), value: f64) -> Matrix {
    Matrix::from_fn(matrix.rows(), matrix.cols(), |i, j| if (i, j) == place { value } else { matrix[(i, j)] })
}

fn zeros(rows: usize, cols: usize) -> Matrix {
    Matrix::from_fn(rows, cols, |_, _| 0.0)
}

#[test]
fn matrix_of_too_few_values() {
    let error = Matrix::from_row_major(2, 3, vec![0.0; 5]).unwrap_err();
    assert_refused!(error, FileError::MatrixSize { rows: 2, cols: 3, found: 5 });
    let error = Matrix::from_row_major(usize::MAX, 2, vec![]).unwrap_err();
    assert_refused!(error, FileError::MatrixSize { .. });
}

#[test]
fn matrix_hands_out_only_what_it_has() {
    let matrix = Matrix::from_fn(2, 3, |i, j| (10 * i + j) as f64);
    assert_eq!(matrix.as_slice(), [0.0, 1.0, 2.0, 10.0, 11.0, 12.0]);
    assert_eq!((matrix.get(1, 2), matrix.get(1, 3), matrix.get(2, 0)), (Some(12.0), None, None));
    assert_eq!((matrix.row(1), matrix.row(2)), (Some([10.0, 11.0, 12.0].as_slice()), None));
}

#[test]
fn shapes_against_the_coordinates() {
    type Change = fn(&mut Tensors);
    let changes: [(&str, Change); 12] = [
        ("stiffness", |t| t.stiffness = zeros(8, 8)),
        ("mass", |t| t.mass = zeros(9, 10)),
        ("rigid_body_modes", |t| t.rigid_body_modes = zeros(8, 6)),
        ("rigid_body_mass", |t| t.rigid_body_mass = zeros(5, 6)),
        ("damping", |t| t.damping = Some(zeros(9, 1))),
        ("mixing", |t| t.mixing = Some(zeros(9, 9))),
        ("gravity", |t| t.gravity = Some(zeros(9, 2))),
        ("load_vectors", |t| t.load_vectors = Some(zeros(8, 1))),
        ("recovery", |t| t.recovery = Recovery::new(zeros(0, 8), vec![], Precision::Double).ok()),
        ("interface_positions", |t| t.interface_positions.clear()),
        ("interface_frames", |t| t.interface_frames.clear()),
        ("rigid_body_mass", |t| t.rigid_body_modes = zeros(9, 0)),
    ];
    for (name, change) in changes {
        assert_refused!(refusal(|tensors, _| change(tensors)), FileError::WrongShape { tensor, .. } if tensor == name);
    }
    let error = Recovery::new(zeros(2, 9), vec![], Precision::Double).unwrap_err();
    assert_refused!(error, FileError::WrongShape { tensor: "recovery_dofs", .. });
}

#[test]
fn number_in_a_tensor_not_finite() {
    let error = refusal(|tensors, _| tensors.mass = with(&tensors.mass, (1, 2), f64::NAN));
    assert_refused!(error, FileError::NotFinite { tensor: "mass", index: 11, value } if value.is_nan());
    let error = refusal(|tensors, _| tensors.frequencies[2] = f64::INFINITY);
    assert_refused!(error, FileError::NotFinite { tensor: "frequencies", index: 2, .. });
    let error = refusal(|tensors, _| tensors.interface_positions[0][1] = f64::NAN);
    assert_refused!(error, FileError::NotFinite { tensor: "interface_positions", index: 1, .. });
    let error = refusal(|tensors, _| tensors.interface_frames[0][2][0] = f64::NAN);
    assert_refused!(error, FileError::NotFinite { tensor: "interface_frames", index: 6, .. });
    let error = refusal(|tensors, _| {
        let recovery = tensors.recovery.take().unwrap();
        tensors.recovery = recovery.with_positions(vec![[0.0, f64::NAN, 0.0]]).ok();
    });
    assert_refused!(error, FileError::NotFinite { tensor: "recovery_positions", index: 1, .. });
    // The largest double does not fit the single precision of the sample's recovery.
    let dofs = sample::complete().tensors().recovery.as_ref().unwrap().dofs().to_vec();
    let rows = with(&zeros(3, 9), (0, 1), f64::MAX);
    let error = refusal(|tensors, _| tensors.recovery = Recovery::new(rows, dofs, Precision::Single).ok());
    assert_refused!(error, FileError::NotFinite { tensor: "recovery", index: 1, .. });
}

#[test]
fn one_bit_of_asymmetry() {
    let next = |value: f64| f64::from_bits(value.to_bits() + 1);
    let error = refusal(|tensors, _| tensors.mass = with(&tensors.mass, (6, 0), next(tensors.mass[(6, 0)])));
    assert_refused!(error, FileError::NotSymmetric { tensor: "mass", row: 0, col: 6, .. });
    let error = refusal(|tensors, _| tensors.stiffness = with(&tensors.stiffness, (3, 7), f64::MIN_POSITIVE));
    assert_refused!(error, FileError::NotSymmetric { tensor: "stiffness", row: 3, col: 7, .. });
}

#[test]
fn number_in_the_metadata_not_finite() {
    type Change = fn(&mut Metadata);
    let changes: [(&str, Change); 7] = [
        ("interface_nodes[0].position", |m| m.interface_nodes[0].position[2] = f64::NAN),
        ("coordinates[6]", |m| {
            m.coordinates[6] = Coordinate::ElasticMode { mode: 0, frequency_hz: f64::NAN, error_bar_hz: None }
        }),
        ("coordinates[7]", |m| {
            m.coordinates[7] = Coordinate::ElasticMode { mode: 1, frequency_hz: 1.0, error_bar_hz: Some(f64::INFINITY) }
        }),
        ("dropped[1]", |m| {
            m.dropped[1].column =
                Coordinate::FixedInterfaceMode { mode: 1, frequency_hz: f64::INFINITY, error_bar_hz: None }
        }),
        ("validity.band_hz", |m| m.validity.band_hz = Some([0.0, f64::INFINITY])),
        ("model.mass_properties", |m| m.model.mass_properties.as_mut().unwrap().inertia[2][1] = f64::NAN),
        ("verification.checks M-12", |m| m.verification.checks[0].limit = f64::NAN),
    ];
    for (name, change) in changes {
        let error = refusal(|_, metadata| change(metadata));
        assert_refused!(error, FileError::MetadataNotFinite { field } if field == name);
    }
}

#[test]
fn interface_node_twice() {
    let error = refusal(|tensors, metadata| {
        tensors.interface_positions.push(tensors.interface_positions[0]);
        tensors.interface_frames.push(tensors.interface_frames[0]);
        metadata.interface_nodes.push(metadata.interface_nodes[0].clone());
    });
    assert_refused!(error, FileError::InterfaceDuplicate { label: Some(12), .. });
}

#[test]
fn dofs_of_an_interface_node_out_of_order() {
    for dofs in [vec![], vec![Direction::Uy, Direction::Ux], vec![Direction::Rz, Direction::Rz]] {
        let error = refusal(|_, metadata| metadata.interface_nodes[0].dofs = dofs);
        assert_refused!(error, FileError::InterfaceDofs { name } if name == "hub");
    }
}

#[test]
fn interface_node_in_two_places() {
    let error = refusal(|tensors, _| tensors.interface_positions[0][0] += 1.0);
    assert_refused!(error, FileError::InterfacePosition { .. });
}

#[test]
fn frame_that_is_no_rotation() {
    let mirrored = [[-1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]];
    let stretched = [[1.0, 0.0, 0.0], [0.0, 2.0, 0.0], [0.0, 0.0, 0.5]];
    let sheared = [[1.0, 0.0, 0.0], [0.6, 0.8, 0.0], [0.0, 0.0, 1.0]];
    for frame in [mirrored, stretched, sheared] {
        let error = refusal(|tensors, _| tensors.interface_frames[0] = frame);
        assert_refused!(error, FileError::InterfaceFrame { name } if name == "hub");
    }
    let (mut tensors, metadata) = sample::complete_parts();
    tensors.interface_frames[0] = [[0.6, -0.8, 0.0], [0.8, 0.6, 0.0], [0.0, 0.0, 1.0]];
    assert!(Superelement::new(tensors, metadata).is_ok(), "a rotation is accepted");
}

#[test]
fn coordinates_out_of_order() {
    let error = refusal(|_, metadata| metadata.coordinates.swap(1, 2));
    assert_refused!(error, FileError::CoordinateOrder { coordinate: 1 });
    let error = refusal(|_, metadata| metadata.coordinates[8] = Coordinate::InterfaceRow { row: 4 });
    assert_refused!(error, FileError::WrongShape { tensor: "mixing", .. });
    let error = refusal(|tensors, metadata| {
        tensors.mixing = None;
        metadata.coordinates[8] = Coordinate::InterfaceRow { row: 4 };
    });
    assert_refused!(error, FileError::CoordinateOrder { coordinate: 8 });
    let error = refusal(|tensors, metadata| {
        tensors.mixing = None;
        metadata.coordinates[8] = Coordinate::Interface { node: 0, direction: Direction::Ux };
    });
    assert_refused!(error, FileError::CoordinateOrder { coordinate: 8 });
    let error = refusal(|_, metadata| metadata.interface_nodes[0].dofs = vec![Direction::Ux, Direction::Uz]);
    assert_refused!(error, FileError::CoordinateOrder { coordinate: 1 });
}

#[test]
fn mode_without_frequency_or_named_twice() {
    let error = refusal(|_, metadata| metadata.coordinates[7] = metadata.coordinates[6].clone());
    assert_refused!(error, FileError::CoordinateMode { coordinate: 7, mode: 0, n_modes: 3 });
    let error = refusal(|tensors, _| tensors.frequencies.truncate(2));
    assert_refused!(error, FileError::CoordinateMode { coordinate: 8, mode: 2, n_modes: 2 });
}

#[test]
fn residual_vector_without_load_or_named_twice() {
    let error = refusal(|_, metadata| metadata.coordinates[8] = Coordinate::ResidualVector { load: 1 });
    assert_refused!(error, FileError::CoordinateLoad { coordinate: 8, load: 1, n_loads: 1 });
    let error = refusal(|_, metadata| {
        (7..9).for_each(|slot| metadata.coordinates[slot] = Coordinate::ResidualVector { load: 0 });
    });
    assert_refused!(error, FileError::CoordinateLoad { coordinate: 8, load: 0, n_loads: 1 });
}

#[test]
fn frequency_in_two_versions() {
    let error = refusal(|tensors, _| tensors.frequencies[1] *= 1.0 + 1e-14);
    assert_refused!(error, FileError::CoordinateFrequency { coordinate: 7, .. });
}

#[test]
fn frequencies_that_do_not_ascend() {
    let error = refusal(|tensors, _| tensors.frequencies.swap(0, 1));
    assert_refused!(error, FileError::FrequencyOrder { mode: 1, .. });
    let error = refusal(|tensors, _| tensors.frequencies[0] = -1.0);
    assert_refused!(error, FileError::FrequencyOrder { mode: 0, .. });
}

#[test]
fn names_and_vectors_of_the_loads() {
    let error = refusal(|_, metadata| metadata.load_names.clear());
    assert_refused!(error, FileError::LoadNames { names: 0, vectors: 1 });
    let error = refusal(|tensors, _| tensors.load_vectors = None);
    assert_refused!(error, FileError::LoadNames { names: 1, vectors: 0 });
}

#[test]
fn names_and_rows_of_the_quantities() {
    let stress = || vec![supel_runtime::Quantity { name: "stress".into(), unit: "MPa".into() }];
    let error = refusal(|_, metadata| metadata.quantities = stress());
    assert_refused!(error, FileError::QuantityNames { names: 1, rows: 0 });
    let error = refusal(|tensors, metadata| {
        metadata.quantities = stress();
        tensors.quantities = Some(zeros(2, 9));
    });
    assert_refused!(error, FileError::QuantityNames { names: 1, rows: 2 });
    let error = refusal(|tensors, _| tensors.quantities = Some(zeros(1, 8)));
    assert_refused!(error, FileError::WrongShape { tensor: "quantities", .. });
    let (mut tensors, mut metadata) = sample::complete_parts();
    metadata.quantities = stress();
    tensors.quantities = Some(zeros(1, 9));
    let whole = Superelement::new(tensors, metadata).unwrap();
    assert_eq!(Superelement::from_bytes(&whole.to_bytes().unwrap().bytes).unwrap(), whole);
}

#[test]
fn names_and_kinds_of_further_matrices() {
    let named = |name: &str, kind| NamedMatrix { name: name.into(), kind };
    let error = refusal(|_, metadata| metadata.matrices = vec![named("A", MatrixKind::Other)]);
    assert_refused!(error, FileError::MatrixNames { names: 1, matrices: 0 });
    let skew = Matrix::from_fn(9, 9, |i, j| i as f64 - j as f64);
    let symmetric = Matrix::from_fn(9, 9, |i, j| (i + j) as f64);
    let of_kind = |kind, matrix: &Matrix| {
        let (mut tensors, mut metadata) = sample::complete_parts();
        metadata.matrices = vec![named("A", kind)];
        tensors.matrices = vec![matrix.clone()];
        Superelement::new(tensors, metadata)
    };
    assert_refused!(
        of_kind(MatrixKind::Gyroscopic, &symmetric).unwrap_err(),
        FileError::NotSkew { row: 0, col: 1, .. }
    );
    let with_diagonal = Matrix::from_fn(9, 9, |i, j| if (i, j) == (2, 2) { 1.0 } else { skew[(i, j)] });
    let error = of_kind(MatrixKind::Gyroscopic, &with_diagonal).unwrap_err();
    assert_refused!(error, FileError::NotSkew { row: 2, col: 2, .. });
    let error = of_kind(MatrixKind::GeometricStiffness, &skew).unwrap_err();
    assert_refused!(error, FileError::NotSymmetric { tensor: "matrices", .. });
    assert_refused!(of_kind(MatrixKind::Other, &zeros(9, 8)).unwrap_err(), FileError::WrongShape { .. });
    let nan = Matrix::from_fn(9, 9, |_, _| f64::NAN);
    assert_refused!(of_kind(MatrixKind::Damping, &nan).unwrap_err(), FileError::NotFinite { tensor: "matrices", .. });
    let (mut tensors, mut metadata) = sample::complete_parts();
    metadata.matrices = vec![named("A", MatrixKind::Gyroscopic), named("A", MatrixKind::Circulatory)];
    tensors.matrices = vec![skew.clone(), symmetric.clone()];
    let error = Superelement::new(tensors.clone(), metadata.clone()).unwrap_err();
    assert_refused!(error, FileError::MatrixName { .. });
    metadata.matrices[1].name = "B".into();
    let whole = Superelement::new(tensors, metadata).unwrap();
    let read = Superelement::from_bytes(&whole.to_bytes().unwrap().bytes).unwrap();
    assert_eq!(read, whole);
    let found: Vec<_> = read.further_matrices().map(|(named, matrix)| (named.name.as_str(), matrix)).collect();
    assert_eq!(found, [("A", &skew), ("B", &symmetric)]);
}

#[test]
fn coordinates_held_for_modes_that_are_no_interface_coordinates() {
    for (held, coordinate) in [(vec![6], 6), (vec![0, 0], 0), (vec![3, 1], 1)] {
        let error = refusal(|_, metadata| metadata.modes_held = held);
        assert_refused!(error, FileError::ModesHeld { coordinate: found, n_interface: 6 } if found == coordinate);
    }
}

#[test]
fn unloaded_dof_that_is_not_there() {
    let unloaded = |node, direction| vec![InterfaceDof { node, direction }];
    let error = refusal(|_, metadata| metadata.validity.unloaded = unloaded(1, Direction::Ux));
    assert_refused!(error, FileError::UnloadedDof { node: 1, direction: Direction::Ux });
    let error = refusal(|_, metadata| {
        metadata.interface_nodes[0].dofs.pop();
        metadata.coordinates[5] = Coordinate::InterfaceRow { row: 5 };
    });
    assert_refused!(error, FileError::UnloadedDof { node: 0, direction: Direction::Rz });
}

#[test]
fn direction_of_gravity_that_is_none() {
    for along in [[f64::NAN, 0.0, 0.0], [0.0, f64::INFINITY, 0.0]] {
        assert_refused!(refusal(|_, metadata| metadata.validity.gravity = Some(along)), FileError::GravityDirection);
    }
}

#[test]
fn verdict_better_than_a_check() {
    let error = refusal(|_, metadata| metadata.verification.verdict = Verdict::Pass);
    assert_refused!(error, FileError::Verdict { check } if check == "M-12");
    assert_eq!(Verdict::worst([Verdict::Pass, Verdict::Fail, Verdict::Warn]), Verdict::Fail);
}

#[test]
fn digest_of_an_input_malformed() {
    let error = refusal(|_, metadata| drop(metadata.inputs.insert("nodes".into(), "12".into())));
    assert_refused!(error, FileError::InputDigest { name } if name == "nodes");
}

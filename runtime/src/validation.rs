//! What makes numbers and metadata one superelement. The same rules hold for one that is built and one that is read.

use alloc::borrow::ToOwned;
use alloc::string::String;
use alloc::vec::Vec;

use crate::coordinate::Coordinate;
use crate::document::is_digest;
use crate::error::{FileError, Result};
use crate::further_matrix::Symmetry;
use crate::matrix::Matrix;
use crate::metadata::{Flag, InterfaceDof, Metadata};
use crate::tensors::Tensors;

/// How far RᵀR of an interface frame may be from the identity; a rotation from twelve printed digits passes.
const FRAME_TOLERANCE: f64 = 1e-10;

/// Hertz and rad/s of a mode may differ by the rounding of 2π and of the division, whatever way they were converted.
const CONVERSION_TOLERANCE: f64 = 8.0 * f64::EPSILON;

/// Checks everything; the first breach is the error.
pub(crate) fn check(tensors: &Tensors, metadata: &Metadata) -> Result<()> {
    check_shapes(tensors, metadata)?;
    check_values(tensors)?;
    check_metadata_numbers(metadata)?;
    check_interface(tensors, metadata)?;
    check_coordinates(metadata)?;
    check_validity(metadata)?;
    check_modes(tensors, metadata)?;
    check_modes_held(metadata)?;
    check_residual_vectors(metadata)?;
    check_matrices(tensors, metadata)?;
    for (name, digest) in &metadata.inputs {
        if !is_digest(digest) {
            return Err(FileError::InputDigest { name: name.clone() });
        }
    }
    let verification = &metadata.verification;
    match verification.checks.iter().find(|check| check.verdict > verification.verdict) {
        Some(check) => Err(FileError::Verdict { check: check.id.clone() }),
        None => Ok(()),
    }
}

/// Every matrix of a superelement with its name.
fn matrices(tensors: &Tensors) -> impl Iterator<Item = (&'static str, &Matrix)> {
    [
        ("stiffness", Some(&tensors.stiffness)),
        ("mass", Some(&tensors.mass)),
        ("rigid_body_modes", Some(&tensors.rigid_body_modes)),
        ("rigid_body_mass", Some(&tensors.rigid_body_mass)),
        ("damping", tensors.damping.as_ref()),
        ("mixing", tensors.mixing.as_ref()),
        ("gravity", tensors.gravity.as_ref()),
        ("load_vectors", tensors.load_vectors.as_ref()),
        ("recovery", tensors.recovery.as_ref().map(|recovery| &recovery.rows)),
        ("quantities", tensors.quantities.as_ref()),
    ]
    .into_iter()
    .filter_map(|(name, matrix)| Some((name, matrix?)))
    .chain(tensors.matrices.iter().map(|matrix| ("matrices", matrix)))
}

fn check_shapes(tensors: &Tensors, metadata: &Metadata) -> Result<()> {
    let r = metadata.coordinates.len();
    let n_eta = metadata.coordinates.iter().filter(|coordinate| !coordinate.is_interface()).count();
    let n_rigid = tensors.rigid_body_modes.cols();
    let is_stiffness_only = metadata.flags.contains(&Flag::StiffnessOnly);
    if !is_stiffness_only && tensors.mass.rows() == 0 && r > 0 {
        return Err(FileError::MissingTensor { tensor: "mass" });
    }
    for (tensor, matrix) in matrices(tensors) {
        let found = (matrix.rows(), matrix.cols());
        let expected = match tensor {
            "mass" | "rigid_body_mass" | "gravity" | "damping" if is_stiffness_only => (0, 0),
            "rigid_body_modes" => (r, n_rigid),
            "rigid_body_mass" => (n_rigid, n_rigid),
            "mixing" => (n_eta, n_eta),
            "gravity" => (r, 3),
            "load_vectors" => (r, matrix.cols()),
            "recovery" | "quantities" => (matrix.rows(), r),
            _ => (r, r),
        };
        if found != expected {
            let (found, expected) = (vec![found.0, found.1], vec![expected.0, expected.1]);
            return Err(FileError::WrongShape { tensor, found, expected });
        }
    }
    let k = metadata.interface_nodes.len();
    let wrong = |tensor, found, expected| Err(FileError::WrongShape { tensor, found, expected });
    if tensors.interface_positions.len() != k {
        return wrong("interface_positions", vec![tensors.interface_positions.len(), 3], vec![k, 3]);
    }
    if tensors.interface_frames.len() != k {
        return wrong("interface_frames", vec![tensors.interface_frames.len(), 3, 3], vec![k, 3, 3]);
    }
    let (names, vectors) = (metadata.load_names.len(), tensors.load_vectors.as_ref().map_or(0, Matrix::cols));
    if names != vectors {
        return Err(FileError::LoadNames { names, vectors });
    }
    let (names, rows) = (metadata.quantities.len(), tensors.quantities.as_ref().map_or(0, Matrix::rows));
    if names != rows {
        return Err(FileError::QuantityNames { names, rows });
    }
    let (names, matrices) = (metadata.matrices.len(), tensors.matrices.len());
    if names == matrices { Ok(()) } else { Err(FileError::MatrixNames { names, matrices }) }
}

/// Further matrices have names of their own, and are what their kind demands.
fn check_matrices(tensors: &Tensors, metadata: &Metadata) -> Result<()> {
    let mut seen = alloc::collections::BTreeSet::new();
    for (named, matrix) in metadata.matrices.iter().zip(&tensors.matrices) {
        if named.name.trim().is_empty() || !seen.insert(&named.name) {
            return Err(FileError::MatrixName { name: named.name.clone() });
        }
        match named.kind.symmetry() {
            Some(Symmetry::Symmetric) => check_symmetry("matrices", matrix)?,
            Some(Symmetry::Skew) => check_skew(&named.name, matrix)?,
            None => {}
        }
    }
    Ok(())
}

/// Opposite to the bit, but for the sign of zero.
fn check_skew(name: &str, matrix: &Matrix) -> Result<()> {
    for row in 0..matrix.rows() {
        for col in row..matrix.cols() {
            let (upper, lower) = (matrix[(row, col)], matrix[(col, row)]);
            if upper != -lower {
                return Err(FileError::NotSkew { name: name.to_owned(), row, col, upper, lower });
            }
        }
    }
    Ok(())
}

fn check_values(tensors: &Tensors) -> Result<()> {
    let recovered = tensors.recovery.as_ref().and_then(|recovery| recovery.positions());
    let vectors = [
        ("interface_positions", tensors.interface_positions.as_flattened()),
        ("interface_frames", tensors.interface_frames.as_flattened().as_flattened()),
        ("frequencies", tensors.frequencies.as_slice()),
        ("recovery_positions", recovered.unwrap_or_default().as_flattened()),
    ];
    for (tensor, values) in matrices(tensors).map(|(name, matrix)| (name, matrix.as_slice())).chain(vectors) {
        if let Some((index, &value)) = values.iter().enumerate().find(|(_, value)| !value.is_finite()) {
            return Err(FileError::NotFinite { tensor, index, value });
        }
    }
    check_symmetry("stiffness", &tensors.stiffness)?;
    check_symmetry("mass", &tensors.mass)
}

/// Symmetry to the bit: clients keep one triangle, and which one must not matter.
fn check_symmetry(tensor: &'static str, matrix: &Matrix) -> Result<()> {
    for row in 0..matrix.rows() {
        for col in row + 1..matrix.cols() {
            let (upper, lower) = (matrix[(row, col)], matrix[(col, row)]);
            if upper.to_bits() != lower.to_bits() {
                return Err(FileError::NotSymmetric { tensor, row, col, upper, lower });
            }
        }
    }
    Ok(())
}

/// JSON has no infinity and no NaN; a writer that met one would write `null` and no reader would take the file.
fn check_metadata_numbers(metadata: &Metadata) -> Result<()> {
    let finite = |values: &[f64], field: &dyn Fn() -> String| {
        if values.iter().all(|value| value.is_finite()) {
            Ok(())
        } else {
            Err(FileError::MetadataNotFinite { field: field() })
        }
    };
    for (k, node) in metadata.interface_nodes.iter().enumerate() {
        finite(&node.position, &|| format!("interface_nodes[{k}].position"))?;
    }
    let dropped = metadata.dropped.iter().map(|dropped| &dropped.column);
    for (list, coordinates) in
        [("coordinates", metadata.coordinates.iter().collect::<Vec<_>>()), ("dropped", dropped.collect())]
    {
        for (k, coordinate) in coordinates.into_iter().enumerate() {
            finite(&mode_numbers(coordinate), &|| format!("{list}[{k}]"))?;
        }
    }
    finite(metadata.validity.band_hz.unwrap_or_default().as_slice(), &|| "validity.band_hz".to_owned())?;
    if let Some(properties) = &metadata.model.mass_properties {
        let numbers = [&[properties.mass], properties.center_of_mass.as_slice(), properties.inertia.as_flattened()];
        finite(&numbers.concat(), &|| "model.mass_properties".to_owned())?;
    }
    for check in &metadata.verification.checks {
        finite(&[check.value.unwrap_or(0.0), check.limit], &|| format!("verification.checks {}", check.id))?;
    }
    Ok(())
}

/// Frequency and error bar of a modal coordinate, zeros for the others.
fn mode_numbers(coordinate: &Coordinate) -> [f64; 2] {
    let frequency_hz = coordinate.mode().map_or(0.0, |(_, frequency_hz)| frequency_hz);
    [frequency_hz, coordinate.error_bar_hz().unwrap_or(0.0)]
}

fn check_interface(tensors: &Tensors, metadata: &Metadata) -> Result<()> {
    let mut seen = alloc::collections::BTreeSet::new();
    let places = tensors.interface_positions.iter().zip(&tensors.interface_frames);
    for (node, (position, frame)) in metadata.interface_nodes.iter().zip(places) {
        let name = || node.name.clone();
        if !seen.insert((&node.name, node.label)) {
            return Err(FileError::InterfaceDuplicate { name: name(), label: node.label });
        }
        if node.dofs.is_empty() || !node.dofs.is_sorted_by(|a, b| a < b) {
            return Err(FileError::InterfaceDofs { name: name() });
        }
        if node.position != *position {
            return Err(FileError::InterfacePosition { name: name(), metadata: node.position, tensor: *position });
        }
        if !is_rotation(frame) {
            return Err(FileError::InterfaceFrame { name: name() });
        }
    }
    Ok(())
}

/// RᵀR = I and det R > 0.
fn is_rotation(frame: &[[f64; 3]; 3]) -> bool {
    let [a, b, c] = frame;
    let dot = |u: &[f64; 3], v: &[f64; 3]| u[0] * v[0] + u[1] * v[1] + u[2] * v[2];
    let cross = [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]];
    let near = |value: f64, target: f64| (value - target).abs() <= FRAME_TOLERANCE;
    let unit = [a, b, c].into_iter().all(|row| near(dot(row, row), 1.0));
    let orthogonal = [(a, b), (a, c), (b, c)].into_iter().all(|(u, v)| near(dot(u, v), 0.0));
    unit && orthogonal && dot(&cross, c) > 0.0
}

/// Whatever is declared unloaded must be there, and a direction of gravity be one.
fn check_validity(metadata: &Metadata) -> Result<()> {
    if metadata.validity.gravity.is_some_and(|along| along.iter().any(|entry| !entry.is_finite())) {
        return Err(FileError::GravityDirection);
    }
    let nodes = &metadata.interface_nodes;
    let is_there = |dof: &&InterfaceDof| nodes.get(dof.node).is_some_and(|node| node.dofs.contains(&dof.direction));
    match metadata.validity.unloaded.iter().find(|dof| !is_there(dof)) {
        Some(&InterfaceDof { node, direction }) => Err(FileError::UnloadedDof { node, direction }),
        None => Ok(()),
    }
}

fn check_coordinates(metadata: &Metadata) -> Result<()> {
    let coordinates = &metadata.coordinates;
    let from_nodes = metadata
        .interface_nodes
        .iter()
        .enumerate()
        .flat_map(|(node, interface)| interface.dofs.iter().map(move |&direction| (node, direction)));
    let mut n_from_nodes = 0;
    for (node, direction) in from_nodes {
        if coordinates.get(n_from_nodes) != Some(&Coordinate::Interface { node, direction }) {
            return Err(FileError::CoordinateOrder { coordinate: n_from_nodes });
        }
        n_from_nodes += 1;
    }
    let rest = coordinates.get(n_from_nodes..).unwrap_or_default();
    let n_rows = rest.iter().take_while(|coordinate| matches!(coordinate, Coordinate::InterfaceRow { .. })).count();
    match rest.iter().skip(n_rows).position(Coordinate::is_interface) {
        Some(stray) => Err(FileError::CoordinateOrder { coordinate: n_from_nodes + n_rows + stray }),
        None => Ok(()),
    }
}

/// What was held while modes were computed is part of the interface, each coordinate once.
fn check_modes_held(metadata: &Metadata) -> Result<()> {
    let n_interface = metadata.coordinates.iter().take_while(|coordinate| coordinate.is_interface()).count();
    let mut least = 0;
    for &coordinate in &metadata.modes_held {
        if coordinate < least || coordinate >= n_interface {
            return Err(FileError::ModesHeld { coordinate, n_interface });
        }
        least = coordinate + 1;
    }
    Ok(())
}

fn check_modes(tensors: &Tensors, metadata: &Metadata) -> Result<()> {
    let frequencies = &tensors.frequencies;
    if metadata.flags.contains(&Flag::StiffnessOnly) && !frequencies.is_empty() {
        return Err(FileError::WrongShape { tensor: "frequencies", found: vec![frequencies.len()], expected: vec![0] });
    }
    let mut last = 0.0;
    for (mode, &omega) in frequencies.iter().enumerate() {
        if omega < last {
            return Err(FileError::FrequencyOrder { mode, omega });
        }
        last = omega;
    }
    let mut named = vec![false; frequencies.len()];
    for (coordinate, description) in metadata.coordinates.iter().enumerate() {
        let Some((mode, frequency_hz)) = description.mode() else {
            continue;
        };
        let (Some(&omega), Some(named @ false)) = (frequencies.get(mode), named.get_mut(mode)) else {
            return Err(FileError::CoordinateMode { coordinate, mode, n_modes: frequencies.len() });
        };
        *named = true;
        if (frequency_hz * core::f64::consts::TAU - omega).abs() > CONVERSION_TOLERANCE * omega {
            return Err(FileError::CoordinateFrequency { coordinate, frequency_hz, omega });
        }
    }
    Ok(())
}

/// A residual vector is that of a load of the file, which has one at most.
fn check_residual_vectors(metadata: &Metadata) -> Result<()> {
    let mut has_one = vec![false; metadata.load_names.len()];
    for (coordinate, description) in metadata.coordinates.iter().enumerate() {
        let Coordinate::ResidualVector { load } = *description else { continue };
        let Some(has_one @ false) = has_one.get_mut(load) else {
            return Err(FileError::CoordinateLoad { coordinate, load, n_loads: metadata.load_names.len() });
        };
        *has_one = true;
    }
    Ok(())
}

//! Tensors to and from little-endian bytes.

use alloc::collections::BTreeMap;
use alloc::vec::Vec;

use crate::container::{Dtype, RawTensor, TENSORS, TensorToWrite};
use crate::direction::Direction;
use crate::error::{FileError, Result};
use crate::matrix::Matrix;
use crate::recovered_faces::RecoveredFaces;
use crate::tensors::{Precision, RecoveredDof, Recovery, Tensors};

/// The tensors that are there, in the order of the file.
pub(crate) fn encode(tensors: &Tensors) -> Vec<TensorToWrite> {
    TENSORS.into_iter().filter_map(|name| encode_one(tensors, name)).collect()
}

fn encode_one(tensors: &Tensors, name: &'static str) -> Option<TensorToWrite> {
    let doubles = |shape: Vec<usize>, values: &[f64]| {
        let bytes = values.iter().flat_map(|value| value.to_le_bytes()).collect();
        TensorToWrite { name, dtype: Dtype::F64, shape, bytes }
    };
    let matrix = |matrix: &Matrix| doubles(vec![matrix.rows(), matrix.cols()], matrix.as_slice());
    let nodes = tensors.interface_positions.len();
    // A superelement of the stiffness alone has neither of the two.
    let has_mass = tensors.mass.rows() > 0;
    Some(match name {
        "mass" | "rigid_body_mass" if !has_mass => return None,
        "stiffness" => matrix(&tensors.stiffness),
        "mass" => matrix(&tensors.mass),
        "rigid_body_modes" => matrix(&tensors.rigid_body_modes),
        "rigid_body_mass" => matrix(&tensors.rigid_body_mass),
        "damping" => matrix(tensors.damping.as_ref()?),
        "mixing" => matrix(tensors.mixing.as_ref()?),
        "gravity" => matrix(tensors.gravity.as_ref()?),
        "load_vectors" => matrix(tensors.load_vectors.as_ref()?),
        "quantities" => matrix(tensors.quantities.as_ref()?),
        "matrices" => {
            let first = tensors.matrices.first()?;
            let values: Vec<f64> = tensors.matrices.iter().flat_map(Matrix::as_slice).copied().collect();
            doubles(vec![tensors.matrices.len(), first.rows(), first.cols()], &values)
        }
        "frequencies" => doubles(vec![tensors.frequencies.len()], &tensors.frequencies),
        "interface_positions" => doubles(vec![nodes, 3], tensors.interface_positions.as_flattened()),
        "interface_frames" => doubles(vec![nodes, 3, 3], tensors.interface_frames.as_flattened().as_flattened()),
        "recovery_dofs" => recovered_dofs(tensors.recovery.as_ref()?),
        "recovery_positions" => {
            let positions = tensors.recovery.as_ref()?.positions()?;
            doubles(vec![positions.len(), 3], positions.as_flattened())
        }
        "recovery_faces" => integers(name, tensors.recovery.as_ref()?.faces()?.nodes().iter().copied()),
        "recovery_face_offsets" => integers(name, tensors.recovery.as_ref()?.faces()?.offsets()),
        "recovery" => match tensors.recovery.as_ref()? {
            Recovery { rows, precision: Precision::Double, .. } => matrix(rows),
            Recovery { rows, precision: Precision::Single, .. } => singles(rows),
        },
        _ => return None,
    })
}

fn singles(rows: &Matrix) -> TensorToWrite {
    let bytes = rows.as_slice().iter().flat_map(|&value| (value as f32).to_le_bytes()).collect();
    TensorToWrite { name: "recovery", dtype: Dtype::F32, shape: vec![rows.rows(), rows.cols()], bytes }
}

fn integers(name: &'static str, values: impl Iterator<Item = usize>) -> TensorToWrite {
    let values: Vec<i64> = values.map(|value| value as i64).collect();
    let bytes = values.iter().flat_map(|value| value.to_le_bytes()).collect();
    TensorToWrite { name, dtype: Dtype::I64, shape: vec![values.len()], bytes }
}

fn recovered_dofs(recovery: &Recovery) -> TensorToWrite {
    let pairs = recovery.dofs().iter().flat_map(|dof| [dof.node, dof.direction as i64]);
    let bytes = pairs.flat_map(i64::to_le_bytes).collect();
    TensorToWrite { name: "recovery_dofs", dtype: Dtype::I64, shape: vec![recovery.dofs().len(), 2], bytes }
}

/// Tensors of a file by name.
pub(crate) type RawTensors<'a> = BTreeMap<&'static str, RawTensor<'a>>;

/// The tensors of a file, each of its own type and number of dimensions; whether they fit each other is checked later.
pub(crate) fn decode(raw: &RawTensors) -> Result<Tensors> {
    let has_mass = find(raw, "mass").is_some();
    let of_mass = |name| match has_mass {
        true => matrix(require(raw, name)?),
        false => Ok(Matrix::default()),
    };
    Ok(Tensors {
        stiffness: matrix(require(raw, "stiffness")?)?,
        mass: of_mass("mass")?,
        rigid_body_modes: matrix(require(raw, "rigid_body_modes")?)?,
        rigid_body_mass: of_mass("rigid_body_mass")?,
        interface_positions: positions(require(raw, "interface_positions")?)?,
        interface_frames: frames(require(raw, "interface_frames")?)?,
        frequencies: vector(require(raw, "frequencies")?)?,
        damping: find(raw, "damping").map(matrix).transpose()?,
        mixing: find(raw, "mixing").map(matrix).transpose()?,
        gravity: find(raw, "gravity").map(matrix).transpose()?,
        load_vectors: find(raw, "load_vectors").map(matrix).transpose()?,
        recovery: recovery(raw)?,
        quantities: find(raw, "quantities").map(matrix).transpose()?,
        matrices: find(raw, "matrices").map(matrices).transpose()?.unwrap_or_default(),
    })
}

/// A tensor with its name, for the errors.
type Named<'a, 'b> = (&'static str, &'b RawTensor<'a>);

fn find<'a, 'b>(raw: &'b RawTensors<'a>, name: &'static str) -> Option<Named<'a, 'b>> {
    raw.get(name).map(|tensor| (name, tensor))
}

fn require<'a, 'b>(raw: &'b RawTensors<'a>, name: &'static str) -> Result<Named<'a, 'b>> {
    find(raw, name).ok_or(FileError::MissingTensor { tensor: name })
}

fn shape<const RANK: usize>((name, tensor): Named) -> Result<[usize; RANK]> {
    let wrong = |_| FileError::WrongRank { tensor: name, found: tensor.shape.clone(), expected: RANK };
    tensor.shape.as_slice().try_into().map_err(wrong)
}

fn doubles<'a>((name, tensor): Named<'a, '_>) -> Result<impl Iterator<Item = f64> + use<'a>> {
    match tensor.dtype {
        Dtype::F64 => Ok(tensor.bytes.as_chunks().0.iter().map(|&bytes| f64::from_le_bytes(bytes))),
        other => Err(FileError::WrongDtype { tensor: name, found: other.name(), expected: "F64" }),
    }
}

fn vector(tensor: Named) -> Result<Vec<f64>> {
    let [_] = shape(tensor)?;
    Ok(doubles(tensor)?.collect())
}

fn matrix(tensor: Named) -> Result<Matrix> {
    let [rows, cols] = shape(tensor)?;
    Matrix::from_row_major(rows, cols, doubles(tensor)?.collect())
}

/// Matrices one after the other. Empty ones take no bytes, so that any number of them could be promised.
fn matrices(tensor: Named) -> Result<Vec<Matrix>> {
    let found @ [n, rows, cols] = shape(tensor)?;
    if found.contains(&0) {
        let expected = [n, rows, cols].map(|length| length.max(1)).to_vec();
        return Err(FileError::WrongShape { tensor: tensor.0, found: found.to_vec(), expected });
    }
    let values: Vec<f64> = doubles(tensor)?.collect();
    // Checked by the container: the values are as many as the shape says.
    values.chunks_exact(rows * cols).map(|own| Matrix::from_row_major(rows, cols, own.to_vec())).collect()
}

fn positions(tensor: Named) -> Result<Vec<[f64; 3]>> {
    let [k, three] = shape(tensor)?;
    if three != 3 {
        return Err(FileError::WrongShape { tensor: tensor.0, found: vec![k, three], expected: vec![k, 3] });
    }
    Ok(doubles(tensor)?.collect::<Vec<_>>().as_chunks().0.to_vec())
}

fn frames(tensor: Named) -> Result<Vec<[[f64; 3]; 3]>> {
    let found @ [k, ..] = shape::<3>(tensor)?;
    if found != [k, 3, 3] {
        return Err(FileError::WrongShape { tensor: tensor.0, found: found.to_vec(), expected: vec![k, 3, 3] });
    }
    Ok(doubles(tensor)?.collect::<Vec<_>>().as_chunks::<3>().0.as_chunks().0.to_vec())
}

fn recovery(raw: &RawTensors) -> Result<Option<Recovery>> {
    let places = find(raw, "recovery_positions");
    let faces = [find(raw, "recovery_faces"), find(raw, "recovery_face_offsets")];
    let belongs = places.is_some() || faces.iter().any(Option::is_some);
    let (rows, dofs) = match (find(raw, "recovery"), find(raw, "recovery_dofs")) {
        (Some(rows), Some(dofs)) => (rows, dofs),
        (None, None) if belongs => return Err(FileError::RecoveryIncomplete { missing: "recovery" }),
        (None, None) => return Ok(None),
        (None, Some(_)) => return Err(FileError::RecoveryIncomplete { missing: "recovery" }),
        (Some(_), None) => {
            return Err(FileError::RecoveryIncomplete { missing: "recovery_dofs" });
        }
    };
    let dofs = read_recovered_dofs(dofs)?;
    let recovery = match rows.1.dtype {
        Dtype::F32 => {
            let [n_rows, n_cols] = shape(rows)?;
            let values = rows.1.bytes.as_chunks().0.iter().map(|&bytes| f64::from(f32::from_le_bytes(bytes)));
            let rows = Matrix::from_row_major(n_rows, n_cols, values.collect())?;
            Recovery::new(rows, dofs, Precision::Single)?
        }
        Dtype::F64 => Recovery::new(matrix(rows)?, dofs, Precision::Double)?,
        Dtype::I64 => {
            let found = Dtype::I64.name();
            return Err(FileError::WrongDtype { tensor: "recovery", found, expected: "F64 or F32" });
        }
    };
    let recovery = match places {
        Some(places) => recovery.with_positions(positions(places)?)?,
        None => recovery,
    };
    with_faces(recovery, faces).map(Some)
}

/// A recovery with the faces of the file: nodes, and offsets.
fn with_faces(recovery: Recovery, faces: [Option<Named>; 2]) -> Result<Recovery> {
    let (nodes, offsets) = match faces {
        [Some(nodes), Some(offsets)] => (read_integers(nodes)?, read_integers(offsets)?),
        [None, None] => return Ok(recovery),
        [None, _] => return Err(FileError::RecoveryIncomplete { missing: "recovery_faces" }),
        [_, None] => return Err(FileError::RecoveryIncomplete { missing: "recovery_face_offsets" }),
    };
    let positions = recovery.positions().ok_or(FileError::RecoveryIncomplete { missing: "recovery_positions" })?;
    let faces = RecoveredFaces::from_file(&nodes, &offsets, positions.len())?;
    recovery.with_faces(faces)
}

fn read_integers((name, tensor): Named) -> Result<Vec<i64>> {
    let [_] = shape((name, tensor))?;
    integers_of((name, tensor))
}

fn integers_of((name, tensor): Named) -> Result<Vec<i64>> {
    match tensor.dtype {
        Dtype::I64 => Ok(tensor.bytes.as_chunks().0.iter().map(|&bytes| i64::from_le_bytes(bytes)).collect()),
        other => Err(FileError::WrongDtype { tensor: name, found: other.name(), expected: "I64" }),
    }
}

fn read_recovered_dofs((name, tensor): Named) -> Result<Vec<RecoveredDof>> {
    let [n_rows, two] = shape((name, tensor))?;
    let numbers = integers_of((name, tensor))?;
    if two != 2 {
        return Err(FileError::WrongShape { tensor: name, found: vec![n_rows, two], expected: vec![n_rows, 2] });
    }
    let pairs = numbers.as_chunks().0.iter().enumerate();
    pairs
        .map(|(row, &[node, direction])| {
            let known = usize::try_from(direction).ok().and_then(|direction| Direction::ALL.get(direction));
            let direction = *known.ok_or(FileError::RecoveryDirection { row, direction })?;
            Ok(RecoveredDof { node, direction })
        })
        .collect()
}

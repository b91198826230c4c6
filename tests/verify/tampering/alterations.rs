//! Changes of tensors, and of several fields together by somebody who knows what they mean.

use std::num::NonZero;

use supel_runtime::{
    Coordinate, Matrix, MatrixKind, Metadata, Precision, RecoveredDof, RecoveredFaces, Recovery, RigidBodyModes,
    Superelement, Tensors, Verdict,
};

/// One change; false where the superelement has nothing to change.
pub(super) struct Alteration {
    pub(super) field: &'static str,
    pub(super) what: &'static str,
    pub(super) alter: fn(&mut Tensors, &mut Metadata) -> bool,
}

const SLIGHTLY: f64 = 1.0 + 1e-6;

/// Whether the interface does more than hold the component: otherwise K̂_BB is rounding.
fn has_statics(tensors: &Tensors, metadata: &Metadata) -> bool {
    let diagonal = |i: usize| tensors.stiffness[(i, i)];
    let largest = (0..tensors.stiffness.rows()).map(diagonal).fold(0.0, f64::max);
    n_interface(metadata) > 0 && (0..n_interface(metadata)).all(|i| diagonal(i) > 1e-9 * largest)
}

/// Rows of interface coordinates.
fn n_interface(metadata: &Metadata) -> usize {
    metadata.coordinates.iter().filter(|coordinate| coordinate.is_interface()).count()
}

/// The entry in a block that is largest relative to its diagonal.
fn largest(matrix: &Matrix, rows: std::ops::Range<usize>, cols: std::ops::Range<usize>) -> Option<(usize, usize)> {
    let size = |(i, j): (usize, usize)| matrix[(i, j)].abs() / (matrix[(i, i)] * matrix[(j, j)]).abs().sqrt();
    let places = rows.flat_map(|i| cols.clone().map(move |j| (i, j))).filter(|(i, j)| i < j);
    let found = places.max_by(|a, b| size(*a).total_cmp(&size(*b)));
    found.filter(|place| size(*place) > 1e-2)
}

/// Multiplies an entry and its twin.
fn scaled(matrix: &mut Matrix, (i, j): (usize, usize), factor: f64) -> bool {
    let value = matrix[(i, j)] * factor;
    let changed = Matrix::from_fn(matrix.rows(), matrix.cols(), |row, col| {
        if (row, col) == (i, j) || (row, col) == (j, i) { value } else { matrix[(row, col)] }
    });
    let is_changed = changed != *matrix;
    *matrix = changed;
    is_changed
}

/// Adds to an entry and its twin a share of the diagonal.
fn coupled(matrix: &mut Matrix, (i, j): (usize, usize), share: f64) -> bool {
    let by = share * (matrix[(i, i)] * matrix[(j, j)]).abs().sqrt();
    *matrix = Matrix::from_fn(matrix.rows(), matrix.cols(), |row, col| {
        matrix[(row, col)] + if (row, col) == (i, j) || (row, col) == (j, i) { by } else { 0.0 }
    });
    by != 0.0
}

/// Multiplies the largest entry that the first load has in some rows.
fn largest_of_load(tensors: &mut Tensors, rows: std::ops::Range<usize>) -> bool {
    let Some(loads) = &mut tensors.load_vectors else { return false };
    let largest = rows.max_by(|a, b| loads[(*a, 0)].abs().total_cmp(&loads[(*b, 0)].abs()));
    largest.is_some_and(|row| entry(loads, (row, 0), SLIGHTLY))
}

/// Multiplies one entry of a matrix that is not symmetric.
fn entry(matrix: &mut Matrix, at: (usize, usize), factor: f64) -> bool {
    let is_there = at.0 < matrix.rows() && at.1 < matrix.cols() && matrix[at] != 0.0;
    *matrix =
        Matrix::from_fn(matrix.rows(), matrix.cols(), |i, j| matrix[(i, j)] * if (i, j) == at { factor } else { 1.0 });
    is_there
}

/// The first further matrix of a kind.
fn first_of_kind<'a>(tensors: &'a mut Tensors, metadata: &Metadata, kind: MatrixKind) -> Option<&'a mut Matrix> {
    let at = metadata.matrices.iter().position(|matrix| matrix.kind == kind)?;
    tensors.matrices.get_mut(at)
}

/// The largest entry of some columns of a matrix.
fn largest_in(matrix: &Matrix, rows: std::ops::Range<usize>, cols: std::ops::Range<usize>) -> Option<(usize, usize)> {
    let places = rows.flat_map(|i| cols.clone().map(move |j| (i, j)));
    places.max_by(|a, b| matrix[*a].abs().total_cmp(&matrix[*b].abs()))
}

fn last_modal(metadata: &Metadata) -> Option<usize> {
    let r = metadata.coordinates.len();
    (r > n_interface(metadata)).then(|| r - 1)
}

fn first_mode(metadata: &Metadata) -> Option<usize> {
    metadata.coordinates.iter().position(|coordinate| coordinate.mode().is_some())
}

fn rows_of(recovery: &Recovery, change: impl FnOnce(&Matrix) -> Matrix) -> Option<Recovery> {
    let rows = change(recovery.rows());
    (rows != *recovery.rows()).then(|| with_places_of(recovery, rows, recovery.dofs().to_vec(), recovery.precision()))
}

/// Other rows at the nodes of a recovery.
fn with_places_of(recovery: &Recovery, rows: Matrix, dofs: Vec<RecoveredDof>, precision: Precision) -> Recovery {
    let new = Recovery::new(rows, dofs, precision).expect("as many dofs as rows");
    let placed = match recovery.positions() {
        Some(positions) => new.with_positions(positions.to_vec()).expect("as many positions as nodes"),
        None => new,
    };
    match recovery.faces() {
        Some(faces) => placed.with_faces(faces.clone()).expect("faces of as many nodes"),
        None => placed,
    }
}

/// Changes the faces between recovered nodes.
fn faced(tensors: &mut Tensors, change: impl FnOnce(&mut Vec<Vec<usize>>)) -> bool {
    let Some(recovery) = tensors.recovery.as_ref() else { return false };
    let (Some(faces), Some(positions)) = (recovery.faces(), recovery.positions()) else { return false };
    let mut all: Vec<Vec<usize>> = faces.iter().map(<[usize]>::to_vec).collect();
    change(&mut all);
    let changed = RecoveredFaces::new(all.iter().map(Vec::as_slice), positions.len()).expect("faces");
    let is_changed = changed != *faces;
    tensors.recovery = recovery.clone().with_faces(changed).ok();
    is_changed
}

fn recovered(tensors: &mut Tensors, change: impl FnOnce(&Matrix) -> Matrix) -> bool {
    let new = tensors.recovery.as_ref().and_then(|recovery| rows_of(recovery, change));
    let is_changed = new.is_some();
    tensors.recovery = new.or(tensors.recovery.take());
    is_changed
}

/// Changes the positions of recovered nodes.
fn placed(tensors: &mut Tensors, change: impl FnOnce(&mut [[f64; 3]])) -> bool {
    let Some(recovery) = tensors.recovery.as_ref() else { return false };
    let Some(mut positions) = recovery.positions().map(<[[f64; 3]]>::to_vec) else { return false };
    change(&mut positions);
    let is_changed = recovery.positions() != Some(&positions[..]);
    tensors.recovery = recovery.clone().with_positions(positions).ok();
    is_changed
}

/// Leaves the coordinates out of every tensor, as a reduction that kept fewer would. Mixing is triangular, so that its leading
/// block stays what it was where the last columns go.
fn keep(tensors: &mut Tensors, metadata: &mut Metadata, kept: &[usize]) {
    let n_b = n_interface(metadata);
    let all = |matrix: &Matrix| -> Vec<usize> { (0..matrix.cols()).collect() };
    let of = |matrix: &Matrix, rows: &[usize], cols: &[usize]| {
        Matrix::from_fn(rows.len(), cols.len(), |i, j| matrix[(rows[i], cols[j])])
    };
    tensors.stiffness = of(&tensors.stiffness, kept, kept);
    tensors.mass = of(&tensors.mass, kept, kept);
    tensors.rigid_body_modes = of(&tensors.rigid_body_modes, kept, &all(&tensors.rigid_body_modes));
    tensors.gravity = tensors.gravity.as_ref().map(|gravity| of(gravity, kept, &all(gravity)));
    let modal: Vec<usize> = kept.iter().filter(|at| **at >= n_b).map(|at| at - n_b).collect();
    tensors.mixing = tensors.mixing.as_ref().map(|mixing| of(mixing, &modal, &modal));
    tensors.recovery = tensors.recovery.as_ref().map(|recovery| {
        let rows: Vec<usize> = (0..recovery.rows().rows()).collect();
        let kept = of(recovery.rows(), &rows, kept);
        with_places_of(recovery, kept, recovery.dofs().to_vec(), recovery.precision())
    });
    let square = |matrix: &Matrix| of(matrix, kept, kept);
    tensors.damping = tensors.damping.as_ref().map(square);
    tensors.matrices = tensors.matrices.iter().map(square).collect();
    tensors.quantities = tensors.quantities.as_ref().map(|rows| of(rows, &(0..rows.rows()).collect::<Vec<_>>(), kept));
    metadata.coordinates = kept.iter().map(|at| metadata.coordinates[*at].clone()).collect();
}

/// Leaves modes out: all from one number on, with their frequencies and the band, as a job that asks for fewer would.
fn without_modes_from(tensors: &mut Tensors, metadata: &mut Metadata, first: usize) -> bool {
    if first >= tensors.frequencies.len() {
        return false;
    }
    let is_kept = |coordinate: &Coordinate| coordinate.mode().is_none_or(|(mode, _)| mode < first);
    let kept: Vec<usize> = (0..metadata.coordinates.len()).filter(|at| is_kept(&metadata.coordinates[*at])).collect();
    keep(tensors, metadata, &kept);
    metadata.dropped.retain(|dropped| is_kept(&dropped.column));
    tensors.frequencies.truncate(first);
    true
}

/// Multiplies the k-th frequency, wherever it stands.
fn frequency(tensors: &mut Tensors, metadata: &mut Metadata, k: usize, factor: f64) -> bool {
    let Some(omega) = tensors.frequencies.get_mut(k) else { return false };
    *omega *= factor;
    let hertz = *omega / std::f64::consts::TAU;
    for coordinate in &mut metadata.coordinates {
        if let Coordinate::ElasticMode { mode, frequency_hz, .. }
        | Coordinate::FixedInterfaceMode { mode, frequency_hz, .. } = coordinate
            && *mode == k
        {
            *frequency_hz = hertz;
        }
    }
    true
}

fn bars(metadata: &mut Metadata, set: impl Fn(Option<f64>) -> Option<f64>) -> bool {
    let mut is_changed = false;
    for coordinate in &mut metadata.coordinates {
        if let Coordinate::ElasticMode { error_bar_hz, .. } | Coordinate::FixedInterfaceMode { error_bar_hz, .. } =
            coordinate
        {
            let new = set(*error_bar_hz);
            is_changed |= new != *error_bar_hz;
            *error_bar_hz = new;
        }
    }
    is_changed
}

fn job(metadata: &mut Metadata, path: &str, value: serde_json::Value) -> bool {
    let (parent, key) = path.rsplit_once('/').expect("a path");
    let Some(object) = metadata.job.pointer_mut(parent).and_then(serde_json::Value::as_object_mut) else {
        return false;
    };
    object.insert(key.to_owned(), value.clone()) != Some(value)
}

const INTERFACE_LEFT_OUT: &str = "an interface coordinate said to be left out";

fn node_moved(t: &mut Tensors, m: &mut Metadata) -> bool {
    let (Some(position), Some(node)) = (t.interface_positions.last_mut(), m.interface_nodes.last_mut()) else {
        return false;
    };
    let size = position.iter().fold(0.0f64, |max, x| max.max(x.abs()));
    position[2] += 1e-6 * size;
    node.position = *position;
    size > 0.0
}

fn leave_out_interface(_: &mut Tensors, metadata: &mut Metadata) -> bool {
    let Some(column) = metadata.coordinates.first().filter(|coordinate| coordinate.is_interface()).cloned() else {
        return false;
    };
    let cause = supel_runtime::DropCause::Spanned;
    metadata.dropped.push(supel_runtime::DroppedColumn { column, reason: "for no reason".to_owned(), cause });
    true
}

pub(super) const ALTERATIONS: &[Alteration] = &[
    Alteration {
        field: "stiffness",
        what: "a diagonal entry of the interface × (1 + 1e-6)",
        alter: |t, m| has_statics(t, m) && scaled(&mut t.stiffness, (0, 0), SLIGHTLY),
    },
    Alteration {
        field: "stiffness",
        what: "the largest coupling of the interface × (1 + 1e-6)",
        alter: |t, m| {
            let b = n_interface(m);
            has_statics(t, m)
                && largest(&t.stiffness, 0..b, 0..b).is_some_and(|at| scaled(&mut t.stiffness, at, SLIGHTLY))
        },
    },
    Alteration {
        field: "stiffness",
        what: "the first modal entry × (1 + 1e-6)",
        alter: |t, m| first_mode(m).is_some_and(|at| scaled(&mut t.stiffness, (at, at), SLIGHTLY)),
    },
    Alteration {
        field: "stiffness",
        what: "the last modal entry × (1 + 1e-6)",
        alter: |t, m| last_modal(m).is_some_and(|at| scaled(&mut t.stiffness, (at, at), SLIGHTLY)),
    },
    Alteration {
        field: "stiffness",
        what: "interface and a mode coupled by 1e-6 of their entries",
        alter: |t, m| last_modal(m).is_some_and(|at| has_statics(t, m) && coupled(&mut t.stiffness, (0, at), 1e-6)),
    },
    Alteration {
        field: "stiffness",
        what: "two modes coupled by 1e-6 of their entries",
        alter: |t, m| {
            let b = n_interface(m);
            last_modal(m).is_some_and(|at| at > b && coupled(&mut t.stiffness, (b, at), 1e-6))
        },
    },
    Alteration {
        field: "mass",
        what: "a diagonal entry of the interface × (1 + 1e-6)",
        alter: |t, m| n_interface(m) > 0 && scaled(&mut t.mass, (0, 0), SLIGHTLY),
    },
    Alteration {
        field: "mass",
        what: "the largest coupling of the interface × (1 + 1e-6)",
        alter: |t, m| {
            let b = n_interface(m);
            largest(&t.mass, 0..b, 0..b).is_some_and(|at| scaled(&mut t.mass, at, SLIGHTLY))
        },
    },
    Alteration {
        field: "mass",
        what: "the largest entry between interface and modes × (1 + 1e-6)",
        alter: |t, m| {
            let b = n_interface(m);
            largest(&t.mass, 0..b, b..m.coordinates.len()).is_some_and(|at| scaled(&mut t.mass, at, SLIGHTLY))
        },
    },
    Alteration {
        field: "mass",
        what: "the last modal entry × (1 + 1e-6)",
        alter: |t, m| last_modal(m).is_some_and(|at| scaled(&mut t.mass, (at, at), SLIGHTLY)),
    },
    Alteration {
        field: "rigid_body_modes",
        what: "the largest entry × (1 + 1e-6)",
        alter: |t, _| {
            let (rows, cols) = (t.rigid_body_modes.rows(), t.rigid_body_modes.cols());
            largest_in(&t.rigid_body_modes, 0..rows, 0..cols)
                .is_some_and(|at| entry(&mut t.rigid_body_modes, at, SLIGHTLY))
        },
    },
    Alteration {
        field: "rigid_body_modes",
        what: "the last taken out",
        alter: |t, m| {
            let (r, n) = (t.rigid_body_modes.rows(), t.rigid_body_modes.cols());
            if n == 0 {
                return false;
            }
            let fewer = |matrix: &Matrix, rows| Matrix::from_fn(rows, n - 1, |i, j| matrix[(i, j)]);
            t.rigid_body_modes = fewer(&t.rigid_body_modes, r);
            t.rigid_body_mass = fewer(&t.rigid_body_mass, n - 1);
            m.model.rigid_body_modes = RigidBodyModes::Algebraic;
            m.model.mass_properties = None;
            true
        },
    },
    Alteration {
        field: "rigid_body_mass",
        what: "an entry × (1 + 1e-6)",
        alter: |t, _| t.rigid_body_mass.cols() > 0 && scaled(&mut t.rigid_body_mass, (0, 0), SLIGHTLY),
    },
    Alteration {
        field: "rigid_body_mass",
        what: "one of two mirrored entries × (1 + 1e-6)",
        alter: |t, _| {
            let n = t.rigid_body_mass.cols();
            largest(&t.rigid_body_mass, 0..n, 0..n).is_some_and(|(i, j)| {
                let below = (i.max(j), i.min(j));
                entry(&mut t.rigid_body_mass, below, SLIGHTLY)
            })
        },
    },
    Alteration {
        field: "interface_positions",
        what: "moved by 1e-6 of the distance, with the node",
        alter: |t, m| t.rigid_body_mass.rows() > 0 && node_moved(t, m),
    },
    Alteration {
        field: "interface_positions",
        what: "moved by 1e-6 of the distance, with the node, on supports",
        alter: |t, m| t.rigid_body_mass.rows() == 0 && node_moved(t, m),
    },
    Alteration {
        field: "interface_frames",
        what: "turned",
        alter: |t, _| {
            let Some(frame) = t.interface_frames.first_mut() else { return false };
            *frame = [[0.0, -1.0, 0.0], [1.0, 0.0, 0.0], [0.0, 0.0, 1.0]];
            true
        },
    },
    Alteration {
        field: "frequencies",
        what: "the first × (1 + 1e-6), wherever it stands",
        alter: |t, m| frequency(t, m, 0, SLIGHTLY),
    },
    Alteration {
        field: "frequencies",
        what: "the last × (1 + 1e-6), wherever it stands",
        alter: |t, m| {
            let last = t.frequencies.len().wrapping_sub(1);
            frequency(t, m, last, SLIGHTLY)
        },
    },
    Alteration {
        field: "frequencies",
        what: "the last mode left out everywhere",
        alter: |t, m| {
            let n = t.frequencies.len();
            n > 0 && without_modes_from(t, m, n - 1)
        },
    },
    Alteration {
        field: "frequencies",
        what: "all modes but one left out everywhere",
        alter: |t, m| without_modes_from(t, m, 1),
    },
    Alteration {
        field: "frequencies",
        what: "all modes left out everywhere",
        alter: |t, m| without_modes_from(t, m, 0),
    },
    Alteration {
        field: "mixing",
        what: "a diagonal entry × (1 + 1e-6)",
        alter: |t, _| {
            let n = t.mixing.as_ref().map_or(0, Matrix::cols);
            n > 0 && t.mixing.as_mut().is_some_and(|mixing| entry(mixing, (n - 1, n - 1), SLIGHTLY))
        },
    },
    Alteration { field: "mixing", what: "taken out", alter: |t, _| t.mixing.take().is_some() },
    Alteration {
        field: "mixing",
        what: "the identity put in",
        alter: |t, m| {
            let n = m.coordinates.len() - n_interface(m);
            let is_new = t.mixing.is_none() && n > 0;
            if is_new {
                t.mixing = Some(Matrix::from_fn(n, n, |i, j| f64::from(u8::from(i == j))));
            }
            is_new
        },
    },
    Alteration {
        field: "gravity",
        what: "the largest entry × (1 + 1e-6)",
        alter: |t, _| {
            t.gravity.as_mut().is_some_and(|gravity| {
                let at = largest_in(gravity, 0..gravity.rows(), 0..3).expect("an entry");
                entry(gravity, at, SLIGHTLY)
            })
        },
    },
    Alteration {
        field: "gravity",
        what: "the largest modal entry × (1 + 1e-6)",
        alter: |t, m| {
            let b = n_interface(m);
            t.gravity.as_mut().is_some_and(|gravity| {
                largest_in(gravity, b..gravity.rows(), 0..3).is_some_and(|at| entry(gravity, at, SLIGHTLY))
            })
        },
    },
    Alteration { field: "gravity", what: "taken out", alter: |t, _| t.gravity.take().is_some() },
    Alteration {
        field: "recovery",
        what: "the largest interface entry × 1.01",
        alter: |t, m| {
            let b = n_interface(m);
            b > 0
                && recovered(t, |rows| {
                    let mut new = rows.clone();
                    let at = largest_in(rows, 0..rows.rows(), 0..b).expect("an entry");
                    entry(&mut new, at, 1.01);
                    new
                })
        },
    },
    Alteration {
        field: "recovery",
        what: "the largest modal entry × 1.01",
        alter: |t, m| {
            let b = n_interface(m);
            m.coordinates.len() > b
                && recovered(t, |rows| {
                    let mut new = rows.clone();
                    let at = largest_in(rows, 0..rows.rows(), b..rows.cols()).expect("an entry");
                    entry(&mut new, at, 1.01);
                    new
                })
        },
    },
    Alteration {
        field: "recovery",
        what: "two rows of a node exchanged",
        alter: |t, _| {
            recovered(t, |rows| {
                let other = |i: usize| if i < 2 { 1 - i } else { i };
                Matrix::from_fn(rows.rows(), rows.cols(), |i, j| rows[(other(i), j)])
            })
        },
    },
    Alteration {
        field: "recovery",
        what: "two nodes exchanged",
        alter: |t, _| {
            recovered(t, |rows| {
                let other = |i: usize| {
                    if i < 3 {
                        i + 3
                    } else if i < 6 {
                        i - 3
                    } else {
                        i
                    }
                };
                Matrix::from_fn(rows.rows(), rows.cols(), |i, j| rows[(other(i), j)])
            })
        },
    },
    Alteration {
        field: "recovery",
        what: "every seventh value × 1.5",
        alter: |t, _| {
            recovered(t, |rows| {
                let factor = |i: usize, j: usize| if (i * rows.cols() + j).is_multiple_of(7) { 1.5 } else { 1.0 };
                Matrix::from_fn(rows.rows(), rows.cols(), |i, j| rows[(i, j)] * factor(i, j))
            })
        },
    },
    Alteration { field: "recovery", what: "taken out", alter: |t, _| t.recovery.take().is_some() },
    Alteration {
        field: "recovery",
        what: "kept in the other precision",
        alter: |t, _| {
            let Some(recovery) = &t.recovery else { return false };
            let other = match recovery.precision() {
                Precision::Single => Precision::Double,
                Precision::Double => Precision::Single,
            };
            let dofs = recovery.dofs().to_vec();
            t.recovery = Some(with_places_of(recovery, recovery.rows().clone(), dofs, other));
            true
        },
    },
    Alteration {
        field: "recovery_dofs",
        what: "another node",
        alter: |t, _| {
            let Some(recovery) = &t.recovery else { return false };
            let mut dofs: Vec<RecoveredDof> = recovery.dofs().to_vec();
            let label = dofs[0].node;
            dofs.iter_mut().filter(|dof| dof.node == label).for_each(|dof| dof.node += 1000);
            t.recovery = Some(with_places_of(recovery, recovery.rows().clone(), dofs, recovery.precision()));
            true
        },
    },
    Alteration {
        field: "recovery_dofs",
        what: "two directions exchanged",
        alter: |t, _| {
            let Some(recovery) = &t.recovery else { return false };
            let mut dofs: Vec<RecoveredDof> = recovery.dofs().to_vec();
            let (a, b) = (dofs[0].direction, dofs[1].direction);
            (dofs[0].direction, dofs[1].direction) = (b, a);
            t.recovery = Some(with_places_of(recovery, recovery.rows().clone(), dofs, recovery.precision()));
            true
        },
    },
    Alteration {
        field: "quantities",
        what: "the smallest row × 1.01",
        alter: |t, _| {
            let Some(rows) = &mut t.quantities else { return false };
            *rows = Matrix::from_fn(rows.rows(), rows.cols(), |i, j| rows[(i, j)] * if i == 0 { 1.01 } else { 1.0 });
            true
        },
    },
    Alteration {
        field: "quantities",
        what: "every seventh value × 1.5",
        alter: |t, _| {
            let Some(rows) = &mut t.quantities else { return false };
            let factor = |at: usize| if at.is_multiple_of(7) { 1.5 } else { 1.0 };
            *rows = Matrix::from_fn(rows.rows(), rows.cols(), |i, j| rows[(i, j)] * factor(i * rows.cols() + j));
            true
        },
    },
    Alteration {
        field: "quantities",
        what: "two rows exchanged",
        alter: |t, _| {
            let Some(rows) = &mut t.quantities else { return false };
            *rows = Matrix::from_fn(rows.rows(), rows.cols(), |i, j| rows[(rows.rows() - 1 - i, j)]);
            true
        },
    },
    Alteration {
        field: "quantities",
        what: "taken out with their names",
        alter: |t, m| {
            m.quantities.clear();
            t.quantities.take().is_some()
        },
    },
    Alteration {
        field: "recovery_faces",
        what: "a face turned over",
        alter: |t, _| faced(t, |faces| faces[0].reverse()),
    },
    Alteration { field: "recovery_faces", what: "a face left out", alter: |t, _| faced(t, |faces| drop(faces.pop())) },
    Alteration {
        field: "recovery_faces",
        what: "taken out",
        alter: |t, _| {
            let Some(recovery) = t.recovery.as_ref().filter(|recovery| recovery.faces().is_some()) else {
                return false;
            };
            let positions = recovery.positions().expect("faces have positions").to_vec();
            let bare = Recovery::new(recovery.rows().clone(), recovery.dofs().to_vec(), recovery.precision());
            t.recovery = bare.and_then(|bare| bare.with_positions(positions)).ok();
            true
        },
    },
    Alteration {
        field: "recovery_face_offsets",
        what: "a corner left out",
        alter: |t, _| {
            faced(t, |faces| faces.iter_mut().filter(|face| face.len() == 4).take(1).for_each(|face| face.truncate(3)))
        },
    },
    Alteration {
        field: "recovery_positions",
        what: "a node elsewhere",
        alter: |t, _| {
            placed(t, |positions| {
                let size = positions.iter().flatten().fold(0.0f64, |size, x| size.max(x.abs()));
                positions[0][1] += 1e-3 * size;
            })
        },
    },
    Alteration {
        field: "recovery_positions",
        what: "two nodes exchanged",
        alter: |t, _| placed(t, |positions| positions.swap(0, 1)),
    },
    Alteration {
        field: "recovery_positions",
        what: "taken out",
        alter: |t, _| {
            let Some(recovery) = t.recovery.as_ref().filter(|recovery| recovery.positions().is_some()) else {
                return false;
            };
            let dofs = recovery.dofs().to_vec();
            t.recovery = Recovery::new(recovery.rows().clone(), dofs, recovery.precision()).ok();
            true
        },
    },
    Alteration {
        field: "damping",
        what: "an entry changed",
        alter: |t, _| {
            let Some(damping) = &mut t.damping else { return false };
            largest_in(damping, 0..damping.rows(), 0..damping.cols()).is_some_and(|at| entry(damping, at, SLIGHTLY))
        },
    },
    Alteration { field: "damping", what: "taken out", alter: |t, _| t.damping.take().is_some() },
    Alteration {
        field: "matrices",
        what: "an entry of a damping matrix changed",
        alter: |t, m| {
            let Some(matrix) = first_of_kind(t, m, MatrixKind::Damping) else { return false };
            largest_in(matrix, 0..matrix.rows(), 0..matrix.cols()).is_some_and(|at| entry(matrix, at, SLIGHTLY))
        },
    },
    Alteration {
        field: "matrices",
        what: "a skew matrix turned over",
        alter: |t, m| {
            let Some(matrix) = first_of_kind(t, m, MatrixKind::Gyroscopic) else { return false };
            *matrix = Matrix::from_fn(matrix.rows(), matrix.cols(), |i, j| matrix[(j, i)]);
            true
        },
    },
    Alteration {
        field: "matrices",
        what: "taken out, with their names",
        alter: |t, m| {
            m.matrices.clear();
            !std::mem::take(&mut t.matrices).is_empty()
        },
    },
    Alteration {
        field: "damping",
        what: "put in",
        alter: |t, _| {
            t.damping = Some(t.stiffness.clone());
            true
        },
    },
    Alteration {
        field: "load_vectors",
        what: "put in, with a name",
        alter: |t, m| {
            t.load_vectors = Some(Matrix::from_fn(t.stiffness.rows(), 1, |i, _| i as f64));
            m.load_names = vec!["wind".to_owned()];
            true
        },
    },
    Alteration {
        field: "load_vectors",
        what: "the largest modal entry of the first × (1 + 1e-6)",
        alter: |t, m| largest_of_load(t, n_interface(m)..m.coordinates.len()),
    },
    Alteration {
        field: "load_vectors",
        what: "the largest interface entry of the first × (1 + 1e-6)",
        alter: |t, m| largest_of_load(t, 0..n_interface(m)),
    },
    Alteration {
        field: "load_vectors",
        what: "the first two exchanged",
        alter: |t, _| {
            let Some(loads) = t.load_vectors.take().filter(|loads| loads.cols() > 1) else { return false };
            let column = |j: usize| if j < 2 { 1 - j } else { j };
            t.load_vectors = Some(Matrix::from_fn(loads.rows(), loads.cols(), |i, j| loads[(i, column(j))]));
            true
        },
    },
    Alteration {
        field: "load_names[]",
        what: "the first two exchanged",
        alter: |_, m| {
            let has_two = m.load_names.len() > 1;
            if has_two {
                m.load_names.swap(0, 1);
            }
            has_two
        },
    },
    Alteration {
        field: "load_names[]",
        what: "put in, with a vector",
        alter: |t, m| {
            t.load_vectors = Some(Matrix::from_fn(t.stiffness.rows(), 1, |i, _| i as f64));
            m.load_names = vec!["wind".to_owned()];
            true
        },
    },
    Alteration { field: "coordinates[].error_bar_hz", what: "all set to 0", alter: |_, m| bars(m, |_| Some(0.0)) },
    Alteration { field: "coordinates[].error_bar_hz", what: "all set to 1e9", alter: |_, m| bars(m, |_| Some(1e9)) },
    Alteration { field: "coordinates[].error_bar_hz", what: "all taken out", alter: |_, m| bars(m, |_| None) },
    Alteration {
        field: "coordinates[].error_bar_hz",
        what: "all set to 1e9, and the first modal stiffness × 1.001",
        alter: |t, m| {
            bars(m, |_| Some(1e9)) && first_mode(m).is_some_and(|at| scaled(&mut t.stiffness, (at, at), 1.001))
        },
    },
    Alteration {
        field: "coordinates[].error_bar_hz",
        what: "all set to 1e9, and a stiffness of the interface × 1.001",
        alter: |t, m| n_interface(m) > 0 && bars(m, |_| Some(1e9)) && scaled(&mut t.stiffness, (0, 0), 1.001),
    },
    Alteration {
        field: "coordinates[].kind",
        what: "the last coordinate and its columns taken out, its frequency left",
        alter: |t, m| {
            let Some(last) = last_modal(m) else { return false };
            keep(t, m, &(0..last).collect::<Vec<_>>());
            true
        },
    },
    Alteration {
        field: "dropped[].cause",
        what: "said to be a mode that nothing sees",
        alter: |_, m| {
            let dropped = m.dropped.first_mut();
            dropped.is_some_and(|dropped| {
                dropped.cause = supel_runtime::DropCause::Unseen;
                true
            })
        },
    },
    Alteration { field: "dropped[].column.node", what: INTERFACE_LEFT_OUT, alter: leave_out_interface },
    Alteration { field: "dropped[].column.direction", what: INTERFACE_LEFT_OUT, alter: leave_out_interface },
    Alteration {
        field: "dropped[].column.row",
        what: INTERFACE_LEFT_OUT,
        alter: |t, m| m.interface_nodes.is_empty() && leave_out_interface(t, m),
    },
    Alteration {
        field: "model.rigid_body_modes",
        what: "declared algebraic, gravity and mass properties taken out",
        alter: |t, m| {
            if m.model.rigid_body_modes == RigidBodyModes::Algebraic {
                return false;
            }
            m.model.rigid_body_modes = RigidBodyModes::Algebraic;
            m.model.mass_properties = None;
            t.gravity = None;
            true
        },
    },
    Alteration {
        field: "validity.gravity[]",
        what: "gravity declared to act along one axis",
        alter: |_, m| {
            m.validity.gravity = Some([0.0, 0.0, 1.0]);
            true
        },
    },
    Alteration {
        field: "validity.unloaded[].node",
        what: "a direction declared unloaded",
        alter: |_, m| {
            let Some(direction) = m.interface_nodes.first().and_then(|node| node.dofs.first().copied()) else {
                return false;
            };
            m.validity.unloaded = vec![supel_runtime::InterfaceDof { node: 0, direction }];
            true
        },
    },
    Alteration {
        field: "validity.unloaded[].direction",
        what: "a direction declared unloaded",
        alter: |_, m| {
            let Some(direction) = m.interface_nodes.first().and_then(|node| node.dofs.last().copied()) else {
                return false;
            };
            m.validity.unloaded = vec![supel_runtime::InterfaceDof { node: 0, direction }];
            true
        },
    },
    Alteration {
        field: "verification.checks[].value",
        what: "all set to 0",
        alter: |_, m| {
            m.verification.checks.iter_mut().for_each(|check| check.value = Some(0.0));
            true
        },
    },
    Alteration {
        field: "verification.checks[].limit",
        what: "all set to 1e9",
        alter: |_, m| {
            m.verification.checks.iter_mut().for_each(|check| check.limit = 1e9);
            true
        },
    },
    Alteration {
        field: "verification.checks[].verdict",
        what: "one warns, and so does the whole",
        alter: |_, m| {
            m.verification.checks[0].verdict = Verdict::Warn;
            m.verification.verdict = Verdict::Warn;
            true
        },
    },
    Alteration {
        field: "verification.checks[].verdict",
        what: "a value past its limit passes",
        alter: |_, m| {
            let check = &mut m.verification.checks[0];
            check.value = Some(10.0 * check.limit + 1.0);
            true
        },
    },
    Alteration {
        field: "job",
        what: "one mode more asked for",
        alter: |_, m| {
            let modes = m.job["reduction"]["modes"].clone();
            match (modes["count"].as_u64(), modes["up_to_hz"].as_f64()) {
                (Some(count), _) => job(m, "/reduction/modes/count", (count + 1).into()),
                (_, Some(limit)) => job(m, "/reduction/modes/up_to_hz", (1.5 * limit).into()),
                _ => false,
            }
        },
    },
    Alteration { field: "job", what: "of another version", alter: |_, m| job(m, "/future", 1.into()) },
    Alteration {
        field: "generator.parts_of_earlier_runs",
        what: "stated",
        alter: |_, m| {
            m.generator.parts_of_earlier_runs = NonZero::new(3);
            true
        },
    },
    Alteration {
        field: "generator.version",
        what: "another, and damping put in",
        alter: |t, m| {
            t.damping = Some(t.stiffness.clone());
            of_other_version(m)
        },
    },
    Alteration {
        field: "generator.version",
        what: "another, and the record of checks emptied",
        alter: |_, m| {
            m.verification.checks.clear();
            of_other_version(m)
        },
    },
    Alteration {
        field: "generator.version",
        what: "another, and a job of another version",
        alter: |_, m| job(m, "/future", 1.into()) && of_other_version(m),
    },
    Alteration {
        field: "generator.version",
        what: "another, and all error bars set to 1e9",
        alter: |_, m| bars(m, |_| Some(1e9)) && of_other_version(m),
    },
    Alteration {
        field: "generator.version",
        what: "another, and an inertia relief left out everywhere",
        alter: |t, m| {
            let is_relief = |coordinate: &Coordinate| matches!(coordinate, Coordinate::InertiaRelief { .. });
            let kept: Vec<usize> = (0..m.coordinates.len()).filter(|at| !is_relief(&m.coordinates[*at])).collect();
            let is_changed = kept.len() < m.coordinates.len();
            keep(t, m, &kept);
            is_changed && of_other_version(m)
        },
    },
    Alteration {
        field: "generator.version",
        what: "another, and rigid-body modes declared algebraic",
        alter: |_, m| {
            let is_new = m.model.rigid_body_modes == RigidBodyModes::Geometric;
            m.model.rigid_body_modes = RigidBodyModes::Algebraic;
            is_new && of_other_version(m)
        },
    },
];

fn of_other_version(metadata: &mut Metadata) -> bool {
    metadata.generator.version = "99.0.0".to_owned();
    true
}

/// The altered superelement; none where there is nothing to alter, an error where the format refuses it.
pub(super) fn altered(original: &Superelement, alteration: &Alteration) -> Option<Result<Superelement, String>> {
    let (mut tensors, mut metadata) = (original.tensors().clone(), original.metadata().clone());
    if !(alteration.alter)(&mut tensors, &mut metadata) {
        return None;
    }
    Some(Superelement::new(tensors, metadata).map_err(|error| error.to_string()))
}

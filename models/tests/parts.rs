//! The quadratic tetrahedra and the parts made of them: exact integrals, linear fields, six rigid-body modes.

use std::collections::{BTreeMap, BTreeSet};

use supel_models::model::{dot, multiply};
use supel_models::*;

/// What assembly may lose: a row sums some 90 blocks, each of them from four points, with entries up to the largest.
const ROUNDING: f64 = 1e3 * f64::EPSILON;

fn largest(x: impl IntoIterator<Item = f64>) -> f64 {
    x.into_iter().fold(0.0, |worst, value| worst.max(value.abs()))
}

/// A twisted block with a bore, of material of unit density.
fn holed(material: &Material) -> (TetMesh, Model) {
    let bent = |[x, y, z]: [f64; 3]| [3.0 * x + 0.3 * y * z, 2.0 * y + 0.2 * x * z, z - 0.2 * x * y];
    let mesh = TetMesh::structured([4, 3, 2], bent, |[i, j, _]| ![[1, 1], [2, 1]].contains(&[i, j]));
    let model = mesh.assemble(material);
    (mesh, model)
}

/// ∫ 1 dV and ∫ x xᵀ dV over the mesh, by the closed forms of a tetrahedron.
fn moments(mesh: &TetMesh) -> (f64, [[f64; 3]; 3]) {
    let (mut volume, mut second) = (0.0, [[0.0; 3]; 3]);
    for element in &mesh.elements {
        let corners: [[f64; 3]; 4] = std::array::from_fn(|a| mesh.nodes[element[a] as usize]);
        let [a, b, c]: [[f64; 3]; 3] =
            std::array::from_fn(|e| std::array::from_fn(|d| corners[e + 1][d] - corners[0][d]));
        let cross = [b[1] * c[2] - b[2] * c[1], b[2] * c[0] - b[0] * c[2], b[0] * c[1] - b[1] * c[0]];
        let v = dot(&a, &cross) / 6.0;
        let sum: [f64; 3] = std::array::from_fn(|d| corners.iter().map(|x| x[d]).sum());
        for i in 0..3 {
            for j in 0..3 {
                let own: f64 = corners.iter().map(|x| x[i] * x[j]).sum();
                second[i][j] += v / 20.0 * (own + sum[i] * sum[j]);
            }
        }
        volume += v;
    }
    (volume, second)
}

#[test]
fn rigid_motions_meet_no_force() {
    let parts = Family::ALL.map(|family| Part::new(family, 3000).model);
    for model in parts.into_iter().chain([holed(&Material::UNIT).1]) {
        let scale = largest(model.stiffness.iter().map(|entry| entry.2));
        for mode in model.rigid_body_modes() {
            let force = multiply(&model.stiffness, &mode);
            let error = largest(force) / (scale * largest(mode.iter().copied()));
            assert!(error <= ROUNDING, "{error:e}");
        }
    }
}

/// Six rows that hold a body and no more: those with the largest pivots in an elimination of U.
fn determinate_support(model: &Model) -> Vec<usize> {
    let mut modes = model.rigid_body_modes();
    let mut rows = Vec::new();
    for column in 0..6 {
        let size = |row: &usize| modes[column][*row].abs();
        let pivot = (0..model.n).max_by(|a, b| size(a).total_cmp(&size(b))).expect("rows");
        let (done, rest) = modes.split_at_mut(column + 1);
        for mode in rest {
            let factor = mode[pivot] / done[column][pivot];
            mode.iter_mut().zip(&done[column]).for_each(|(x, y)| *x -= factor * y);
        }
        rows.push(pivot);
    }
    rows
}

/// The smallest pivot of a Cholesky factorisation of K without some rows, relative to the diagonal; rows are kept from
/// their first entry on.
fn least_pivot(model: &Model, held: &[usize]) -> f64 {
    let mut rows: Vec<(usize, Vec<f64>)> = (0..model.n).map(|row| (row, Vec::new())).collect();
    for &(i, j, value) in model.stiffness.iter().filter(|(i, j, _)| j <= i) {
        let (row, column) = (i as usize, j as usize);
        let (first, values) = &mut rows[row];
        if values.is_empty() {
            *first = column;
        }
        values.resize(column - *first, 0.0);
        let is_held = held.contains(&row) || held.contains(&column);
        values.push(if !is_held { value } else { f64::from(u8::from(row == column)) });
    }
    let mut least = f64::INFINITY;
    for i in 0..model.n {
        let (above, row) = rows.split_at_mut(i);
        let (first, values) = &mut row[0];
        let own = values[i - *first];
        for j in *first..i {
            let (other_first, other) = &above[j];
            let from = (*first).max(*other_first);
            let product = dot(&values[from - *first..j - *first], &other[from - other_first..j - other_first]);
            values[j - *first] = (values[j - *first] - product) / other[j - other_first];
        }
        let pivot = own - dot(&values[..i - *first], &values[..i - *first]);
        assert!(pivot > 0.0, "pivot {pivot:e} of {own:e} in row {i}");
        least = least.min(pivot / own);
        values[i - *first] = pivot.sqrt();
    }
    least
}

#[test]
fn no_other_motion_is_free_of_force() {
    for family in Family::ALL {
        let part = Part::new(family, 0);
        let least = least_pivot(&part.model, &determinate_support(&part.model));
        // A mechanism leaves a pivot of rounding, some 1e-14; a sound part of this size one above 1e-9.
        assert!(least > 1e-9, "{}: {least:e}", family.name());
    }
    let cell = |[i, j, _]: [usize; 3]| [i, j] != [1, 1];
    let lambda = spectrum(&TetMesh::structured([2, 2, 1], |t| t, cell).assemble(&Material::UNIT));
    let rounding = 1e-12 * lambda[lambda.len() - 1];
    assert!(lambda[..6].iter().all(|value| value.abs() < rounding) && lambda[6] > 1e3 * rounding, "{lambda:?}");
}

#[test]
fn linear_displacements_pass_the_patch_test() {
    let material = Material { young: 2.0, poisson: 0.3, density: 1.0 };
    let (mesh, model) = holed(&material);
    let gradient = [[0.3, -0.1, 0.4], [0.2, 0.5, 0.1], [-0.3, 0.2, -0.4]];
    let u: Vec<f64> = mesh.nodes.iter().flat_map(|x| gradient.map(|row| dot(&row, x))).collect();
    let strain: [[f64; 3]; 3] =
        std::array::from_fn(|i| std::array::from_fn(|j| 0.5 * (gradient[i][j] + gradient[j][i])));
    let trace: f64 = (0..3).map(|d| strain[d][d]).sum();
    let square: f64 = strain.iter().flatten().map(|e| e * e).sum();
    let Material { young, poisson, .. } = material;
    let lame = young * poisson / ((1.0 + poisson) * (1.0 - 2.0 * poisson));
    // σ : ε = λ tr(ε)² + 2 µ ε : ε, everywhere.
    let twice_energy = (lame * trace * trace + young / (1.0 + poisson) * square) * moments(&mesh).0;
    let force = multiply(&model.stiffness, &u);
    assert!((dot(&u, &force) / twice_energy - 1.0).abs() < ROUNDING);
    // Constant stress is in equilibrium at the nodes that no face with one element only touches.
    let mut owners = BTreeMap::new();
    for element in &mesh.elements {
        for face in [[0, 1, 2, 4, 5, 6], [0, 1, 3, 4, 8, 7], [1, 2, 3, 5, 9, 8], [0, 2, 3, 6, 9, 7]] {
            let mut nodes = face.map(|a| element[a]);
            nodes.sort_unstable();
            *owners.entry(nodes).or_insert(0) += 1;
        }
    }
    let border: BTreeSet<u32> = owners.iter().filter(|&(_, &n)| n == 1).flat_map(|(face, _)| *face).collect();
    assert!(owners.values().all(|&n| n <= 2) && border.len() < mesh.nodes.len());
    let scale = largest(model.stiffness.iter().map(|entry| entry.2)) * largest(u.iter().copied());
    for (row, force) in force.iter().enumerate().filter(|(row, _)| !border.contains(&(*row as u32 / 3))) {
        assert!(force.abs() <= ROUNDING * scale, "row {row}: {force:e} of {scale:e}");
    }
}

#[test]
fn mass_and_inertia_are_those_of_the_solid() {
    let (mesh, model) = holed(&Material::UNIT);
    let (volume, second) = moments(&mesh);
    let trace: f64 = (0..3).map(|d| second[d][d]).sum();
    let modes = model.rigid_body_modes();
    let products: Vec<Vec<f64>> = modes.iter().map(|mode| multiply(&model.mass, mode)).collect();
    for i in 0..3 {
        assert!((dot(&modes[i], &products[i]) / volume - 1.0).abs() < ROUNDING);
        for j in 0..3 {
            let exact = if i == j { trace - second[i][i] } else { -second[i][j] };
            assert!((dot(&modes[3 + i], &products[3 + j]) - exact).abs() < ROUNDING * trace);
        }
    }
    let block = TetMesh::structured([2, 1, 3], |[x, y, z]| [3.0 * x, 2.0 * y, z], |_| true).assemble(&Material::UNIT);
    let about_z = &block.rigid_body_modes()[5];
    // About a corner: m (a² + b²)/3.
    let exact = 6.0 * (3.0 * 3.0 + 2.0 * 2.0) / 3.0;
    assert!((dot(about_z, &multiply(&block.mass, about_z)) / exact - 1.0).abs() < ROUNDING);
    assert!((block.total_mass(0) / 6.0 - 1.0).abs() < ROUNDING);
}

#[test]
fn matrices_are_sorted_and_symmetric_to_the_bit() {
    let model = Part::new(Family::Bulky, 0).model;
    for entries in [&model.stiffness, &model.mass] {
        assert!(entries.is_sorted_by(|a, b| (a.0, a.1) < (b.0, b.1)));
        let mut mirrored: Vec<_> = entries.iter().map(|&(i, j, value)| (j, i, value.to_bits())).collect();
        mirrored.sort_unstable();
        assert!(mirrored.iter().zip(entries).all(|(a, b)| *a == (b.0, b.1, b.2.to_bits())));
    }
}

#[test]
fn parts_have_about_the_size_asked_for() {
    for family in Family::ALL {
        for dofs in [10_000, 30_000] {
            let part = Part::new(family, dofs);
            // From one mesh to the next a third is added at most: two cells become three along one axis, in the
            // coarsest meshes half.
            assert!((0.75..1.25).contains(&(part.model.n as f64 / dofs as f64)), "{}: {}", family.name(), part.model.n);
            assert!(part.model.groups.values().all(|members| members.len() >= 4));
        }
    }
}

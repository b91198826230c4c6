//! What every family must hold: exact symmetry, rigid-body modes to rounding, mass ρV.

use std::collections::BTreeMap;
use std::f64::consts::PI;

use supel_models::model::{dot, multiply};
use supel_models::transform::{dof_scaled, grounded, join, rounded, scaled, supported, translated};
use supel_models::*;

/// ‖K u‖∞ / (‖K‖∞ ‖u‖∞), the relative null-space error.
fn relative_force(model: &Model, u: &[f64]) -> f64 {
    let mut row_sums = vec![0.0; model.n];
    model.stiffness.iter().for_each(|&(row, _, value)| row_sums[row as usize] += f64::abs(value));
    largest(&multiply(&model.stiffness, u)) / (largest(&row_sums) * largest(u))
}

fn largest(x: &[f64]) -> f64 {
    x.iter().fold(0.0, |worst, value| value.abs().max(worst))
}

fn assert_symmetric_and_sorted(model: &Model) {
    for entries in [&model.stiffness, &model.mass] {
        assert!(entries.is_sorted_by(|a, b| (a.0, a.1) < (b.0, b.1)), "sorted, each position once");
        let by_position: BTreeMap<(u32, u32), u64> = entries.iter().map(|&(i, j, v)| ((i, j), v.to_bits())).collect();
        assert!(by_position.iter().all(|(&(i, j), bits)| by_position.get(&(j, i)) == Some(bits)), "symmetric bits");
    }
}

fn solids() -> Vec<(Model, f64)> {
    let steel = Material::STEEL_MM_T_S;
    let twisted = |[x, y, z]: [f64; 3]| [100.0 * x + 7.0 * y * z, 40.0 * y + 5.0 * x * z, 30.0 * z - 4.0 * x * y];
    let mesh = HexMesh::structured([4, 3, 2], twisted, |cell| cell != [1, 1, 0]);
    let volume = 100.0 * 40.0 * 30.0;
    vec![
        (brick([5, 3, 2], [10.0, 4.0, 3.0], &Material::UNIT), 120.0),
        (brick([20, 2, 2], [10.0, 1.0, 1.0], &Material::STEEL_SI), 10.0 * 7850.0),
        (brick([6, 6, 1], [1.0, 1.0, 1e-3], &Material::UNIT), 1e-3),
        (mesh.assemble(&steel), f64::NAN),
        (brick([4, 3, 2], [100.0, 40.0, 30.0], &steel), volume * 7.85e-9),
    ]
}

#[test]
fn solids_carry_six_rigid_body_modes() {
    for (model, _) in solids() {
        assert_symmetric_and_sorted(&model);
        for mode in model.rigid_body_modes() {
            // A row sums at most 81 terms, each rounded to ε; the coordinates are at most √3 extents.
            let error = relative_force(&model, &mode);
            assert!(error <= 100.0 * f64::EPSILON, "{error:e}");
        }
    }
}

#[test]
fn solids_have_exactly_six_zero_eigenvalues() {
    let lambda = spectrum(&brick([3, 2, 1], [3.0, 2.0, 1.0], &Material::UNIT));
    let rounding = 1e-13 * lambda[lambda.len() - 1];
    assert!(lambda[..6].iter().all(|value| value.abs() < rounding) && lambda[6] > 1e9 * rounding, "{lambda:?}");
}

#[test]
fn solids_weigh_density_times_volume() {
    for (model, mass) in solids().into_iter().filter(|(_, mass)| mass.is_finite()) {
        for axis in 0..3 {
            assert!((model.total_mass(axis) / mass - 1.0).abs() < 1e-13);
        }
    }
}

#[test]
fn brick_inertia_is_that_of_a_block() {
    let (model, [x, y, _]) = (brick([3, 4, 2], [3.0, 2.0, 1.0], &Material::UNIT), [3.0, 2.0, 1.0]);
    let about_z = &model.rigid_body_modes()[5];
    // About the corner: m (x² + y²)/3; linear fields are integrated exactly.
    let exact = 6.0 * (x * x + y * y) / 3.0;
    assert!((dot(about_z, &multiply(&model.mass, about_z)) / exact - 1.0).abs() < 1e-13);
}

#[test]
fn membrane_has_three_rigid_body_modes() {
    let model = membrane([4, 3], [2.0, 1.0], &Material::UNIT);
    assert_symmetric_and_sorted(&model);
    let modes = model.rigid_body_modes();
    for mode in [0, 1, 5] {
        assert!(relative_force(&model, &modes[mode]) <= 100.0 * f64::EPSILON);
    }
    assert!((model.total_mass(0) / 2.0 - 1.0).abs() < 1e-13);
    let lambda = spectrum(&model);
    assert!(lambda[2].abs() < 1e-13 * lambda[39] && lambda[3] > 1e-4 * lambda[39]);
}

/// A plate and half a tube, radius 1.
fn shells(drilling: f64) -> [Model; 2] {
    let wall = Wall { material: Material::UNIT, thickness: 0.02, drilling };
    let plate = shell([6, 4], |[x, y]| [3.0 * x, y, 0.0], &wall);
    let tube = shell([8, 3], |[x, y]| [(PI * x).cos(), 2.0 * y, -(PI * x).sin()], &wall);
    [plate, tube]
}

#[test]
fn shells_have_six_rigid_body_modes_and_their_mass() {
    for (model, area) in shells(1e-3).into_iter().zip([3.0, 8.0 * 2.0 * (PI / 16.0).sin() * 2.0]) {
        assert_symmetric_and_sorted(&model);
        for mode in model.rigid_body_modes() {
            // A row sums at most 54 terms of a sum over four points.
            let error = relative_force(&model, &mode);
            assert!(error <= 100.0 * f64::EPSILON, "{error:e}");
        }
        assert!((model.total_mass(2) / (0.02 * area) - 1.0).abs() < 1e-13);
        assert_eq!(zeros(&model), 6);
    }
}

#[test]
fn a_clamped_strip_of_shells_bends_as_a_beam() {
    let wall = Wall { material: Material { poisson: 0.0, ..Material::UNIT }, thickness: 0.05, drilling: 1e-3 };
    let strip = shell([16, 2], |[x, y]| [4.0 * x, 0.4 * y, 0.0], &wall);
    let clamped = supported(&strip, |(label, _)| strip.groups["XMIN"].contains(&label));
    // (1.8751/L)⁴ E t²/12ρ; sixteen elements are a per cent too stiff at most, shear and rotary inertia make less.
    let exact = f64::powi(1.875_104 / 4.0, 4) * 0.05 * 0.05 / 12.0;
    let found = spectrum(&clamped)[0];
    assert!((found / exact - 1.0).abs() < 0.02, "{found:e} for {exact:e}");
}

#[test]
fn frame_has_six_rigid_body_modes_and_its_mass() {
    let nodes = [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [1.0, 1.0, 0.5], [0.0, 0.0, 2.0]];
    let edges = [[0, 1], [1, 2], [2, 3], [3, 0], [0, 2]];
    let section = Section { second_moment_z: 3e-6, ..Section::round(0.02) };
    let length: f64 =
        edges.iter().map(|&[a, b]| (0..3).map(|d| f64::powi(nodes[a][d] - nodes[b][d], 2)).sum::<f64>().sqrt()).sum();
    for inertia in [Inertia::Consistent, Inertia::LumpedTranslations] {
        let model = frame(&nodes, &edges, &section, &Material::STEEL_SI, inertia);
        assert_symmetric_and_sorted(&model);
        for mode in model.rigid_body_modes() {
            assert!(relative_force(&model, &mode) <= 100.0 * f64::EPSILON);
        }
        for axis in 0..3 {
            assert!((model.total_mass(axis) / (7850.0 * section.area * length) - 1.0).abs() < 1e-13);
        }
    }
}

/// Number of eigenvalues that are zero to rounding, relative to the largest.
fn zeros(model: &Model) -> usize {
    let lambda = spectrum(model);
    let rounding = 1e-12 * lambda[lambda.len() - 1];
    lambda.iter().filter(|value| value.abs() <= rounding).count()
}

#[test]
fn joints_leave_the_right_number_of_zero_modes() {
    let a = brick([1, 1, 1], [1.0, 1.0, 1.0], &Material::UNIT);
    let b = translated(&a, [1.0, 0.0, 0.0]);
    // Nodes 2, 4, 6, 8 of the first are the face x = 1; 1, 3, 5, 7 of the second lie on it.
    for (pairs, expected) in
        [(&[][..], 12), (&[(2, 1)][..], 9), (&[(2, 1), (4, 3)][..], 7), (&[(2, 1), (4, 3), (6, 5), (8, 7)][..], 6)]
    {
        let joined = join(&a, &b, pairs);
        assert_symmetric_and_sorted(&joined);
        assert_eq!(joined.n, 48 - 3 * pairs.len());
        assert_eq!(zeros(&joined), expected);
        assert_eq!(joined.labels.len(), joined.nodes.len());
        let worst = joined.rigid_body_modes().iter().map(|u| relative_force(&joined, u)).fold(0.0, f64::max);
        assert!(worst <= 100.0 * f64::EPSILON);
    }
}

#[test]
fn joined_on_a_face_two_bricks_are_one() {
    let a = brick([1, 1, 1], [1.0, 1.0, 1.0], &Material::UNIT);
    let joined = join(&a, &translated(&a, [1.0, 0.0, 0.0]), &[(2, 1), (4, 3), (6, 5), (8, 7)]);
    let whole = spectrum(&brick([2, 1, 1], [2.0, 1.0, 1.0], &Material::UNIT));
    assert!(dense::largest_difference(&spectrum(&joined), &whole) < 1e-13 * whole[35]);
    assert_eq!(joined.groups["B.XMIN"], vec![2, 4, 6, 8]);
}

#[test]
fn scaling_and_rounding_touch_values_only() {
    let model = brick([2, 1, 1], [2.0, 1.0, 1.0], &Material::UNIT);
    let scales: Vec<f64> = (0..model.n).map(|row| if row % 3 == 0 { 1e3 } else { 0.7 }).collect();
    for changed in
        [scaled(&model, 3.0, 0.1), dof_scaled(&model, &scales), rounded(&model, 9), grounded(&model, 0, 1e-3)]
    {
        assert_symmetric_and_sorted(&changed);
        assert_eq!(changed.dofs, model.dofs);
    }
    let reference = spectrum(&model);
    let same = spectrum(&dof_scaled(&model, &scales));
    assert!(dense::largest_difference(&reference, &same) < 1e-11 * reference[35]);
    let rounded_values = rounded(&model, 3);
    assert!(
        model.stiffness.iter().zip(&rounded_values.stiffness).all(|(a, b)| (a.2 - b.2).abs() <= 5.01e-3 * a.2.abs())
    );
    assert_ne!(model, rounded_values);
}

#[test]
fn a_held_face_leaves_no_zero_mode() {
    let model = brick([2, 1, 1], [2.0, 1.0, 1.0], &Material::UNIT);
    let held = supported(&model, |(node, _)| model.groups["XMIN"].contains(&node));
    assert_symmetric_and_sorted(&held);
    assert_eq!((held.n, zeros(&held)), (24, 0));
}

#[test]
fn matrix_market_reads_back_the_same_bits() {
    let model = brick([1, 1, 1], [1.0, 0.3, 0.7], &Material::STEEL_SI);
    let mut text = Vec::new();
    write::matrix_market(&mut text, model.n, &model.stiffness, "a comment").expect("memory takes everything");
    let text = String::from_utf8(text).expect("text");
    let mut lines = text.lines().skip_while(|line| line.starts_with('%'));
    let mut read = Assembler::default();
    assert_eq!(lines.next(), Some("24 24 300"));
    for line in lines {
        let fields: Vec<&str> = line.split(' ').collect();
        let index = |i: usize| fields[i].parse::<u32>().expect("index") - 1;
        assert!(index(0) >= index(1), "lower triangle");
        read.add(index(1), index(0), fields[2].parse().expect("value"));
    }
    assert_eq!(read.finish(), model.stiffness);
}

//! The space of the modes, against computed modes and dense algebra.

use faer::linalg::solvers::Solve;
use faer::{Mat, Side};
use supel::cli::ExitCode;
use supel_models::Model;
use supel_runtime::{Coordinate, Method};
use supel_testing::pencil::{difference, eigen, matrices, spectrum};
use supel_testing::place::{Place, steel_brick, supel};

use crate::{AVERAGE, Case, OF_FILE, PATCH, TIP, WALL, place_with};

/// Numbers of the leading coordinates.
fn leading(n: usize) -> Vec<usize> {
    (0..n).collect()
}

/// What two ways to one spectrum may differ by: θ = 1/(λ + α) is known to ε times the condition of the factor in unit diagonal, which is
/// below 10⁵ here, a dozen times over.
const EXACT: f64 = 1e-9;

/// Near the first elastic eigenvalue of the brick, (2π · 1 kHz)².
const ALPHA: f64 = 4e7;

fn columns(shapes: &Mat<f64>, which: std::ops::Range<usize>) -> Vec<Vec<f64>> {
    which.map(|j| (0..shapes.nrows()).map(|i| shapes[(i, j)]).collect()).collect()
}

/// Displacements that no eigenvector is: waves along the three axes.
fn waves(model: &Model, count: usize) -> Vec<Vec<f64>> {
    let wave = |mode: usize, (node, direction): &(i64, u8)| {
        let x = model.nodes[*node as usize - 1];
        let phase = 0.7 * mode as f64 + 1.3 * f64::from(*direction);
        ((1.0 + mode as f64) * x[0] + 2.0 * x[1] - 3.0 * x[2] + phase).sin()
    };
    (0..count).map(|mode| model.dofs.iter().map(|dof| wave(mode, dof)).collect()).collect()
}

fn made(
    model: &Model,
    modes: &[Vec<f64>],
    (interface, fixed): (&'static str, &'static str),
) -> supel_runtime::Superelement {
    Case { interface, fixed, reduction: OF_FILE }.made(&place_with(model, modes))
}

/// Equation (23) with V = [U X] is Herting's method: the modes of the free component from dense algebra give his space. An average ties
/// nothing, so that the component with one has the same modes.
#[test]
fn rigid_and_free_modes_give_the_space_of_herting() {
    let model = steel_brick();
    let [k, m] = matrices(&model);
    let (_, shapes) = eigen(k.as_ref(), m.as_ref(), ALPHA);
    let mut modes = model.rigid_body_modes().to_vec();
    modes.extend(columns(&shapes, 6..10));
    for interface in [TIP, AVERAGE] {
        let file = made(&model, &modes, (interface, ""));
        assert_eq!(file.metadata().method, Method::ModeAcceleration);
        let named: Vec<Coordinate> = file.metadata().coordinates[file.n_interface()..].to_vec();
        assert_eq!(named, (0..10).map(|column| Coordinate::ExpansionMode { column }).collect::<Vec<_>>());
        let herting = Case { interface, fixed: "", reduction: r#"method = "herting", modes = { count = 4 }"# };
        let herting = herting.made(&Place::with(&model));
        for n_held in [0, file.n_interface()] {
            let [found, expected] = [&file, &herting].map(|file| spectrum(file, &leading(n_held), ALPHA));
            let error = difference(&found, &expected, ALPHA);
            assert!(error <= EXACT, "{interface}, {n_held} held: {error:e}");
        }
    }
}

/// With V_B = 0 it is Craig-Bampton: the modes of the held interface give its space, clamped at a wall or not.
#[test]
fn modes_of_the_held_interface_give_the_space_of_craig_bampton() {
    let model = steel_brick();
    for (fixed, held) in [("", &[5, 15, 45][..]), (WALL, &[5, 15, 45, 1, 6, 11, 16, 21, 26, 31, 36, 41][..])] {
        let [k, m] = matrices(&model);
        let free: Vec<usize> = (0..model.n).filter(|row| !held.contains(&model.dofs[*row].0)).collect();
        let [k, m] = [k, m].map(|a| Mat::from_fn(free.len(), free.len(), |i, j| a[(free[i], free[j])]));
        let (_, shapes) = eigen(k.as_ref(), m.as_ref(), ALPHA);
        let modes: Vec<Vec<f64>> = columns(&shapes, 0..5)
            .iter()
            .map(|shape| {
                let mut whole = vec![0.0; model.n];
                free.iter().zip(shape).for_each(|(row, value)| whole[*row] = *value);
                whole
            })
            .collect();
        let file = made(&model, &modes, (TIP, fixed));
        let reduction = r#"method = "craig-bampton", modes = { count = 5 }"#;
        let expected = Case { interface: TIP, fixed, reduction }.made(&Place::with(&model));
        for n_held in [0, file.n_interface()] {
            let [found, expected] = [&file, &expected].map(|file| spectrum(file, &leading(n_held), ALPHA));
            let error = difference(&found, &expected, ALPHA);
            assert!(error <= EXACT, "{fixed}, {n_held} held: {error:e}");
        }
    }
}

/// T: how the rows of the brick follow its dofs, with nodes at rest and others that follow a node at their mean as a rigid body.
fn transformation(model: &Model, at_rest: &[i64], patch: &[i64]) -> (Mat<f64>, usize) {
    let own: Vec<usize> = (0..model.n)
        .filter(|row| !at_rest.contains(&model.dofs[*row].0) && !patch.contains(&model.dofs[*row].0))
        .collect();
    let n_patch = if patch.is_empty() { 0 } else { 6 };
    let mut t = Mat::zeros(model.n, own.len() + n_patch);
    own.iter().enumerate().for_each(|(at, row)| t[(*row, at)] = 1.0);
    let place = |node: i64| model.nodes[node as usize - 1];
    let mean: [f64; 3] =
        std::array::from_fn(|axis| patch.iter().map(|node| place(*node)[axis]).sum::<f64>() / patch.len() as f64);
    for (row, (node, direction)) in model.dofs.iter().enumerate().filter(|(_, dof)| patch.contains(&dof.0)) {
        let [x, y, z]: [f64; 3] = std::array::from_fn(|axis| place(*node)[axis] - mean[axis]);
        let direction = usize::from(*direction);
        t[(row, own.len() + direction)] = 1.0;
        let by_rotation = [[0.0, -z, y], [z, 0.0, -x], [-y, x, 0.0]];
        (0..3).for_each(|axis| t[(row, own.len() + 3 + axis)] = by_rotation[axis][direction]);
    }
    (t, own.len())
}

/// Any shapes at all: the spectrum is that of Ψ = [I 0; Ψ_S Ψ_D] with (23) by dense algebra, where dofs are held and patches are
/// rigid too, and its values are upper bounds of those of the full model, one by one (Rayleigh and Ritz).
#[test]
fn any_shapes_give_the_upper_bounds_of_dense_algebra() {
    const OF_PATCH: [i64; 9] = [5, 10, 15, 20, 25, 30, 35, 40, 45];
    const OF_WALL: [i64; 9] = [1, 6, 11, 16, 21, 26, 31, 36, 41];
    let model = steel_brick();
    let modes = waves(&model, 5);
    for (interface, fixed, at_rest, patch) in
        [(TIP, "", &[][..], &[][..]), (TIP, WALL, &OF_WALL[..], &[][..]), (PATCH, "", &[][..], &OF_PATCH[..])]
    {
        let file = made(&model, &modes, (interface, fixed));
        let (t, n_own) = transformation(&model, at_rest, patch);
        let [k, m] = matrices(&model);
        let v = Mat::from_fn(model.n, modes.len(), |i, j| modes[j][i]);
        let inertia = t.transpose() * &m * &v;
        let [k, m] = [k, m].map(|a| t.transpose() * &a * &t);
        // The interface last, in the order of the job.
        let rows: Vec<usize> = (0..model.n).filter(|row| t.row(*row).iter().any(|entry| *entry != 0.0)).collect();
        let place_of = |row: usize| (0..n_own).find(|at| t[(row, *at)] == 1.0);
        let interface: Vec<usize> = match patch.is_empty() {
            true => [5, 15, 45]
                .iter()
                .flat_map(|node| {
                    rows.iter().filter(|row| model.dofs[**row].0 == *node).filter_map(|row| place_of(*row))
                })
                .collect(),
            false => (n_own..n_own + 6).collect(),
        };
        let internal: Vec<usize> = (0..k.nrows()).filter(|dof| !interface.contains(dof)).collect();
        let (n_i, n_b) = (internal.len(), interface.len());
        let part = |a: &Mat<f64>, rows: &[usize], columns: &[usize]| {
            Mat::from_fn(rows.len(), columns.len(), |i, j| a[(rows[i], columns[j])])
        };
        let factor = part(&k, &internal, &internal).llt(Side::Lower).expect("definite");
        let statics = factor.solve(&part(&k, &internal, &interface));
        let all: Vec<usize> = (0..modes.len()).collect();
        let dynamic = factor.solve(&part(&inertia, &internal, &all));
        let psi = Mat::from_fn(n_b + n_i, n_b + modes.len(), |i, j| match (i < n_b, j < n_b) {
            (true, _) => f64::from(u8::from(i == j)),
            (false, true) => -statics[(i - n_b, j)],
            // In the scale of displacements: λ of these columns is near ALPHA.
            (false, false) => ALPHA * dynamic[(i - n_b, j - n_b)],
        });
        let order: Vec<usize> = interface.iter().chain(&internal).copied().collect();
        let [k, m] = [k, m].map(|a| part(&a, &order, &order));
        let [k_red, m_red] = [&k, &m].map(|a| psi.transpose() * a * &psi);
        for n_held in [0, n_b] {
            let inner = |a: &Mat<f64>| {
                let n = a.nrows() - n_held;
                a.as_ref().submatrix(n_held, n_held, n, n).to_owned()
            };
            let expected = eigen(inner(&k_red).as_ref(), inner(&m_red).as_ref(), ALPHA).0;
            let found = spectrum(&file, &leading(n_held), ALPHA);
            let error = difference(&found, &expected, ALPHA);
            assert!(error <= EXACT, "{fixed} {interface:?}, {n_held} held: {error:e}");
            let full = eigen(inner(&k).as_ref(), inner(&m).as_ref(), ALPHA).0;
            for (bound, value) in found.iter().zip(&full) {
                let [theta_of_bound, theta] = [bound, value].map(|lambda| (full[0] + ALPHA) / (lambda + ALPHA));
                assert!(theta_of_bound <= theta + EXACT, "{bound} bounds {value} from above");
            }
        }
    }
}

/// A mode may be of any size: its length is in the mixing alone.
#[test]
fn the_size_of_a_mode_changes_nothing_but_the_mixing() {
    let model = steel_brick();
    let modes = waves(&model, 3);
    let file = made(&model, &modes, (TIP, ""));
    for size in [0.7e-150, 1.3, 2e150] {
        let scaled: Vec<Vec<f64>> = modes.iter().map(|mode| mode.iter().map(|value| value * size).collect()).collect();
        let other = made(&model, &scaled, (TIP, ""));
        for n_held in [0, file.n_interface()] {
            let [found, expected] = [&other, &file].map(|file| spectrum(file, &leading(n_held), ALPHA));
            let error = difference(&found, &expected, ALPHA);
            assert!(error <= EXACT, "{size:e}: {error:e}");
        }
        let [own, scaled] = [&file, &other].map(|file| file.tensors().mixing.clone().expect("a mixing"));
        let ratio = own[(0, 0)] / scaled[(0, 0)] / size;
        assert!((ratio - 1.0).abs() <= EXACT, "{size:e}: {ratio}");
    }
}

/// Modes of a file next to inertia relief, loads with residual vectors and dependent columns, which are left out by name.
#[test]
fn other_columns_come_along_and_dependent_modes_are_left_out() {
    let model = steel_brick();
    let mut modes = waves(&model, 3);
    modes.push(modes[0].iter().zip(&modes[2]).map(|(a, b)| 2.0 * a - b).collect());
    modes.push(model.rigid_body_modes()[4].clone());
    let place = place_with(&model, &modes);
    let reduction = r#"method = "mode-acceleration", modes = { file = "modes.mtx" }, inertia_relief = true"#;
    let case = Case { interface: TIP, fixed: "", reduction };
    let file = case.made(&place);
    let dropped: Vec<&Coordinate> = file.metadata().dropped.iter().map(|dropped| &dropped.column).collect();
    // The combination of two others, and the rigid-body motion whose inertia relief is there.
    assert_eq!(dropped, [3, 4].map(|column| Coordinate::ExpansionMode { column }).iter().collect::<Vec<_>>());
    assert_eq!(file.n_modal(), 6 + 3);
}

const ENDS: &str = r#"{ name = "ends", nodes = [1, 5, 11, 15, 41, 45] }"#;

/// Exported as a model, the superelement is reduced again to itself: its modal coordinates are found as modes of the held interface.
#[test]
fn an_exported_superelement_is_reduced_to_itself() {
    let model = steel_brick();
    let place = place_with(&model, &waves(&model, 3));
    // More than just holds the component: such an interface has no stiffness but rounding.
    let first = Case { interface: ENDS, fixed: "", reduction: OF_FILE }.made(&place);
    supel(&["export", &place.text("x.supel"), "--to", "matrix-market"]).expect(ExitCode::Done);
    supel(&["reduce", &place.text("x.job.toml")]).expect(ExitCode::Done);
    let second = place.superelement("x.again.supel");
    for n_held in [0, first.n_interface()] {
        let [found, expected] = [&second, &first].map(|file| spectrum(file, &leading(n_held), ALPHA));
        let error = difference(&found, &expected, ALPHA);
        assert!(error <= EXACT, "{n_held} held: {error:e}");
    }
}

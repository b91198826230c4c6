//! Constraints against what they stand for: the saddle point of their multipliers, and penalties without end.

use std::f64::consts::TAU;

use faer::linalg::solvers::Solve;
use faer::{Mat, Side};
use supel::cli::ExitCode;
use supel_models::random::SplitMix64;
use supel_models::transform::join;
use supel_models::{Inertia, Material, Model, Section, frame};
use supel_testing::place::{Place, assert_close, frequencies_hz, supel};

use crate::model::{labels_at, tied_halves};
use crate::{Case, Rows, eigenvalues, null_space, unpacked};

const HERTING: &str = r#"method = "herting", modes = { count = 6 }"#;
/// Modes that are compared.
const N: usize = 6;

/// Two halves of a block with duplicate nodes, tied one by one.
fn halves() -> Case {
    let (model, rows) = tied_halves([2, 2, 2], [2, 2, 2]);
    Case::new(model, rows)
}

/// The interface of the halves.
fn ends(case: &Case) -> String {
    let labels = labels_at(&case.model, &[[0.0, 0.0, 0.0], [0.0, 0.31, 0.0], [1.0, 0.31, 0.23], [1.0, 0.0, 0.115]]);
    format!("{{ name = \"ends\", nodes = {labels:?} }}")
}

/// λ of the saddle pencil [K Gᵀ; G 0], [M 0; 0 0], ascending: θ = 1/(λ + α) are the eigenvalues of Lᵀ A L, M = L Lᵀ, with A the leading block of
/// the inverse of [K + αM, Gᵀ; G, 0]. Rows of G are as large as K.
fn saddle([k, m, g]: [&Mat<f64>; 3], alpha: f64) -> Vec<f64> {
    let (n, n_g, size) = (k.nrows(), g.nrows(), k.norm_max());
    let entry = |i: usize, j: usize| match (i < n, j < n) {
        (true, true) => k[(i, j)] + alpha * m[(i, j)],
        (true, false) => size * g[(j - n, i)],
        (false, true) => size * g[(i - n, j)],
        (false, false) => 0.0,
    };
    let whole = Mat::from_fn(n + n_g, n + n_g, entry);
    let l = m.llt(Side::Lower).expect("a definite mass").L().to_owned();
    let loads = Mat::from_fn(n + n_g, n, |i, j| if i < n { l[(i, j)] } else { 0.0 });
    let answers = whole.partial_piv_lu().solve(loads);
    let operator = l.transpose() * answers.as_ref().subrows(0, n);
    let sum = Mat::from_fn(n, n, |i, j| 0.5 * (operator[(i, j)] + operator[(j, i)]));
    let theta = sum.self_adjoint_eigenvalues(Side::Lower).expect("eigenvalues");
    theta.iter().rev().map(|theta| 1.0 / theta - alpha).collect()
}

fn hertz(lambda: &[f64]) -> Vec<f64> {
    lambda.iter().map(|lambda| lambda.sqrt() / TAU).collect()
}

/// Frequencies with constraints are those of the saddle point, whose rows the program does not take for stiffness.
#[test]
fn constraints_are_the_saddle_point_of_their_multipliers() {
    let case = halves();
    let found = case.reduced(&ends(&case), HERTING, "");
    let first = (TAU * frequencies_hz(&found)[0]).powi(2);
    let expected = saddle([&case.stiffness(), &case.mass(), &case.g()], first);
    assert!(expected[5].abs() < 1e-9 * expected[6], "{:?}", &expected[..8]);
    assert_close(&frequencies_hz(&found)[..N], &hertz(&expected[6..6 + N]), 1e-9);
    // The rows of G appended to K, as programs write them that keep multipliers.
    let Model { n, mut stiffness, .. } = case.model.clone();
    for (row, terms) in (n as u32..).zip(&case.constraints) {
        terms.iter().for_each(|(column, factor)| stiffness.extend([(row, *column, *factor), (*column, row, *factor)]));
    }
    stiffness.sort_by_key(|(row, column, _)| (*row, *column));
    let saddle = Model { n: n + case.constraints.len(), stiffness, dofs: Vec::new(), ..case.model.clone() };
    let place = Place::with(&saddle);
    let flags = "--interface ends=rows:0,1,2,6,7,8,160,161 --method herting --modes 6";
    let refused = place.reduce(&place.matrix_flags(), flags).expect(ExitCode::InputData).err;
    assert!(refused.contains("E-LAGRANGE") && refused.contains("27"), "{refused}");
}

/// A constraint of a dof that is held leaves no more than rounding of its own terms, which programs leave when they turn axes.
#[test]
fn rounding_in_a_constraint_next_to_a_held_dof_is_none() {
    let (model, rows) = tied_halves([2, 2, 2], [2, 2, 2]);
    let at = rows.iter().position(|row| row.iter().all(|(column, _)| model.dofs[*column as usize].1 == 1)).expect("uy");
    let nodes = [rows[at][0].0, rows[at][1].0].map(|column| model.dofs[column as usize].0);
    let column = |node: i64, axis: u8| model.dofs.iter().position(|dof| *dof == (node, axis)).expect("a column") as u32;
    let held = format!("[[fixed]]\nnodes = [{}]\ndofs = [\"uy\"]\n", nodes[1]);
    let hertz = |rows: &Rows| {
        let case = Case::new(model.clone(), rows.clone());
        frequencies_hz(&case.reduced(&ends(&case), r#"method = "craig-bampton", modes = { count = 6 }"#, &held))
    };
    // Each of the three rows of the pair has a little of the others, so that none has an unknown to itself.
    let mut rounded = rows.clone();
    let is_of_pair = |row: &[(u32, f64)]| row.iter().all(|(column, _)| nodes.contains(&model.dofs[*column as usize].0));
    for row in rounded.iter_mut().filter(|row| is_of_pair(row)) {
        let own = model.dofs[row[0].0 as usize].1;
        for axis in (0..3).filter(|axis| *axis != own) {
            let size = 1e-17 * f64::from(1 + own + 2 * axis);
            row.extend([(column(nodes[0], axis), size), (column(nodes[1], axis), -1.3 * size)]);
        }
        row.sort_by_key(|(column, _)| *column);
    }
    assert_close(&hertz(&rounded), &hertz(&rows), 1e-9);
}

/// Penalties of 10^p times the stiffness come to the constraints from below, ten times as near for each power, until rounding of the penalty
/// is more than what is left: the constraints are where they lead and cannot arrive.
#[test]
fn constraints_are_the_limit_of_penalties() {
    let case = halves();
    let found = frequencies_hz(&case.reduced(&ends(&case), HERTING, ""));
    let (k, m, g) = (case.stiffness(), case.mass(), case.g());
    let size = k.norm_max();
    let whole = Mat::<f64>::identity(k.nrows(), k.nrows());
    let squares = g.transpose() * &g;
    let errors: Vec<f64> = (1..=12)
        .map(|p| {
            let stiff = &k + &squares * faer::Scale(size * 10f64.powi(p));
            let of_penalty = hertz(&eigenvalues([&stiff, &m], &whole)[6..6 + N]);
            let errors = found.iter().zip(&of_penalty).map(|(exact, found)| 1.0 - found / exact);
            errors.fold(0.0, |worst: f64, error| if error.abs() > worst.abs() { error } else { worst })
        })
        .collect();
    for (p, pair) in (1..).zip(errors.windows(2)) {
        // λ of the penalty is κ = 10^p times that of the block's highest mode, 10⁵ of the first elastic one, and its rounding ε of that.
        let rounding = 100.0 * f64::EPSILON * 1e5 * 10f64.powi(p + 1);
        if rounding > 0.05 * pair[1].abs() {
            continue;
        }
        let ratio = pair[0] / pair[1];
        // The next term of the series is a share of 10^−p.
        assert!(pair[1] > 0.0 && (ratio / 10.0 - 1.0).abs() <= 0.1 + 2.0 * 10f64.powi(-p), "10^{p}: {errors:?}");
    }
    // Three powers come a thousand times as near; twelve are as far off as one.
    assert!(errors[3] < 2e-3 * errors[0] && errors[11].abs() > errors[0], "{errors:?}");
}

/// Equations have no unit: multiplied by a power of two they change no bit, by anything else rounding alone.
#[test]
fn scales_of_constraints_do_not_matter() {
    let case = halves();
    let interface = ends(&case);
    let expected = case.reduced(&interface, HERTING, "");
    let scaled = |factor: &dyn Fn(usize) -> f64| {
        let rows: Rows = case
            .constraints
            .iter()
            .enumerate()
            .map(|(row, terms)| terms.iter().map(|(column, value)| (*column, factor(row) * value)).collect())
            .collect();
        let other = Case::new(case.model.clone(), rows);
        other.run("", &interface, HERTING, "").expect(ExitCode::Done);
        other.place.superelement("x.supel")
    };
    let by_two = scaled(&|row| 2f64.powi(row as i32 * 7 % 61 - 30));
    assert!(by_two.tensors() == expected.tensors());
    for factor in [1e12, 1e-12] {
        let found = scaled(&|row| if row % 2 == 0 { factor } else { 3.0 });
        assert_close(&frequencies_hz(&found), &frequencies_hz(&expected), 1e-11);
        let n_b = expected.n_interface();
        let (k, own) = (&found.tensors().stiffness, &expected.tensors().stiffness);
        for (i, j) in (0..n_b).flat_map(|i| (0..n_b).map(move |j| (i, j))) {
            let size = (own[(i, i)] * own[(j, j)]).sqrt();
            assert!((k[(i, j)] - own[(i, j)]).abs() <= 1e-11 * size, "{factor:e}: {i}, {j}");
        }
    }
}

/// Two arms, of six nodes and of seven, with a ball joint between them.
fn arms(random: &mut SplitMix64) -> Case {
    let mut arm = |n: usize, from: [f64; 3], side: f64| {
        let mut at = from;
        let step = |at: [f64; 3], by: [f64; 3]| [at[0] + 0.1 + by[0], at[1] + side * by[1], at[2] + by[2]];
        let mut nodes = vec![at];
        for _ in 1..n {
            at = step(at, [0; 3].map(|_| 0.1 * random.normal()));
            nodes.push(at);
        }
        nodes
    };
    let first = arm(6, [0.0; 3], 1.0);
    let second = arm(7, first[5], -1.0);
    let section = Section { area: 3e-4, second_moment_y: 2e-8, second_moment_z: 5e-8, torsion: 6e-8 };
    let beams = |nodes: &[[f64; 3]]| {
        let edges: Vec<[usize; 2]> = (1..nodes.len()).map(|i| [i - 1, i]).collect();
        frame(nodes, &edges, &section, &Material::STEEL_SI, Inertia::Consistent)
    };
    let joint = (0..3).map(|axis| vec![(30 + axis, 1.0), (36 + axis, -1.0)]).collect();
    Case::new(join(&beams(&first), &beams(&second), &[]), joint)
}

/// An arm that hangs on another one swings while the interface, on the other one, is at rest. Rubin's static modes do without constraint modes,
/// which need an interface that holds all of it.
#[test]
fn rubin_beside_an_arm_that_the_interface_leaves_free() {
    let mut random = SplitMix64::new(7);
    for (round, fixed) in [(0, ""), (1, ""), (2, "fixed = [{ nodes = [1] }]")] {
        let case = arms(&mut random);
        let run = |method: &str| {
            let reduction = format!("method = \"{method}\", modes = {{ count = 5 }}");
            case.run(r#", mechanisms = "accept""#, r#"{ name = "a", nodes = [2, 4] }"#, &reduction, fixed)
        };
        let refused = run("herting").expect(ExitCode::ModelPhysics).err;
        assert!(refused.contains("E-NOT-DEFINITE") || refused.contains("E-INTERFACE-RANK"), "{refused}");
        run("rubin").expect(ExitCode::Done);
        let (file, job) = (case.place.text("x.supel"), case.place.text("job.toml"));
        supel(&["verify", &file, "--strict"]).expect(ExitCode::Done);
        supel(&["verify", &file, "--job", &job, "--strict"]).expect(ExitCode::Done);
        let superelement = case.place.superelement("x.supel");
        let is_free = |row: usize| fixed.is_empty() || row >= 6;
        let free: Vec<usize> = (0..case.model.n).filter(|row| is_free(*row)).collect();
        let among = |a: Mat<f64>| Mat::from_fn(free.len(), free.len(), |i, j| a[(free[i], free[j])]);
        let (k, m) = (among(case.stiffness()), among(case.mass()));
        let g = case.g();
        let z = null_space(&Mat::from_fn(g.nrows(), free.len(), |i, j| g[(i, free[j])]));
        let lambda = eigenvalues([&k, &m], &z);
        let n_zero = if fixed.is_empty() { 9 } else { 3 };
        assert_eq!(superelement.tensors().rigid_body_modes.cols(), n_zero, "{round}");
        // The dense spectrum is rounded to ε of its largest, 10⁸ times the softest.
        assert_close(&frequencies_hz(&superelement), &hertz(&lambda[n_zero..n_zero + 5]), 1e-7);
        let [reduced_k, reduced_m] = [&superelement.tensors().stiffness, &superelement.tensors().mass].map(unpacked);
        let whole = Mat::<f64>::identity(reduced_k.nrows(), reduced_k.nrows());
        let of_reduced = eigenvalues([&reduced_k, &reduced_m], &whole);
        assert_close(&hertz(&of_reduced[n_zero..n_zero + 5]), &hertz(&lambda[n_zero..n_zero + 5]), 1e-7);
    }
}

/// A clamped arm with another one hinged to its tip: the inertia relief of the mechanism answers with the soft arm, next to which its answers in
/// the other one are small, and what deforms in its motions by rounding answers likewise.
#[test]
fn the_inertia_relief_of_arms_on_a_hinge_agrees() {
    let mut random = SplitMix64::new(7);
    for round in 0..10 {
        let case = arms(&mut random);
        for method in ["herting", "rubin"] {
            let ends = r#"{ name = "a", nodes = [9, 10] }, { name = "b", nodes = [13, 6] }"#;
            let reduction = format!("method = \"{method}\", modes = {{ count = 3 }}");
            case.run(r#", mechanisms = "accept""#, ends, &reduction, "fixed = [{ nodes = [1] }]")
                .expect(ExitCode::Done);
            let verified = supel(&["verify", &case.place.text("x.supel"), "--job", &case.place.text("job.toml")]);
            assert_eq!(verified.code, ExitCode::Done, "{round}, {method}: {}", verified.out);
        }
    }
}

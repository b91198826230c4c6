//! Motion of recovered nodes: that of the full model.

use faer::linalg::solvers::Solve;
use faer::{Mat, Side};
use supel::cli::ExitCode;
use supel_models::model::multiply;

use super::{Case, any, difference, foot_rows, largest};

/// What two answers by factors of K may differ by: the condition of the interior is some 10⁵, and ε of that is made by a dozen
/// operations on either side.
const EXACT: f64 = 1e-10;

/// Displacements of the full model with its interface moved and nothing else acting.
pub(crate) fn static_answer(case: &Case, u_b: &[f64]) -> Vec<f64> {
    let model = &case.model;
    let interface = foot_rows(model);
    let inside: Vec<usize> = (0..model.n).filter(|row| !interface.contains(row)).collect();
    let mut moved = vec![0.0; model.n];
    interface.iter().zip(u_b).for_each(|(row, value)| moved[*row] = *value);
    let force = multiply(&model.stiffness, &moved);
    let mut k = Mat::zeros(model.n, model.n);
    model.stiffness.iter().for_each(|(i, j, value)| k[(*i as usize, *j as usize)] = *value);
    let k_ii = Mat::from_fn(inside.len(), inside.len(), |i, j| k[(inside[i], inside[j])]);
    let u_i = k_ii.llt(Side::Lower).expect("definite").solve(Mat::from_fn(inside.len(), 1, |i, _| -force[inside[i]]));
    inside.iter().enumerate().for_each(|(at, row)| moved[*row] = u_i[(at, 0)]);
    moved
}

/// Whatever the interface does, what follows inside without inertia is the static answer of the full model, for each of several states.
#[test]
fn a_static_state_is_that_of_the_full_model() {
    let case = Case::new("craig-bampton");
    let header = case.header();
    assert!(
        header.starts_with("foot.1.ux,foot.1.uy,foot.1.uz,foot.11.ux,") && header.ends_with(",eta.4,eta.5"),
        "{header}"
    );
    let states: Vec<Vec<f64>> = (1..4).map(|seed| [any(9, seed), vec![0.0; 5]].concat()).collect();
    case.table("q.csv", &header, &states);
    let ended = case.recover(&["-o", "u.csv"]).expect(ExitCode::Done);
    assert_eq!(ended.out, format!("{}: motion of 135 degrees of freedom in 3 states\n", case.place.text("u.csv")));
    for (number, state) in states.iter().enumerate() {
        let error = difference(&case.values("u.csv", number + 1, "displacement"), &static_answer(&case, &state[..9]));
        assert!(error <= EXACT, "state {}: {error:e}", number + 1);
    }
    let first = &case.rows("u.csv")[1];
    assert_eq!((first["node"].as_str(), first["dof"].as_str(), first.len()), ("1", "uy", 4), "{first:?}");
}

/// A mode of the component with its interface held swings by itself: M ü + K u vanishes inside, with u and ü as they were written; and it
/// is half a period from u to u̇.
#[test]
fn a_mode_swings_as_in_the_full_model() {
    let case = Case::new("craig-bampton");
    let omega = case.place.superelement("x.supel").tensors().frequencies.clone();
    let mode = |k: usize, factor: f64| (0..14).map(|at| if at == 9 + k { factor } else { 0.0 }).collect::<Vec<f64>>();
    let header = format!("Time,{}", case.header());
    let timed = |factor: &dyn Fn(f64) -> f64| -> Vec<Vec<f64>> {
        let state = |(k, omega): (usize, &f64)| [vec![0.25 * k as f64], mode(k, factor(*omega))].concat();
        omega.iter().enumerate().map(state).collect()
    };
    case.table("q.csv", &header, &timed(&|_| 1.0));
    case.table("v.csv", &header, &timed(&|omega| omega));
    case.table("a.csv", &header, &timed(&|omega| -omega * omega));
    case.recover(&["--velocity", "v.csv", "--acceleration", "a.csv", "--output", "u.csv"]).expect(ExitCode::Done);
    let interface = foot_rows(&case.model);
    for (k, omega) in omega.iter().enumerate() {
        let [u, v, a] = ["displacement", "velocity", "acceleration"].map(|name| case.values("u.csv", k + 1, name));
        let (elastic, inertial) = (multiply(&case.model.stiffness, &u), multiply(&case.model.mass, &a));
        let inside = (0..case.model.n).filter(|row| !interface.contains(row));
        let rest: Vec<f64> = inside.map(|row| elastic[row] + inertial[row]).collect();
        // The error of a mode is rounding of K x, ε times the condition of K, some 10⁵, over its eigenvalue.
        assert!(largest(&rest) <= 1e-9 * largest(&elastic), "mode {k}: {:e}", largest(&rest) / largest(&elastic));
        assert!(difference(&v, &u.iter().map(|u| omega * u).collect::<Vec<_>>()) <= 1e-14, "mode {k}");
        let times = case.values("u.csv", k + 1, "time");
        assert!(times.iter().all(|time| *time == 0.25 * k as f64), "{times:?}");
    }
}

/// Columns may stand in any order and have numbers in place of names; the results are the same bytes.
#[test]
fn columns_are_found_by_name_or_number() {
    let case = Case::new("herting");
    let header = case.header();
    let n = header.split(',').count();
    let states: Vec<Vec<f64>> = (1..3).map(|seed| any(n, seed)).collect();
    case.table("q.csv", &header, &states);
    case.recover(&["-o", "u.csv"]).expect(ExitCode::Done);
    let numbers: Vec<String> = (1..=n).rev().map(|number| format!("q{number}")).collect();
    let backwards: Vec<Vec<f64>> = states.iter().map(|state| state.iter().rev().copied().collect()).collect();
    case.table("q.csv", &numbers.join(","), &backwards);
    case.recover(&["-o", "again.csv"]).expect(ExitCode::Done);
    assert!(case.place.bytes("u.csv") == case.place.bytes("again.csv"));
}

/// One node needs no label, and names that a table would misread are numbers.
#[test]
fn every_coordinate_has_a_name_that_a_table_can_hold() {
    let of = |interfaces: &str| Case::with("craig-bampton", interfaces).header();
    let rigid =
        of("{ name = \"hub\", nodes = [5, 15, 35], coupling = \"rigid\" }, { name = \"a, b\", nodes = [1, 2] }");
    assert!(rigid.starts_with("hub.ux,hub.uy,hub.uz,hub.rx,hub.ry,hub.rz,q7,q8,q9,q10,q11,q12,eta.1,"), "{rigid}");
    let alike = of("{ name = \"a\", nodes = [1, 11] }, { name = \"a.1\", nodes = [31] }");
    assert!(alike.starts_with("q1,q2,q3,a.11.ux,a.11.uy,a.11.uz,q7,q8,q9,eta.1,"), "{alike}");
}

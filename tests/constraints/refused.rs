//! Constraints that are refused by name, or told.

use supel::cli::ExitCode;
use supel_models::transform::{join, translated};
use supel_models::{Ends, Material, Model, SplitMix64, brick, spring};
use supel_runtime::Tensors;
use supel_testing::place::{Place, assert_close, frequencies_hz, steel_brick, supel};

use crate::model::{lever, position, rigid_elements, row, with_hub};
use crate::{Case, Rows, matrix_market};

const CRAIG_BAMPTON: &str = r#"method = "craig-bampton", modes = { count = 4 }"#;
const FOOT: &str = r#"{ name = "foot", nodes = [1, 11, 31] }"#;

#[track_caller]
fn assert_refused(case: &Case, interface: &str, words: &[&str]) {
    let ended = case.run("", interface, CRAIG_BAMPTON, "");
    assert!(ended.code == ExitCode::InputData || ended.code == ExitCode::ModelPhysics, "{}{}", ended.out, ended.err);
    words.iter().for_each(|word| assert!(ended.err.contains(word), "{word:?} is not in {}", ended.err));
    assert!(!case.place.path("x.supel").exists());
}

#[test]
fn files_of_constraints_that_cannot_be_taken() {
    let case = Case::new(steel_brick(), vec![vec![]]);
    for (text, words) in [
        ("%%MatrixMarket matrix coordinate real symmetric\n1 135 0\n", ["E-CONSTRAINT-FORMAT", "G.mtx:1"]),
        ("%%MatrixMarket matrix coordinate real general\n1 134 0\n", ["E-CONSTRAINT-SIZE", "134 columns"]),
        ("%%MatrixMarket matrix coordinate real general\n1 135 1\n2 1 1\n", ["E-", "G.mtx:3"]),
        ("%%MatrixMarket matrix coordinate real general\n1 135 1\n1 1 1e200\n", ["E-RANGE", "constraint"]),
    ] {
        case.place.write("G.mtx", text.as_bytes());
        assert_refused(&case, FOOT, &words);
    }
    // A header that promises any number of rows.
    let many = format!("%%MatrixMarket matrix coordinate real general\n{} 135 0\n", u64::MAX);
    case.place.write("G.mtx", many.as_bytes());
    case.run("", FOOT, CRAIG_BAMPTON, "").expect(ExitCode::Done);
    let output = case.place.text("G.mtx");
    assert_ne!(supel(&["reduce", &case.place.text("job.toml"), "--report", &output]).code, ExitCode::Done);
}

/// u = 0 of a dof, or equal displacements of nodes that are apart: what a rigid-body motion does not satisfy is named, and taken where the
/// job accepts it. Then a dof at rest is one that the job holds.
#[test]
fn constraints_that_hold_the_component_to_the_ground() {
    let model = steel_brick();
    let equal = vec![vec![(row(&model, (45, 1)), 1.0), (row(&model, (41, 1)), -1.0)]];
    let case = Case::new(model.clone(), equal);
    // Nodes 41 and 45 are one apart along x: rotation about z moves them by 1/2 and −1/2.
    assert_refused(&case, FOOT, &["E-CONSTRAINT-GROUND", "row 1 (node 41 uy, node 45 uy)", "rotation about z"]);

    let at_rest = vec![vec![], vec![(row(&model, (45, 1)), -2.5)], vec![(row(&model, (45, 2)), 1.0)]];
    let case = Case::new(model, at_rest);
    assert_refused(
        &case,
        FOOT,
        &["E-CONSTRAINT-GROUND", "row 2 (node 45 uy)", "translation along y", "2 constraints do so"],
    );
    case.run(r#", constraints_to_ground = "accept""#, FOOT, CRAIG_BAMPTON, "").expect(ExitCode::Done);
    let (codes, told) = case.told();
    assert_eq!(codes, ["W-CONSTRAINT-GROUND"], "{told}");
    assert!(told.contains("2 constraints, 2 dofs are held at rest; 1 row has no terms"), "{told}");
    let (file, job) = (case.place.text("x.supel"), case.place.text("job.toml"));
    for args in [&["verify", &file] as &[&str], &["verify", &file, "--job", &job]] {
        supel(args).expect(ExitCode::Done);
    }
    let found = case.place.superelement("x.supel");
    assert!(found.metadata().validity.assumptions.iter().any(|words| words.contains("ground")));
    case.place.write("G.mtx", matrix_market(135, &vec![vec![]], |value| value.to_string()).as_bytes());
    let held = "[[fixed]]\nnodes = [45]\ndofs = [\"uy\", \"uz\"]\n";
    case.run("", FOOT, CRAIG_BAMPTON, held).expect(ExitCode::Done);
    let without_gravity = |tensors: &Tensors| Tensors { gravity: None, ..tensors.clone() };
    let expected = case.place.superelement("x.supel");
    assert_eq!(without_gravity(found.tensors()), without_gravity(expected.tensors()));
    assert_eq!(found.metadata().model.n_dofs, expected.metadata().model.n_dofs);
}

/// Factors of four digits hold a rotation softly, and the warning names the row; what rounding leaves of a factor is none.
#[test]
fn constraints_of_few_digits_are_told() {
    let (model, hub) = with_hub(&steel_brick(), [1.0, 0.155, 0.115]);
    let exact = rigid_elements(&model, hub, &[5, 15, 45]);
    let mut rounded = exact.clone();
    rounded[1].iter_mut().for_each(|(_, value)| *value *= if value.abs() < 1.0 { 1.0 + 3e-5 } else { 1.0 });
    let mut dusty = exact.clone();
    dusty[0].push((row(&model, (1, 1)), 1e-17));
    for (rows, expected) in [(exact, false), (rounded, true), (dusty, false)] {
        let case = Case::new(model.clone(), rows);
        let ended = case.run("", FOOT, CRAIG_BAMPTON, "");
        let said = format!("{}{}", ended.out, ended.err);
        assert!(!said.contains("E-CONSTRAINT-GROUND"), "{said}");
        let (codes, told) = case.told();
        assert_eq!(codes.iter().any(|code| code == "W-CONSTRAINT-ROUNDED"), expected, "{told}{said}");
        assert!(!expected || told.contains("row 2 (node") && told.contains("is held by as much"), "{told}");
    }
    // Equal rotations of two nodes, and dust along a displacement.
    let (model, other) = with_hub(&model, [0.0, 0.155, 0.115]);
    let mut rows: Rows = rigid_elements(&model, hub, &[5, 15, 45]);
    rows.extend(rigid_elements(&model, other, &[1, 11, 41]));
    rows.push(vec![(row(&model, (hub, 3)), 1.0), (row(&model, (other, 3)), -1.0), (row(&model, (hub, 1)), 1e-16)]);
    let case = Case::new(model, rows);
    case.run("", r#"{ name = "foot", nodes = [3, 33, 8] }"#, CRAIG_BAMPTON, "").expect(ExitCode::Done);
}

/// Levers and shares of four digits, or of single precision, hold no rotation: they are set right within their digits.
#[test]
fn constraints_of_few_digits_are_set_right() {
    let (model, hub) = with_hub(&steel_brick(), [1.0317, 0.153_71, 0.114_93]);
    let rows = rigid_elements(&model, hub, &[5, 15, 45]);
    let case = Case::new(model.clone(), rows.clone());
    let exact = case.reduced(FOOT, CRAIG_BAMPTON, "");
    assert_eq!((exact.n_rigid(), case.told().0), (6, Vec::new()));
    let four: &dyn Fn(f64) -> String = &|value| format!("{value:.3e}");
    let single: &dyn Fn(f64) -> String = &|value| f64::from(value as f32).to_string();
    let decimals: &dyn Fn(f64) -> String = &|value| format!("{value:.4}");
    for (number, near) in [(four, 1e-4), (decimals, 1e-3), (single, 1e-7)] {
        case.place.write("G.mtx", matrix_market(model.n, &rows, number).as_bytes());
        let rounded = case.reduced(FOOT, CRAIG_BAMPTON, "");
        let (codes, told) = case.told();
        assert_eq!((rounded.n_rigid(), codes), (6, vec!["W-CONSTRAINT-ROUNDED".to_owned()]), "{told}");
        assert!(told.contains("constraints resisted rigid-body motion by what their few digits leave"), "{told}");
        assert!(told.contains("error bars of frequencies do not count"), "{told}");
        assert_close(&frequencies_hz(&rounded), &frequencies_hz(&exact), near);
    }
}

/// Factors that rounding left of none, as a solution by least squares has them, in as few digits as all others.
#[test]
fn factors_that_are_rounding_of_none_keep_no_constraint_from_being_set_right() {
    let (model, hub) = with_hub(&steel_brick(), [1.0317, 0.153_71, 0.114_93]);
    let rows = rigid_elements(&model, hub, &[5, 15, 45]);
    let exact = Case::new(model.clone(), rows.clone()).reduced(FOOT, CRAIG_BAMPTON, "");
    let digits = |value: f64| format!("{value:.3e}");
    for size in [1e-18, 1e-12] {
        let of_row = |(number, terms): (usize, &Vec<(u32, f64)>)| {
            let has = |row: u32| terms.iter().any(|(own, _)| *own == row);
            // Of two nodes of which the constraint has one, in the directions that it has not.
            let rest = [5_i64, 15].iter().flat_map(|label| [0, 1, 2].map(|axis| row(&model, (*label, axis))));
            let rest: Vec<u32> = rest.filter(|row| !has(*row)).collect();
            let noise =
                rest.iter().enumerate().map(|(k, row)| (*row, size * (1.3 + (number * 7 + k * 3) as f64 / 17.0)));
            terms.iter().copied().chain(noise).collect::<Vec<_>>()
        };
        let noisy: Rows = rows.iter().enumerate().map(of_row).collect();
        let case = Case::new(model.clone(), noisy.clone());
        case.place.write("G.mtx", matrix_market(model.n, &noisy, digits).as_bytes());
        let rounded = case.reduced(FOOT, CRAIG_BAMPTON, "");
        let (codes, told) = case.told();
        assert_eq!((rounded.n_rigid(), codes), (6, vec!["W-CONSTRAINT-ROUNDED".to_owned()]), "{size:e}: {told}");
        assert!(told.contains("set right within their digits"), "{size:e}: {told}");
        assert_close(&frequencies_hz(&rounded), &frequencies_hz(&exact), 1e-4);
    }
}

/// Factors of the displacements of some nodes that let every rigid-body motion pass, without a pattern otherwise.
fn passing(model: &Model, labels: &[i64], random: &mut SplitMix64) -> Vec<(u32, f64)> {
    let dofs: Vec<(i64, u8)> = labels.iter().flat_map(|label| [0, 1, 2].map(|axis| (*label, axis))).collect();
    let motion = |j: usize| {
        let of = |(label, axis): &(i64, u8)| lever(position(model, *label), usize::from(*axis))[j];
        dofs.iter().map(of).collect::<Vec<f64>>()
    };
    let dot = |a: &[f64], b: &[f64]| a.iter().zip(b).map(|(a, b)| a * b).sum::<f64>();
    let mut basis: Vec<Vec<f64>> = Vec::new();
    let start: Vec<f64> = dofs.iter().map(|_| random.uniform() - 0.5).collect();
    for motion in (0..6).map(motion).chain([start]) {
        let mut left = motion;
        for own in basis.iter().chain(&basis) {
            let along = dot(own, &left);
            left.iter_mut().zip(own).for_each(|(left, own)| *left -= along * own);
        }
        let size = dot(&left, &left).sqrt();
        left.iter_mut().for_each(|value| *value /= size);
        basis.push(left);
    }
    let factors = basis.pop().expect("what is left of the start");
    dofs.iter().zip(factors).map(|(dof, factor)| (row(model, *dof), factor)).collect()
}

/// Constraints that are sums of others, each written with few digits: what these leave of them is no constraint.
#[test]
fn sums_of_constraints_of_few_digits_are_no_others() {
    let model = steel_brick();
    let mut random = SplitMix64::new(5);
    let of_nodes = |labels: &[i64], random: &mut SplitMix64| passing(&model, labels, random);
    let [first, second] = [[5, 15, 45, 30, 20], [5, 15, 45, 30, 20]].map(|labels| of_nodes(&labels, &mut random));
    let sum = first.iter().zip(&second).map(|((row, a), (_, b))| (*row, 0.7 * (a + b))).collect();
    let rows: Rows = vec![first, second, sum];
    let case = Case::new(model.clone(), rows.clone());
    case.reduced(FOOT, CRAIG_BAMPTON, "");
    assert!(case.told().1.contains("3 constraints, 2 dofs follow others"), "{}", case.told().1);
    for n_digits in 4..9 {
        let digits = |value: f64| format!("{value:.*e}", n_digits - 1);
        let case = Case::new(model.clone(), rows.clone());
        case.place.write("G.mtx", matrix_market(model.n, &rows, digits).as_bytes());
        assert_refused(&case, FOOT, &["E-CONSTRAINT-RANK"]);
    }
}

/// Two halves of a bar with a gap between them, equal dofs of the nodes on either side of it tied.
fn tied_halves(gap: f64) -> (Model, Rows) {
    let half = brick([2, 2, 2], [0.5, 0.31, 0.23], &Material::STEEL_SI);
    let model = join(&half, &translated(&half, [0.5 + gap, 0.0, 0.0]), &[]);
    let (ends, starts): (Vec<i64>, Vec<i64>) =
        (1..=27).filter(|label| label % 3 != 2).partition(|label| label % 3 == 0);
    let tie = |(end, start): (&i64, &i64)| {
        let of = |axis: u8| vec![(row(&model, (*end, axis)), 1.0), (row(&model, (27 + start, axis)), -1.0)];
        [0, 1, 2].map(of)
    };
    let rows = ends.iter().zip(&starts).flat_map(tie).collect();
    (model, rows)
}

/// A small factor of a constraint is not taken for a rounded zero: a row that compares two more nodes by a ten-thousandth stays as it is.
#[test]
fn a_small_factor_is_not_set_to_nothing() {
    let (model, mut rows) = tied_halves(0.0);
    let mut more = rows[0].clone();
    more.extend([(row(&model, (2, 0)), 1e-4), (row(&model, (5, 0)), -1e-4)]);
    rows.push(more);
    let n_rows = rows.len();
    let case = Case::new(model, rows);
    case.reduced(r#"{ name = "foot", nodes = [1, 7, 25] }"#, CRAIG_BAMPTON, "");
    let (codes, told) = case.told();
    assert!(codes.iter().any(|code| code == "W-CONSTRAINT-ROUNDED"), "{told}");
    assert!(!told.contains("set right within their digits"), "{told}");
    assert!(told.contains(&format!("{n_rows} constraints, {n_rows} dofs follow others")), "{told}");
}

/// Ties of equal dofs of nodes that are apart are no constraints of few digits. The halves turn together at the cost of a little motion along
/// the gap, and the warning of motions inside says where it may come from.
#[test]
fn ties_of_nodes_that_are_a_little_apart_are_told() {
    let (model, rows) = tied_halves(1e-5);
    let case = Case::new(model, rows);
    case.reduced(r#"{ name = "foot", nodes = [1, 7, 25] }"#, CRAIG_BAMPTON, "");
    let (codes, told) = case.told();
    assert!(["W-CONSTRAINT-ROUNDED", "W-MECHANISM"].iter().all(|code| codes.iter().any(|own| own == code)), "{told}");
    assert!(told.contains("rigid-body motions that constraints resist, as W-CONSTRAINT-ROUNDED says"), "{told}");
}

/// Interface dofs are coordinates of the superelement and move independently.
#[test]
fn constraints_between_interface_dofs() {
    let (model, hub) = with_hub(&steel_brick(), [1.0, 0.155, 0.115]);
    let rows = rigid_elements(&model, hub, &[5, 15, 45]);
    let in_line = rigid_elements(&model, hub, &[5, 25, 45]);
    let case = Case::new(model.clone(), rows);
    let all = format!("{{ name = \"ends\", nodes = [1, 5, 15, 45, {hub}] }}");
    assert_refused(&case, &all, &["E-CONSTRAINT-INTERFACE", "constraint row", "`dofs`"]);
    // Two nodes of one rigid body have a distance that does not change.
    assert_refused(&case, r#"{ name = "ends", nodes = [1, 5, 15] }"#, &["E-CONSTRAINT-INTERFACE"]);
    case.run("", r#"{ name = "ends", nodes = [1, 3, 15] }"#, CRAIG_BAMPTON, "").expect(ExitCode::Done);
    // Nodes in line do not say how the hub turns about that line.
    let case = Case::new(model, in_line);
    assert_refused(&case, FOOT, &["E-CONSTRAINT-LOOSE", "1 dof has", "node 46 r", "not in line"]);
}

/// A circle of ties of six digits: whether its last one says the same as the others is not for a program to judge.
#[test]
fn constraints_that_nearly_follow_from_others() {
    let (model, hub) = with_hub(&steel_brick(), [1.0, 0.155, 0.115]);
    let (model, other) = with_hub(&model, [1.0, 0.155, 0.115]);
    let ends = [5, 10, 25, 40, 45];
    let both =
        |model: &Model| -> Rows { [hub, other].iter().flat_map(|hub| rigid_elements(model, *hub, &ends)).collect() };
    // With all digits both hubs move alike.
    let case = Case::new(model.clone(), both(&model));
    case.run("", FOOT, CRAIG_BAMPTON, "").expect(ExitCode::Done);
    let (_, told) = case.told();
    assert!(told.contains("30 constraints, 21 dofs follow others"), "{told}");
    // Of four digits they are set right, and the circle closes.
    let (apart, hub) = with_hub(&steel_brick(), [1.0317, 0.153_71, 0.114_93]);
    let (apart, other) = with_hub(&apart, [1.0479, 0.147_13, 0.118_37]);
    let rows: Rows = [hub, other].iter().flat_map(|hub| rigid_elements(&apart, *hub, &ends)).collect();
    let of_few = Case::new(apart, rows.clone());
    let four = matrix_market(of_few.model.n, &rows, |value| format!("{value:.3e}"));
    of_few.place.write("G.mtx", four.as_bytes());
    of_few.run("", FOOT, CRAIG_BAMPTON, "").expect(ExitCode::Done);
    let (_, told) = of_few.told();
    assert!(told.contains("30 constraints, 21 dofs follow others"), "{told}");
    std::fs::remove_file(case.place.path("x.supel")).expect("a file");
    // Levers that differ more than their digits say, not the same ones in each row.
    let mut rows = both(&model);
    for (number, row) in rows.iter_mut().enumerate() {
        let levers = row.iter_mut().filter(|(_, value)| value.abs() != 1.0);
        levers.for_each(|(_, value)| *value *= 1.0 + 3e-7 * (number as f64).sin());
    }
    case.place.write("G.mtx", matrix_market(model.n, &rows, |value| value.to_string()).as_bytes());
    assert_refused(&case, FOOT, &["E-CONSTRAINT-RANK", "follows from others but for", "all digits"]);
}

/// A node far from the others that follow it, with a coefficient of a ten-thousandth and less.
#[test]
fn constraints_that_spread_too_far() {
    let model = steel_brick();
    let [a, b, c] = [(1, 0), (2, 0), (3, 0)].map(|dof| row(&model, dof));
    // u₁ = u₂ but for a little of u₃: with both in the interface it is u₃ that follows, 50,000 times as far.
    let rows = vec![vec![(a, 1.0), (b, -1.0 - 2e-5), (c, 2e-5)]];
    let case = Case::new(model, rows);
    assert_refused(&case, r#"{ name = "ends", nodes = [1, 2, 45] }"#, &["E-CONSTRAINT-SPREAD", "node 3 ux", "5.0e4"]);
    assert!(position(&case.model, 3)[0] > 0.0);
}

/// Without a dof map nothing tells a motion, so that constraints are taken as they are.
#[test]
fn constraints_on_rows() {
    let n = 6000;
    let chain = Model { dofs: Vec::new(), ..spring(n, Ends::Free) };
    let circle: Rows = (0..4200u32).map(|row| [0, 1, 7].map(|step| ((row + step) % 4200, 1.0)).to_vec()).collect();
    let interface = r#"{ name = "ends", nodes = { rows = [5999] } }"#;
    assert_refused(&Case::new(chain, circle), interface, &["E-CONSTRAINT-BLOCK", "one of 4200 between 4200 dofs"]);

    let chain = |n: usize| Model { dofs: Vec::new(), ..spring(n, Ends::Free) };
    let all: Rows = (0..4).map(|row| vec![(row, 1.0)]).collect();
    let case = Case::new(chain(4), all);
    assert_refused(&case, "", &["E-CONSTRAINT-ALL", "hold all 4 dofs at rest"]);
    // A chain of which all masses move alike, and one whose mass is at rest.
    let alike: Rows = (0..3).map(|row| vec![(row, 1.0), (row + 1, -1.0)]).collect();
    assert_refused(&Case::new(chain(4), alike), "", &["E-CONSTRAINT-ALL", "nothing but 1 rigid-body motion"]);
    let mut seismic = chain(3);
    seismic.mass.retain(|(row, ..)| *row == 0);
    assert_refused(&Case::new(seismic, vec![vec![(0, 1.0)]]), "", &["E-CONSTRAINT-ALL", "no mass"]);
    // Two rows without stiffness and mass, tied to each other alone.
    let mut loose = chain(6);
    loose.n = 8;
    let case = Case::new(loose, vec![vec![(6, 1.0), (7, -1.0)]]);
    assert_refused(&case, r#"{ name = "ends", nodes = { rows = [0] } }"#, &["E-CONSTRAINT-LOOSE", "row 8"]);
    // Tied to a row that has both they follow it, dropped rows counted or not.
    let case = Case::new(case.model.clone(), vec![vec![(6, 1.0), (0, -1.0)], vec![(7, 1.0), (6, -1.0)]]);
    for drop_empty in ["", ", drop_empty = true"] {
        case.run(drop_empty, r#"{ name = "ends", nodes = { rows = [7] } }"#, CRAIG_BAMPTON, "").expect(ExitCode::Done);
        let place = Place::with(&spring(6, Ends::Free));
        place
            .reduce(&place.matrix_flags(), "--interface ends=rows:0 --method craig-bampton --modes 4")
            .expect(ExitCode::Done);
        let (found, expected) = (case.place.superelement("x.supel"), place.superelement("x.supel"));
        assert_eq!(found.tensors().frequencies.len(), 4);
        supel_testing::place::assert_close(&found.tensors().frequencies, &expected.tensors().frequencies, 1e-12);
    }
}

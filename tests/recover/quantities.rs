//! Quantities that follow from displacements: those of the full model.

use supel::cli::ExitCode;
use supel_models::model::dot;
use supel_runtime::{Matrix, Superelement, Tensors};
use supel_testing::place::supel;

use super::{Case, any, files, foot_and_hub};
use crate::displacements::static_answer;

/// Elongation of the line from the first to the second node of each row of some pairs per its length, in other units: strain, strain in
/// millionths, stress in pascals. Rows of R as entries (row of the model, value).
fn rows(case: &Case) -> Vec<Vec<(usize, f64)>> {
    let pairs = [(3, 4, 1.0), (7, 8, 1e6), (23, 29, 2.1e11), (10, 34, 1e-3)];
    let of_pair = |(a, b, unit): (usize, usize, f64)| {
        let [a, b] = [a - 1, b - 1];
        let d: [f64; 3] = std::array::from_fn(|i| case.model.nodes[b][i] - case.model.nodes[a][i]);
        let square = dot(&d, &d);
        (0..3).flat_map(|i| [(3 * b + i, unit * d[i] / square), (3 * a + i, -unit * d[i] / square)]).collect()
    };
    pairs.map(of_pair).into()
}

const NAMES: &str = "name,unit\nεxx at 3,1\n\"shear, at 7\",µm/m\nσ at 23,Pa\nelongation of the bolt,\n";

/// The case with its quantities, from a file of entries in any order, one of them in two parts.
fn case(interfaces: &str, more: &str) -> Case {
    let case = Case::writing("craig-bampton", interfaces, "");
    let mut entries: Vec<(usize, usize, f64)> = Vec::new();
    for (i, row) in rows(&case).iter().enumerate() {
        entries.extend(row.iter().map(|(column, value)| (i, *column, *value)));
    }
    let (i, j, value) = entries[0];
    entries[0].2 = 0.75 * value;
    entries.push((i, j, 0.25 * value));
    entries.reverse();
    let mut text = format!("%%MatrixMarket matrix coordinate real general\n% strains\n4 135 {}\n", entries.len());
    entries.iter().for_each(|(i, j, value)| text += &format!("{} {} {value:e}\n", i + 1, j + 1));
    case.place.write("R.mtx", text.as_bytes());
    case.place.write("names.csv", NAMES.as_bytes());
    case.again(interfaces, &format!("{QUANTITIES}\n{more}"))
}

const QUANTITIES: &str = "quantities = { matrix = \"R.mtx\", names = \"names.csv\" }";

const ALL: &str = "recovery = { nodes = { within = { box = { min = [0, 0, 0], max = [1, 1, 1] } } } }";

/// Strains and stresses of a static state are those of the full model, whatever their units.
#[test]
fn quantities_of_a_static_state_are_those_of_the_full_model() {
    let case = case("{ name = \"foot\", nodes = [1, 11, 31] }", "");
    let states: Vec<Vec<f64>> = (1..3).map(|seed| [any(9, seed), vec![0.0; 5]].concat()).collect();
    case.table("q.csv", &case.header(), &states);
    let ended = case.recover(&["--quantities", "s.csv"]).expect(ExitCode::Done);
    assert!(ended.out.ends_with("s.csv: 4 quantities in 2 states\n"), "{}", ended.out);
    let text = String::from_utf8(case.place.bytes("s.csv")).expect("UTF-8");
    let lines: Vec<&str> = text.lines().collect();
    assert_eq!((lines[0], lines.len()), ("state,quantity,unit,value", 9));
    assert!(lines[6].starts_with("2,\"shear, at 7\",µm/m,") && lines[8].starts_with("2,elongation of the bolt,,"));
    for (number, state) in states.iter().enumerate() {
        let u = static_answer(&case, &state[..9]);
        for (i, row) in rows(&case).iter().enumerate() {
            let found: f64 = lines[1 + 4 * number + i].rsplit(',').next().expect("a value").parse().expect("a number");
            let terms: f64 = row.iter().map(|(k, value)| (value * u[*k]).abs()).sum();
            let expected: f64 = row.iter().map(|(k, value)| value * u[*k]).sum();
            // Both displacements are good to 1e-10 of the largest, as those of a static state are.
            assert!((found - expected).abs() <= 1e-9 * terms, "row {i}: {found} for {expected}");
            assert!(expected.abs() > 1e-4 * terms, "there is something to compare with");
        }
    }
}

/// R T Ψ is R times the rows of all nodes, those of a rigid patch and of held dofs among them.
#[test]
fn rows_of_quantities_are_those_of_the_recovered_nodes() {
    let held = format!("{ALL}\n[[fixed]]\nnodes = [23]\ndofs = [\"uy\"]");
    let case = case(foot_and_hub(), &held);
    let file = case.place.superelement("x.supel");
    let (w, found) =
        (file.tensors().recovery.as_ref().expect("rows"), file.tensors().quantities.as_ref().expect("rows"));
    let units: Vec<&str> = file.metadata().quantities.iter().map(|quantity| quantity.unit.as_str()).collect();
    assert_eq!(units, ["1", "µm/m", "Pa", ""]);
    for (i, row) in rows(&case).iter().enumerate() {
        for j in 0..file.n_coordinates() {
            let terms: Vec<f64> = row.iter().map(|(k, value)| value * w.rows()[(*k, j)]).collect();
            let expected: f64 = terms.iter().sum();
            let size: f64 = terms.iter().map(|term| term.abs()).sum();
            // A dozen products, summed in another order; rows of the patch are six products each.
            assert!((found[(i, j)] - expected).abs() <= 100.0 * f64::EPSILON * size, "{i}, {j}");
        }
    }
    let uy = w.dofs().iter().position(|dof| dof.node == 23 && dof.direction == supel_runtime::Direction::Uy);
    assert!(w.rows().row(uy.expect("held, and recovered")).expect("a row").iter().all(|value| *value == 0.0));
}

/// `verify --job` compares every row by itself: a small one is seen next to one that is 10¹¹ times as large.
#[test]
fn rows_that_are_not_those_of_the_model_fail() {
    let case = case(foot_and_hub(), ALL);
    let verify = |more: &[&str]| supel(&[&["verify", &case.place.text("x.supel")][..], more].concat());
    let job = case.place.text("job.toml");
    verify(&["--job", &job]).expect(ExitCode::Done);
    let alone = verify(&[]).expect(ExitCode::Done);
    assert!(alone.out.contains("quantities") && alone.out.contains("names, units and rows of a recovery matrix"));
    let whole = case.place.superelement("x.supel");
    let rows = whole.tensors().quantities.clone().expect("rows");
    let cols = rows.cols();
    type Change<'a> = (&'a str, &'a dyn Fn(usize, usize) -> f64);
    let changes: [Change<'_>; 4] = [
        ("every seventh value", &|i, j| rows[(i, j)] * if (i * cols + j).is_multiple_of(7) { 1.5 } else { 1.0 }),
        ("rows exchanged", &|i, j| rows[([1, 0, 2, 3][i], j)]),
        ("a small row", &|i, j| rows[(i, j)] * if i == 3 { 1.0 + 1e-6 } else { 1.0 }),
        ("a modal value", &|i, j| rows[(i, j)] * if (i, j) == (0, cols - 1) { 1.0 + 1e-6 } else { 1.0 }),
    ];
    for (what, value) in changes {
        let tensors = Tensors { quantities: Some(Matrix::from_fn(4, cols, value)), ..whole.tensors().clone() };
        let altered = Superelement::new(tensors, whole.metadata().clone()).expect("a superelement");
        assert!(altered != whole, "{what} changes nothing");
        altered.write(&case.place.path("x.supel")).expect("written");
        let ended = verify(&["--job", &job]).expect(ExitCode::CheckFailed);
        assert!(ended.out.contains("quantities are those of the full model"), "{what}: {}", ended.out);
    }
}

#[test]
fn files_of_quantities_that_cannot_be_read() {
    let case = case("{ name = \"foot\", nodes = [1, 11, 31] }", "");
    let matrix = String::from_utf8(case.place.bytes("R.mtx")).expect("UTF-8");
    let banner = "%%MatrixMarket matrix coordinate real general\n";
    let wrong = [
        ("R.mtx", matrix.replace("general", "symmetric"), "E-QUANTITY-FORMAT"),
        ("R.mtx", matrix.replace("4 135", "4 134"), "E-QUANTITY-SIZE"),
        ("R.mtx", matrix.replace("4 135", "3 135"), "E-QUANTITY-SIZE"),
        ("R.mtx", format!("{banner}4 135\n"), "E-QUANTITY-FORMAT"),
        ("R.mtx", format!("{banner}4 135 18446744073709551615\n1 1 1\n"), "found"),
        ("R.mtx", format!("{banner}4 135 1\n5 1 1\n"), "E-"),
        ("R.mtx", format!("{banner}4 135 1\n1 1 nan\n"), "E-"),
        ("R.mtx", format!("{banner}4 135 1\n1 1 1\n1 2 1\n"), "E-"),
        ("names.csv", NAMES.replace("σ at 23", "εxx at 3"), "E-QUANTITY-NAME"),
        ("names.csv", NAMES.replace("σ at 23", " "), "E-QUANTITY-NAME"),
        ("names.csv", NAMES.replace("name,", "title,"), "E-TABLE-COLUMN"),
        ("names.csv", "name,unit\n".to_owned(), "E-NO-DATA"),
    ];
    let before = case.place.bytes("x.supel");
    for (name, text, said) in wrong {
        let sound = case.place.bytes(name);
        case.place.write(name, text.as_bytes());
        let ended = supel(&["reduce", &case.place.text("job.toml"), "--quiet"]).expect(ExitCode::InputData);
        assert!(ended.err.contains(said), "{said} in {}", ended.err);
        case.place.write(name, &sound);
    }
    assert!(case.place.bytes("x.supel") == before);
    let output = case.place.text("names.csv");
    let ended = supel(&["reduce", &case.place.text("job.toml"), "--report", &output]);
    assert_ne!(ended.code, ExitCode::Done, "an input is no output");
    case.table("q.csv", &case.header(), &[any(14, 1)]);
    let names = files(&case);
    let ended = case.recover(&["-o", "u.csv", "--quantities", "s.csv"]).expect(ExitCode::Usage);
    assert!(ended.err.contains("E-NO-RECOVERY") && ended.err.contains("write.recovery"), "{}", ended.err);
    assert_eq!(files(&case), names);
    supel(&["recover", &case.place.text("x.supel"), "--state", &case.place.text("q.csv")]).expect(ExitCode::Usage);
}

//! The columns Ψᵀf.

use supel::cli::ExitCode;
use supel_models::model::dot;
use supel_testing::place::{Place, steel_brick, supel};

use crate::{Case, METHODS, array, centrifugal, elbow, pressure, shared_out};

const LOADS: &str = r#"
    { name = "thrust", nodes = [13, 18, 28], force = [2.0, 0.0, -3.0] },
    { name = "pressure", file = "pressure.mtx" },
    { name = "spin", rotation = { axis = [0, 0, 3], through = [0.2, 0.1, 7] } }"#;

/// A block that is free or clamped, coupled directly or by a patch.
fn blocks() -> Vec<Case> {
    let direct = r#"{ name = "tip", nodes = [5, 15, 45] }"#;
    let patch = r#"{ name = "tip", coupling = "rigid", nodes = { within = { box = { min = [0.9, 0, 0], max = [1, 1, 1] } } } }"#;
    let wall = "{ nodes = [1, 6, 11, 16, 21, 26, 31, 36, 41] }, { nodes = [23], dofs = [\"uy\"] }";
    let case = |name, interface, fixed| Case { name, model: steel_brick(), interface, fixed, loads: LOADS };
    vec![
        case("free", direct, ""),
        case("free with a patch", patch, ""),
        case("clamped", direct, wall),
        case("clamped with a patch", patch, wall),
    ]
}

/// f̂ = WᵀF, W the rows of every dof: forces on held dofs are lost, those on a patch go to its node, mass of held dofs takes part in
/// the centrifugal load.
#[test]
fn load_vectors_are_the_work_of_the_loads_on_the_shapes() {
    for case in blocks() {
        let model = &case.model;
        let expected = [
            shared_out(model, &[13, 18, 28], [2.0, 0.0, -3.0]),
            pressure(model),
            centrifugal(model, [0.0, 0.0, 1.0], [0.2, 0.1, 7.0]),
        ];
        for method in METHODS {
            let (_, file) = case.made(method, 5);
            assert_eq!(file.metadata().load_names, ["thrust", "pressure", "spin"]);
            let loads = file.tensors().load_vectors.as_ref().expect("loads");
            let w = file.tensors().recovery.as_ref().expect("rows").rows();
            assert_eq!((loads.rows(), loads.cols(), w.rows()), (w.cols(), 3, model.n));
            for (at, load) in expected.iter().enumerate() {
                for column in 0..w.cols() {
                    let shape: Vec<f64> = (0..w.rows()).map(|row| w[(row, column)]).collect();
                    let sizes: Vec<f64> = shape.iter().map(|value| value.abs()).collect();
                    let terms: Vec<f64> = load.iter().map(|value| value.abs()).collect();
                    // Two sums of n products, here and in supel; entries of M p are sums of n more.
                    let bound = 4.0 * model.n as f64 * f64::EPSILON * dot(&sizes, &terms);
                    let error = (loads[(column, at)] - dot(&shape, load)).abs();
                    assert!(
                        error <= bound,
                        "{}, {method}, load {at}, coordinate {column}: {error:e} above {bound:e}",
                        case.name
                    );
                }
            }
        }
    }
}

/// A file of several columns, as an array or by places, with entries that add up: the column asked for.
#[test]
fn columns_of_files() {
    let place = Place::with(&elbow());
    let one = pressure(&elbow());
    let other: Vec<f64> = one.iter().map(|value| value * value - 0.5).collect();
    place.write("both.mtx", array(&[one.clone(), other.clone()]).as_bytes());
    let mut text = format!("%%MatrixMarket matrix coordinate real general\n% by places\n36 3 {}\n", 2 * 36);
    for (row, value) in other.iter().enumerate() {
        let half = 0.5 * value;
        text += &format!("{} 3 {half:.17e}\n{} 3 {}\n", row + 1, row + 1, format!("{half:.17e}").replace('e', "D"));
    }
    place.write("places.mtx", text.as_bytes());
    let job = r#"
model     = { stiffness = "K.mtx", mass = "M.mtx", dofs = "dofs.txt", nodes = "nodes.csv" }
interface = [{ name = "ends", nodes = [1, 6] }]
load      = [
    { name = "a", file = "both.mtx", column = 1 },
    { name = "b", file = "places.mtx", column = 2 },
    { name = "c", file = "both.mtx", column = 0 },
]
reduction = { method = "craig-bampton", modes = { count = 3 } }
write     = { superelement = "x.supel" }
"#;
    place.write("job.toml", job.as_bytes());
    supel(&["reduce", &place.text("job.toml")]).expect(ExitCode::Done);
    let file = place.superelement("x.supel");
    let loads = file.tensors().load_vectors.as_ref().expect("loads");
    let column = |at: usize| -> Vec<f64> { (0..loads.rows()).map(|row| loads[(row, at)]).collect() };
    assert_eq!(column(0), column(1), "the same numbers by another way");
    assert_ne!(column(0), column(2));
    assert_eq!(file.metadata().inputs.keys().filter(|role| role.starts_with("load ")).count(), 3);
}

/// `verify`, alone and with the job, believes what `reduce` has made, also where the files of the job have moved.
#[test]
fn verification_believes_them() {
    for case in blocks() {
        for method in METHODS {
            let (place, _) = case.made(method, 5);
            let alone = supel(&["verify", &place.text("x.supel")]);
            assert_eq!(alone.code, ExitCode::Done, "{}, {method}: {}", case.name, alone.out);
            let full = supel(&["verify", &place.text("x.supel"), "--job", &place.text("job.toml")]);
            assert_eq!(full.code, ExitCode::Done, "{}, {method}: {}", case.name, full.out);
            assert!(full.out.contains("loads of the job are those of the full"), "{}", full.out);
        }
    }
}

/// Another file under the same name is seen by its digest and by its loads.
#[test]
fn verification_sees_another_load() {
    let case = Case {
        name: "elbow",
        model: elbow(),
        interface: r#"{ name = "ends", nodes = [1, 6] }"#,
        fixed: "",
        loads: r#"{ name = "thrust", nodes = [3], force = [0, 0, 1] }, { name = "pressure", file = "pressure.mtx" }"#,
    };
    let (place, _) = case.made("herting", 4);
    let mut other = pressure(&case.model);
    other[14] *= 1.0 + 1e-6;
    place.write("pressure.mtx", array(&[other]).as_bytes());
    let ended = supel(&["verify", &place.text("x.supel"), "--job", &place.text("job.toml")]);
    assert_eq!(ended.code, ExitCode::CheckFailed, "{}", ended.out);
    assert!(ended.out.contains("pressure at"), "the load is named: {}", ended.out);
    assert!(ended.out.contains("load pressure"), "the file is named: {}", ended.out);
    // Loads that are named in another order are taken for different ones.
    let job = case
        .job("herting", 4)
        .replace("thrust", "x")
        .replace("\"pressure\"", "\"thrust\"")
        .replace("\"x\"", "\"pressure\"");
    place.write("swapped.toml", job.as_bytes());
    place.write("pressure.mtx", array(&[pressure(&case.model)]).as_bytes());
    let ended = supel(&["verify", &place.text("x.supel"), "--job", &place.text("swapped.toml")]);
    assert_eq!(ended.code, ExitCode::CheckFailed, "{}", ended.out);
}

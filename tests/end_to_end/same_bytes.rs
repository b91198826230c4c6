//! Same input, same bytes: whatever the threads, the folder, the memory, the day, and what else the process does.

use supel::cli::ExitCode;
use supel_models::{Assembler, Ends, Material, Model, brick, spring};
use supel_testing::chain::certified::eigensolver_words;

use crate::place::{Place, frequencies_hz, supel};

/// Superelement and body of the report.
type Written = (Vec<u8>, String);

/// Numbers of threads: an even and an odd one, more than small machines have.
const THREADS: [&str; 3] = ["1", "2", "7"];

/// The bundled example.
fn reduced(place: &Place, method: &str, threads: &str) -> Written {
    reduced_by(place, &["--method", method, "--threads", threads])
}

fn reduced_by(place: &Place, flags: &[&str]) -> Written {
    let job = place.text("job.toml");
    supel(&[["reduce", &job].as_slice(), flags].concat()).expect(ExitCode::Done);
    (place.bytes("bracket.supel"), place.report_body("bracket.report.json"))
}

#[track_caller]
fn assert_same(found: &Written, expected: &Written, what: &str) {
    assert!(found.0 == expected.0, "the superelement differs: {what}");
    assert_eq!(found.1, expected.1, "the report differs: {what}");
}

fn assert_threads_change_nothing(method: &str) {
    let place = Place::with_example();
    for solver in eigensolver_words() {
        let by = |threads| reduced_by(&place, &["--method", method, "--eigensolver", solver, "--threads", threads]);
        let first = by("1");
        for threads in THREADS {
            assert_same(&by(threads), &first, &format!("{method} by {solver} with {threads} threads"));
        }
    }
}

#[test]
fn pages_for_people_do_not_touch_the_superelement() {
    let place = Place::with_example();
    let plain = reduced_by(&place, &[]);
    let (html, junit) = (place.text("bracket.html"), place.text("bracket.xml"));
    assert_same(&reduced_by(&place, &["--html", &html, "--junit", &junit]), &plain, "with a page");
}

#[test]
fn herting_does_not_depend_on_threads() {
    assert_threads_change_nothing("herting");
}

#[test]
fn craig_bampton_does_not_depend_on_threads() {
    assert_threads_change_nothing("craig-bampton");
}

/// A beam of square section, whose bending modes come in pairs, with an interface at both ends.
fn square_beam() -> Place {
    // 2325 dofs: the sparse products of five tiles run on as many threads as there are.
    Place::with(&brick([30, 4, 4], [10.0, 1.0, 1.0], &Material::STEEL_SI))
}

/// The corners of the two ends of [`square_beam`].
const ENDS: &str = "--interface root=1,125,621,745 --interface tip=31,155,651,775";

fn beam(place: &Place, rest: &str) -> Written {
    place.reduce(&place.model_flags(), &format!("{ENDS} {rest}")).expect(ExitCode::Done);
    (place.bytes("x.supel"), place.report_body("x.report.json"))
}

/// Copies of a repeated frequency may turn into each other by any rounding; that none differs shows in the bytes.
#[test]
fn pairs_of_modes_do_not_depend_on_threads_nor_on_the_run() {
    let place = square_beam();
    for method in ["herting", "craig-bampton", "mixed-interface --held root"] {
        for solver in eigensolver_words() {
            let flags = format!("--method {method} --eigensolver {solver} --modes 8 --threads");
            let first = beam(&place, &format!("{flags} 1"));
            let found = frequencies_hz(&place.superelement("x.supel"));
            assert!(found.windows(2).any(|pair| pair[1] / pair[0] - 1.0 < 1e-6), "no repeated frequency: {found:?}");
            for threads in THREADS {
                let again = beam(&place, &format!("{flags} {threads}"));
                assert_same(&again, &first, &format!("{flags} {threads}"));
            }
        }
    }
}

/// Every other method, Rubin's on an interface that holds nothing, and modes of a file.
#[test]
fn f_10_methods_do_not_depend_on_threads() {
    let model = brick([16, 4, 4], [6.0, 1.0, 0.8], &Material::STEEL_SI);
    let place = Place::with(&model);
    let wave = |k: usize| (0..model.n).map(|row| (0.01 * (k + 1) as f64 * (row * row % 977) as f64).sin()).collect();
    let columns: Vec<Vec<f64>> = (0..6).map(wave).collect();
    let mut text = format!("%%MatrixMarket matrix array real general\n{} {}\n", model.n, columns.len());
    columns.iter().flatten().for_each(|value| text += &format!("{value:.17e}\n"));
    place.write("V.mtx", text.as_bytes());
    let of_file = format!("{HELD_ENDS} --method mode-acceleration --modes-from {}", place.text("V.mtx"));
    for flags in [
        format!("{HELD_ENDS} --method rubin --modes 8"),
        "--interface pin=1 --method rubin --modes 4".to_owned(),
        format!("{HELD_ENDS} --method macneal --modes 8"),
        format!("{HELD_ENDS} --method guyan --inertia-relief"),
        of_file,
    ] {
        let written = |threads: &str| {
            place.reduce(&place.model_flags(), &format!("{flags} --threads {threads}")).expect(ExitCode::Done);
            (place.bytes("x.supel"), place.report_body("x.report.json"))
        };
        let first = written("1");
        for threads in &THREADS[1..] {
            assert_same(&written(threads), &first, &format!("{flags} with {threads} threads"));
        }
    }
}

/// Corners of the two ends of the brick of 16 × 4 × 4.
const HELD_ENDS: &str = "--interface root=1,69,341,409 --interface tip=17,85,357,425";

/// A job with loads, further matrices, damping, held dofs, a mean motion and multipoint constraints.
#[test]
fn f_10_a_job_with_everything_does_not_depend_on_threads() {
    let model = brick([10, 3, 3], [4.0, 1.0, 0.8], &Material::STEEL_SI);
    let place = Place::with(&model);
    let n = model.n;
    // Node 50 stays in the middle between its neighbours along the brick.
    let mut text = format!("%%MatrixMarket matrix coordinate real general\n3 {n} 9\n");
    for direction in 1..4 {
        for (node, factor) in [(50, 1.0), (49, -0.5), (51, -0.5)] {
            text += &format!("{direction} {} {factor}\n", 3 * (node - 1) + direction);
        }
    }
    place.write("G.mtx", text.as_bytes());
    let skew = model.stiffness.iter().filter(|(i, j, _)| i > j);
    let skew: Vec<String> = skew.map(|(i, j, value)| format!("{} {} {:e}\n", i + 1, j + 1, 1e-6 * value)).collect();
    let banner = "%%MatrixMarket matrix coordinate real skew-symmetric";
    place.write("S.mtx", format!("{banner}\n{n} {n} {}\n{}", skew.len(), skew.concat()).as_bytes());
    let job = r#"
interface = [{ name = "tip", coupling = "average", nodes = { within = { box = { min = [3.99, 0, 0], max = [9, 9, 9] } } } },
    { name = "side", nodes = [6, 17] }]
fixed  = [{ nodes = [1, 12, 23] }]
load   = [{ name = "pull", nodes = [60, 70], force = [1, 2, 3] }, { name = "spin", rotation = { axis = [0, 0, 1] } }]
matrix = [{ name = "spin", kind = "gyroscopic", file = "S.mtx" }]
damping = { modal = { ratio = 0.01 }, rigid_motion = "resist" }
reduction = { method = "herting", modes = { count = 6 } }
[model]
stiffness = "K.mtx"
mass      = "M.mtx"
dofs      = "dofs.txt"
nodes     = "nodes.csv"
constraints = "G.mtx"
[write]
superelement = "x.supel"
recovery = { nodes = [60, 70] }
"#;
    place.write("job.toml", job.as_bytes());
    assert_job_does_not_depend_on_threads(&place);
}

/// A string of points under tension.
#[test]
fn f_10_a_preloaded_component_does_not_depend_on_threads() {
    let n_points = 150;
    let (mut stiffness, mut mass) = (Assembler::default(), Assembler::default());
    for point in 1..n_points {
        for (axis, k) in [1e3, 1e2, 1e2].into_iter().enumerate() {
            let [a, b] = [3 * (point - 1) + axis as u32, 3 * point + axis as u32];
            [(a, a, k), (b, b, k), (a, b, -k)].into_iter().for_each(|(i, j, k)| stiffness.add(i, j, k));
        }
    }
    (0..3 * n_points).for_each(|row| mass.add(row, row, 1.0));
    let nodes = (0..n_points).map(|i| [f64::from(i), 0.0, 0.0]).collect();
    let place = Place::with(&Model::node_major(nodes, &[0, 1, 2], stiffness, mass));
    // The ends are pulled towards each other by what their springs take up.
    let forces = (0..3 * n_points).map(|row| match row {
        0 => -1e2,
        row if row == 3 * n_points - 3 => 1e2,
        _ => 0.0,
    });
    let values: Vec<String> = forces.map(|force| format!("{force:e}\n")).collect();
    let head = format!("%%MatrixMarket matrix array real general\n{} 1\n", values.len());
    place.write("q.mtx", (head + &values.concat()).as_bytes());
    let job = r#"
model     = { stiffness = "K.mtx", mass = "M.mtx", dofs = "dofs.txt", nodes = "nodes.csv", state = "preloaded", internal_forces = "q.mtx" }
interface = [{ name = "ends", nodes = [1, 150] }]
reduction = { method = "herting", modes = { count = 8 } }
write     = { superelement = "x.supel" }
"#;
    place.write("job.toml", job.as_bytes());
    assert_job_does_not_depend_on_threads(&place);
}

#[track_caller]
fn assert_job_does_not_depend_on_threads(place: &Place) {
    let written = |threads: &str| {
        supel(&["reduce", &place.text("job.toml"), "--threads", threads]).expect(ExitCode::Done);
        (place.bytes("x.supel"), place.report_body("x.report.json"))
    };
    let first = written("1");
    for threads in &THREADS[1..] {
        assert_same(&written(threads), &first, &format!("{threads} threads"));
    }
}

/// METIS draws from `rand` and ARPACK keeps the state of its generator: a job before must not be felt by the one after.
#[test]
fn a_job_does_not_depend_on_the_jobs_before_it() {
    let (beams, chains) = (square_beam(), Place::with(&spring(200, Ends::Free)));
    for solver in eigensolver_words() {
        let of_beam = || beam(&beams, &format!("--method herting --eigensolver {solver} --modes 6"));
        let of_chain = || {
            let flags = format!("--interface ends=rows:0,199 --method herting --eigensolver {solver} --modes 9");
            chains.reduce(&chains.matrix_flags(), &flags).expect(ExitCode::Done);
            (chains.bytes("x.supel"), chains.report_body("x.report.json"))
        };
        let (first_beam, first_chain) = (of_beam(), of_chain());
        let (second_chain, second_beam) = (of_chain(), of_beam());
        assert_same(&second_beam, &first_beam, &format!("{solver}, the beam after the chain"));
        assert_same(&second_chain, &first_chain, &format!("{solver}, the chain before the beam"));
    }
}

/// Jobs that run at the same time share the state of the process.
#[test]
fn a_job_does_not_depend_on_jobs_that_run_at_its_side() {
    for solver in eigensolver_words() {
        let flags = |method: &str| format!("--method {method} --eigensolver {solver} --modes 6 --threads 2");
        let methods = ["herting", "craig-bampton", "herting", "craig-bampton"];
        let alone = methods.map(|method| beam(&square_beam(), &flags(method)));
        let together = std::thread::scope(|scope| {
            let started = methods.map(|method| scope.spawn(move || beam(&square_beam(), &flags(method))));
            started.map(|job| job.join().expect("a job that ends"))
        });
        for (job, (together, alone)) in together.iter().zip(&alone).enumerate() {
            assert_same(together, alone, &format!("{solver}, job {job} together with three others"));
        }
    }
}

#[test]
fn nothing_depends_on_the_folder_and_the_body_names_none() {
    let (a, b) = (Place::with_example(), Place::with_example());
    let (first, second) = (reduced(&a, "herting", "2"), reduced(&b, "herting", "2"));
    assert_same(&first, &second, "another folder");
    for place in [&a, &b] {
        let folder = place.text("");
        assert!(!first.1.contains(folder.trim_end_matches('/')), "the body names {folder}");
    }
}

#[test]
fn the_job_in_the_file_makes_the_file_again() {
    let place = Place::with_example();
    for method in ["herting", "craig-bampton"] {
        let (bytes, body) = reduced(&place, method, "2");
        let job = supel(&["inspect", &place.text("bracket.supel"), "--job"]).expect(ExitCode::Done);
        place.write("again.json", job.out.as_bytes());
        std::fs::remove_file(place.path("bracket.supel")).expect("removed");
        supel(&["reduce", &place.text("again.json")]).expect(ExitCode::Done);
        assert!(place.bytes("bracket.supel") == bytes, "{method}: the file differs");
        assert_eq!(place.report_body("bracket.report.json"), body);
    }
}
